# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Regions of signal colours on the CIE 1931 diagram, with the spectral locus as an arc."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.colour.locus import spectral_locus
from lamplit.errors import RuleError, nearest_name
from lamplit.rules.models import ColourRegion, Edge, RuleFile, Trust
from lamplit.toml_files import read_toml

Array = NDArray[np.float64]

_FILE = Path(__file__).parent / "library" / "colours.toml"

#: A chromaticity so near to a border lies on it, and the regulations' ≤ let it through.
_ON_BORDER = 1e-9
#: One so little beyond the spectral locus or the purple line counts as the nearest on it: no light
#: lies beyond, but a table at each nm joined by chords does not say where that is any better. From
#: 545 nm on the curve bulges past its chords by 8·10⁻⁶ and less, beyond 700 nm the table's last
#: digit moves it by 10⁻⁷. The edges that a regulation draws, and their corners, stay exact.
_ON_LOCUS = 1e-5
#: The least variance of x and y: a colour that does not scatter has a circle of this size.
_SMALLEST_VARIANCE = 1e-18


class BorderDistance(NamedTuple):
    """How far a chromaticity is inside a region, and from which edge."""

    #: In x, y; below 0 outside.
    distance: float
    #: In standard errors, along the direction in which the border is nearest in these.
    sigmas: float
    #: Standard error of the distance to the border's nearest point, in x, y.
    standard_error: float
    #: The edge, as the document writes it.
    edge: str


@dataclass(frozen=True, eq=False)
class Region:
    """A region of the CIE 1931 chromaticity diagram."""

    name: str
    title: str
    clause: str
    trust: Trust
    #: (k, 2), where one edge meets the next, and (k,) the wavelength there; NaN off the locus.
    vertices: Array
    vertices_nm: Array
    #: (n, 2), the border as a closed line, the last point joined to the first.
    border: Array
    #: The edge that each of its n pieces belongs to.
    edges: tuple[str, ...]
    #: (n,), whether light can lie beyond: not beyond the spectral locus or the purple line.
    crossable: NDArray[np.bool_]

    def contains(self, xy: ArrayLike) -> bool:
        """Return whether a chromaticity (2,) lies in the region or on its border.

        So does one that lies beyond the spectral locus by 10⁻⁵ or less, square to it.
        """
        point = np.asarray(xy, dtype=np.float64)
        distance, at = _nearest(point, self.border)
        if distance <= _ON_BORDER or _inside(point, self.border):
            return True
        return distance <= _ON_LOCUS and self._faces_limit(point, at)

    def _faces_limit(self, point: Array, at: int) -> bool:
        """Return whether piece ``at`` limits all light and its end is not the nearest point."""
        after = (at + 1) % len(self.border)
        if self.crossable[at]:
            return False
        start, end = self.border[at], self.border[after]
        share = float((point - start) @ (end - start)) / float((end - start) @ (end - start))
        return (share > 0.0 or not self.crossable[at - 1]) and (
            share < 1.0 or not self.crossable[after]
        )

    def border_distance(self, xy: ArrayLike, covariance: ArrayLike | None = None) -> BorderDistance:
        """Return how far a chromaticity (2,) is inside, also in its standard errors.

        ``covariance`` (2, 2) is that of x and y; without it, the colour is exact. The ellipse of
        k standard errors touches the border when ``sigmas`` = k: the plane is stretched until the
        ellipse is a circle, and there the nearest point of the border is sought. From inside, only
        edges count that light can cross: the colour of an LED lies next to the spectral locus, and
        no scatter takes it beyond.
        """
        point = np.asarray(xy, dtype=np.float64)
        inside = self.contains(point)
        pieces = self.crossable if inside else np.ones_like(self.crossable)
        distance, _ = _nearest(point, self.border, pieces)
        spread = np.zeros((2, 2)) if covariance is None else np.asarray(covariance, np.float64)
        variances, axes = np.linalg.eigh(spread)
        lengths = np.sqrt(np.maximum(variances, _SMALLEST_VARIANCE))
        whitened = np.asarray((self.border - point) @ axes / lengths, dtype=np.float64)
        sigmas, at = _nearest(np.zeros(2), whitened, pieces)
        sign = 1.0 if inside else -1.0
        error = distance / sigmas if sigmas > 0.0 else float(np.sqrt(np.trace(spread)))
        return BorderDistance(sign * distance, sigmas, error, self.edges[at])


@cache
def _library() -> RuleFile:
    return RuleFile.model_validate(read_toml(_FILE, noun="rule", error=RuleError))


def region_names() -> tuple[str, ...]:
    """Return the names of the regions that come with Lamplit."""
    return tuple(_library().colours)


@cache
def region(name: str) -> Region:
    """Return the library's region ``name``.

    >>> region("un-red").vertices.round(3).tolist()[0]
    [0.645, 0.335]

    Raises:
        RuleError: There is none; the message names the nearest.
    """
    if name not in region_names():
        near = nearest_name(name, region_names()) or f"; there are {', '.join(region_names())}"
        raise RuleError(f"there is no colour region {name[:60]!r}{near}")
    return build_region(name, _library().colours[name])


def check_region(written: ColourRegion, *, where: str) -> None:
    """Refuse a region whose edges do not meet.

    Raises:
        RuleError: With ``where``, and what to do.
    """
    try:
        build_region("", written)
    except RuleError as fault:
        raise RuleError(fault.message, where=where) from None


def build_region(name: str, written: ColourRegion) -> Region:
    """Return the region that a rule file writes down, edge after edge.

    Raises:
        RuleError: Two edges that follow each other do not meet.
    """
    count = len(written.edges)
    corners: list[Array] = []
    wavelengths: list[float] = []
    for at, edge in enumerate(written.edges):
        point, nm = _meeting(written.edges[at - 1], edge)
        corners.append(point)
        wavelengths.append(nm)
    border: list[Array] = []
    labels: list[str] = []
    crossable: list[bool] = []
    for at, edge in enumerate(written.edges):
        piece = _piece(edge, corners[at], wavelengths[at], wavelengths[(at + 1) % count])
        border.append(piece)
        labels += [edge.label] * len(piece)
        crossable += [edge.line is not None] * len(piece)
    return Region(
        name,
        written.title,
        written.clause,
        written.trust,
        np.array(corners),
        np.array(wavelengths),
        np.concatenate(border),
        tuple(labels),
        np.array(crossable),
    )


def _piece(edge: Edge, start: Array, start_nm: float, end_nm: float) -> Array:
    """Return the corner where an edge begins and, on the locus, its points each nm."""
    if edge.locus_nm is None:
        return start[None]
    nm, locus = spectral_locus()
    low, high = min(start_nm, end_nm), max(start_nm, end_nm)
    between = (nm > low) & (nm < high)
    arc = locus[between]
    return np.concatenate([start[None], arc if start_nm < end_nm else arc[::-1]])


def _meeting(first: Edge, second: Edge) -> tuple[Array, float]:
    """Return where two edges meet, and the wavelength there; NaN off the locus."""
    _, locus = spectral_locus()
    if first.locus_nm is not None and second.locus_nm is not None:
        raise RuleError("two edges on the spectral locus follow each other; make them one")
    if first.locus_nm is not None or second.locus_nm is not None:
        arc, other = (first, second) if first.locus_nm is not None else (second, first)
        return _on_locus(arc, _line(other, locus), other.label)
    a, b = _line(first, locus), _line(second, locus)
    matrix = np.array([a[:2], b[:2]])
    if abs(float(np.linalg.det(matrix))) < 1e-12:
        raise RuleError(f"the edges {first.label!r} and {second.label!r} are parallel")
    met = np.linalg.solve(matrix, np.array([a[2], b[2]]))
    return np.asarray(met, dtype=np.float64), float("nan")


def _line(edge: Edge, locus: Array) -> Array:
    """Return a, b, c of a x + b y = c; the purple line joins the ends of the locus."""
    if edge.line is not None:
        return np.array(edge.line)
    (x0, y0), (x1, y1) = locus[-1], locus[0]
    return np.array([y1 - y0, x0 - x1, (y1 - y0) * x0 + (x0 - x1) * y0])


def _on_locus(arc: Edge, line: Array, label: str) -> tuple[Array, float]:
    nm, locus = spectral_locus()
    low, high = arc.locus_nm or (nm[0], nm[-1])
    off = locus @ line[:2] - line[2]
    # The last point counts as met when the purple line ends in it.
    off = np.where(np.abs(off) < 1e-12, 0.0, off)
    for at in range(len(nm) - 1):
        if off[at] * off[at + 1] > 0.0:
            continue
        step = off[at] / (off[at] - off[at + 1]) if off[at] != off[at + 1] else 0.0
        wavelength = float(nm[at] + step * (nm[at + 1] - nm[at]))
        if low <= wavelength <= high:
            return locus[at] + step * (locus[at + 1] - locus[at]), wavelength
    raise RuleError(f"{label!r} does not meet the spectral locus from {low:g} to {high:g} nm")


def _nearest(
    point: Array, border: Array, pieces: NDArray[np.bool_] | None = None
) -> tuple[float, int]:
    """Return the distance to a closed line, or some ``pieces`` of it, and the nearest piece."""
    along = np.roll(border, -1, axis=0) - border
    length = np.sum(along * along, axis=1)
    share = np.sum((point - border) * along, axis=1) / np.where(length > 0.0, length, 1.0)
    foot = border + np.clip(share, 0.0, 1.0)[:, None] * along
    distance = np.hypot(*(foot - point).T)
    if pieces is not None:
        distance = np.where(pieces, distance, np.inf)
    at = int(np.argmin(distance))
    return float(distance[at]), at


def _inside(point: Array, border: Array) -> bool:
    """Return whether a half line from the point crosses a closed line an odd number of times."""
    after = np.roll(border, -1, axis=0)
    spans = (border[:, 1] > point[1]) != (after[:, 1] > point[1])
    rise = np.where(spans, after[:, 1] - border[:, 1], 1.0)
    crossing = border[:, 0] + (point[1] - border[:, 1]) / rise * (after[:, 0] - border[:, 0])
    return bool(np.count_nonzero(spans & (crossing > point[0])) % 2)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Photometry`: the luminous intensity of a lamp or luminaire in every direction.

The frame of a luminaire is right-handed. Its **axis is +z**: straight down (nadir) for type C, the
photometric axis (0, 0) for types A and B. Its **reference is +y**: the plane C = 0 for type C, up
for types A and B. An observer whom the axis points at, with +y up, has +x on the right-hand side.

    type C   (sin γ sin C,   sin γ cos C,   cos γ)     γ vertical angle from nadir, C horizontal
    type A   (−cos V sin H,  sin V,         cos V cos H)       polar axis ±y
    type B   (−sin H,        cos H sin V,   cos H cos V)       polar axis ±x

So C runs counterclockwise and H clockwise for one who looks from behind the luminaire along +z,
that is from above where the axis is nadir. H > 0 is on the right of one who looks where the lamp
shines, which is the left of one who looks at the lamp.
Source: ANSI/IESNA LM-63-2002, clause 3; CIE 121-1996.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

PhotometricType = Literal["A", "B", "C"]

#: Rounding of a direction may take it this far, in degrees, over the edge of a table.
_EDGE_DEG = 1e-9


@dataclass(frozen=True, eq=False)
class PolarTable:
    """Intensities on a grid of azimuths and polar angles about a pole, bilinear in both.

    A direction with the azimuth φ and the polar angle θ is sin θ (cos φ **u** + sin φ **v**) +
    cos θ **p**, where the rows of ``frame`` are **u**, **v** and the pole **p** in the luminaire's
    frame: unit vectors at right angles, left-handed for types A and C. Outside of the grid is dark.
    """

    #: (a,), rising, at most a full turn.
    azimuths_deg: NDArray[np.float64]
    #: (t,), rising, from 0 to 180.
    polar_deg: NDArray[np.float64]
    #: (a, t), in cd.
    candela: NDArray[np.float64]
    #: (3, 3): rows u, v, p.
    frame: NDArray[np.float64]

    def intensity_cd(self, directions: ArrayLike) -> NDArray[np.float64]:
        """Return the intensity (…) in cd towards ``directions`` (…, 3) of any length but 0."""
        along = np.asarray(directions, dtype=np.float64) @ self.frame.T
        u, v, p = along[..., 0], along[..., 1], along[..., 2]
        first = self.azimuths_deg[0]
        turned = np.mod(np.degrees(np.arctan2(v, u)) - first, 360.0)
        azimuth = first + np.where(turned > 360.0 - _EDGE_DEG, 0.0, turned)
        polar = np.degrees(np.arctan2(np.hypot(u, v), p))
        i, s, beyond = _cell(self.azimuths_deg, azimuth)
        j, t, above = _cell(self.polar_deg, polar)
        table = self.candela
        low = (1.0 - t) * table[i, j] + t * table[i, j + 1]
        high = (1.0 - t) * table[i + 1, j] + t * table[i + 1, j + 1]
        return np.where(beyond | above, 0.0, (1.0 - s) * low + s * high)

    def flux_lm(self) -> float:
        """Return ∫∫ I sin θ dθ dφ in lm, exact for the bilinear table."""
        azimuths, polar = np.radians(self.azimuths_deg), np.radians(self.polar_deg)
        trapezes = np.zeros_like(azimuths)
        trapezes[:-1] += 0.5 * np.diff(azimuths)
        trapezes[1:] += 0.5 * np.diff(azimuths)
        # ∫ sin θ dθ over an interval, and the part of it that falls to its upper end.
        steps = np.diff(polar)
        whole = -np.diff(np.cos(polar))
        upper = np.diff(np.sin(polar)) / steps - np.cos(polar[1:])
        rings = np.zeros_like(polar)
        rings[:-1] += whole - upper
        rings[1:] += upper
        return float(trapezes @ self.candela @ rings)


@dataclass(frozen=True, eq=False)
class Photometry:
    """A luminous intensity distribution in the angles of its file; symmetries are written out.

    Directions outside of the angles given are dark.
    """

    photometric_type: PhotometricType
    #: (h,), rising: C from 0 to 360, both ends there (type C); H (types A and B).
    horizontal_deg: NDArray[np.float64]
    #: (v,), rising: γ from 0 to 180 at most (type C); V (types A and B).
    vertical_deg: NDArray[np.float64]
    #: (h, v), in cd, with every factor of the file applied.
    candela: NDArray[np.float64]
    #: What the file states as the flux of its lamps together, in lm (in absolute photometry of an
    #: EULUMDAT file: of the luminaire); None where an IES file is absolute.
    lamp_flux_lm: float | None

    @cached_property
    def polar(self) -> PolarTable:
        """The same table about a pole, one form for all three types."""
        x, y, z = np.eye(3)
        if self.photometric_type == "C":
            frame = np.stack([y, x, z])
            return PolarTable(self.horizontal_deg, self.vertical_deg, self.candela, frame)
        if self.photometric_type == "A":
            frame = np.stack([z, -x, y])
            polar = 90.0 - self.vertical_deg[::-1]
            return PolarTable(self.horizontal_deg, polar, self.candela[:, ::-1], frame)
        frame = np.stack([z, y, -x])
        polar = 90.0 - self.horizontal_deg[::-1]
        return PolarTable(self.vertical_deg, polar, self.candela[::-1].T, frame)

    def intensity_cd(self, directions: ArrayLike) -> NDArray[np.float64]:
        """Return the luminous intensity (…) in cd towards unit vectors (…, 3) in the own frame."""
        return self.polar.intensity_cd(directions)

    def flux_lm(self) -> float:
        """Return the luminous flux of the whole distribution in lm, integrated from the table."""
        return self.polar.flux_lm()


def _cell(
    nodes: NDArray[np.float64], values: NDArray[np.float64]
) -> tuple[NDArray[np.intp], NDArray[np.float64], NDArray[np.bool_]]:
    """Return the interval of each value, how far along it lies (0 to 1), and what lies outside."""
    at = np.clip(np.searchsorted(nodes, values, side="right") - 1, 0, nodes.size - 2)
    share = (values - nodes[at]) / (nodes[at + 1] - nodes[at])
    outside = (values < nodes[0] - _EDGE_DEG) | (values > nodes[-1] + _EDGE_DEG)
    return at, np.clip(share, 0.0, 1.0), outside


def mirrored(
    angles: NDArray[np.float64], candela: NDArray[np.float64], about_deg: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return angles (n,) and their rows (n, …) with their mirror image about one of their ends.

    >>> mirrored(np.array([0.0, 90.0]), np.array([[1.0], [2.0]]), 90.0)[0].tolist()
    [0.0, 90.0, 180.0]
    """
    images, rows = 2.0 * about_deg - angles[::-1], candela[::-1]
    if about_deg == angles[-1]:
        return np.concatenate([angles, images[1:]]), np.concatenate([candela, rows[1:]])
    return np.concatenate([images[:-1], angles]), np.concatenate([rows[:-1], candela])


def full_turn(
    planes_deg: NDArray[np.float64], candela: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the C-planes 0 to 360 of those that a file gives, (c,) and (c, v), by their ends.

    0 alone: the same all around; 0 to 90 and 0 to 180: mirrored; 90 to 270 and −90 to 90: mirrored
    about 90–270; 0 to 360: as they are; 0 to between 180 and 360: closed by the plane 0.

    Raises:
        ValueError: The ends are others.
    """
    first, last = float(planes_deg[0]), float(planes_deg[-1])
    if (first, last) == (0.0, 0.0):
        return np.array([0.0, 360.0]), np.repeat(candela, 2, axis=0)
    if (first, last) in {(0.0, 90.0), (0.0, 180.0)}:
        while planes_deg[-1] < 360.0:
            planes_deg, candela = mirrored(planes_deg, candela, float(planes_deg[-1]))
        return planes_deg, candela
    if (first, last) in {(90.0, 270.0), (-90.0, 90.0)}:
        planes_deg, candela = mirrored(planes_deg, candela, last)
        return _from_zero(planes_deg, candela)
    if first == 0.0 and 180.0 < last < 360.0:
        return np.append(planes_deg, 360.0), np.concatenate([candela, candela[:1]])
    if (first, last) == (0.0, 360.0):
        return planes_deg, candela
    raise ValueError(
        f"planes from {first:g}° to {last:g}° are no symmetry of the format; they go "
        "from 0° to 0°, 90°, 180° or 360°, or from 90° to 270°"
    )


def _from_zero(
    planes_deg: NDArray[np.float64], candela: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the planes of a full turn, both ends there, beginning at 0 instead.

    Where 0 itself is not among them, it lies in the middle of two planes that mirror each other.
    """
    turned = np.mod(planes_deg[:-1], 360.0)
    order = np.argsort(turned)
    planes, rows = turned[order], candela[:-1][order]
    if planes[0] != 0.0:
        share = planes[0] / (planes[0] + 360.0 - planes[-1])
        middle = (1.0 - share) * rows[:1] + share * rows[-1:]
        planes, rows = np.append(0.0, planes), np.concatenate([middle, rows])
    return np.append(planes, 360.0), np.concatenate([rows, rows[:1]])

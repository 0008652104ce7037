# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Chromaticities with their 2 σ ellipses, beside the legal region of colour."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamplit.report.photometry.style import (
    FAINT,
    INK,
    PAPER,
    QUIET,
    dress,
    head,
    new_figure,
    shortened,
)
from lamplit.report.photometry.table import angle
from lamplit.report.sheet import FONT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lamplit.photometry.observed import Observed
    from lamplit.report.photometry.results import ColourRegion, FunctionResults

Array = NDArray[np.float64]

_REGION_INK = {"red": "#b3261e", "amber": "#b06a00", "yellow": "#b06a00", "white": "#6b6a66"}
#: Where the close view stands, in the axes' own 0 to 1: left, bottom, width, height.
_CLOSE_VIEW = (0.57, 0.58, 0.42, 0.41)
_TICKS_NM = (480, 520, 560, 580, 590, 600, 610, 620, 640, 700)


class Ellipse(NamedTuple):
    """The k σ ellipse of a chromaticity: half axes (major first), and the major's direction."""

    half_major: float
    half_minor: float
    angle_deg: float


def ellipse_of(covariance: Array, sigmas: float = 2.0) -> Ellipse:
    """Return the ellipse (d/σ)² = ``sigmas``² of a covariance (2, 2).

    Its half axes are ``sigmas`` times the roots of the eigenvalues. With 2 it holds 1 − e⁻² = 86 %
    of a normal distribution.
    """
    values, vectors = np.linalg.eigh(covariance)
    minor, major = sigmas * np.sqrt(np.maximum(values, 0.0))
    across, up = vectors[:, 1]
    return Ellipse(float(major), float(minor), float(np.degrees(np.arctan2(up, across))) % 180.0)


def draw_chromaticity(function: FunctionResults) -> Figure | None:
    """Draw the spots' chromaticities by the legal region; None where that of none is known."""
    observed = function.observed
    xy, covariance, known = observed.spot_colours
    if not known.any():
        return None
    region = function.region
    figure = new_figure(4.7, 4.7)
    head(
        figure,
        f"{shortened(observed.name, 24)}: colour at the test points",
        f"CIE 1931 x, y; ellipses: 2 σ (86 %)"
        f"{'' if region is None else f'; outlined: {region.name}, as allowed'}",
    )
    axes = figure.add_axes((0.135, 0.105, 0.845, 0.755))
    dress(axes, x="x", y="y")
    _window(axes, xy[known], region)
    _draw_locus(axes, covered=(_CLOSE_VIEW[0] - 0.16, _CLOSE_VIEW[1] - 0.08))
    if region is not None:
        _draw_region(axes, region)
    for place in np.flatnonzero(known):
        _draw_ellipse(axes, xy[place], covariance[place])
    _draw_overview(axes, region)
    _draw_close_view(axes, function)
    return figure


def _draw_close_view(axes: Axes, function: FunctionResults) -> None:
    """Draw the points once more, as large as fits, where no colour is: to the upper right."""
    colours = function.observed.spot_colours
    xy, covariance, known = colours
    reach = 2.0 * colours.standard_error[known]
    low, high = (xy[known] - reach).min(axis=0), (xy[known] + reach).max(axis=0)
    half = max(0.6 * float((high - low).max()), 5e-5)
    if half > 0.3 * float(np.ptp(axes.get_xlim())):
        _name_some(axes, function.observed)
        return
    close = axes.inset_axes(_CLOSE_VIEW)
    close.set_facecolor(PAPER)
    for spine in close.spines.values():
        spine.set(color=QUIET, linewidth=0.8)
    close.tick_params(colors=QUIET, labelsize=6.5, length=2, width=0.5)
    middle = 0.5 * (low + high)
    limits = [(float(at - half), float(at + half)) for at in middle]
    if function.region is not None:
        _draw_region(close, function.region)
    close.set(xlim=limits[0], ylim=limits[1], aspect="auto")
    _draw_locus(close)
    for place in np.flatnonzero(known):
        _draw_ellipse(close, xy[place], covariance[place])
    close.locator_params(nbins=3)
    close.ticklabel_format(useOffset=False)
    _name_some(close, function.observed)
    axes.indicate_inset_zoom(close, edgecolor=QUIET, alpha=0.8, linewidth=0.7)


def _window(axes: Axes, xy: Array, region: ColourRegion | None) -> None:
    """Set the limits to a square round the region and the points, wider where the axes are."""
    every = xy if region is None else np.concatenate([xy, region.outline_xy])
    middle = 0.5 * (every.min(axis=0) + every.max(axis=0))
    half = max(0.58 * float(np.ptp(every, axis=0).max()), 0.012)
    x, y = ((float(at - half), float(at + half)) for at in middle)
    box = axes.get_window_extent()
    stretch = half * (box.width / box.height - 1.0)
    x = (x[0] - stretch, x[1] + stretch)
    axes.set(xlim=x, ylim=y, aspect="equal")
    axes.locator_params(nbins=5)


def _draw_locus(axes: Axes, covered: tuple[float, float] = (1.0, 1.0)) -> None:
    """Draw the spectral locus and the purple line, with wavelengths where they are in sight.

    What lies to the upper right of ``covered``, in the axes' own 0 to 1, gets no wavelength.
    """
    from lamplit.colour.locus import spectral_locus

    nm, locus = spectral_locus("cie-1931-2")
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    axes.plot(*np.concatenate([locus, locus[:1]]).T, color=QUIET, linewidth=1.0)
    for at in np.flatnonzero(np.isin(nm, _TICKS_NM)):
        x, y = locus[at]
        hidden = x > left + covered[0] * (right - left) and y > low + covered[1] * (high - low)
        if left < x < right and low < y < high and not hidden:
            axes.plot(x, y, "o", ms=2.4, color=QUIET)
            axes.annotate(f"{nm[at]:g} nm", (x, y), (4, 3), textcoords="offset points",
                          color=QUIET, fontsize=7, family=FONT, annotation_clip=True)  # fmt: skip
    axes.set(xlim=(left, right), ylim=(low, high))


def _region_ink(region: ColourRegion) -> str:
    """Return the ink of a region by the colour that its name has in it."""
    words = region.name.lower()
    return next((ink for name, ink in _REGION_INK.items() if name in words), INK)


def _draw_region(axes: Axes, region: ColourRegion) -> None:
    from matplotlib.patches import Polygon

    ink = _region_ink(region)
    shape = Polygon(region.outline_xy, facecolor=ink + "14", edgecolor=ink, linewidth=1.3)
    axes.add_patch(shape)


def _draw_ellipse(axes: Axes, xy: Array, covariance: Array) -> None:
    from matplotlib.patches import Ellipse as Drawn

    found = ellipse_of(covariance)
    axes.add_patch(
        Drawn(
            (float(xy[0]), float(xy[1])), 2 * found.half_major, 2 * found.half_minor,
            angle=found.angle_deg, facecolor=INK + "10", edgecolor=INK, linewidth=0.6, zorder=3,
        )
    )  # fmt: skip
    axes.plot(*xy, "o", ms=2.4, color=INK, zorder=4)


def _name_some(axes: Axes, observed: Observed) -> None:
    """Name the spot on the axis and the one whose colour is farthest from it."""
    xy, _, known = observed.spot_colours
    on_axis = known & (observed.spot_h_deg == 0.0) & (observed.spot_v_deg == 0.0)
    start = int(np.argmax(on_axis)) if on_axis.any() else int(np.argmax(known))
    away = np.where(known, np.hypot(*(xy - xy[start]).T), -1.0)
    farthest = int(np.argmax(away))
    for place in dict.fromkeys((start, farthest)):
        h_deg, v_deg = float(observed.spot_h_deg[place]), float(observed.spot_v_deg[place])
        name = "HV" if h_deg == v_deg == 0.0 else f"H {angle(h_deg)}, V {angle(v_deg)}"
        left, right = axes.get_xlim()
        above = (place == start) == (xy[farthest, 0] <= xy[start, 0])
        inward = xy[place, 0] < left + 0.45 * (right - left)
        axes.annotate(
            name, xy[place], (6, 5) if above else (6 if inward else -6, -11), color=INK,
            textcoords="offset points", fontsize=7.5, family=FONT, zorder=6,
            ha="left" if above or inward else "right",
        )  # fmt: skip


def _draw_overview(axes: Axes, region: ColourRegion | None) -> None:
    """Show in a small diagram which part of all colours is drawn."""
    from matplotlib.patches import Polygon, Rectangle

    from lamplit.colour.locus import spectral_locus

    _, locus = spectral_locus("cie-1931-2")
    small = axes.inset_axes((0.0, 0.0, 0.2, 0.24))
    small.set(xlim=(-0.02, 0.78), ylim=(-0.02, 0.86), aspect="equal", anchor="SW")
    small.set_axis_off()
    small.add_patch(Polygon(locus, facecolor=PAPER, edgecolor=QUIET, linewidth=0.8))
    if region is not None:
        ink = _region_ink(region)
        small.add_patch(Polygon(region.outline_xy, facecolor=ink, edgecolor="none"))
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    frame = Rectangle((left, low), right - left, high - low, fill=False, edgecolor=INK)
    frame.set(linewidth=0.7)
    small.add_patch(frame)
    small.patch.set_facecolor(FAINT)

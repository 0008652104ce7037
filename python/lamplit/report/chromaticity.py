# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The CIE x, y diagram with displays, signal colours and marked pixels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lamplit.report.sheet import FAINT, PAGE, QUIET, TEXT
from lamplit.report.summary import chromaticity

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from lamplit.report.difference import Mark

Array = NDArray[np.float64]

#: UN Regulation No. 48, 2.29, and SAE J578: four corners (x, y), CIE 1931. From the second to the
#: third the boundary is the spectral locus between the two wavelengths in nm.
_SIGNAL_COLOURS: dict[str, tuple[list[tuple[float, float]], tuple[float, float]]] = {
    "red": ([(0.645, 0.335), (0.665, 0.335), (0.735, 0.265), (0.721, 0.259)], (610.0, 700.0)),
    "amber": ([(0.545, 0.425), (0.560, 0.440), (0.609, 0.390), (0.597, 0.390)], (588.0, 596.0)),
}
_SIGNAL_INK = {"red": "#ff5a4f", "amber": "#ffb02e"}
_DISPLAYS = {"srgb": ("sRGB", "-"), "display-p3": ("Display P3", (0, (5, 3)))}
#: Where the close view stands in the diagram, beside the locus: x, y, width, height.
_CLOSE_VIEW = (0.70, 0.42, 0.44, 0.44)
_LOCUS_TICKS_NM = (460, 480, 500, 520, 540, 560, 580, 600, 620, 680)


def draw_chromaticities(axes: Axes, marks: Sequence[Mark], *, observer: str, scale: float) -> None:
    """Draw the diagram of ``observer`` with ``marks``, and a close view of them, into ``axes``.

    A ring is the RGB picture, a dot the spectral one. ``scale`` multiplies line widths and text.
    """
    from lamplit.colour.locus import spectral_locus

    wavelengths_nm, locus = spectral_locus(observer)
    _dress(axes, scale)
    _draw_ground(axes, locus, observer, scale)
    ticks = np.arange(9) / 10.0
    axes.set(xlim=(-0.02, 1.16), ylim=(-0.02, 0.88), aspect="equal", anchor="NW")
    axes.set(xticks=ticks, yticks=ticks)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines["bottom"].set_bounds(-0.02, 0.82)
    for at in np.flatnonzero(np.isin(wavelengths_nm, _LOCUS_TICKS_NM)):
        _label_wavelength(axes, f"{wavelengths_nm[at]:g}", locus[at - 3 : at + 4], scale)
    legend = axes.legend(loc="lower right", bbox_to_anchor=(0.93, 0.03), fontsize=8 * scale)
    legend.set(frame_on=False, zorder=0)
    for text in legend.get_texts():
        text.set_color(QUIET)
    window = _window(marks)
    if window is None:
        return
    close = axes.inset_axes(_CLOSE_VIEW, transform=axes.transData)
    _dress(close, scale)
    _draw_ground(close, locus, observer, scale)
    close.set(xlim=window[0], ylim=window[1], aspect="equal")
    close.locator_params(nbins=4)
    _draw_marks(close, marks, scale, numbers=True)
    _draw_marks(axes, marks, 0.6 * scale, numbers=False)
    axes.indicate_inset_zoom(close, edgecolor=QUIET, alpha=0.6, linewidth=0.8 * scale)


def signal_region(name: str) -> Array:
    """Return the outline x, y (n, 2) of a UN signal colour: ``red`` or ``amber``."""
    from lamplit.colour.locus import spectral_locus

    corners, (low_nm, high_nm) = _SIGNAL_COLOURS[name]
    wavelengths_nm, locus = spectral_locus("cie-1931-2")
    arc = locus[(wavelengths_nm >= low_nm) & (wavelengths_nm <= high_nm)]
    return np.concatenate([corners[:2], arc, corners[2:]])


def _dress(axes: Axes, scale: float) -> None:
    axes.set_facecolor(PAGE)
    axes.tick_params(colors=QUIET, labelsize=7.5 * scale, length=3 * scale, width=0.6 * scale)
    for spine in axes.spines.values():
        spine.set(color=FAINT, linewidth=0.8 * scale)


def _draw_ground(axes: Axes, locus: Array, observer: str, scale: float) -> None:
    from matplotlib.patches import Polygon

    from lamplit.colour.display import Display

    closed = np.concatenate([locus, locus[:1]])
    fill = axes.imshow(
        _horseshoe(), extent=(0.0, 0.8, 0.0, 0.9), origin="lower", alpha=0.5, aspect="auto"
    )
    outline = Polygon(closed, closed=True, transform=axes.transData, fill=False, linewidth=0)
    axes.add_patch(outline)
    fill.set_clip_path(outline)
    axes.plot(*closed.T, color=QUIET, linewidth=1.0 * scale)
    for name, (label, style) in _DISPLAYS.items():
        corners = np.asarray(Display.named(name).primaries_xy)
        outline = Polygon(corners, fill=False, edgecolor="white", linestyle=style)
        outline.set(linewidth=0.9 * scale, label=label, alpha=0.85)
        axes.add_patch(outline)
    if observer != "cie-1931-2":
        return
    for name, ink in _SIGNAL_INK.items():
        region = Polygon(signal_region(name), facecolor=ink + "2e", edgecolor=ink)
        region.set(linewidth=1.1 * scale, label=f"UN {name}")
        axes.add_patch(region)


def _draw_marks(axes: Axes, marks: Sequence[Mark], scale: float, *, numbers: bool) -> None:
    style: dict[str, Any] = {"linestyle": "none", "clip_on": True}
    for mark in marks:
        rgb, spectral = chromaticity(mark.rgb_xyz), chromaticity(mark.spectral_xyz)
        if rgb is None or spectral is None:
            continue
        axes.plot(*np.transpose([rgb, spectral]), color="white", linewidth=0.8 * scale, alpha=0.8)
        axes.plot(*rgb, "o", ms=5.5 * scale, mfc=PAGE, mec="white", mew=1.1 * scale, **style)
        axes.plot(*spectral, "o", ms=5.5 * scale, mfc="white", mec=PAGE, mew=0.6 * scale, **style)
        if numbers:
            axes.annotate(
                mark.label, spectral, (6 * scale, 5 * scale), textcoords="offset points",
                color=TEXT, fontsize=8.5 * scale, fontweight="bold", annotation_clip=True,
            )  # fmt: skip


def _label_wavelength(axes: Axes, label: str, around: Array, scale: float) -> None:
    """Write ``label`` outside the locus at the middle of its points ``around``."""
    middle = around[len(around) // 2]
    along = around[-1] - around[0]
    outward = np.array([-along[1], along[0]]) / max(float(np.hypot(*along)), 1e-9)
    axes.plot(*middle, "o", ms=1.8 * scale, color=TEXT)
    axes.annotate(
        label, middle, tuple(9 * scale * outward), textcoords="offset points",
        color=QUIET, fontsize=6.5 * scale, ha="center", va="center",
    )  # fmt: skip


def _window(marks: Sequence[Mark]) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Return the limits of a square around all marks that have a chromaticity."""
    found = [chromaticity(xyz) for mark in marks for xyz in (mark.rgb_xyz, mark.spectral_xyz)]
    points = np.array([xy for xy in found if xy is not None])
    if points.size == 0:
        return None
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    half = max(0.6 * float(np.ptp(points, axis=0).max()), 0.03)
    (x, y) = middle
    return (x - half, x + half), (y - half, y + half)


def _horseshoe(size: int = 320) -> Array:
    """Return the familiar colours of the diagram, (size, size, 3) sRGB, for the eye only."""
    from lamplit.colour.display import Display
    from lamplit.colour.tristimulus import xyz_of_xy

    display = Display.named("srgb")
    grid = np.stack(np.meshgrid(np.linspace(0.0, 0.8, size), np.linspace(1e-3, 0.9, size)), axis=-1)
    linear = np.clip(xyz_of_xy(grid) @ np.asarray(display.xyz_to_rgb).T, 0.0, None)
    linear /= np.maximum(linear.max(axis=-1, keepdims=True), 1e-9)
    return np.asarray(display.encode(linear))

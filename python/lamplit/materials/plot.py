# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Pictures of a material: transmittance for several thicknesses, or reflectance, with its colour.

The curves and plates are drawn in the colour that a white light box of daylight (D65) gives them,
mapped into sRGB.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lamplit.errors import OutputError, SceneError
from lamplit.materials.appearance import (
    VISIBLE_NM,
    plate_transmittance,
    seen_xyz,
    surface_reflectance,
)
from lamplit.materials.models import Checker, Dielectric, Material
from lamplit.spectrum import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PAGE, _INK, _QUIET, _RULE = "#17181b", "#f2f1ee", "#a3a29d", "#34363b"
_LIGHT_BOX = "#ffffff"

#: How the plates beside the curves are lit.
_LIT = {"transmittance": "on a D65 light box", "reflectance": "in D65 daylight"}

#: Plates have the height that this many of them fill the page with; more make each smaller.
_ROWS = 5

#: On the dark page a curve is drawn no darker than this, so that a thick plate's still shows.
_DIMMEST_CURVE = 0.4


class _Curve(NamedTuple):
    label: str
    values: Array
    internal: Array | None


def plot_transmittance(
    material: Material,
    path: Path,
    thicknesses_mm: Sequence[float] = (1.0, 2.0, 3.0, 5.0, 10.0),
    *,
    name: str = "",
) -> None:
    """Draw total (solid) and internal (dotted) transmittance for several thicknesses.

    Total is T = (1 − R)² τ / (1 − R² τ²) at normal incidence. The suffix of ``path`` chooses PNG,
    SVG or PDF.

    Raises:
        SceneError: The material is opaque, or a thickness is not positive.
        OutputError: The file cannot be written.
    """
    if not isinstance(material, Dielectric):
        raise SceneError(f"a {material.kind} lets no light through; draw its reflectance instead")
    if not thicknesses_mm or not all(0 < mm < np.inf for mm in thicknesses_mm):
        raise SceneError("thicknesses are positive numbers of mm, and one is needed at least")
    curves = [
        _Curve(
            f"{mm:g} mm",
            plate_transmittance(material, VISIBLE_NM, mm),
            material.transmittance(VISIBLE_NM, mm),
        )
        for mm in sorted(thicknesses_mm)
    ]
    _save(_page(material, name, curves, "transmittance"), path)


def plot_reflectance(material: Material, path: Path, *, name: str = "") -> None:
    """Draw the reflectance of one surface at normal incidence; both squares of a checker.

    Raises:
        OutputError: The file cannot be written.
    """
    if isinstance(material, Checker):
        both = (material.reflectance_a_at(VISIBLE_NM), material.reflectance_b_at(VISIBLE_NM))
        curves = [_Curve(label, values, None) for label, values in zip("ab", both, strict=True)]
    else:
        curves = [_Curve("surface", surface_reflectance(material, VISIBLE_NM), None)]
    _save(_page(material, name, curves, "reflectance"), path)


def _page(material: Material, name: str, curves: list[_Curve], quantity: str) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.6, 6.6), dpi=150, facecolor=_PAGE)
    figure.text(0.07, 0.945, name or material.kind, color=_INK, fontsize=19, weight="bold")
    figure.text(0.07, 0.905, material.description, color=_QUIET, fontsize=10.5)
    axes = figure.add_axes((0.07, 0.215, 0.58, 0.615))
    plates = figure.add_axes((0.69, 0.215, 0.275, 0.615))
    _draw_curves(axes, curves, quantity)
    _draw_spectrum(figure.add_axes((0.07, 0.187, 0.58, 0.014)))
    _draw_plates(plates, curves, _LIT[quantity])
    notes = [*material.references, f"Licence: {material.licence}"]
    lines = [line for note in notes for line in textwrap.wrap(note, 172, subsequent_indent="   ")]
    figure.text(0.07, 0.105, "\n".join(lines), color=_QUIET, fontsize=7, va="top", linespacing=1.45)
    return figure


def _draw_curves(axes: Axes, curves: list[_Curve], quantity: str) -> None:
    axes.set_facecolor(_PAGE)
    for curve in curves:
        colour = _lifted(_srgb(seen_xyz(curve.values, "D65")))
        axes.plot(VISIBLE_NM, curve.values, color=colour, lw=2.2, solid_capstyle="round")
        if curve.internal is not None:
            axes.plot(VISIBLE_NM, curve.internal, color=colour, lw=1.0, ls=(0, (1, 2)), alpha=0.9)
    axes.set_xlim(380, 780)
    axes.set_ylim(0, 1.0)
    axes.set_yticks(np.linspace(0, 1, 6), [f"{value:.0f} %" for value in np.linspace(0, 100, 6)])
    axes.set_xticks(np.arange(400, 781, 50), [])
    axes.grid(color=_RULE, lw=0.7)
    axes.set_axisbelow(True)
    axes.tick_params(length=0, colors=_QUIET, labelsize=9)
    for spine in axes.spines.values():
        spine.set_visible(False)
    means = (
        "solid: total, with both faces · dotted: internal" if curves[0].internal is not None else ""
    )
    axes.text(0, 1.03, quantity, color=_INK, fontsize=10, transform=axes.transAxes)
    axes.text(1, 1.03, means, color=_QUIET, fontsize=8, ha="right", transform=axes.transAxes)


def _draw_spectrum(axes: Axes) -> None:
    """Draw the colours of the spectrum as a band, with the wavelengths below it."""
    from lamplit.colour.display import Display
    from lamplit.colour.observer import colour_matching_functions

    display = Display.named("srgb")
    xyz = colour_matching_functions("cie-1931-2", VISIBLE_NM)
    linear = xyz @ display.xyz_to_rgb.T
    softened = linear - 0.4 * np.minimum(linear.min(axis=1, keepdims=True), 0.0)
    linear = np.maximum(softened, 0.0)
    brightness = np.minimum(
        1.0, 1.6 * np.cbrt(xyz.sum(axis=1, keepdims=True) / xyz.sum(axis=1).max())
    )
    band = display.encode(linear / linear.max(axis=1, keepdims=True)) * brightness
    axes.imshow(band[None, :, :], aspect="auto", extent=(380, 780, 0, 1), interpolation="bilinear")
    axes.set_yticks([])
    axes.set_xticks(np.arange(400, 781, 50))
    axes.tick_params(length=0, colors=_QUIET, labelsize=9)
    axes.set_xlabel("wavelength in nm", color=_QUIET, fontsize=9)
    for spine in axes.spines.values():
        spine.set_visible(False)


def _draw_plates(axes: Axes, curves: list[_Curve], title: str) -> None:
    """Draw a plate for each curve on white, with its luminous value and chromaticity."""
    from matplotlib.patches import Rectangle

    from lamplit.colour.tristimulus import chromaticity_xy

    rows = max(len(curves), _ROWS)
    axes.set_xlim(0, 1)
    axes.set_ylim(rows, 0)
    axes.axis("off")
    axes.add_patch(Rectangle((0, 0), 0.44, len(curves), color=_LIGHT_BOX, lw=0))
    for row, curve in enumerate(curves):
        daylight = seen_xyz(curve.values, "D65")
        x, y = chromaticity_xy(seen_xyz(curve.values, "A"))
        axes.add_patch(Rectangle((0.04, row + 0.07), 0.36, 0.86, color=_srgb(daylight), lw=0))
        axes.text(0.5, row + 0.27, curve.label, color=_INK, fontsize=11.5, va="center")
        numbers = f"{daylight[1]:.1f} % of D65\nxy {x:.3f}, {y:.3f} under A"
        axes.text(0.5, row + 0.66, numbers, color=_QUIET, fontsize=8, va="center", linespacing=1.5)
    axes.text(0, -0.03 * rows, title, color=_INK, fontsize=10)


def _srgb(xyz: Array) -> Array:
    """Return the sRGB colour, 0 to 1, of XYZ (…, 3) relative to Y = 100 under D65."""
    from lamplit.colour.display import Display
    from lamplit.colour.gamut import map_to_gamut

    display = Display.named("srgb")
    linear, _ = map_to_gamut(xyz @ display.xyz_to_rgb.T / 100.0, display)
    return np.clip(display.encode(linear), 0.0, 1.0)


def _lifted(colour: Array) -> Array:
    """Return ``colour`` brighter, in the order of brightness, so that the dark page shows it."""
    brightest = max(float(colour.max()), 1e-3)
    return colour * ((_DIMMEST_CURVE + (1.0 - _DIMMEST_CURVE) * brightest) / brightest)


def _save(figure: Figure, path: Path) -> None:
    suffix = path.suffix.lower().lstrip(".") or "png"
    if suffix not in ("png", "svg", "pdf"):
        raise OutputError(f"a plot is a .png, .svg or .pdf file, not .{suffix}", file=path)
    unfinished = path.with_name(f".{path.name}.part")
    try:
        figure.savefig(unfinished, format=suffix, facecolor=_PAGE)
        unfinished.replace(path)
    except OSError as fault:
        unfinished.unlink(missing_ok=True)
        raise OutputError(f"cannot be written: {fault.strerror}", file=path) from fault

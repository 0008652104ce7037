# SPDX-License-Identifier: Apache-2.0 OR MIT
"""One page that lays the RGB and the spectral picture of a lamp side by side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lamplit.report.chromaticity import draw_chromaticities
from lamplit.report.sheet import FAINT, FONT, QUIET, Sheet, show_pixels
from lamplit.report.summary import chromaticity

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from lamplit.engine.image import Image
    from lamplit.report.difference import Difference, Mark

Array = NDArray[np.float64]

#: A picture on the page is this wide, in pixels; one in between is shown pixel for pixel.
_NARROWEST, _WIDEST, _TALLEST = 620, 960, 900
_COLOUR_SCALE = "magma"
_CARDS = 5
_LONGEST_NAME = 44


@dataclass(frozen=True)
class _Layout:
    """Where things stand, in pixels from the top left corner of the page."""

    picture: tuple[int, int]
    column: int
    unit: float

    @property
    def margin(self) -> int:
        return round(44 * self.unit)

    @property
    def gap(self) -> int:
        return round(28 * self.unit)

    @property
    def pictures_top(self) -> int:
        return round(176 * self.unit)

    @property
    def lower_top(self) -> int:
        return self.pictures_top + self.picture[1] + round(78 * self.unit)

    @property
    def lower_height(self) -> int:
        return max(self.picture[1] + round(64 * self.unit), round(440 * self.unit))

    @property
    def cards_top(self) -> int:
        return self.lower_top + self.lower_height + round(72 * self.unit)

    def left(self, column: int) -> int:
        """Return where a column (0 or 1) begins."""
        return self.margin + column * (self.column + self.gap)

    def sheet(self) -> Sheet:
        width = 2 * self.margin + 2 * self.column + self.gap
        return Sheet(width, self.cards_top + 172 * self.unit, unit=self.unit)


def draw_page(spectral: Image, difference: Difference) -> Array:
    """Return the page as display values (rows, columns, 3) in [0, 1].

    The pictures stand on it in the values of their display: tag the page with that display.
    """
    layout = _layout(spectral.width, spectral.height)
    sheet = layout.sheet()
    _draw_heading(sheet, layout, spectral, difference)
    pictures = [
        ("RGB", "three numbers per light and material", difference.rgb.picture.encoded),
        ("Spectral", "every wavelength carried to the eye", difference.spectral.picture.encoded),
    ]
    for column, (name, explanation, encoded) in enumerate(pictures):
        left = layout.left(column)
        sheet.title(left, layout.pictures_top, name, explanation)
        axes = sheet.axes(left, layout.pictures_top, *layout.picture)
        show_pixels(axes, encoded, layout.picture)
        _ring(axes, difference.marks, encoded.shape[1], layout.unit)
    explanation = "ΔE₀₀ of every pixel; 1 is just visible side by side"
    sheet.title(layout.left(0), layout.lower_top, "Where they differ", explanation)
    _draw_map(sheet, layout.left(0), layout.lower_top, layout.picture, difference)
    _draw_diagram(sheet, layout, spectral, difference)
    _draw_cards(sheet, layout, difference.marks)
    _draw_footer(sheet, layout, spectral, difference)
    return sheet.pixels()


def draw_map(difference: Difference) -> Array:
    """Return the ΔE00 map with its colour scale, alone, as display values (rows, columns, 3)."""
    layout = _layout(*difference.delta_e.shape[::-1])
    width, height = layout.picture
    sheet = Sheet(width, height + 52 * layout.unit, unit=layout.unit)
    _draw_map(sheet, 0, 0, layout.picture, difference)
    return sheet.pixels()


def draw_diagram(difference: Difference, *, observer: str) -> Array:
    """Return the chromaticity diagram, alone, as display values (rows, columns, 3)."""
    sheet = Sheet(1200, 920, unit=1.5)
    axes = sheet.axes(70, 30, 1100, 850)
    draw_chromaticities(axes, difference.marks, observer=observer, scale=sheet.unit)
    return sheet.pixels()


def _layout(width: int, height: int) -> _Layout:
    scale = 1.0 if width >= _NARROWEST else float(-(-_NARROWEST // width))
    scale = min(scale, _TALLEST / height, _WIDEST / width)
    picture = (max(round(width * scale), 1), max(round(height * scale), 1))
    column = max(picture[0], _NARROWEST)
    return _Layout(picture, column, column / 640.0)


def _ring(axes: Axes, marks: Sequence[Mark], width: int, unit: float) -> None:
    """Ring the marked pixels on a picture that is ``width`` pixels wide."""
    from matplotlib import patheffects

    edge = patheffects.withStroke(linewidth=2.2 * unit, foreground="black")
    for mark in marks:
        place = (mark.column + 0.5, mark.row + 0.5)
        for ink, weight in (("black", 3.2), ("white", 1.4)):
            ring = axes.plot(*place, "o", markersize=11 * unit, markerfacecolor="none")[0]
            ring.set(markeredgecolor=ink, markeredgewidth=weight * unit, alpha=0.9)
        side = -1 if mark.column > 0.9 * width else 1
        label = axes.annotate(
            mark.label,
            place,
            (side * 9 * unit, 6 * unit),
            textcoords="offset points",
            color="white",
            fontsize=10 * unit,
            fontweight="bold",
            family=FONT,
            ha="left" if side > 0 else "right",
        )
        label.set_path_effects([edge])


def _draw_heading(sheet: Sheet, layout: _Layout, image: Image, difference: Difference) -> None:
    unit, right = sheet.unit, sheet.width - layout.margin
    name = image.scene.name or "Lamp"
    if len(name) > _LONGEST_NAME:
        name = name[: _LONGEST_NAME - 1] + "…"
    sheet.write(layout.margin, 66 * unit, name, 24, bold=True)
    facts = (
        f"{image.width} × {image.height} pixels, {image.samples} samples per pixel, "
        f"{difference.spectral.display_label} with white at "
        f"{difference.spectral.white_luminance_cd_m2:.0f} cd/m²"
    )
    sheet.write(layout.margin, 94 * unit, facts, 10.5, ink=QUIET)
    numbers = {
        "max": difference.largest,
        "95 %": difference.percentile_95,
        "mean": difference.mean,
    }
    for place, (label, value) in enumerate(numbers.items()):
        at = right - 116 * unit * place
        sheet.write(at, 68 * unit, f"{value:.1f}", 24, align="right")
        sheet.write(at, 94 * unit, label, 10.5, ink=QUIET, align="right")
    sheet.write(right - 325 * unit, 68 * unit, "ΔE₀₀", 15, ink=QUIET, align="right")


def _draw_map(
    sheet: Sheet, left: float, top: float, size: tuple[int, int], difference: Difference
) -> None:
    """Draw the ΔE00 map at ``size`` pixels, and its colour scale below."""
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    unit, (width, height) = sheet.unit, size
    limit = _round_limit(float(np.percentile(difference.delta_e, 99.5)))
    inks = colormaps[_COLOUR_SCALE](np.clip(difference.delta_e / limit, 0.0, 1.0))[..., :3]
    axes = sheet.axes(left, top, width, height)
    show_pixels(axes, inks, size)
    _ring(axes, difference.marks, difference.delta_e.shape[1], unit)
    bar = sheet.axes(left + 12 * unit, top + height + 14 * unit, width - 24 * unit, 12 * unit)
    scale = sheet.figure.colorbar(
        ScalarMappable(Normalize(0.0, limit), _COLOUR_SCALE), cax=bar, orientation="horizontal"
    )
    scale.outline.set_edgecolor(FAINT)
    bar.tick_params(colors=QUIET, labelsize=9 * unit, length=3 * unit, width=0.6 * unit)
    ticks = np.linspace(0.0, limit, 6)
    labels = [f"{tick:g}" for tick in ticks]
    if difference.largest > limit:
        labels[-1] = f"≥ {limit:g}"
    scale.set_ticks(list(ticks), labels=labels)


def _round_limit(value: float) -> float:
    """Return the next of 5, 10, 20, 25, 50, 100: the scale never makes much of nothing."""
    return next((limit for limit in (5.0, 10.0, 20.0, 25.0, 50.0) if value <= limit), 100.0)


def _draw_diagram(sheet: Sheet, layout: _Layout, image: Image, difference: Difference) -> None:
    left, top, indent = layout.left(1), layout.lower_top, 30 * sheet.unit
    explanation = "of the marked pixels: ring RGB, dot spectral"
    sheet.title(left, top, "Chromaticity", explanation)
    axes = sheet.axes(left + indent, top, layout.column - indent, layout.lower_height)
    observer = image.scene.image.observer
    draw_chromaticities(axes, difference.marks, observer=observer, scale=sheet.unit)


def _draw_cards(sheet: Sheet, layout: _Layout, marks: Sequence[Mark]) -> None:
    """Draw for each mark what the display shows for it, RGB beside spectral, with its numbers."""
    unit, top, gap = sheet.unit, layout.cards_top, 20 * sheet.unit
    width = (sheet.width - 2 * layout.margin - gap * (_CARDS - 1)) / _CARDS
    for place, mark in enumerate(marks):
        left = layout.margin + place * (width + gap)
        right = left + width
        swatch = np.stack([mark.rgb_encoded, mark.spectral_encoded])[None]
        axes = sheet.axes(left, top, width, 56 * unit)
        axes.imshow(swatch, aspect="auto", interpolation="nearest")
        axes.set_axis_off()
        sheet.write(left, top - 12 * unit, mark.label, 13, bold=True)
        sheet.write(right, top - 12 * unit, f"ΔE₀₀ {mark.delta_e:.1f}", 11, align="right")
        lines = {"RGB": mark.rgb_xyz, "spectral": mark.spectral_xyz}
        for line, (name, xyz) in enumerate(lines.items()):
            baseline = top + (78 + 20 * line) * unit
            sheet.write(left, baseline, name, 9, ink=QUIET)
            sheet.write(right, baseline, _numbers(xyz), 9, align="right")


def _numbers(xyz: Array) -> str:
    xy = chromaticity(xyz)
    place = "black" if xy is None else f"{xy[0]:.3f}, {xy[1]:.3f}"
    luminance = f"{xyz[1]:.0f}" if xyz[1] >= 100.0 else f"{xyz[1]:.3g}"
    return f"{place} · {luminance} cd/m²"


def _draw_footer(sheet: Sheet, layout: _Layout, image: Image, difference: Difference) -> None:
    rgb, spectral = (
        f"{100 * view.picture.gamut_share:.1f} %" for view in (difference.rgb, difference.spectral)
    )
    text = (
        f"Outside {difference.spectral.display_label}: RGB {rgb}, spectral {spectral} of the "
        "pixels. ΔE₀₀ is measured before colours are brought into the display. "
        f"Lamplit {image.version}, seed {image.seed}, scene {image.scene.scene_hash[:12]}."
    )
    sheet.write(layout.margin, sheet.height - 28 * sheet.unit, text, 8.5, ink=QUIET)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Where three numbers per light and material are enough and where not: docs/scenes, compared."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import lamplit as ll
from builders.sections import table
from lamplit.colour.difference import delta_e_2000
from lamplit.colour.display import Display
from lamplit.report.difference import Difference, measure_difference
from lamplit.report.png import write_png
from lamplit.report.sheet import QUIET, Sheet
from lamplit.report.summary import chromaticity
from lamplit.spectrum import Array

#: Pixels along a patch of a scene in docs/scenes.
_PITCH = 32
_BOX = "background.soft_boxes[0].source"
_LAMP = "lights[0].source"


@dataclass(frozen=True)
class Case:
    """One scene of docs/scenes with some values changed, and what its patches are."""

    title: str
    scene: str
    patches: Sequence[str]
    changes: Mapping[str, object]


_PLATES = ("LED alone", "smoke PMMA", "amber PMMA", "red PMMA")
_PAINTS = ("paint a", "paint b")
CASES = (
    Case(
        "Matt paints, one reflection of the white",
        "diffuse",
        ("grey", "sand", "moss", "slate blue", "brick"),
        {},
    ),
    Case(
        "Clear and lightly tinted plates before the white",
        "neutral",
        ("PMMA 3 mm", "PC 3 mm", "BK7 3 mm", "smoke 1 mm"),
        {},
    ),
    Case(
        "Red PMMA of rising thickness before the white",
        "thickness",
        ("0.5 mm", "1 mm", "2 mm", "3 mm", "5 mm", "8 mm"),
        {},
    ),
    Case(
        "Dyed plates, alone and stacked, before the white",
        "stacked",
        ("teal", "lime", "teal on lime", "teal on amber", "lime on amber", "amber on red"),
        {},
    ),
    Case("Plates of 2.5 mm before amber LEDs, 593 nm", "led", _PLATES, {_BOX: "amber-led-593"}),
    Case("Plates of 2.5 mm before phosphor amber LEDs", "led", _PLATES, {_BOX: "pc-amber-led"}),
    Case("Plates of 2.5 mm before red LEDs, 624 nm", "led", _PLATES, {_BOX: "red-led-624"}),
    Case("Two paints of one colour in daylight, D65", "metamers", _PAINTS, {_LAMP: "D65"}),
    Case("The same two under tungsten, illuminant A", "metamers", _PAINTS, {_LAMP: "A"}),
    Case("The same two under a three-band lamp, FL11", "metamers", _PAINTS, {_LAMP: "FL11"}),
)


@dataclass(frozen=True)
class Outcome:
    """A case, rendered both ways; ``columns`` are its patches' middles along the middle row."""

    case: Case
    difference: Difference
    rgb_xyz: Array
    spectral_xyz: Array
    columns: Sequence[int]

    def pair_differences(self) -> tuple[float, float]:
        """Return ΔE00 between the first two patches: in RGB, and in spectra."""
        white = self.difference.spectral.white_xyz
        rgb, spectral = (
            float(delta_e_2000(xyz[0], xyz[1], white_xyz=white))
            for xyz in (self.rgb_xyz, self.spectral_xyz)
        )
        return rgb, spectral


def compared(folder: Path) -> list[Outcome]:
    """Render every case of ``folder`` in RGB and in spectra."""
    return [_compared(case, folder) for case in CASES]


def _compared(case: Case, folder: Path) -> Outcome:
    scene = ll.load_scene(folder / f"{case.scene}.toml", overrides=case.changes)
    pair = ll.compare(scene)
    columns = [at * _PITCH + _PITCH // 2 for at in range(len(case.patches))]
    rgb, spectral = (image.xyz[_PITCH // 2, columns] for image in (pair.rgb, pair.spectral))
    return Outcome(case, measure_difference(pair.spectral, pair.rgb), rgb, spectral, columns)


def failures_table(outcomes: Sequence[Outcome]) -> str:
    """Return the numbers of every patch as a Markdown table."""
    rows: list[list[str]] = []
    for outcome in outcomes:
        middle = outcome.difference.delta_e[_PITCH // 2]
        for at, patch in enumerate(outcome.case.patches):
            numbers = (_numbers(outcome.rgb_xyz[at]), _numbers(outcome.spectral_xyz[at]))
            title = outcome.case.title if at == 0 else ""
            rows.append([title, patch, *numbers, f"{middle[outcome.columns[at]]:.1f}"])
    return table(("", "patch", "RGB: x, y; cd/m²", "spectral: x, y; cd/m²", "ΔE00"), rows)


def pairs_table(outcomes: Sequence[Outcome]) -> str:
    """Return how far apart the two paints of the metameric pair look, as a Markdown table."""
    rows: list[list[str]] = []
    for outcome in outcomes:
        if outcome.case.scene == "metamers":
            rgb, spectral = outcome.pair_differences()
            rows.append([str(outcome.case.changes[_LAMP]), f"{rgb:.1f}", f"{spectral:.1f}"])
    return table(("light", "ΔE00 between the paints, RGB", "spectral"), rows)


def _numbers(xyz: Array) -> str:
    x, y = chromaticity(xyz) or (0.0, 0.0)
    return f"{x:.3f}, {y:.3f}; {xyz[1]:.1f}"


def draw_failures(outcomes: Sequence[Outcome], path: Path) -> None:
    """Draw every patch, RGB beside spectral, into the PNG ``path``."""
    left, top, pitch, row = 36, 120, 152, 118
    sheet = Sheet(left + 6 * pitch + 20, top + row * len(outcomes) - 10, unit=1.0)
    sheet.write(left, 48, "RGB against spectral", 20, bold=True)
    explanation = (
        "each patch: RGB on the left half, spectral on the right; sRGB, white at 1000 cd/m²"
    )
    sheet.write(left, 74, explanation, 10, ink=QUIET)
    for number, outcome in enumerate(outcomes):
        base = top + row * number
        sheet.write(left, base, outcome.case.title, 11, bold=True)
        for at, patch in enumerate(outcome.case.patches):
            _draw_patch(sheet, (left + pitch * at, base + 12), outcome, at, patch)
    write_png(path, sheet.pixels(), Display.named("srgb"))


def _draw_patch(
    sheet: Sheet, place: tuple[float, float], outcome: Outcome, at: int, patch: str
) -> None:
    (x, y), width = place, 136
    column, difference = outcome.columns[at], outcome.difference
    pictures = (difference.rgb.picture, difference.spectral.picture)
    halves = np.stack([picture.encoded[_PITCH // 2, column] for picture in pictures])
    axes = sheet.axes(x, y, width, 48)
    axes.imshow(halves[None], aspect="auto", interpolation="nearest")
    axes.set_axis_off()
    delta_e = difference.delta_e[_PITCH // 2, column]
    sheet.write(x, y + 65, patch, 8.5, ink=QUIET)
    sheet.write(x + width, y + 65, f"{delta_e:.1f}", 9.5, align="right")

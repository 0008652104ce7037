# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The bench's pictures of lit lamps on one sheet, through the tone curve of its errors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from errors import Array
from lit_runners import Shot

import lamplit as ll
from lamplit.colour.picture import to_picture
from lamplit.report.develop import scene_display, scene_white_xy

#: Height of a line of text and space between pictures, in pixels.
_LINE, _GAP = 18, 4
_INK, _PAPER = (230, 230, 230), (24, 24, 24)


@dataclass
class Sheet:
    """Pictures of all programs side by side, a line for each lamp and time."""

    _lines: list[list[tuple[str, Array]]] = field(default_factory=list[Any])

    def add(
        self,
        lamp: str,
        scene: ll.Scene,
        shots: Mapping[str, Sequence[Shot]],
        *,
        longer: Mapping[str, Shot],
        reference: Array,
    ) -> None:
        """Add two lines: one picture of each program, and a ``longer`` one or its seeds' mean."""

        def shown(xyz: Array) -> Array:
            return _shown(scene, xyz, float(reference[..., 1].mean()))

        first = [
            (f"{lamp}  {name}  {own[0].core_s:.0f} core s", shown(own[0].xyz))
            for name, own in shots.items()
        ]
        second = [
            (f"{lamp}  {name}  {own.core_s:.0f} core s", shown(own.xyz))
            for name, own in longer.items()
        ] or [
            (
                f"{lamp}  {name}  mean of {len(own)} x {own[0].core_s:.0f} core s",
                shown(np.mean([shot.xyz for shot in own], axis=0)),
            )
            for name, own in shots.items()
        ]
        self._lines += [[*first, (f"{lamp}  converged", shown(reference))], second]

    def write(self, path: Path) -> None:
        """Write the sheet as a PNG."""
        from PIL import Image, ImageDraw

        height, width = self._lines[0][0][1].shape[:2]
        columns = max(len(line) for line in self._lines)
        step = height + _LINE + _GAP
        size = (columns * (width + _GAP), len(self._lines) * step)
        sheet = Image.new("RGB", size, _PAPER)
        pen = ImageDraw.Draw(sheet)
        for row, line in enumerate(self._lines):
            for column, (title, pixels) in enumerate(line):
                at = (column * (width + _GAP), row * step)
                pen.text((at[0] + 4, at[1] + 3), title, fill=_INK)
                levels = np.round(255.0 * pixels).astype(np.uint8)
                sheet.paste(Image.fromarray(levels), (at[0], at[1] + _LINE))
        sheet.save(path)


def _shown(scene: ll.Scene, xyz: Array, mean: float) -> Array:
    """Return sRGB (H, W, 3) of 0 to 1, luminance through T = Y/(Y + mean), colour kept."""
    developed = to_picture(
        xyz / (xyz[..., 1:2] + mean),
        display=scene_display(scene),
        white_luminance_cd_m2=1.0,
        white_xy=scene_white_xy(scene),
        adaptation=scene.display.adaptation,
        gamut=scene.display.gamut,
    )
    return developed.encoded

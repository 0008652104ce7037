# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The pictures to look at that a scene's ``[display]`` asks for, beside the exact values."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from lamplit.report.develop import Developed, develop_xyz, eye_glare
from lamplit.report.gamut_mask import gamut_mask_picture
from lamplit.report.png import write_png

if TYPE_CHECKING:
    from lamplit.scene.camera import DisplaySettings

_PICTURE = {"picture.png": "the picture, tagged for the display"}
_FALSE_COLOUR = {"false-colour.png": "the luminance in false colours, with a scale in cd/m²"}
_GLARE = {"picture-glare.png": "the picture with the glare of the eye, a copy to look at"}
_MASK = {"gamut-mask.png": "cyan: colours that the display cannot show"}


def shown_files(settings: DisplaySettings, *, gamut_mask: bool = False) -> dict[str, str]:
    """Return the names that `write_shown` writes, and what is in each file."""
    asked = ((_FALSE_COLOUR, settings.false_colour), (_GLARE, settings.glare), (_MASK, gamut_mask))
    return _PICTURE | {
        name: text for files, wanted in asked if wanted for name, text in files.items()
    }


def write_shown(
    directory: Path,
    xyz: NDArray[np.float64],
    developed: Developed,
    *,
    provenance: Mapping[str, str],
    bits: Literal[8, 16] = 8,
    gamut_mask: bool = False,
) -> dict[str, Any]:
    """Write `shown_files` of XYZ (H, W, 3) in cd/m² and return the numbers that belong to them.

    Glare is laid on a copy, and that is seen under the exposure of the picture itself.

    Raises:
        OutputError: A file cannot be written; older files are left as they were.
    """
    from lamplit.colour.display import Display

    view, display, picture = developed.view, developed.display, developed.picture
    write_png(directory / "picture.png", picture.encoded, display, bits=bits, provenance=provenance)
    numbers: dict[str, Any] = {"false_colour": None, "glare": None}
    if view.settings.false_colour:
        from lamplit.report.false_colour import draw_false_colour

        pixels, limits = draw_false_colour(xyz[..., 1])
        path, srgb = directory / "false-colour.png", Display.named("srgb")
        write_png(path, pixels, srgb, provenance=provenance)
        numbers["false_colour"] = dict(zip(("lowest_cd_m2", "highest_cd_m2"), limits, strict=True))
    if view.settings.glare:
        glare = eye_glare(xyz, view)
        seen = develop_xyz(glare.xyz, view, exposure=developed.exposure).picture.encoded
        path = directory / "picture-glare.png"
        write_png(path, seen, display, bits=bits, provenance=provenance)
        numbers["glare"] = {
            "age": glare.eye.age,
            "pupil_mm": glare.eye.pupil_mm,
            "pigmentation": glare.eye.pigmentation,
            "scattered_share": glare.eye.scattered_share,
            "left_frame_share": glare.left_frame_share,
        }
    if gamut_mask:
        masked = gamut_mask_picture(picture)
        write_png(directory / "gamut-mask.png", masked, display, provenance=provenance)
    return numbers

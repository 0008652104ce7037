# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The files of ``lamplit render``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from lamplit.report.atomic import prepare_output, write_json
from lamplit.report.develop import develop
from lamplit.report.exr import write_exr
from lamplit.report.layers import LAYERS_FILE, write_layers
from lamplit.report.provenance import text_provenance
from lamplit.report.showing import shown_files, write_shown
from lamplit.report.summary import summary

if TYPE_CHECKING:
    from lamplit.engine.image import Image
    from lamplit.scene.camera import DisplaySettings

_EXACT = {
    "picture.exr": "XYZ in cd/m² with standard errors, linear RGB, and what else was asked for",
    "summary.json": "luminance, chromaticity, gamut, errors, how to make it again",
}
_LAYERS = {LAYERS_FILE: "XYZ of each light group: `lamplit mix` weighs and adds them"}


def picture_files(
    settings: DisplaySettings, *, layers: bool = False, gamut_mask: bool = False
) -> dict[str, str]:
    """Return the names that `write_picture` writes, and what is in each file."""
    shown = shown_files(settings, gamut_mask=gamut_mask)
    return shown | _EXACT | (_LAYERS if layers else {})


def write_picture(
    image: Image,
    directory: Path | str,
    *,
    bits: Literal[8, 16] = 8,
    spectral: bool = False,
    gamut_mask: bool = False,
) -> dict[str, Any]:
    """Write ``image`` into ``directory`` as a PNG, an EXR and a JSON summary; return the summary.

    The scene's ``[display]`` may ask for more PNGs: false colours, and the eye's glare. Features
    that the image has are in the EXR, and its layers in an EXR of their own. ``spectral`` keeps the
    bands in the EXR; ``gamut_mask`` also draws which pixels the scene's display cannot show.

    Raises:
        OutputError: A file cannot be written; older files are left as they were.
    """
    folder = Path(directory)
    settings = image.scene.display
    prepare_output(
        folder, picture_files(settings, layers=bool(image.layers), gamut_mask=gamut_mask)
    )
    developed = develop(image)
    write_exr(folder / "picture.exr", image, developed, spectral=spectral)
    if image.layers:
        write_layers(folder / LAYERS_FILE, image)
    shown = write_shown(
        folder,
        image.xyz,
        developed,
        provenance=text_provenance(image),
        bits=bits,
        gamut_mask=gamut_mask,
    )
    numbers = summary(image, developed) | shown
    write_json(folder / "summary.json", numbers)
    return numbers

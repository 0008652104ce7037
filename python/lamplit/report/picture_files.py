# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The files of ``lamplit render``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from lamplit.report.atomic import prepare_output, write_json
from lamplit.report.develop import develop
from lamplit.report.exr import write_exr
from lamplit.report.gamut_mask import gamut_mask_picture
from lamplit.report.layers import LAYERS_FILE, write_layers
from lamplit.report.png import write_png
from lamplit.report.provenance import text_provenance
from lamplit.report.summary import summary

if TYPE_CHECKING:
    from lamplit.engine.image import Image

_CONTENTS = {
    "picture.png": "the picture, tagged for the display",
    "picture.exr": "XYZ in cd/m² with standard errors, linear RGB, and what else was asked for",
    "summary.json": "luminance, chromaticity, gamut, errors, how to make it again",
}
_LAYERS = {LAYERS_FILE: "XYZ of each light group: `lamplit mix` weighs and adds them"}
_MASK = {"gamut-mask.png": "cyan: colours that the display cannot show"}


def picture_files(*, layers: bool = False, gamut_mask: bool = False) -> dict[str, str]:
    """Return the names that `write_picture` writes, and what is in each file."""
    return _CONTENTS | (_LAYERS if layers else {}) | (_MASK if gamut_mask else {})


def write_picture(
    image: Image,
    directory: Path | str,
    *,
    bits: Literal[8, 16] = 8,
    spectral: bool = False,
    gamut_mask: bool = False,
) -> dict[str, Any]:
    """Write ``image`` into ``directory`` as a PNG, an EXR and a JSON summary; return the summary.

    Features that the image has are in the EXR, and its layers in an EXR of their own. ``spectral``
    keeps the bands in the EXR; ``gamut_mask`` also draws which pixels the scene's display cannot
    show.

    Raises:
        OutputError: A file cannot be written; older files are left as they were.
    """
    folder = Path(directory)
    prepare_output(folder, picture_files(layers=bool(image.layers), gamut_mask=gamut_mask))
    developed = develop(image)
    picture, display, texts = developed.picture, developed.display, text_provenance(image)
    numbers = summary(image, developed)
    write_png(folder / "picture.png", picture.encoded, display, bits=bits, provenance=texts)
    write_exr(folder / "picture.exr", image, developed, spectral=spectral)
    if image.layers:
        write_layers(folder / LAYERS_FILE, image)
    write_json(folder / "summary.json", numbers)
    if gamut_mask:
        masked = gamut_mask_picture(picture)
        write_png(folder / "gamut-mask.png", masked, display, provenance=texts)
    return numbers

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The files of ``lamplit compare``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lamplit.report.atomic import write_json
from lamplit.report.develop import Developed, develop
from lamplit.report.difference import Difference, measure_difference
from lamplit.report.exr import write_exr
from lamplit.report.page import draw_diagram, draw_map, draw_page
from lamplit.report.png import write_png
from lamplit.report.provenance import text_provenance
from lamplit.report.summary import summary

if TYPE_CHECKING:
    from lamplit.engine.image import Image

#: What `write_comparison` writes, and what is in each file.
COMPARISON_FILES = {
    "comparison.png": "one page to show: both pictures, differences, chromaticities",
    "rgb.png": "the RGB picture",
    "spectral.png": "the spectral picture",
    "difference.png": "the map of colour differences",
    "chromaticity.png": "the marked pixels on the CIE diagram",
    "rgb.exr": "exact values of the RGB picture",
    "spectral.exr": "exact values of the spectral picture",
    "comparison.json": "all numbers, and how to make them again",
}


def write_comparison(
    spectral: Image, rgb: Image, directory: Path, *, marks: Sequence[tuple[int, int]] | None = None
) -> Difference:
    """Write `COMPARISON_FILES` about two renders of one scene into ``directory``.

    ``marks`` are (column, row) of pixels to look at; without them, the places that differ most.

    Raises:
        OutputError: A file cannot be written; older files are left as they were.
    """
    difference = measure_difference(spectral, rgb, marks=marks)
    display, texts = difference.spectral.display, text_provenance(spectral)
    drawn = {
        "comparison.png": draw_page(spectral, difference),
        "difference.png": draw_map(difference),
        "chromaticity.png": draw_diagram(difference, observer=spectral.scene.image.observer),
    }
    for name, pixels in drawn.items():
        write_png(directory / name, pixels, display, provenance=texts)
    for image, developed in ((rgb, difference.rgb), (spectral, difference.spectral)):
        _write_picture(image, developed, directory)
    write_json(directory / "comparison.json", comparison_numbers(spectral, rgb, difference))
    return difference


def write_half(image: Image, directory: Path) -> tuple[str, str]:
    """Write the picture and the exact values of one half of a comparison; return the names.

    Raises:
        OutputError: A file cannot be written; older files are left as they were.
    """
    return _write_picture(image, develop(image), directory)


def _write_picture(image: Image, developed: Developed, directory: Path) -> tuple[str, str]:
    png, exr = f"{image.colour}.png", f"{image.colour}.exr"
    texts = text_provenance(image)
    write_png(directory / png, developed.picture.encoded, developed.display, provenance=texts)
    write_exr(directory / exr, image, developed)
    return png, exr


def comparison_numbers(spectral: Image, rgb: Image, difference: Difference) -> dict[str, Any]:
    """Return the numbers of a comparison as plain JSON values."""
    return {
        "lamplit_comparison": 1,
        "delta_e_2000": {
            "mean": difference.mean,
            "percentile_95": difference.percentile_95,
            "max": difference.largest,
        },
        "marks": [mark.as_json() for mark in difference.marks],
        "spectral": summary(spectral, difference.spectral),
        "rgb": summary(rgb, difference.rgb),
    }

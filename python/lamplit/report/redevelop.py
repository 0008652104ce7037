# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The files of ``lamplit develop``: other pictures of the exact values that a render has kept."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from lamplit.errors import LamplitError, OutputError
from lamplit.report.atomic import write_json
from lamplit.report.develop import develop_xyz
from lamplit.report.exr_file import ExrFile, read_exr
from lamplit.report.provenance import text_facts
from lamplit.report.showing import shown_files, write_shown
from lamplit.report.summary import picture_numbers
from lamplit.report.view import View

if TYPE_CHECKING:
    from lamplit.scene.camera import DisplaySettings

_NUMBERS = {
    "develop.json": "exposure, luminance, chromaticity, gamut, glare, and what was rendered"
}
#: What a header keeps of the run that made its file, as text and as JSON.
_TEXTS = ("scene", "scene_hash", "version", "method", "colour", "command")
_JSON = ("seed", "samples", "weights", "render")


@dataclass(frozen=True, eq=False)
class Kept:
    """The exact values of a picture, as a render or a mixture has written them."""

    #: X, Y, Z in cd/m², (H, W, 3).
    xyz: NDArray[np.float64]
    #: 1σ of the mean, or an upper bound of it, (H, W, 3).
    standard_error: NDArray[np.float64]
    view: View
    #: What made it.
    made: Mapping[str, Any]


def read_picture(path: Path, changed: Mapping[str, object]) -> Kept:
    """Read the values of a ``picture.exr``; ``changed`` are values of its view, "display.tone".

    Raises:
        OutputError: The file is missing, or is no picture of Lamplit.
        LamplitError: Its display was an ICC profile, which it does not hold, or it has no angles
            for the glare that is asked for.
    """
    if not path.is_file():
        raise OutputError("there is no such file; `lamplit render` writes picture.exr", file=path)
    file = read_exr(path)
    try:
        xyz, errors = (file.vectors(part).astype(np.float64) for part in ("", "standard_error."))
        view = View.read(json.loads(str(file.attributes["lamplit.view"])), changed)
        made = _made(file)
    except (KeyError, TypeError, ValueError, ValidationError) as fault:
        raise OutputError(
            "this file is no picture with a view that Lamplit wrote; develop a picture.exr",
            file=path,
        ) from fault
    except LamplitError as fault:
        raise type(fault)(fault.message, file=path, where=fault.where) from fault
    return Kept(xyz, errors, view, made)


def developed_files(settings: DisplaySettings, *, gamut_mask: bool = False) -> dict[str, str]:
    """Return the names that `write_developed` writes, and what is in each file."""
    return shown_files(settings, gamut_mask=gamut_mask) | _NUMBERS


def write_developed(
    kept: Kept,
    directory: Path,
    *,
    command: str,
    version: str,
    bits: Literal[8, 16] = 8,
    gamut_mask: bool = False,
) -> dict[str, Any]:
    """Write `developed_files` into ``directory`` and return the numbers.

    Raises:
        OutputError: A file cannot be written; older files are left as they were.
    """
    developed = develop_xyz(kept.xyz, kept.view)
    facts = {"command": command, "picture": dict(kept.made)}
    texts = text_facts(str(kept.made.get("scene", "")), version, facts)
    shown = write_shown(
        directory, kept.xyz, developed, provenance=texts, bits=bits, gamut_mask=gamut_mask
    )
    numbers = picture_numbers(kept.xyz, kept.standard_error, developed)
    written = {"lamplit_develop": 1, "version": version, **facts, **numbers, **shown}
    write_json(directory / "develop.json", written)
    return written


def _made(file: ExrFile) -> dict[str, Any]:
    """Return what the header says of the run that made its file."""
    found = {name: file.attributes.get(f"lamplit.{name}") for name in (*_TEXTS, *_JSON)}
    return {
        name: str(text) if name in _TEXTS else json.loads(str(text))
        for name, text in found.items()
        if text is not None
    }

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``layers.exr``: the light of each group by itself, and all that a mixture of them needs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter, ValidationError

from lamplit.errors import LamplitError, OutputError
from lamplit.report.exr import fact_attributes
from lamplit.report.exr_file import ExrFile, planes, read_exr, save_exr
from lamplit.report.provenance import provenance
from lamplit.report.view import View

if TYPE_CHECKING:
    from lamplit.engine.image import Image

Array = NDArray[np.float64]

LAYERS_FILE = "layers.exr"

_UNITS = (
    "<group>.X/Y/Z: tristimulus values of the light of one group, cd/m2 (Y is the luminance); "
    "<group>.standard_error.X/Y/Z: 1 sigma of the mean, cd/m2; all groups together are the picture"
)
_ERROR = "standard_error."


@dataclass(frozen=True, eq=False)
class Layers:
    """The layers of one render, as they were written."""

    #: By light group, X, Y, Z in cd/m², (H, W, 3), and their standard errors.
    xyz: Mapping[str, Array]
    standard_error: Mapping[str, Array]
    #: How the scene wanted its picture to be seen.
    view: View
    #: What made the render: `provenance`.
    render: Mapping[str, Any]


def write_layers(path: Path, image: Image) -> None:
    """Write the layers of ``image`` as float32 OpenEXR.

    Channels: ``<group>.X`` to ``.Z`` in cd/m² and ``<group>.standard_error.X`` to ``.Z``. Header:
    all of `provenance`, each by itself and together as ``lamplit.render``, ``lamplit.groups``, and
    ``lamplit.view``, the scene's display; all but text as JSON.

    Raises:
        OutputError: The file cannot be written.
    """
    channels: dict[str, NDArray[np.float32]] = {}
    for name, xyz in image.layers.items():
        channels |= planes(f"{name}.", "XYZ", xyz)
        channels |= planes(f"{name}.{_ERROR}", "XYZ", image.layers_standard_error[name])
    made = provenance(image)
    view = View.of(image.scene).facts()
    facts = {"units": _UNITS, "groups": list(image.layers), "view": view, "render": made} | made
    save_exr(path, channels, {"software": f"Lamplit {image.version}", **fact_attributes(facts)})


def read_layers(path: Path, *, changed: Mapping[str, object] | None = None) -> Layers:
    """Read back a file of `write_layers`; ``changed`` are values of its view, "display.tone".

    Raises:
        OutputError: The file is missing, or has no layers of Lamplit.
        LamplitError: Its display was an ICC profile, which it does not hold, or it has no angles
            for the glare that is asked for.
    """
    if not path.is_file():
        raise OutputError(
            "there is no such file; `lamplit render --layers` writes it into its folder", file=path
        )
    file = read_exr(path)
    try:
        groups: list[str] = TypeAdapter(list[str]).validate_json(_fact(file, "groups"))
        xyz = {name: _layer(file, f"{name}.") for name in groups}
        errors = {name: _layer(file, f"{name}.{_ERROR}") for name in groups}
        view = View.read(json.loads(_fact(file, "view")), changed or {})
        made: dict[str, Any] = TypeAdapter(dict[str, Any]).validate_json(_fact(file, "render"))
    except (KeyError, TypeError, ValueError, ValidationError) as fault:
        raise OutputError("this file has no layers that Lamplit wrote", file=path) from fault
    except LamplitError as fault:
        raise type(fault)(fault.message, file=path) from fault
    return Layers(xyz, errors, view, made)


def _fact(file: ExrFile, name: str) -> str:
    return str(file.attributes[f"lamplit.{name}"])


def _layer(file: ExrFile, prefix: str) -> Array:
    return file.vectors(prefix).astype(np.float64)

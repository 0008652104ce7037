# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Sums of the layers of one render: lit, unlit, dimmed, without tracing anything."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import LamplitError, nearest_name
from lamplit.report.atomic import write_json
from lamplit.report.develop import develop_xyz
from lamplit.report.exr import header, picture_channels
from lamplit.report.exr_file import save_exr
from lamplit.report.layers import Layers
from lamplit.report.provenance import text_facts
from lamplit.report.showing import shown_files, write_shown
from lamplit.report.summary import picture_numbers

if TYPE_CHECKING:
    from lamplit.scene.camera import DisplaySettings

Array = NDArray[np.float64]

_EXACT = {
    "picture.exr": "XYZ in cd/m² with upper bounds of their standard errors, linear RGB",
    "summary.json": "luminance, chromaticity, gamut, the weights, and the render they weigh",
}
_UNITS = (
    "X, Y, Z: cd/m2 (Y is the luminance); standard_error.*: upper bound of 1 sigma, the weighted "
    "sum of the layers' own, cd/m2; R, G, B: linear, 1 at whiteLuminance, no tone curve, "
    "not gamut-mapped"
)


@dataclass(frozen=True, eq=False)
class Mixture:
    """A weighted sum of layers."""

    layers: Layers
    #: By light group; those that were not named have 1.
    weights: Mapping[str, float]
    #: X, Y, Z in cd/m², (H, W, 3).
    xyz: Array
    #: Σ |w| σ, (H, W, 3): no less than the standard error, since walks may serve several layers.
    standard_error_bound: Array


def mix(layers: Layers, weights: Mapping[str, float]) -> Mixture:
    """Return the sum of ``layers``, each times its weight: 1 for a group that is not named.

    Raises:
        LamplitError: There is no such group, or a weight is negative or not finite.
    """
    for name, weight in weights.items():
        if name not in layers.xyz:
            raise LamplitError(
                f"there is no light group {name!r}{nearest_name(name, layers.xyz)}; "
                f"there are {', '.join(layers.xyz)}"
            )
        if not (math.isfinite(weight) and weight >= 0.0):
            raise LamplitError(f"the weight of {name!r} must be 0 or more, not {weight:g}")
    full = {name: float(weights.get(name, 1.0)) for name in layers.xyz}
    return Mixture(
        layers,
        full,
        sum((full[name] * xyz for name, xyz in layers.xyz.items()), np.zeros(1)),
        sum((full[name] * error for name, error in layers.standard_error.items()), np.zeros(1)),
    )


def mixture_files(settings: DisplaySettings) -> dict[str, str]:
    """Return the names that `write_mixture` writes, and what is in each file."""
    return shown_files(settings) | _EXACT


def write_mixture(
    mixture: Mixture, directory: Path, *, command: str, version: str
) -> dict[str, Any]:
    """Write `mixture_files` into ``directory`` and return the summary.

    Raises:
        OutputError: A file cannot be written; older files are left as they were.
    """
    developed = develop_xyz(mixture.xyz, mixture.layers.view)
    render = mixture.layers.render
    facts = {"command": command, "weights": dict(mixture.weights), "render": dict(render)}
    numbers = picture_numbers(mixture.xyz, mixture.standard_error_bound, developed)
    luminance = numbers["luminance_cd_m2"]
    luminance["mean_standard_error_bound"] = luminance.pop("mean_standard_error")
    channels = picture_channels(mixture.xyz, mixture.standard_error_bound, developed)
    attributes = header(version, developed, facts) | {"lamplit.units": _UNITS}
    save_exr(directory / "picture.exr", channels, attributes)
    texts = text_facts(str(render.get("scene", "")), version, facts)
    shown = write_shown(directory, mixture.xyz, developed, provenance=texts)
    written = {"lamplit_mixture": 1, **facts, **numbers, **shown}
    write_json(directory / "summary.json", written)
    return written

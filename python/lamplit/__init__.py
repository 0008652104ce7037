# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Lamplit: a spectral ray tracer for rear lamps.

>>> import lamplit as ll
>>> scene = ll.load_scene("lamp/scene.toml")  # doctest: +SKIP
>>> image = ll.render(scene, samples=16)  # doctest: +SKIP
>>> image.luminance_cd_m2.mean()  # doctest: +SKIP
>>> ll.write_picture(image, "out")  # doctest: +SKIP
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lamplit._core import __version__
    from lamplit.engine import (
        Comparison,
        Image,
        RenderInterrupted,
        compare,
        measure,
        render,
    )
    from lamplit.errors import LamplitError
    from lamplit.report.picture_files import write_picture
    from lamplit.scene import Scene, check_scene, load_scene
    from lamplit.spectrum import SpectralDistribution

_HOMES = {
    "Comparison": "lamplit.engine",
    "Image": "lamplit.engine",
    "LamplitError": "lamplit.errors",
    "RenderInterrupted": "lamplit.engine",
    "Scene": "lamplit.scene",
    "SpectralDistribution": "lamplit.spectrum",
    "__version__": "lamplit._core",
    "check_scene": "lamplit.scene",
    "compare": "lamplit.engine",
    "load_scene": "lamplit.scene",
    "measure": "lamplit.engine",
    "render": "lamplit.engine",
    "write_picture": "lamplit.report.picture_files",
}

__all__ = [
    "Comparison",
    "Image",
    "LamplitError",
    "RenderInterrupted",
    "Scene",
    "SpectralDistribution",
    "__version__",
    "check_scene",
    "compare",
    "load_scene",
    "measure",
    "render",
    "write_picture",
]


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_HOMES[name]), name)

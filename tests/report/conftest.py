# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A small lamp-like picture that no engine made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lamplit.engine.image import Image
from lamplit.spectrum import SpectralDistribution


@dataclass
class FlatScene:
    """What `report` asks of a scene, without a scene file."""

    name: str = "Rear lamp P21W"
    scene_hash: str = "3f0c9a" * 10 + "beef"
    white_luminance_cd_m2: float | str = 1000.0
    space: Any = "srgb"
    observer: str = "cie-1931-2"
    root: Any = None
    settings: dict[str, Any] = field(default_factory=dict)

    @property
    def display(self) -> SimpleNamespace:
        """The scene's [display]."""
        values = {"space": self.space, "white": "D65", "adaptation": "cat16", "gamut": "map"}
        values["white_luminance_cd_m2"] = self.white_luminance_cd_m2
        return SimpleNamespace(**(values | self.settings))

    @property
    def image(self) -> SimpleNamespace:
        """The scene's [image]."""
        return SimpleNamespace(observer=self.observer, wavelength_range_nm=(380.0, 780.0))

    def resolve_source(self, source: Any) -> SpectralDistribution:
        """Return the equal-energy white, whatever is asked."""
        return SpectralDistribution.constant(1.0, label=str(source))


def lamp_xyz(height: int, width: int, *, shift: float = 0.0) -> np.ndarray:
    """Return XYZ (height, width, 3) in cd/m²: a red lens with an amber field before grey.

    ``shift`` from 0 to 1 moves the red towards orange, as an RGB renderer would.
    """
    y, x = np.mgrid[0:height, 0:width] / np.array([height, width])[:, None, None]
    grey = 60.0 + 240.0 * (1.0 - y)
    xyz = grey[..., None] * np.array([0.9505, 1.0, 1.0888])

    def field_of(xy: tuple[float, float], luminance: np.ndarray) -> np.ndarray:
        return luminance[..., None] * np.array([xy[0] / xy[1], 1.0, (1 - sum(xy)) / xy[1]])

    lens = np.hypot((x - 0.42) / 0.3, (y - 0.5) / 0.36) < 1.0
    pillow = 1.0 + 0.6 * np.cos(40 * x) * np.cos(28 * y)
    red = field_of((0.695 - 0.05 * shift * 1.0, 0.304 + 0.035 * shift), 140.0 * pillow)
    xyz[lens] = red[lens]
    amber = (np.abs(x - 0.82) < 0.09) & (np.abs(y - 0.5) < 0.26)
    xyz[amber] = field_of((0.585, 0.413 - 0.02 * shift), 320.0 * pillow)[amber]
    glow = np.exp(-(((x - 0.42) / 0.05) ** 2 + ((y - 0.5) / 0.07) ** 2))
    return xyz + glow[..., None] * 2500.0 * np.array([1.1, 1.0, 0.36 * (1 - 0.4 * shift)])


@pytest.fixture
def make_image() -> Callable[..., Image]:
    """Return a maker of images; keyword arguments stand in for the usual fields."""

    def make(**fields: Any) -> Image:
        xyz = fields.pop("xyz", None)
        xyz = lamp_xyz(24, 40) if xyz is None else xyz
        usual: dict[str, Any] = {
            "xyz": xyz,
            "xyz_standard_error": 0.01 * np.abs(xyz),
            "samples": 16,
            "samples_asked": 16,
            "seed": 1,
            "scene": FlatScene(),
            "statistics": {"eye_rays": 20_000, "shadow_rays": 10_000, "lost_rays": {}},
            "elapsed_s": 1.5,
            "complete": True,
            "version": "0.1.0",
            "command": "lamplit render scene.toml -o out",
        }
        return Image(**(usual | fields))

    return make

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A small lamp-like picture that no engine made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lamplit.engine.features import Features
from lamplit.engine.image import Image
from lamplit.scene.camera import DisplaySettings
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
    camera: Any = field(default_factory=lambda: SimpleNamespace(field_of_view_deg=20.0))

    @property
    def display(self) -> DisplaySettings:
        """The scene's [display]."""
        values = {"space": self.space, "white_luminance_cd_m2": self.white_luminance_cd_m2}
        return DisplaySettings.model_validate(values | self.settings)

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


def two_layers(height: int = 12, width: int = 20) -> dict[str, Any]:
    """Return the fields of an image whose light comes from a lens and from a lamp in it."""
    lens = lamp_xyz(height, width)
    lamp = np.zeros_like(lens)
    lamp[3:6, 5:9] = (900.0, 700.0, 20.0)
    return {
        "xyz": lens + lamp,
        "xyz_standard_error": np.full_like(lens, 0.25),
        "layers": {"background": lens, "tail lamp": lamp},
        "layers_standard_error": {
            "background": np.full_like(lens, 0.2),
            "tail lamp": np.full_like(lens, 0.15),
        },
    }


def some_features(height: int, width: int) -> Features:
    """Return features that differ from pixel to pixel, with nothing to be seen in the first."""
    plane = np.arange(height * width, dtype=np.float64).reshape(height, width)
    depth = 100.0 + plane / 7.0
    depth[0, 0] = np.inf
    body = (plane % 3).astype(np.int32) - 1
    vectors = np.stack([plane, plane + 0.5, -plane], axis=-1)
    return Features(
        depth_mm=depth,
        normal=vectors / 1e3,
        body=body,
        body_names=("lens", "housing of the lamp"),
        albedo=vectors / 1e4,
        interfaces=plane % 5,
    )


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
            "samples_per_pixel": np.full(xyz.shape[:2], 16, np.uint32),
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


@pytest.fixture
def features() -> Callable[[int, int], Features]:
    """Return the maker of features."""
    return some_features


@pytest.fixture
def layered_image(make_image: Callable[..., Image]) -> Callable[..., Image]:
    """Return a maker of images that have two layers."""
    return lambda **fields: make_image(**(two_layers() | fields))

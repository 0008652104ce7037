# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A scene file, and an engine that paints instead of tracing."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamplit import engine
from lamplit.engine import Comparison, Image, RenderInterrupted

SCENE = """
lamplit = 1
name = "Red ball"
[camera]
kind = "pinhole"
position_mm = [0.0, 0.0, 300.0]
target_mm = [0.0, 0.0, 0.0]
up = [0.0, 1.0, 0.0]
field_of_view_deg = 30.0
[image]
width = 16
height = 10
samples = 4
[display]
white_luminance_cd_m2 = 300.0
[background]
kind = "constant"
source = "D65"
luminance_cd_m2 = 100.0
[[objects]]
name = "ball"
kind = "sphere"
centre_mm = [0.0, 0.0, 0.0]
radius_mm = 40.0
material = "red-pmma"
"""


class Painter:
    """Stands in for the engine: a grey ramp, red on its right for spectra."""

    def __init__(self) -> None:
        self.calls: list[dict[str, Any]] = []
        self.samples_before_stop: int | None = None
        self.fault: BaseException | None = None
        self.statistics: dict[str, Any] = {}
        self.standard_error = 0.01

    def render(self, scene: Any, **options: Any) -> Image:
        """Paint the picture of ``scene``, or stop as a real engine stops."""
        self.calls.append({"scene": scene, **options})
        if self.fault is not None:
            raise self.fault
        image = self.paint(scene, options.get("colour", "spectral"))
        if self.samples_before_stop is not None:
            raise RenderInterrupted(image)
        options["progress"](4, 4)
        return image

    def compare(self, scene: Any, **options: Any) -> Comparison:
        """Paint both halves."""
        return Comparison(*(self.render(scene, colour=c, **options) for c in ("spectral", "rgb")))

    def paint(self, scene: Any, colour: Any) -> Image:
        """Return the picture."""
        width, height, asked = scene.image.width, scene.image.height, scene.image.samples
        done = asked if self.samples_before_stop is None else self.samples_before_stop
        xyz = np.linspace(20.0, 200.0, width * height).reshape(height, width, 1) * np.ones(3)
        xyz[:, width // 2 :] *= (1.0, 0.5, 0.05) if colour == "spectral" else (1.0, 0.6, 0.1)
        return Image(
            xyz=xyz * (done > 0),
            xyz_standard_error=self.standard_error * xyz,
            spectral_radiance=np.ones((height, width, 2)),
            band_centres_nm=np.array([450.0, 650.0]),
            samples=done,
            samples_asked=asked,
            samples_per_pixel=np.full((height, width), done, np.uint32),
            seed=scene.image.seed,
            scene=scene,
            colour=colour,
            statistics=self.statistics,
            elapsed_s=0.1,
            complete=done == asked,
            interrupted=done < asked,
            version="0.1.0",
        )


@pytest.fixture
def painter(monkeypatch: pytest.MonkeyPatch) -> Painter:
    """Put a painter in the engine's place."""
    found = Painter()
    monkeypatch.setattr(engine, "render", found.render)
    monkeypatch.setattr(engine, "compare", found.compare)
    return found


@pytest.fixture
def scene_file(tmp_path: Path) -> Path:
    """Write a small scene."""
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


@pytest.fixture
def lamplit(monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    """Return a runner of command lines that hands back the exit code."""
    from lamplit.cli import main

    def run(*arguments: object) -> int:
        words = [str(argument) for argument in arguments]
        monkeypatch.setattr("sys.argv", ["lamplit", *words])
        return main(words)

    return run

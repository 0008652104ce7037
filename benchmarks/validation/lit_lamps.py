# SPDX-License-Identifier: Apache-2.0 OR MIT
"""T7 for pictures: the luminance of a lit lamp, summed over its face, against its candela.

`lit` makes the picture: walks from the eye that know where light comes from and meet what landed.
The candela are those of walks from the light alone, which share nothing with it but the scene.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from candela_scene import corners_mm
from comparison_scenes import picture
from lit_scene import lit_scene

import lamplit as ll
from lamplit.engine.receiver_view import ReceiverView, receiver_view
from lamplit.scene.camera import ThinLensCamera
from validation.registry import Case, Finding, add

GROUP = "Candela"
#: Of `lit_scene`: a filament before a rough mirror; dies behind a clear and behind a rough cover.
_LAMPS = ("L1", "L3", "L4")
_SPOTS = [(0.0, 0.0), (10.0, 5.0), (-20.0, 0.0)]
_GRID = (np.arange(-90.0, 91.0, 15.0), np.arange(-90.0, 91.0, 15.0))
_RECEIVER_DEG, _DISTANCE_M = 2.0, 25.0
_TRIANGLES = 50_000
#: From the light; and independent pictures, their longer side, and the samples of each.
_PATHS = 1 << 22
_SEEDS, _PIXELS, _SAMPLES = 8, 64, 32


def integrated(lamp: str) -> Iterator[Finding]:
    """Compare I = d² Σ L (n·ω) Ω over a picture's pixels with candela by walks from the light."""
    with tempfile.TemporaryDirectory(prefix="lamplit-integrated-") as folder:
        scene = lit_scene(lamp, Path(folder), triangles=_TRIANGLES)
        if scene.measure is None:
            raise AssertionError("the example lamps say how they are measured")
        own = {"distance_m": _DISTANCE_M, "receiver_deg": _RECEIVER_DEG, "functions": ()}
        scene = scene.changed(measure=scene.measure.model_copy(update=own))
        found = ll.measure(scene, spots=_SPOTS, grid=_GRID, paths=_PATHS, eye=False)
        seen = found.observed()
        gonio, corners = found.goniometer, corners_mm(scene)
        for at, direction in enumerate(gonio.directions()):
            view = receiver_view(gonio, direction, corners, _PIXELS)
            pictures = np.array([_intensity_cd(scene, view, seed) for seed in range(1, _SEEDS + 1)])
            own_sigma = float(pictures.std(ddof=1)) / _SEEDS**0.5
            light_cd, light_sigma = float(seen.spot_cd[at]), float(seen.spot_standard_error_cd[at])
            sigma = float(np.hypot(own_sigma, light_sigma))
            yield Finding(
                f"I at H {_SPOTS[at][0]:g}°, V {_SPOTS[at][1]:g}°, from the light and by pictures",
                light_cd,
                float(pictures.mean()),
                sigma,
                unit="cd",
                note=f"of σ, {own_sigma:.2g} cd is that of {_SEEDS} pictures",
            )


def _intensity_cd(scene: ll.Scene, view: ReceiverView, seed: int) -> float:
    if view.lens_mm is None:
        raise AssertionError("a receiver of 2° is seen through one lens")
    aperture_mm, focus_mm = view.lens_mm
    camera = ThinLensCamera(
        kind="thin-lens",
        position_mm=tuple(view.position_mm.tolist()),
        target_mm=tuple(view.target_mm.tolist()),
        up=tuple(view.up.tolist()),
        field_of_view_deg=view.field_of_view_deg,
        aperture_mm=aperture_mm,
        focus_mm=focus_mm,
    )
    rows, columns = view.areas_m2.shape
    seen = picture(scene.changed(camera=camera), width=columns, height=rows, seed=seed)
    image = ll.render(seen, method="lit", samples=_SAMPLES)
    return float((image.xyz[..., 1] * view.areas_m2).sum())


for _lamp in _LAMPS:
    add(
        Case(
            f"integrated-{_lamp}",
            f"T7: {_lamp} of `benchmarks/lit_scene.py`, lit",
            "I = ∫ L cos θ dA over the lamp's face; walks from the light",
            GROUP,
            lambda lamp=_lamp: integrated(lamp),
        )
    )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The method lit: chosen where an object shines, and the same picture as path's."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import lamplit as ll
from lamplit.engine import render_views
from lamplit.scene import memory_estimate

Table = dict[str, Any]


def bulb(scene_of: Callable[..., Any], *, roughness: float = 0.0, **image: Any) -> Any:
    """Return a small lamp inside a glass ball above a grey floor, in a dim surround."""
    glass = {"kind": "dielectric", "refractive_index": 1.5, "roughness": roughness}
    shining: Table = {
        "name": "filament",
        "kind": "sphere",
        "centre_mm": [0.0, 2.0, 0.0],
        "radius_mm": 1.0,
        "material": "black-abs",
        "emission": {"source": "A", "luminance_cd_m2": 1e5},
    }
    ball = {"name": "ball", "kind": "sphere", "centre_mm": [0.0, 2.0, 0.0], "radius_mm": 3.0}
    floor = {"name": "floor", "kind": "plane", "point_mm": [0, -6, 0], "normal": [0, 1, 0]}
    return scene_of(
        camera={
            "kind": "orthographic",
            "position_mm": [0.0, 60.0, 100.0],
            "target_mm": [0.0, 0.0, 0.0],
            "height_mm": 30.0,
        },
        image={"method": "auto", "width": 12, "height": 10, "samples": 64} | image,
        background={"kind": "constant", "source": "E", "luminance_cd_m2": 1.0},
        materials={"glass": glass},
        objects=[shining, ball | {"material": "glass"}, floor | {"material": "grey-18"}],
    )


@pytest.mark.parametrize("roughness", [0.0, 0.3])
def test_lit_and_path_make_the_same_picture(scene_of: Callable[..., Any], roughness: float) -> None:
    scene = bulb(scene_of, roughness=roughness)
    lit = ll.render(scene, samples=1536)
    path = ll.render(scene, method="path", samples=2048)
    assert lit.method == "lit"
    totals = [image.xyz[..., 1].mean() for image in (lit, path)]
    sigmas = [np.sqrt((i.xyz_standard_error[..., 1] ** 2).sum()) / 120 for i in (lit, path)]
    apart = abs(totals[0] - totals[1]) / np.hypot(*sigmas)
    assert apart < 4.0, (totals, sigmas)
    assert sigmas[0] < 0.03 * totals[0]


def test_the_parts_of_a_lit_picture_are_told_and_add_up(scene_of: Callable[..., Any]) -> None:
    image = ll.render(bulb(scene_of, roughness=0.2))
    found = image.statistics["found_cd_m2"]
    assert set(found) == {"specular", "scattered", "landed"}
    assert sum(found.values()) == pytest.approx(image.xyz[..., 1].mean(), rel=1e-12)
    assert found["landed"] > 0.5 * sum(found.values())
    path = ll.render(bulb(scene_of), method="path").statistics["found_cd_m2"]
    assert set(path) == {"by_eye"}


def test_what_landed_takes_memory_that_is_foretold(scene_of: Callable[..., Any]) -> None:
    small, large = (
        memory_estimate(bulb(scene_of, width=side, height=side)).film_bytes for side in (10, 1000)
    )
    # Two films, and twice 256 bytes and 24: for 12 photons a pixel of each of eight samples, for
    # 2^18 at most.
    per_pixel = 2 * 144
    assert small == 100 * (per_pixel + 8 * 12 * 536)
    assert large == 1_000_000 * per_pixel + 2**18 * 536


def test_path_finds_all_by_the_eye(scene_of: Callable[..., Any]) -> None:
    path = ll.render(bulb(scene_of), method="path").statistics["found_cd_m2"]
    assert set(path) == {"by_eye"}


def test_auto_takes_path_where_no_object_shines(scene_of: Callable[..., Any]) -> None:
    dark = bulb(scene_of, samples=1)
    objects = tuple(thing for thing in dark.objects if thing.emission is None)
    assert ll.render(dark.changed(objects=objects)).method == "path"
    assert ll.render(dark).method == "lit"


def test_a_lit_picture_does_not_depend_on_threads_and_does_on_its_seed(
    scene_of: Callable[..., Any],
) -> None:
    scene = bulb(scene_of, roughness=0.3, samples=24)
    one = ll.render(scene, threads=1).xyz
    assert np.array_equal(one, ll.render(scene, threads=3).xyz)
    assert not np.array_equal(one, ll.render(bulb(scene_of, roughness=0.3, samples=24, seed=2)).xyz)


def test_frames_that_share_what_was_learned_are_those_of_single_renders(
    scene_of: Callable[..., Any],
) -> None:
    scene = bulb(scene_of, samples=8)
    for image in render_views(scene, turntable=3, sweep_deg=90.0):
        alone = ll.render(scene.changed(camera=image.scene.camera))
        assert np.array_equal(image.xyz, alone.xyz)


def test_lit_is_no_error_where_nothing_shines(scene_of: Callable[..., Any]) -> None:
    lit = bulb(scene_of, samples=4)
    dark = lit.changed(objects=tuple(thing for thing in lit.objects if thing.emission is None))
    for image in [ll.render(dark, method="lit"), *render_views(dark, turntable=2, method="lit")]:
        assert image.method == "lit"
        assert image.xyz[..., 1].max() > 0.0


def test_the_few_samples_of_a_frosted_bulb_show_its_light(scene_of: Callable[..., Any]) -> None:
    scene = bulb(scene_of, roughness=0.3)
    few = np.mean(
        [
            ll.render(bulb(scene_of, roughness=0.3, samples=4, seed=seed)).xyz[..., 1].mean()
            for seed in range(12)
        ]
    )
    many = ll.render(scene, samples=256).xyz[..., 1].mean()
    assert few == pytest.approx(many, rel=0.25)


def test_the_films_of_a_lit_picture_are_foretold(scene_of: Callable[..., Any]) -> None:
    lit, path = (memory_estimate(bulb(scene_of, method=method)) for method in ("auto", "path"))
    # Two films of 144 bytes a pixel instead of one, and what landed.
    assert lit.film_bytes - path.film_bytes == (144 + 8 * 12 * 536) * 12 * 10

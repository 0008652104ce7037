# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Depth, normal, body, albedo and interfaces are those of scenes whose answers are known."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import lamplit as ll

Table = dict[str, Any]

SLAB: Table = {
    "name": "slab",
    "kind": "box",
    "min_mm": [-4, -4, 2],
    "max_mm": [4, 4, 5],
    "material": "pmma-clear",
}
WALL: Table = {
    "name": "wall",
    "kind": "disc",
    "centre_mm": [0, 0, 0],
    "normal": [0, 0, 1],
    "radius_mm": 8.0,
    "material": "half",
}
HALF: Table = {"half": {"kind": "diffuse", "reflectance": 0.5}}


def features(scene_of: Callable[..., Any], *objects: Table, **tables: Any) -> Any:
    scene = scene_of(objects=list(objects), materials=HALF, **tables)
    image = ll.render(scene, samples=1, features=True)
    assert image.features is not None
    return image.features


def test_a_slab_before_a_wall_before_nothing(scene_of: Callable[..., Any]) -> None:
    """The eye at z = 100 mm; pixels of 2.5 mm, so that 8 × 8 of them span 20 mm."""
    found = features(scene_of, WALL, SLAB)
    assert found.body_names == ("wall", "slab")
    # Column 3 is up to 2.5 mm beside the axis, column 1 from 5 to 7.5 mm, and a corner beyond 8.
    assert [found.body[3, 3], found.body[3, 1], found.body[0, 0]] == [1, 0, -1]
    np.testing.assert_allclose(found.depth_mm[[3, 3, 0], [3, 1, 0]], [95.0, 100.0, np.inf])
    np.testing.assert_allclose(found.normal[3, 3], [0, 0, 1], atol=1e-12)
    np.testing.assert_array_equal(found.normal[0, 0], [0, 0, 0])
    assert [found.interfaces[3, 3], found.interfaces[3, 1], found.interfaces[0, 0]] == [2, 0, 0]


def test_the_albedo_of_a_matt_wall_is_its_reflectance(scene_of: Callable[..., Any]) -> None:
    found = features(scene_of, WALL)
    # Nine rays see nine of 25 phases of the wavelengths, so X and Z are near 0.5 and not at it.
    np.testing.assert_allclose(found.albedo[3, 3, 1], 0.5, rtol=1e-9)
    np.testing.assert_allclose(found.albedo[3, 3], 0.5, rtol=0.05)
    np.testing.assert_array_equal(found.albedo[0, 0], [0, 0, 0])


def test_depth_and_normal_of_a_ball_are_those_of_its_equation(scene_of: Callable[..., Any]) -> None:
    ball = {"name": "ball", "kind": "sphere", "centre_mm": [0, 0, 0], "radius_mm": 30.0}
    found = features(scene_of, ball | {"material": "half"})
    middles = (np.arange(8) - 3.5) * 2.5
    x, y = np.meshgrid(middles, -middles)
    z = np.sqrt(30.0**2 - x**2 - y**2)
    # Means over a pixel of 2.5 mm differ from its middle by the curvature, (2.5/3)²·2/3/(2·30).
    np.testing.assert_allclose(found.depth_mm, 100.0 - z, atol=0.03)
    normal = np.stack([x, y, z], axis=-1) / 30.0
    np.testing.assert_allclose(found.normal, normal, atol=3e-3)
    assert np.linalg.norm(found.normal, axis=-1).max() < 1.0


@pytest.mark.parametrize("method", ["hall", "path"])
def test_features_belong_to_either_method(scene_of: Callable[..., Any], method: str) -> None:
    found = features(scene_of, WALL, SLAB, image={"method": method})
    assert found.interfaces.max() == 2


def test_features_are_kept_only_when_they_are_asked_for(scene_of: Callable[..., Any]) -> None:
    assert ll.render(scene_of(objects=[SLAB])).features is None

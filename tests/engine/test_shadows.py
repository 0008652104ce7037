# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What stands between a surface and a light: opaque bodies block it, clear ones dim it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

Array = NDArray[np.float64]
Maker = Callable[[], Any]

INDICES = np.linspace(1.05, 2.2, 16)
LAMP = np.array([0.0, 60.0, 80.0])


def lit_floor(lane_scene: Maker, put: Callable[[Any], None], **settings: Any) -> Array:
    """Return the lanes of a row of a white floor (z = 0), seen straight from below a lamp."""
    scene = lane_scene()
    scene.body("plane", [0, 0, 0, 0, 0, 1], scene.matt(1.0))
    scene.builder.add_point_light(scene.spectrum(1.0), tuple(LAMP))
    put(scene)
    scene.look((0, 0, 10), (0, 0, 0), height_mm=8.0)
    return scene.radiance(8, 8, **({"shadows": True} | settings))


def unshadowed(z: float = 0.0) -> Array:
    offsets = ((np.arange(8) + 0.5) / 8 - 0.5) * 8
    x, y = np.meshgrid(offsets, -offsets)
    way = LAMP - np.stack([x, y, np.full_like(x, z)], -1)
    return way[..., 2] / np.linalg.norm(way, axis=-1)


@pytest.mark.parametrize("kind", ["matt", "mirror"])
def test_an_opaque_body_blocks_and_the_rest_is_untouched(lane_scene: Maker, kind: str) -> None:
    def put(scene: Any) -> None:
        scene.body("sphere", [0, 30, 40, 1.5], getattr(scene, kind)(0.5))

    got, free = lit_floor(lane_scene, put), unshadowed()
    offsets = ((np.arange(8) + 0.5) / 8 - 0.5) * 8
    x, y = np.meshgrid(offsets, -offsets)
    way = LAMP - np.stack([x, y, np.zeros_like(x)], -1)
    way /= np.linalg.norm(way, axis=-1, keepdims=True)
    to_ball = np.array([0, 30, 40]) - np.stack([x, y, np.zeros_like(x)], -1)
    gap = np.linalg.norm(np.cross(way, to_ball), axis=-1)
    blocked = gap < 1.5
    assert 0.2 < blocked.mean() < 0.8
    np.testing.assert_allclose(
        got, np.where(blocked, 0.0, free)[..., None] * np.ones(16), rtol=1e-9
    )
    lit = lit_floor(lane_scene, put, shadows=False)
    np.testing.assert_allclose(lit, free[..., None] * np.ones(16), rtol=1e-9)


def test_a_body_beyond_the_light_casts_no_shadow(lane_scene: Maker) -> None:
    def put(scene: Any) -> None:
        scene.body("sphere", [*(LAMP * 1.1), 5.0], scene.matt(0.5))

    np.testing.assert_allclose(lit_floor(lane_scene, put)[..., 0], unshadowed(), rtol=1e-9)


def fresnel(cos_outer: Array, n: Array) -> Array:
    cos_inner = np.sqrt(1 - (1 - cos_outer**2) / n**2)
    s = (cos_outer - n * cos_inner) / (cos_outer + n * cos_inner)
    p = (n * cos_outer - cos_inner) / (n * cos_outer + cos_inner)
    return (s**2 + p**2) / 2


@pytest.mark.parametrize("kind", ["box", "mesh"])
def test_a_slab_dims_by_both_faces_and_what_it_absorbs(
    lane_scene: Maker, box_mesh: Any, kind: str
) -> None:
    alpha, thickness = np.linspace(0.0, 0.3, 16), 3.0
    low, high = [-500.0, -500.0, 40.0], [500.0, 500.0, 40.0 + thickness]

    def put(scene: Any) -> None:
        glass = scene.glass(INDICES, alpha)
        if kind == "box":
            scene.body("box", [*low, *high], glass)
        else:
            scene.mesh(*box_mesh(low, high), glass)

    cosine = unshadowed()[..., None]
    dimmed = cosine * (1 - fresnel(cosine, INDICES)) ** 2 * np.exp(-alpha * thickness / cosine)
    np.testing.assert_allclose(lit_floor(lane_scene, put), dimmed, rtol=1e-6)


def test_a_bodys_own_specular_transmittance_dims_each_face(lane_scene: Maker) -> None:
    f_st = np.linspace(0.1, 0.9, 16)

    def put(scene: Any) -> None:
        scene.body("box", [-500, -500, 40, 500, 500, 43], scene.glass(1.5, 0.0, f_st=f_st))

    expected = unshadowed()[..., None] * f_st**2
    np.testing.assert_allclose(lit_floor(lane_scene, put), expected, rtol=1e-9)


def test_a_point_inside_a_clear_body_is_lit_through_its_own_way_out(lane_scene: Maker) -> None:
    scene, alpha = lane_scene(), np.linspace(0.0, 0.5, 16)
    scene.body("box", [-50, -50, -9, 50, 50, 4], scene.glass(1.0, alpha))
    scene.body("disc", [0, 0, 0, 0, 0, 1, 5], scene.matt(1.0))
    scene.builder.add_directional_light(scene.spectrum(1.0), (0.0, -3.0, -4.0))
    scene.look((0, 0, 50), (0, 0, 0))
    # 4 mm down from the eye's side, and 4/0.8 mm along the light's.
    expected = 0.8 * np.exp(-alpha * (4 + 5))
    np.testing.assert_allclose(scene.radiance(shadows=True), expected, rtol=1e-9)


def test_light_reaches_through_a_body_to_the_face_that_is_seen_from_behind(
    lane_scene: Maker,
) -> None:
    # Eq. (3) with a light that must first cross another slab: k_st·F_st at the last face.
    scene, n, alpha = lane_scene(), INDICES, np.linspace(0.0, 0.3, 16)
    scene.body("box", [-50, -50, 0, 50, 50, 2], scene.glass(n, alpha, k_sr=0.0))
    scene.body("box", [-50, -50, -20, 50, 50, -15], scene.glass(n[::-1], alpha[::-1]))
    scene.builder.add_directional_light(scene.spectrum(1.0), (0.0, 0.0, 1.0))
    scene.look((0, 0, 50), (0, 0, 0))
    got = scene.radiance(max_depth=1, shadows=True)
    r, q = ((n - 1) / (n + 1)) ** 2, ((n[::-1] - 1) / (n[::-1] + 1)) ** 2
    dimmed = (1 - q) ** 2 * np.exp(-5 * alpha[::-1])
    np.testing.assert_allclose(got, (1 - r) ** 2 * np.exp(-2 * alpha) * dimmed, rtol=1e-6)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Mirrors of known shape: corner cubes send light back, a paraboloid sends it along its axis."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

Array = NDArray[np.float64]
Maker = Callable[[], Any]

DIRECTIONS = np.array([[-1, -1, -1], [-1.2, -0.9, -1], [-0.7, -1.1, -1.3]])


def cycled(points: Array, turns: int) -> Array:
    """Return points with their axes renamed x → y → z → x, ``turns`` times."""
    return np.roll(points, turns, axis=-1)


@pytest.mark.parametrize("material", ["mirror", "mirror mesh", "glass"])
@pytest.mark.parametrize("aim", range(3))
def test_a_corner_cube_returns_rays_antiparallel(
    lane_scene: Maker, material: str, aim: int
) -> None:
    d = DIRECTIONS[aim] / np.linalg.norm(DIRECTIONS[aim])
    returned = []
    for turns in range(3):
        scene = lane_scene()
        scene.gradient()
        tip = cycled(np.array([[0, 0, 0], [30, 0, 0], [0, 30, 0], [0, 0, 30]], float), turns)
        if material == "glass":
            # With F_sr = 0 and F_st = 1 nothing but total reflection can send light back.
            glass = scene.glass(1.4915, f_sr=0.0, f_st=1.0)
            scene.body("tetrahedron", tip.ravel(), glass)
        elif material == "mirror":
            for axis in np.eye(3):
                scene.body("plane", [0, 0, 0, *axis], scene.mirror(1.0))
        else:
            scene.mesh(tip, [[0, 1, 2], [0, 2, 3], [0, 3, 1]], scene.mirror(1.0))
        target = cycled(np.array([2.1, 2.0, 1.7]), turns)
        way = cycled(d, turns)
        scene.look(target - 200 * way, target, up=(0.3, 0.5, -0.8))
        returned.append(2 * scene.radiance()[0] - 1)
    # Each turn brings another component of the direction onto the y axis.
    np.testing.assert_allclose(returned, [-d[1], -d[0], -d[2]], rtol=1e-6)


def paraboloid(focus: float, rings: int) -> tuple[Array, NDArray[np.uint32], Array]:
    """Return corners, triangles and unit normals of z = (x² + y²)/4f − f over a square, at f."""
    x, y = np.meshgrid(*[np.linspace(-2 * focus, 2 * focus, rings + 1)] * 2)
    x, y = x.ravel(), y.ravel()
    corners = np.stack([x, y, (x**2 + y**2) / (4 * focus) - focus], 1)
    normals = np.stack([-x / (2 * focus), -y / (2 * focus), np.ones_like(x)], 1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    at = np.arange(rings * (rings + 1)).reshape(rings, rings + 1)[:, :-1].ravel()
    right, over = at + 1, at + rings + 1
    faces = np.concatenate([np.stack([at, right, over], 1), np.stack([right, over + 1, over], 1)])
    return corners, faces.astype(np.uint32), normals


def spread(lane_scene: Maker, rings: int) -> float:
    """Return the largest y of the directions that leave a paraboloid mirror from its focus."""
    scene, focus = lane_scene(), 25.0
    corners, faces, normals = paraboloid(focus, rings)
    scene.gradient()
    scene.mesh(corners, faces, scene.mirror(1.0), normals=normals)
    scene.look((0, 0, 0), (0, 0, -1), field_of_view_deg=80.0)
    lanes = scene.radiance(40, 40)
    assert lanes.shape == (40, 40, 16)
    return float(np.abs(2 * lanes - 1).max())


def test_a_smooth_mesh_of_a_paraboloid_collimates_what_comes_from_its_focus(
    lane_scene: Maker,
) -> None:
    # The facet of side h lies up to h²/8f off the surface (its sag, curvature 1/2f both ways), seen
    # from at least f: an angle of h²/8f². The interpolated unit normals are off by up to
    # |n''| h²/8 in each direction with |n''| ≤ 3/4f²; a mirror doubles it, x and y and their mixed
    # term add up to four times: 3 h²/4f². Together below h²/f² = 16/rings².
    coarse, fine = spread(lane_scene, 50), spread(lane_scene, 200)
    assert coarse < 16.0 / 50**2
    assert fine < 16.0 / 200**2
    assert fine == pytest.approx(coarse / 16, rel=0.35)


def test_facets_of_a_flat_mesh_stay_flat(lane_scene: Maker) -> None:
    scene = lane_scene()
    scene.gradient()
    corners, faces, _ = paraboloid(25.0, 50)
    scene.mesh(corners, faces, scene.mirror(1.0))
    scene.look((0, 0, 0), (0, 0, -1), field_of_view_deg=80.0)
    lanes = scene.radiance(40, 40)
    # A facet turns by up to h/2 · 1/2f = 0.04/2 against the surface; its mirror doubles that.
    assert 0.01 < np.abs(2 * lanes - 1).max() < 0.05


@pytest.mark.parametrize("depth", [1, 2, 5, 9])
def test_facing_mirrors_multiply_their_spectra_as_often_as_the_depth_limit_lets_them(
    lane_scene: Maker, depth: int
) -> None:
    scene, reflectance = lane_scene(), np.linspace(0.3, 0.99, 16)
    mirror = scene.mirror(reflectance, f_sa=0.2)
    scene.body("plane", [0, 0, 0, 0, 0, 1], mirror)
    scene.body("plane", [0, 0, 10, 0, 0, 1], mirror)
    scene.builder.set_ambient(scene.spectrum(3.0))
    scene.look((0, 0, 5), (0, 0, 0))
    hits = np.arange(depth + 1)[:, None]
    expected = (3.0 * 0.2 * reflectance**hits).sum(axis=0)
    np.testing.assert_allclose(scene.radiance(max_depth=depth), expected, rtol=1e-12)


def test_branches_below_the_contribution_limit_are_left_out_and_counted(lane_scene: Maker) -> None:
    scene = lane_scene()
    mirror = scene.mirror(0.5, f_sa=1.0)
    scene.body("plane", [0, 0, 0, 0, 0, 1], mirror)
    scene.body("plane", [0, 0, 10, 0, 0, 1], mirror)
    scene.builder.set_ambient(scene.spectrum(1.0))
    scene.look((0, 0, 5), (0, 0, 0))
    render = scene.render(contribution_limit=0.1)
    # 1/2, 1/4 and 1/8 are followed; 1/16 is not.
    np.testing.assert_array_equal(render.spectral_radiance(), 1.875)
    assert render.statistics()["cut_by_contribution"] == 1
    assert render.statistics()["cut_by_depth"] == 0

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""All the rays between the faces of clear bodies: slabs against their closed form, and furnaces."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

Array = NDArray[np.float64]
Maker = Callable[[], Any]

INDICES = np.linspace(1.05, 2.2, 16)


def fresnel(cos_outer: float, n: Array) -> Array:
    cos_inner = np.sqrt(1 - (1 - cos_outer**2) / n**2)
    s = (cos_outer - n * cos_inner) / (cos_outer + n * cos_inner)
    p = (n * cos_outer - cos_inner) / (n * cos_outer + cos_inner)
    return (s**2 + p**2) / 2


@pytest.mark.parametrize("degrees", [0.0, 20.0, 45.0, 60.0, 80.0])
def test_a_slab_transmits_and_reflects_the_whole_series(lane_scene: Maker, degrees: float) -> None:
    # The method averages s and p at every face, so the series is that of the averaged R:
    # T = (1 − R)²τ/(1 − R²τ²), exact physics straight on.
    scene, angle, alpha = lane_scene(), np.radians(degrees), np.linspace(0.0, 0.5, 16)
    scene.gradient(zenith=5.0, nadir=2.0)
    scene.body("box", [-1e5, 0, -1e5, 1e5, 3, 1e5], scene.glass(INDICES, alpha))
    scene.look((200 * np.sin(angle), 200 * np.cos(angle), 0), (0, 0, 0), up=(0, 0, 1))
    got = scene.radiance(dispersion_groups=16)
    r = fresnel(np.cos(angle), INDICES)
    tau = np.exp(-alpha * 3 / np.sqrt(1 - (np.sin(angle) / INDICES) ** 2))
    transmitted = (1 - r) ** 2 * tau / (1 - (r * tau) ** 2)
    reflected = r + (1 - r) ** 2 * r * tau**2 / (1 - (r * tau) ** 2)
    down = 2.0 + 3.0 * (1 - np.cos(angle)) / 2
    up = 2.0 + 3.0 * (1 + np.cos(angle)) / 2
    np.testing.assert_allclose(got, transmitted * down + reflected * up, rtol=1e-6)


def test_two_slabs_with_a_gap_reflect_into_each_other(lane_scene: Maker) -> None:
    # Adding of layers, straight on: T = T₁T₂/(1 − R₁R₂), R = R₁ + T₁²R₂/(1 − R₁R₂).
    scene = lane_scene()
    scene.gradient(zenith=5.0, nadir=2.0)
    n, m = INDICES, INDICES[::-1]
    scene.body("box", [-99, 4, -99, 99, 7, 99], scene.glass(n))
    scene.body("box", [-99, 0, -99, 99, 2, 99], scene.glass(m))
    scene.look((0, 200, 0), (0, 0, 0), up=(0, 0, 1))
    got = scene.radiance(max_depth=40, contribution_limit=1e-9)

    def slab(index: Array) -> tuple[Array, Array]:
        r = ((index - 1) / (index + 1)) ** 2
        return (1 - r) / (1 + r), 2 * r / (1 + r)

    (t_1, r_1), (t_2, r_2) = slab(n), slab(m)
    transmitted = t_1 * t_2 / (1 - r_1 * r_2)
    reflected = r_1 + t_1**2 * r_2 / (1 - r_1 * r_2)
    np.testing.assert_allclose(got, transmitted * 2.0 + reflected * 5.0, rtol=1e-6)


def sphere(scene: Any, _: Any) -> None:
    scene.body("sphere", [0, 0, 0, 8], scene.glass(1.5))


def dispersive_sphere(scene: Any, _: Any) -> None:
    scene.body("sphere", [0, 0, 0, 8], scene.glass(INDICES))


def shells(scene: Any, _: Any) -> None:
    for radius, n in ((8, 1.5), (6, 1.2), (4, 1.8)):
        name, priority = f"shell {radius}", 10 - radius
        scene.body("sphere", [0, 0, 0, radius], scene.glass(n), name=name, priority=priority)


def box(scene: Any, _: Any) -> None:
    scene.body("box", [-4, -5, -6, 6, 5, 4], scene.glass(1.3))


def mesh(scene: Any, box_mesh: Any) -> None:
    scene.mesh(*box_mesh([-4, -5, -6], [6, 5, 4]), scene.glass(1.3))


def cylinder_in_mesh(scene: Any, box_mesh: Any) -> None:
    scene.mesh(*box_mesh([-6, -6, -6], [6, 6, 6]), scene.glass(1.3))
    scene.body("cylinder", [0, 0, -4, 0, 0, 1, 3, 8], scene.glass(1.15), priority=1)


BODIES = [sphere, dispersive_sphere, shells, box, mesh, cylinder_in_mesh]


@pytest.mark.parametrize("groups", [1, 16])
@pytest.mark.parametrize("put", BODIES)
def test_lossless_glass_in_an_even_surround_cannot_be_seen(
    lane_scene: Maker, box_mesh: Any, put: Callable[[Any, Any], None], groups: int
) -> None:
    scene, limit, side = lane_scene(), 1e-4, 12
    scene.surround()
    put(scene, box_mesh)
    scene.look((50, 31, 77), (0, 0, 0), height_mm=17.0)
    render = scene.render(
        side, side, max_depth=250, contribution_limit=limit, dispersion_groups=groups
    )
    statistics, lanes = render.statistics(), render.spectral_radiance()
    assert statistics["cut_by_depth"] == 0
    assert statistics["lost_rays"] == {}
    assert statistics["dropped_samples"] == 0
    # What is missing is what was cut: at most the limit for every branch not followed.
    missing = (1.0 - lanes).sum(axis=(0, 1))
    assert lanes.max() < 1 + 1e-12
    assert (missing <= limit * statistics["cut_by_contribution"] + 1e-9).all()
    assert lanes.min() > 0.99


@pytest.mark.parametrize("put", [sphere, dispersive_sphere, box, mesh])
def test_the_furnace_closes_to_1e_minus_6_when_every_ray_is_followed(
    lane_scene: Maker, box_mesh: Any, put: Callable[[Any, Any], None]
) -> None:
    scene = lane_scene()
    scene.surround()
    put(scene, box_mesh)
    scene.look((50, 31, 77), (0, 0, 0), height_mm=14.0)
    settings = {"max_depth": 250, "contribution_limit": 1e-10, "dispersion_groups": 16}
    np.testing.assert_allclose(scene.radiance(12, 12, **settings), 1.0, rtol=1e-6)


def test_the_eye_inside_glass_sees_the_surround_undimmed(lane_scene: Maker) -> None:
    scene = lane_scene()
    scene.surround()
    scene.body("sphere", [0, 0, 0, 8], scene.glass(1.2))
    scene.look((1, 2, 3), (5, 5, 1), field_of_view_deg=100.0)
    lanes = scene.radiance(12, 12, max_depth=250, contribution_limit=1e-10)
    np.testing.assert_allclose(lanes, 1.0, rtol=1e-6)

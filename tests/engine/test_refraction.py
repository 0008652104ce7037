# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Snell, Fresnel and total reflection at real interfaces, from the picture alone.

A surround of radiance (1 + y)/2 in the direction (x, y, z) tells where a ray went; a point light's
cosine on a floor tells where it arrived.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import lamplit as ll

Array = NDArray[np.float64]
Maker = Callable[[], Any]

INDICES = np.linspace(1.05, 2.4, 16)

#: PMMA by a Cauchy formula, n = A + B/λ² + C/λ⁴ with λ in µm.
CAUCHY = (1.4779, 0.0050496, -6.9486e-5)


def pmma(nm: Array) -> Array:
    a, b, c = CAUCHY
    return a + b / (nm / 1000) ** 2 + c / (nm / 1000) ** 4


def fresnel(outer: Array, n: Array) -> Array:
    """Return F for light at the angle ``outer`` in air on matter of index n: Fresnel's sines."""
    inner = np.arcsin(np.sin(outer) / n)
    s = np.sin(outer - inner) / np.sin(outer + inner)
    p = np.tan(outer - inner) / np.tan(outer + inner)
    return 0.5 * (s**2 + p**2)


@pytest.mark.parametrize("degrees", [1.0, 30.0, 56.3, 70.0, 85.0, 89.9])
def test_a_surface_reflects_by_fresnel_at_every_angle(lane_scene: Maker, degrees: float) -> None:
    scene, angle = lane_scene(), np.radians(degrees)
    scene.surround(2.0)
    soot = scene.glass(INDICES, absorption=1e3)
    scene.body("box", [-1e5, -1e5, -50, 1e5, 1e5, 0], soot)
    scene.look((1e3 * np.sin(angle), 0, 1e3 * np.cos(angle)), (0, 0, 0))
    np.testing.assert_allclose(scene.radiance(), 2.0 * fresnel(angle, INDICES), rtol=1e-6)


def test_a_surface_reflects_straight_on_the_square_of_the_contrast(lane_scene: Maker) -> None:
    scene = lane_scene()
    scene.surround()
    scene.body("box", [-9, -9, -50, 9, 9, 0], scene.glass(INDICES, absorption=1e3))
    scene.look((0, 0, 100), (0, 0, 0))
    expected = ((INDICES - 1) / (INDICES + 1)) ** 2
    np.testing.assert_allclose(scene.radiance(), expected, rtol=1e-6)


@pytest.mark.parametrize("share", [0.3, 0.9, 0.999])
def test_from_inside_a_surface_lets_through_what_it_does_from_outside(
    lane_scene: Maker, share: float
) -> None:
    scene = lane_scene()
    inner = np.arcsin(share / INDICES)
    got = []
    for n, angle in zip(INDICES, inner, strict=True):
        scene = lane_scene()
        scene.surround()
        scene.body("box", [-1e4, -1e4, -1e4, 1e4, 1e4, 0], scene.glass(n, k_sr=0.0))
        scene.look((100 * np.sin(angle), 0, -100 * np.cos(angle)), (0, 0, 0))
        got.append(scene.radiance()[0])
    np.testing.assert_allclose(got, 1 - fresnel(np.arcsin(share), INDICES), rtol=1e-6)


@pytest.mark.parametrize("n", [1.333, 1.4915, 1.585, 2.4])
def test_light_is_locked_in_from_the_critical_angle_on(lane_scene: Maker, n: float) -> None:
    def through(angle: float) -> float:
        scene = lane_scene()
        scene.surround()
        scene.body("box", [-1e4, -1e4, -1e4, 1e4, 1e4, 0], scene.glass(n, k_sr=0.0))
        scene.look((100 * np.sin(angle), 0, -100 * np.cos(angle)), (0, 0, 0))
        return float(scene.radiance()[0])

    critical = np.arcsin(1 / n)
    assert through(critical * (1 + 1e-6)) == 0.0
    assert 0.0 < through(critical * (1 - 1e-6)) < 0.05


def test_the_long_side_of_a_right_angled_prism_reflects_all(lane_scene: Maker) -> None:
    scene = lane_scene()
    scene.gradient(zenith=0.0, nadir=1.0)
    n = INDICES + 0.37  # above √2, so that 45° lies beyond the critical angle
    corners = [[x, y, z] for z in (-9, 9) for x, y in ((0, 0), (16, 0), (0, 16))]
    faces = [[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]]
    scene.mesh(corners, faces, scene.glass(n))
    # In along +x through one leg, off the long side, out along −y through the other: a folded slab.
    scene.look((-100, 6, 1), (0, 6, 1))
    f = ((n - 1) / (n + 1)) ** 2
    down = (1 - f) ** 2 / (1 - f**2)
    back = f + (1 - f) ** 2 * f / (1 - f**2)
    np.testing.assert_allclose(scene.radiance(), down * 1.0 + back * 0.5, rtol=1e-6)


@pytest.mark.parametrize("degrees", [10.0, 40.0, 70.0])
def test_a_slab_shifts_a_ray_by_snells_law(lane_scene: Maker, degrees: float) -> None:
    scene, angle, side = lane_scene(), np.radians(degrees), 6
    height, floor, thickness = 4.0, -20.0, 5.0
    scene.surround(0.0)
    slab = scene.glass(INDICES, k_sr=0.0, f_sr=0.0, f_st=1.0)
    scene.body("box", [-1e3, -1e3, 0, 1e3, 1e3, thickness], slab)
    scene.body("plane", [0, 0, floor, 0, 0, 1], scene.matt(1.0))
    lamp = np.array([11.0, -4.0, 40.0])  # in front of the slab, so that eq. (3) adds nothing
    scene.builder.add_point_light(scene.spectrum(1.0), tuple(lamp))
    away = np.array([np.sin(angle), 0, np.cos(angle)])
    scene.look(200 * away, (0, 0, 0), height_mm=height)
    got = scene.radiance(side, side, dispersion_groups=16)

    right = np.cross(-away, [0, 1, 0])
    offsets = ((np.arange(side) + 0.5) / side - 0.5) * height
    x, y = (axis[..., None] for axis in np.meshgrid(offsets, -offsets))
    inner = np.arcsin(np.sin(angle) / INDICES)
    # In the plane z = thickness; then down through the slab, then on to the floor.
    start = x * right[0] + (thickness - x * right[2]) * np.tan(angle)
    where = start - thickness * np.tan(inner) + floor * np.tan(angle)
    way = np.stack(
        [
            lamp[0] - where,
            np.broadcast_to(lamp[1] - y, where.shape),
            np.full(where.shape, lamp[2] - floor),
        ],
        -1,
    )
    expected = way[..., 2] / np.linalg.norm(way, axis=-1)
    np.testing.assert_allclose(got, expected, rtol=1e-6)


def prism(scene: Any, apex: float, index: Array, shape: str) -> None:
    """Put the refracting edge of a prism on the z axis, its bisector along −y."""
    glass = scene.glass(index, k_sr=0.0, f_sr=0.0, f_st=1.0)
    x, y = 60 * np.tan(apex / 2), -60.0
    corners = np.array([[0, 0, 200], [0, 0, -200], [x, y, 0], [-x, y, 0]], dtype=float)
    if shape == "tetrahedron":
        scene.body("tetrahedron", corners.ravel(), glass)
    else:
        scene.mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], glass)


def directions(lanes: Array) -> Array:
    """Return the angle over the horizon of the rays that saw these radiances."""
    return np.arcsin(2 * lanes - 1)


@pytest.mark.parametrize("shape", ["tetrahedron", "mesh"])
def test_a_prism_of_pmma_deviates_each_wavelength_least_as_its_index_asks(
    lane_scene: Maker, shape: str
) -> None:
    apex, nm = np.radians(50.0), np.linspace(392.5, 767.5, 16)
    n = pmma(nm)

    def deviation(incidence: float) -> Array:
        scene = lane_scene()
        scene.gradient()
        prism(scene, apex, n, shape)
        # The left face's outward normal points up and to the left; the ray comes from there.
        normal = np.array([-np.cos(apex / 2), np.sin(apex / 2)])
        turn = np.array(
            [[np.cos(incidence), np.sin(incidence)], [-np.sin(incidence), np.cos(incidence)]]
        )
        from_eye = -(turn.T @ normal)
        hit = np.array([-6 * np.tan(apex / 2), -6.0])
        scene.look((*(hit - 150 * from_eye), 0.0), (*hit, 0.0), up=(0, 0, 1))
        return np.arctan2(from_eye[1], from_eye[0]) - directions(
            scene.radiance(dispersion_groups=16)
        )

    for lane in (0, 4, 9, 15):
        least = 2 * np.arcsin(n[lane] * np.sin(apex / 2)) - apex
        incidence = (least + apex) / 2
        got = deviation(incidence)
        np.testing.assert_allclose(got[lane], least, rtol=1e-6)
        for other in (incidence - 0.02, incidence + 0.02):
            assert deviation(other)[lane] > least + 1e-5
        # Every other lane goes its own way: Snell's law twice.
        first = np.arcsin(np.sin(incidence) / n)
        out = np.arcsin(n * np.sin(apex - first))
        np.testing.assert_allclose(got, incidence + out - apex, rtol=1e-6)


def test_a_prism_in_a_scene_file_spreads_the_spectrum_by_pmmas_index(
    scene_of: Callable[..., Any],
) -> None:
    apex, incidence = np.radians(50.0), np.radians(40.0)
    x = 60 * np.tan(apex / 2)
    normal = np.array([-np.cos(apex / 2), np.sin(apex / 2)])
    turn = np.array(
        [[np.cos(incidence), -np.sin(incidence)], [np.sin(incidence), np.cos(incidence)]]
    )
    view = -(turn @ normal)
    hit = np.array([-6 * np.tan(apex / 2), -6.0])
    dark = {"source": "E", "luminance_cd_m2": 0.0}
    scene = scene_of(
        camera={
            "kind": "orthographic",
            "position_mm": [*(hit - 150 * view), 0.0],
            "target_mm": [*hit, 0.0],
            "up": [0, 0, 1],
            "height_mm": 0.1,
        },
        image={"width": 3, "height": 2, "samples": 25},
        hall={"dispersion_groups": 16},
        background={
            "kind": "gradient",
            "nadir": dark,
            "zenith": {"source": "E", "luminance_cd_m2": 100.0},
        },
        materials={
            "pmma": {
                "kind": "dielectric",
                "refractive_index": {"cauchy": list(CAUCHY)},
                "hall": {"k_sr": 0.0, "specular_reflectance": 0.0, "specular_transmittance": 1.0},
            }
        },
        objects=[
            {
                "name": "prism",
                "kind": "tetrahedron",
                "material": "pmma",
                "points_mm": [[0, 0, 200], [0, 0, -200], [x, -60, 0], [-x, -60, 0]],
            }
        ],
    )
    image = ll.render(scene, spectral_bands=True)
    nm = 380.5 + np.arange(400.0)
    first = np.arcsin(np.sin(incidence) / pmma(nm))
    out = np.arcsin(pmma(nm) * np.sin(apex - first))
    heading = np.arctan2(view[1], view[0]) - (incidence + out - apex)
    share = (1 + np.sin(heading)) / 2
    expected = share.reshape(80, 5).mean(axis=1)
    got = image.spectral_radiance / image.spectral_radiance[..., :1]
    np.testing.assert_allclose(got, np.broadcast_to(expected / expected[0], got.shape), rtol=1e-6)
    assert np.ptp(np.degrees(heading)) > 1.0


@pytest.mark.parametrize("groups", [1, 2, 4, 8, 16])
def test_groups_of_lanes_part_as_finely_as_asked(lane_scene: Maker, groups: int) -> None:
    scene, apex = lane_scene(), np.radians(40.0)
    n = pmma(np.linspace(392.5, 767.5, 16))
    scene.gradient()
    prism(scene, apex, n, "tetrahedron")
    scene.look((-150, -6, 0), (0, -6, 0), up=(0, 0, 1))
    seen = directions(scene.radiance(dispersion_groups=groups))
    shared = (
        np.full(16, n[0])
        if groups == 1
        else np.repeat(n.reshape(groups, -1).mean(axis=1), 16 // groups)
    )
    first = np.arcsin(np.sin(apex / 2) / shared)
    expected = apex / 2 - np.arcsin(shared * np.sin(apex - first))
    np.testing.assert_allclose(seen, expected, atol=1e-12)

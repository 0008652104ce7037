# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Thin films, far places, turned normals, broken meshes: nothing is lost, or it is counted."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import lamplit as ll

Array = NDArray[np.float64]
Maker = Callable[[], Any]


def film_picture(
    lane_scene: Maker, box_mesh: Any, kind: str, low: Array, high: Array, alpha: Array
) -> tuple[Array, Array, Any]:
    """Return lanes, their expected values and statistics of a slanted view through a film."""
    scene, n = lane_scene(), 1.49
    scene.gradient(zenith=0.0, nadir=1.0)
    glass = scene.glass(n, alpha)
    if kind == "box":
        scene.body("box", [*low, *high], glass)
    else:
        scene.mesh(*box_mesh(low, high), glass)
    size, angle = np.max(high - low), np.radians(35.0)
    target = (low + high) / 2
    away = np.array([0.3 * np.sin(angle), np.cos(angle), np.sqrt(0.91) * np.sin(angle)])
    scene.look(target + 5 * size * away, target, up=(1, 0, 0), height_mm=0.2 * size)
    render = scene.render(16, 16)
    inner = np.arcsin(np.sin(angle) / n)
    s, p = (
        np.sin(angle - inner) / np.sin(angle + inner),
        np.tan(angle - inner) / np.tan(angle + inner),
    )
    r = (s**2 + p**2) / 2
    tau = np.exp(-alpha * (high - low)[1] / np.cos(inner))
    t = (1 - r) ** 2 * tau / (1 - (r * tau) ** 2)
    back = r + (1 - r) ** 2 * r * tau**2 / (1 - (r * tau) ** 2)
    expected = t * (1 + np.cos(angle)) / 2 + back * (1 - np.cos(angle)) / 2
    return render.spectral_radiance(), expected, render.statistics()


def start_offset(place: float) -> float:
    """Return how far, in mm, from a face at ``place`` on all axes a ray starts at most.

    The rounding errors of hitting it and leaving it are bounded by 8 γ₁₆ of the sizes summed.
    """
    return 8 * 16 * 2.0**-53 * 3 * place


@pytest.mark.parametrize("kind", ["box", "mesh"])
@pytest.mark.parametrize("offset", [0.0, 1e3, 1e6])
def test_a_film_of_10_um_far_from_the_origin_transmits_exactly(
    lane_scene: Maker, box_mesh: Any, kind: str, offset: float
) -> None:
    low = np.array([-20.0, 0.0, -20.0]) + offset
    high = low + np.array([40.0, 0.01, 40.0])
    alpha = np.linspace(0.0, 80.0, 16)
    lanes, expected, statistics = film_picture(lane_scene, box_mesh, kind, low, high, alpha)
    assert statistics["lost_rays"] == {}
    close = 1e-6 + alpha.max() * start_offset(offset)
    np.testing.assert_allclose(lanes, np.broadcast_to(expected, lanes.shape), rtol=close)


@pytest.mark.parametrize("kind", ["box", "mesh"])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("offset", [0.0, 1e3, 1e6])
def test_a_slab_is_the_same_at_every_size_and_place(
    lane_scene: Maker, box_mesh: Any, kind: str, scale: float, offset: float
) -> None:
    low = scale * np.array([-20.0, -2.0, -20.0]) + offset
    high = low + scale * np.array([40.0, 3.0, 40.0])
    alpha = np.linspace(0.0, 0.5, 16) / scale
    lanes, expected, statistics = film_picture(lane_scene, box_mesh, kind, low, high, alpha)
    assert statistics["lost_rays"] == {}
    assert statistics["eye_rays"] > 256 * 3
    close = 1e-6 + alpha.max() * start_offset(offset)
    np.testing.assert_allclose(lanes, np.broadcast_to(expected, lanes.shape), rtol=close)


@pytest.mark.parametrize("kind", ["sphere", "cylinder", "cone", "tetrahedron"])
@pytest.mark.parametrize("offset", [0.0, 1e3, 1e6])
def test_round_bodies_lose_no_ray_at_any_place(lane_scene: Maker, kind: str, offset: float) -> None:
    numbers = {
        "sphere": [0, 0, 0, 5],
        "cylinder": [0, 0, -4, 0, 0, 1, 3, 7],
        "cone": [0, 0, -4, 0, 0, 1, 4, 8],
        "tetrahedron": [-3, -3, -3, 6, -3, -3, -3, 6, -3, -3, -3, 6],
    }[kind]
    points = {"sphere": 1, "cylinder": 1, "cone": 1, "tetrahedron": 4}[kind]
    placed = np.array(numbers, float)
    placed[: 3 * points] += offset
    scene = lane_scene()
    scene.surround()
    scene.body(kind, placed, scene.glass(1.3))
    centre = np.full(3, offset)
    scene.look(np.add(centre, (80, 45, 30)), centre, height_mm=12.0)
    render = scene.render(48, 48, max_depth=60, contribution_limit=1e-4)
    assert render.statistics()["lost_rays"] == {}
    assert render.statistics()["dropped_samples"] == 0
    lanes = render.spectral_radiance()
    assert lanes.max() < 1 + 1e-9
    # A cone and a pyramid lock some light in for longer than 60 reflections.
    assert np.median(lanes) > 0.999


def test_flipped_triangles_give_the_same_picture(
    scene_of: Callable[..., Any], box_mesh: Callable[..., Any], write_ply: Callable[..., str]
) -> None:
    corners, faces = box_mesh([-6, -5, -4], [6, 5, 4])
    some = faces.copy()
    some[::3] = some[::3, ::-1]
    pictures = []
    for name, turned in (("out", faces), ("in", faces[:, ::-1]), ("mixed", some)):
        file = write_ply(f"{name}.ply", corners, turned)
        scene = scene_of(
            camera={
                "kind": "pinhole",
                "position_mm": [20, 30, 50],
                "target_mm": [0, 0, 0],
                "field_of_view_deg": 18.0,
            },
            lights=[
                {
                    "kind": "point",
                    "position_mm": [30, 50, 20],
                    "source": "D65",
                    "luminance_cd_m2": 300.0,
                }
            ],
            objects=[
                {
                    "name": "block",
                    "kind": "mesh",
                    "file": file,
                    "unit": "mm",
                    "material": "red-pmma",
                }
            ],
        )
        pictures.append(ll.render(scene).xyz)
        assert bool(scene.resolved_objects()[0].notices) == (name != "out")
    assert pictures[0][..., 1].std() > 1.0
    np.testing.assert_array_equal(pictures[1], pictures[0])
    np.testing.assert_array_equal(pictures[2], pictures[0])


def broken_box(lane_scene: Maker, box_mesh: Any, spoil: Callable[[Any], Any]) -> Any:
    scene = lane_scene()
    scene.surround()
    corners, faces = box_mesh([-4, -4, -4], [4, 4, 4])
    scene.mesh(corners, spoil(faces), scene.glass(1.0), name="lens")
    scene.look((0.1, 0.2, 50), (0.1, 0.2, 0))
    return scene.render().statistics()["lost_rays"]


def test_rays_that_a_broken_mesh_loses_are_counted_by_body_and_cause(
    lane_scene: Maker, box_mesh: Any
) -> None:
    # box_mesh lists the face z = low first and z = high second; the eye looks along −z.
    assert broken_box(lane_scene, box_mesh, lambda faces: faces) == {}
    without_back = broken_box(lane_scene, box_mesh, lambda faces: faces[2:])
    assert without_back == {"lens": {"ended_inside": 1}}
    without_front = broken_box(lane_scene, box_mesh, lambda faces: np.delete(faces, [2, 3], axis=0))
    assert without_front == {"lens": {"left_without_entering": 1}}

    def turned_back(faces: Any) -> Any:
        return np.concatenate([faces[:2, ::-1], faces[2:]])

    assert broken_box(lane_scene, box_mesh, turned_back) == {
        "lens": {"entered_twice": 1, "ended_inside": 1}
    }


def test_a_ray_lost_on_the_way_to_a_light_is_counted_too(lane_scene: Maker, box_mesh: Any) -> None:
    scene = lane_scene()
    corners, faces = box_mesh([-4, -4, 60], [4, 4, 63])
    scene.mesh(corners, np.delete(faces, [0, 1], axis=0), scene.glass(1.0), name="lens")
    scene.body("plane", [0, 0, 0, 0, 0, 1], scene.matt(0.5))
    scene.builder.add_directional_light(scene.spectrum(1.0), (0.0, 0.0, -1.0))
    scene.look((0.1, 0.2, 5), (0.1, 0.2, 0))
    lost = scene.render(shadows=True).statistics()["lost_rays"]
    assert lost == {"lens": {"left_without_entering": 1}}


def test_a_picture_of_extreme_contrast_has_no_value_that_is_not_a_radiance(
    lane_scene: Maker,
) -> None:
    scene = lane_scene()
    scene.surround(np.geomspace(1e-12, 1e12, 16))
    scene.body("sphere", [0, 0, 0, 5], scene.glass(1.5, np.geomspace(1e-9, 1e6, 16)))
    scene.body("plane", [0, -6, 0, 0, 1, 0], scene.matt(np.linspace(0.0, 1.0, 16)))
    scene.builder.add_point_light(scene.spectrum(1e9), (0.0, 20.0, 0.0))
    scene.look((20, 9, 30), (0, 0, 0), height_mm=14.0)
    render = scene.render(16, 16, max_depth=20, contribution_limit=1e-6, shadows=True)
    lanes = render.spectral_radiance()
    assert np.isfinite(lanes).all()
    assert (lanes >= 0).all()
    assert render.statistics()["dropped_samples"] == 0

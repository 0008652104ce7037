# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Bodies that touch, overlap, hold each other or the eye."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import lamplit as ll
from lamplit.errors import SceneError

Array = NDArray[np.float64]
Maker = Callable[[], Any]


def test_a_body_of_index_1_is_invisible(lane_scene: Maker) -> None:
    def picture(*, has_ball: bool) -> Array:
        scene = lane_scene()
        scene.gradient()
        scene.body("plane", [0, -9, 0, 0, 1, 0], scene.matt(0.5))
        if has_ball:
            scene.body("sphere", [0, 0, 0, 8], scene.glass(1.0))
        scene.builder.set_ambient(scene.spectrum(0.7))
        scene.look((20, 30, 50), (0, 0, 0), field_of_view_deg=25.0)
        return scene.radiance(24, 24)

    np.testing.assert_allclose(picture(has_ball=True), picture(has_ball=False), rtol=1e-9)


def test_a_body_in_another_of_the_same_index_is_invisible(lane_scene: Maker) -> None:
    def picture(*, has_core: bool) -> Array:
        scene = lane_scene()
        scene.gradient()
        scene.body("box", [-8, -8, -8, 8, 8, 8], scene.glass(1.5, k_sr=0.0))
        if has_core:
            scene.body("sphere", [1, 0, 1, 5], scene.glass(1.5, k_sr=0.0), priority=1)
        scene.look((20, 30, 50), (0, 0, 0), height_mm=20.0)
        return scene.radiance(16, 16)

    np.testing.assert_allclose(picture(has_core=True), picture(has_core=False), rtol=1e-9)


@pytest.mark.parametrize("kind", ["box", "mesh"])
def test_touching_bodies_of_one_material_are_one_body(
    lane_scene: Maker, box_mesh: Any, kind: str
) -> None:
    def picture(cuts: list[float]) -> tuple[Array, Any]:
        scene = lane_scene()
        scene.gradient(zenith=3.0, nadir=1.0)
        red = scene.glass(1.49, np.linspace(0.01, 0.3, 16))
        for at, (low, high) in enumerate(pairwise(cuts)):
            corners = [-6, -6, low], [6, 6, high]
            if kind == "box":
                scene.body("box", np.ravel(corners), red, name=str(at))
            else:
                scene.mesh(*box_mesh(*corners), red, name=str(at))
        scene.look((20, 33, 57), (0.1, 0.2, 0), height_mm=18.0)
        render = scene.render(16, 16, max_depth=10, contribution_limit=1e-3)
        return render.spectral_radiance(), render.statistics()

    (one, _), (three, statistics) = picture([-4, 4]), picture([-4, -1, 2, 4])
    np.testing.assert_allclose(three, one, rtol=1e-6)
    assert statistics["lost_rays"] == {}


def test_glued_meshes_may_be_tessellated_differently(lane_scene: Maker, box_mesh: Any) -> None:
    """The touching faces are turned, so that rounding moves the vertices of each otherwise."""
    angle = np.radians([31.0, 17.0])
    (c, d), (s, u) = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array(
        [[1, 0, 0], [0, d, -u], [0, u, d]]
    )

    def picture(bodies: list[tuple[Any, ...]]) -> tuple[Array, Any]:
        scene = lane_scene()
        scene.gradient(zenith=3.0, nadir=1.0)
        red = scene.glass(1.49, np.linspace(0.01, 0.3, 16))
        for at, (vertices, triangles) in enumerate(bodies):
            scene.mesh(np.asarray(vertices) @ turn.T, triangles, red, name=str(at))
        scene.look((20, 33, 57), (0.1, 0.2, 0), height_mm=18.0)
        render = scene.render(24, 24, max_depth=8, contribution_limit=1e-3)
        return render.spectral_radiance(), render.statistics()

    whole = box_mesh([-6, -6, -4], [6, 6, 4])
    lower = box_mesh([-6, -6, -4], [6, 6, 1.1])
    one, _ = picture([whole])
    two, statistics = picture([lower, fan_box([-6, -6, 1.1], [6, 6, 4])])
    assert statistics["lost_rays"] == {}
    np.testing.assert_allclose(two, one, rtol=1e-5)


def fan_box(low: list[float], high: list[float]) -> tuple[Array, NDArray[np.uint32]]:
    """Return a closed box with four triangles on each face, round a point off its middle."""
    corners = np.array(np.meshgrid(*zip(low, high, strict=True), indexing="ij")).reshape(3, 8).T
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    weights = np.array([0.1, 0.2, 0.3, 0.4])
    hubs = [weights @ corners[list(face)] for face in faces]
    triangles = [
        (face[k], face[(k + 1) % 4], 8 + at) for at, face in enumerate(faces) for k in range(4)
    ]
    return np.concatenate([corners, hubs]), np.array(triangles, np.uint32)


@pytest.mark.parametrize("floor", ["plane", "disc", "box"])
@pytest.mark.parametrize("kind", ["box", "mesh"])
def test_a_floor_is_seen_through_the_glass_that_stands_on_it(
    lane_scene: Maker, box_mesh: Any, kind: str, floor: str
) -> None:
    scene, alpha = lane_scene(), np.linspace(0.1, 1.0, 16)
    scene.builder.set_ambient(scene.spectrum(2.0))
    numbers = {
        "plane": [0, 0.7, 0, 0, 1, 0],
        "disc": [0, 0.7, 0, 0, 1, 0, 50],
        "box": [-50, -9, -50, 50, 0.7, 50],
    }
    scene.body(floor, numbers[floor], scene.matt(0.25))
    glass = scene.glass(1.5, alpha, f_sr=0.0, f_st=1.0)
    low, high = [-9, 0.7, -9], [9, 3.7, 9]
    if kind == "box":
        scene.body("box", low + high, glass)
    else:
        scene.mesh(*box_mesh(low, high), glass)
    scene.look((0.3, 90, 0.2), (0.3, 0, 0.2), up=(0, 0, 1), height_mm=6.0)
    render = scene.render(8, 8)
    expected = np.broadcast_to(0.5 * np.exp(-alpha * 3), (8, 8, 16))
    np.testing.assert_allclose(render.spectral_radiance(), expected, rtol=1e-6)
    assert render.statistics()["lost_rays"] == {}


def test_a_depth_beyond_the_stack_is_refused(lane_scene: Maker) -> None:
    scene = lane_scene()
    scene.look((0, 0, 9), (0, 0, 0))
    with pytest.raises(ValueError, match="max_depth is at most 256, not 257"):
        scene.render(max_depth=257)


def test_touching_bodies_of_two_materials_share_one_interface(lane_scene: Maker) -> None:
    n, m = 1.5, 1.7
    scene = lane_scene()
    scene.gradient(zenith=5.0, nadir=2.0)
    scene.body("box", [-99, 0, -99, 99, 3, 99], scene.glass(n))
    scene.body("box", [-99, -2, -99, 99, 0, 99], scene.glass(m))
    scene.look((0, 200, 0), (0, 0, 0), up=(0, 0, 1))
    r = [((a - b) / (a + b)) ** 2 for a, b in ((1, n), (n, m), (m, 1))]
    t, back = 1 - r[2], r[2]
    for face in (r[1], r[0]):
        t, back = (
            (1 - face) * t / (1 - face * back),
            face + (1 - face) ** 2 * back / (1 - face * back),
        )
    np.testing.assert_allclose(
        scene.radiance(max_depth=40, contribution_limit=1e-9), t * 2.0 + back * 5.0, rtol=1e-6
    )


@pytest.mark.parametrize("winner", ["ball", "block"])
def test_where_bodies_overlap_the_higher_priority_is_there(lane_scene: Maker, winner: str) -> None:
    scene, side = lane_scene(), 20
    ball, block = np.linspace(0.01, 0.1, 16), np.linspace(0.3, 0.05, 16)
    scene.surround()
    scene.body("sphere", [0, 0, 0, 8], scene.glass(1.0, ball), priority=int(winner == "ball"))
    scene.body(
        "box", [-3, -30, -30, 30, 30, 2], scene.glass(1.0, block), priority=int(winner == "block")
    )
    scene.look((0, 0, 100), (0, 0, 0), height_mm=20.0)
    got = scene.radiance(side, side)
    offsets = ((np.arange(side) + 0.5) / side - 0.5) * 20
    x, y = np.meshgrid(offsets, -offsets)
    half = np.sqrt(np.maximum(64 - x**2 - y**2, 0))
    in_block = np.where(x > -3, 32.0, 0.0)
    both = np.where(x > -3, np.clip(np.minimum(half, 2.0) + half, 0, None), 0.0)
    ball_path = 2 * half - (both if winner == "block" else 0)
    block_path = in_block - (both if winner == "ball" else 0)
    expected = np.exp(-ball * ball_path[..., None] - block * block_path[..., None])
    np.testing.assert_allclose(got, expected, rtol=1e-6)


def test_among_equal_priorities_the_later_in_the_file_wins(lane_scene: Maker) -> None:
    scene, alphas = lane_scene(), (0.1, 0.7)
    scene.surround()
    for at, alpha in enumerate(alphas):
        scene.body("box", [-9, -9, 0, 9, 9, 2], scene.glass(1.0, alpha), name=str(at))
    scene.look((0.1, 0.2, 9), (0.1, 0.2, 0))
    np.testing.assert_allclose(scene.radiance(), np.exp(-0.7 * 2), rtol=1e-9)


def test_a_bubble_of_air_is_a_body_of_higher_priority(lane_scene: Maker) -> None:
    scene, alpha = lane_scene(), np.linspace(0.0, 1.0, 16)
    scene.surround()
    scene.body("box", [-9, -9, 0, 9, 9, 10], scene.glass(1.0, alpha))
    scene.body("box", [-5, -5, 3, 5, 5, 7], scene.glass(1.0), priority=1)
    scene.look((0.1, 0.2, 50), (0.1, 0.2, 0))
    np.testing.assert_allclose(scene.radiance(), np.exp(-alpha * 6), rtol=1e-9)


def test_an_opaque_body_in_a_clear_one_is_seen_through_it(lane_scene: Maker) -> None:
    scene, alpha = lane_scene(), np.linspace(0.1, 1.0, 16)
    scene.builder.set_ambient(scene.spectrum(2.0))
    scene.body("box", [-9, -9, 0, 9, 9, 10], scene.glass(1.0, alpha))
    scene.body("sphere", [0, 0, 5, 2], scene.matt(0.25))
    scene.look((0, 0, 50), (0, 0, 0))
    np.testing.assert_allclose(scene.radiance(), 0.5 * np.exp(-alpha * 3), rtol=1e-9)


@pytest.mark.parametrize("nested", [1, 5, 16])
def test_sixteen_bodies_may_hold_one_point(lane_scene: Maker, nested: int) -> None:
    scene = lane_scene()
    scene.surround()
    for at in range(nested):
        size = 20.0 - at
        glass = scene.glass(1.0, 0.01 * (at + 1))
        scene.body("sphere", [0, 0, 0, size], glass, name=str(at), priority=at)
    scene.look((0, 0, 100), (0, 0, 0))
    render = scene.render()
    shells = 2.0 * np.append(np.ones(nested - 1), 21.0 - nested)
    expected = np.exp(-(shells * 0.01 * np.arange(1, nested + 1)).sum())
    np.testing.assert_allclose(render.spectral_radiance()[0, 0], expected, rtol=1e-9)
    assert render.statistics()["lost_rays"] == {}


def test_more_bodies_at_one_point_than_that_are_counted(lane_scene: Maker) -> None:
    scene = lane_scene()
    scene.surround()
    for at in range(17):
        scene.body("sphere", [0, 0, 0, 20.0 - at], scene.glass(1.0), name=f"shell {at}")
    scene.look((0, 0, 100), (0, 0, 0))
    lost = scene.render().statistics()["lost_rays"]
    assert lost == {"shell 16": {"too_many_bodies": 1, "left_without_entering": 1}}


EYE_IN_BALL = {
    "kind": "pinhole",
    "position_mm": [1, 2, 3],
    "target_mm": [1, 2, -9],
    "field_of_view_deg": 40.0,
}
BALL = {"name": "ball", "kind": "sphere", "centre_mm": [0, 0, 0], "radius_mm": 10, "material": "it"}


def test_a_camera_in_an_opaque_body_is_refused_in_one_line(scene_of: Callable[..., Any]) -> None:
    paint = {"kind": "diffuse", "reflectance": 0.5}
    scene = scene_of(camera=EYE_IN_BALL, materials={"it": paint}, objects=[BALL])
    with pytest.raises(SceneError, match=r"camera.*inside.*'ball'") as caught:
        ll.render(scene)
    assert "\n" not in str(caught.value)


def test_the_core_itself_refuses_an_eye_in_an_opaque_body(lane_scene: Maker) -> None:
    scene = lane_scene()
    scene.body("sphere", [0, 0, 0, 10], scene.matt(0.5), name="ball")
    scene.look((1, 2, 3), (1, 2, -9))
    with pytest.raises(ValueError, match=r"camera is inside the opaque body .ball"):
        scene.render()


def test_a_camera_in_a_clear_body_looks_out_of_it(scene_of: Callable[..., Any]) -> None:
    tinted = {
        "kind": "dielectric",
        "refractive_index": 1.0,
        "internal_transmittance": {"thickness_mm": 1.0, "value": 0.9},
    }
    scene = scene_of(
        camera=EYE_IN_BALL,
        image={"samples": 25, "width": 1, "height": 1, "filter": "box"},
        materials={"it": tinted},
        objects=[BALL],
    )
    scene = scene.changed(camera=scene.camera.model_copy(update={"field_of_view_deg": 1e-6}))
    image = ll.render(scene)
    path = 3 + np.sqrt(100 - 1 - 4)
    np.testing.assert_allclose(image.luminance_cd_m2, 100 * 0.9**path, rtol=1e-6)
    assert image.statistics["lost_rays"] == {}


def test_a_camera_in_nested_clear_bodies_knows_all_of_them(lane_scene: Maker) -> None:
    scene, outer, inner = lane_scene(), np.linspace(0.01, 0.1, 16), np.linspace(0.3, 0.05, 16)
    scene.surround()
    scene.body("sphere", [0, 0, 0, 10], scene.glass(1.0, outer))
    scene.body("box", [-3, -3, -3, 3, 3, 3], scene.glass(1.0, inner), priority=1)
    scene.body("sphere", [40, 0, 0, 5], scene.glass(1.0, 1.0), name="beside")
    scene.look((0, 0, 1), (0, 0, -9))
    render = scene.render()
    np.testing.assert_allclose(render.spectral_radiance()[0, 0], np.exp(-4 * inner - 7 * outer))
    assert render.statistics()["lost_rays"] == {}

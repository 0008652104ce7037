# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Eq. (2), T(λ) = t(λ)^b, along every kind of path through every kind of body."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import colour
import numpy as np
import pytest
from numpy.typing import NDArray

import lamplit as ll
from lamplit.report.develop import develop
from lamplit.report.exr import write_exr
from lamplit.report.exr_file import read_exr

Array = NDArray[np.float64]


def colour_matching(nm: Array) -> Array:
    table = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    return np.stack([np.interp(nm, table.wavelengths, column) for column in table.values.T], 1)


SLAB = """
lamplit = 1
[camera]
kind = "orthographic"
position_mm = [0.0, 0.0, 100.0]
target_mm = [0.0, 0.0, 0.0]
height_mm = 20.0
[image]
width = 4
height = 2
samples = 25
[background]
kind = "constant"
source = "D65"
luminance_cd_m2 = 100.0
[materials.tinted]
kind = "dielectric"
refractive_index = 1.0
internal_transmittance = { thickness_mm = 1.0, value = 0.9 }
[[objects]]
name = "slab"
kind = "box"
min_mm = [-50.0, -50.0, 0.0]
max_mm = [0.0, 50.0, 3.0]
material = "tinted"
"""


def tinted(t: Any = 0.9, thickness_mm: float = 1.0) -> dict[str, Any]:
    value = t if isinstance(t, dict) else {"value": t}
    return {
        "kind": "dielectric",
        "refractive_index": 1.0,
        "internal_transmittance": {"thickness_mm": thickness_mm, **value},
    }


def test_nine_tenths_per_mm_over_3_mm_is_read_from_the_exr_as_0_729(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(SLAB)
    image = ll.render(ll.load_scene(tmp_path / "scene.toml", overrides={"image.filter": "box"}))
    write_exr(tmp_path / "picture.exr", image, develop(image))
    xyz = read_exr(tmp_path / "picture.exr").xyz
    through, beside = xyz[:, :2], xyz[:, 2:]
    np.testing.assert_allclose(beside[..., 1], 100.0, rtol=1e-6)
    np.testing.assert_allclose(through[..., 1], 72.9, rtol=1e-6)
    np.testing.assert_allclose(through, 0.729 * beside, rtol=1e-6)


def test_each_band_has_its_own_transmittance(scene_of: Callable[..., Any]) -> None:
    table_nm, table = [370.0, 500.0, 560.0, 650.0, 790.0], [0.02, 0.6, 0.05, 0.99, 0.8]
    lens = tinted({"wavelengths_nm": table_nm, "values": table, "interpolation": "linear"}, 2.0)
    slab = {"name": "slab", "kind": "box", "min_mm": [-50, -50, 0], "max_mm": [50, 50, 5]}
    scene = scene_of(
        image={"samples": 25, "width": 2, "height": 1},
        materials={"lens": lens},
        objects=[slab | {"material": "lens"}],
    )
    bands = ll.render(scene, spectral_bands=True).spectral_radiance
    nm = 380.5 + np.arange(400.0)
    through = np.interp(nm, table_nm, table) ** (5.0 / 2.0)
    luminous = colour_matching(nm)[:, 1]
    of_100_cd_m2 = 100.0 / (683.0 * luminous.sum())
    expected = of_100_cd_m2 * through.reshape(80, 5).mean(axis=1)
    np.testing.assert_allclose(bands, np.broadcast_to(expected, bands.shape), rtol=1e-9)


@pytest.mark.parametrize("thickness", [1e-6, 1e-3, 0.1, 2.5, 40.0, 1e3, 3e5])
def test_any_thickness_dims_by_t_to_its_power(
    lane_scene: Callable[[], Any], thickness: float
) -> None:
    scene, t = lane_scene(), np.linspace(1e-3, 0.999, 16)
    scene.surround(2.0)
    scene.body("box", [-1, -1, 0, 1, 1, thickness], scene.glass(1.0, -np.log(t)))
    scene.look((0.2, 0.3, thickness + 50), (0.2, 0.3, 0))
    expected = 2.0 * np.exp(np.log(t) * thickness)
    np.testing.assert_allclose(scene.radiance(), expected, rtol=1e-6, atol=1e-300)


@pytest.mark.parametrize("degrees", [0.0, 17.0, 45.0, 60.0, 85.0])
def test_a_slanted_path_is_as_long_as_it_is(lane_scene: Callable[[], Any], degrees: float) -> None:
    scene, angle = lane_scene(), np.radians(degrees)
    alpha = np.linspace(0.0, 1.2, 16)
    scene.surround()
    scene.body("box", [-1e4, -1e4, 0, 1e4, 1e4, 3], scene.glass(1.0, alpha))
    scene.look((500 * np.sin(angle), 0, 500 * np.cos(angle)), (0, 0, 0))
    np.testing.assert_allclose(scene.radiance(), np.exp(-alpha * 3 / np.cos(angle)), rtol=1e-6)


def sphere_chord(o: Array, d: Array) -> Array:
    nearest = o - (o @ d)[:, None] * d
    return 2 * np.sqrt(np.maximum(25.0 - (nearest**2).sum(axis=1), 0.0))


def clipped(intervals: list[tuple[Array, Array]]) -> Array:
    enter = np.max([np.minimum(a, b) for a, b in intervals], axis=0)
    leave = np.min([np.maximum(a, b) for a, b in intervals], axis=0)
    return np.maximum(leave - enter, 0.0)


def box_chord(o: Array, d: Array) -> Array:
    low, high = np.array([-5.0, -3.0, -2.0]), np.array([4.0, 3.0, 6.0])
    return clipped([((low - o)[:, i] / d[i], (high - o)[:, i] / d[i]) for i in range(3)])


def pyramid_chord(o: Array, d: Array) -> Array:
    # x, y, z ≥ −2 and x + y + z ≤ 6
    half_spaces = [(-np.eye(3)[i], 2.0) for i in range(3)] + [(np.ones(3), 6.0)]
    far = np.full(len(o), 1e9)
    pieces = []
    for normal, offset in half_spaces:
        t = (offset - o @ normal) / (d @ normal)
        pieces.append((t, far) if d @ normal < 0 else (-far, t))
    return clipped(pieces)


def quadratic(a: float, half_b: Array, c: Array) -> tuple[Array, Array]:
    root = np.sqrt(np.maximum(half_b**2 - a * c, 0.0))
    return (-half_b - root) / a, (-half_b + root) / a


def cylinder_chord(o: Array, d: Array) -> Array:
    side = quadratic(
        d[0] ** 2 + d[1] ** 2, o[:, 0] * d[0] + o[:, 1] * d[1], o[:, 0] ** 2 + o[:, 1] ** 2 - 9.0
    )
    return clipped([side, ((-4.0 - o[:, 2]) / d[2], (3.0 - o[:, 2]) / d[2])])


def cone_chord(o: Array, d: Array) -> Array:
    # Base of radius 4 at z = −4, tip at z = 4: x² + y² = (4 − z)²/4
    h = 4.0 - o[:, 2]
    a = d[0] ** 2 + d[1] ** 2 - d[2] ** 2 / 4
    half_b = o[:, 0] * d[0] + o[:, 1] * d[1] + h * d[2] / 4
    low, high = quadratic(a, half_b, o[:, 0] ** 2 + o[:, 1] ** 2 - h**2 / 4)
    # Both crossings lie on the lower nappe for every ray flatter than the mantle.
    return clipped([(low, high), ((-4.0 - o[:, 2]) / d[2], (4.0 - o[:, 2]) / d[2])])


BODIES = {
    "sphere": ([0, 0, 0, 5], sphere_chord),
    "box": ([-5, -3, -2, 4, 3, 6], box_chord),
    "tetrahedron": ([-2, -2, -2, 10, -2, -2, -2, 10, -2, -2, -2, 10], pyramid_chord),
    "cylinder": ([0, 0, -4, 0, 0, 1, 3, 7], cylinder_chord),
    "cone": ([0, 0, -4, 0, 0, 1, 4, 8], cone_chord),
}


@pytest.mark.parametrize("kind", BODIES)
def test_the_path_through_a_body_is_its_chord_at_every_pixel(
    lane_scene: Callable[[], Any], kind: str
) -> None:
    numbers, chord = BODIES[kind]
    scene, alpha = lane_scene(), np.linspace(0.02, 0.4, 16)
    scene.surround(3.0)
    scene.body(kind, numbers, scene.glass(1.0, alpha))
    eye, side = np.array([80.0, 45.0, 30.0]), 24
    scene.look(eye, (0, 0, 0), height_mm=16.0)
    forward = -eye / np.linalg.norm(eye)
    right = np.cross(forward, [0, 1, 0]) / np.linalg.norm(np.cross(forward, [0, 1, 0]))
    offsets = ((np.arange(side) + 0.5) / side - 0.5) * 16.0
    x, y = (axis.ravel()[:, None] for axis in np.meshgrid(offsets, -offsets))
    b = chord(eye + x * right + y * np.cross(right, forward), forward).reshape(side, side)
    assert 0.15 < (b > 0).mean() < 0.95
    got = scene.radiance(side, side)
    np.testing.assert_allclose(got, 3.0 * np.exp(-alpha * b[..., None]), rtol=1e-6)


def test_the_way_to_a_mirror_and_back_counts_twice(lane_scene: Callable[[], Any]) -> None:
    scene, alpha = lane_scene(), np.linspace(0.1, 0.5, 16)
    scene.surround()
    scene.body("box", [-9, -9, 0, 9, 9, 4], scene.glass(1.0, alpha))
    scene.body("disc", [0, 0, 1, 0, 0, 1, 8], scene.mirror(0.8))
    angle = np.radians(30)
    scene.look((100 * np.sin(angle), 0, 1 + 100 * np.cos(angle)), (0, 0, 1))
    expected = 0.8 * np.exp(-alpha * 2 * 3 / np.cos(angle))
    np.testing.assert_allclose(scene.radiance(), expected, rtol=1e-6)


@pytest.mark.parametrize(("unit", "size"), [("mm", 3.0), ("cm", 0.3), ("m", 0.003)])
def test_the_unit_of_a_mesh_changes_nothing(
    scene_of: Callable[..., Any],
    box_mesh: Callable[..., Any],
    write_ply: Callable[..., str],
    unit: str,
    size: float,
) -> None:
    file = write_ply("slab.ply", *box_mesh(np.full(3, -size / 2), np.full(3, size / 2)))
    slab = {"name": "slab", "kind": "mesh", "file": file, "unit": unit, "material": "lens"}
    scene = scene_of(
        camera={"height_mm": 2.0}
        | {"kind": "orthographic", "position_mm": [0, 0, 9], "target_mm": [0, 0, 0]},
        image={"samples": 25, "width": 3, "height": 3},
        materials={"lens": tinted()},
        objects=[slab],
    )
    np.testing.assert_allclose(ll.render(scene).luminance_cd_m2, 72.9, rtol=1e-6)


def test_a_world_a_thousand_times_larger_looks_the_same(scene_of: Callable[..., Any]) -> None:
    def picture(scale: float) -> Array:
        ball = {"name": "ball", "kind": "sphere", "centre_mm": [1, 2, 3], "radius_mm": 8}
        scene = scene_of(
            camera={
                "kind": "pinhole",
                "position_mm": [0, 0, 40 * scale],
                "target_mm": [0, 0, 0],
                "field_of_view_deg": 30.0,
            },
            materials={"lens": tinted(0.9, scale) | {"refractive_index": 1.49}},
            objects=[ball | {"material": "lens", "transform": {"scale": scale}}],
        )
        return ll.render(scene).xyz

    np.testing.assert_allclose(picture(1000.0), picture(1.0), rtol=1e-6)
    np.testing.assert_allclose(picture(0.001), picture(1.0), rtol=1e-6)

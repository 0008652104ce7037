# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Eqs. (3) and (4), at every pixel, against their evaluation in a few lines of NumPy.

transmission  I = k_st · I_l(λ) · F_st(λ) · t(λ)^b · (L·N)^n + k_sa · I_a(λ) · F_sa(λ)
reflection    I = k_sr · I_l(λ) · F_sr(λ) · (L·N)^n + k_sa · I_a(λ) · F_sa(λ)

The scenes are files as a user writes them. A working range of 16 nm has one wavelength per lane, so
that a single sample, in the middle of its pixel, carries all of them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import colour
import numpy as np
import pytest
from numpy.typing import NDArray

import lamplit as ll

Array = NDArray[np.float64]

LOW, HIGH = 596.0, 612.0
NM = LOW + 0.5 + np.arange(16.0)
EYE = np.array([30.0, 50.0, 90.0])
WIDTH, HEIGHT, SPAN = 12, 9, 18.0

CMF = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]


def ramp(low: float, high: float) -> dict[str, Any]:
    return {
        "wavelengths_nm": [300.0, LOW, HIGH, 900.0],
        "values": [low, low, high, high],
        "interpolation": "linear",
    }


def value(spec: dict[str, Any], nm: Array = NM) -> Array:
    return np.interp(nm, spec["wavelengths_nm"], spec["values"])


def observer(nm: Array = NM) -> Array:
    return np.stack([np.interp(nm, CMF.wavelengths, column) for column in CMF.values.T], 1)


def strength(spec: dict[str, Any], luminance: float) -> Array:
    shape = value(spec)
    return shape * luminance / (683.0 * (shape @ observer()[:, 1]))


LAMP, SKY, HAZE = ramp(0.2, 1.0), ramp(1.0, 0.4), ramp(0.7, 0.9)
F_SR, F_ST, F_SA = ramp(0.1, 0.5), ramp(0.9, 0.3), ramp(0.6, 0.2)
T_PER_MM = ramp(0.99, 0.8)
TERMS = {
    "k_sr": 0.7,
    "k_st": 0.8,
    "k_sa": 0.9,
    "specular_reflectance": F_SR,
    "specular_transmittance": F_ST,
    "ambient_reflectance": F_SA,
}

I_L, I_A, I_B = strength(LAMP, 900.0), strength(HAZE, 150.0), strength(SKY, 200.0)

POSITION = np.array([40.0, 60.0, 30.0])
TRAVELS = np.array([-1.0, -2.0, -0.5])
LIGHTS = {
    "point": {"kind": "point", "position_mm": POSITION.tolist()},
    "directional": {"kind": "directional", "direction": TRAVELS.tolist()},
    "sphere": {"kind": "sphere", "centre_mm": POSITION.tolist(), "radius_mm": 1e-7},
}


def towards_light(kind: str, points: Array) -> Array:
    way = np.broadcast_to(-TRAVELS, points.shape) if kind == "directional" else POSITION - points
    return way / np.linalg.norm(way, axis=1, keepdims=True)


def rays() -> tuple[Array, Array]:
    forward = -EYE / np.linalg.norm(EYE)
    right = np.cross(forward, [0, 1, 0]) / np.linalg.norm(np.cross(forward, [0, 1, 0]))
    x = ((np.arange(WIDTH) + 0.5) - WIDTH / 2) * SPAN / HEIGHT
    y = (HEIGHT / 2 - (np.arange(HEIGHT) + 0.5)) * SPAN / HEIGHT
    x, y = (axis.ravel()[:, None] for axis in np.meshgrid(x, y))
    return EYE + x * right + y * np.cross(right, forward), forward


def meet_sphere(o: Array, d: Array) -> tuple[Array, Array, Array, Array]:
    along, nearest = -(o @ d), o - (o @ d)[:, None] * d
    half = np.sqrt(np.maximum(64.0 - (nearest**2).sum(axis=1), 0.0))
    return (
        along - half,
        along + half,
        (o + (along - half)[:, None] * d) / 8,
        (o + (along + half)[:, None] * d) / 8,
    )


def meet_box(o: Array, d: Array) -> tuple[Array, Array, Array, Array]:
    low, high = np.array([-6.0, -4.0, -5.0]), np.array([5.0, 4.0, 7.0])
    near, far = np.minimum((low - o) / d, (high - o) / d), np.maximum((low - o) / d, (high - o) / d)
    enter, leave = near.max(axis=1), far.min(axis=1)
    return (
        enter,
        leave,
        -np.sign(d) * np.eye(3)[near.argmax(1)],
        np.sign(d) * np.eye(3)[far.argmin(1)],
    )


def meet_plane(o: Array, d: Array) -> tuple[Array, Array, Array, Array]:
    normal = np.array([0.0, 0.6, 0.8])
    t = (1.0 - o @ normal) / (d @ normal)
    normals = np.broadcast_to(normal, o.shape)
    return t, t + 1.0, normals, normals


SHAPES = {
    "sphere": ({"centre_mm": [0, 0, 0], "radius_mm": 8}, meet_sphere),
    "box": ({"min_mm": [-6, -4, -5], "max_mm": [5, 4, 7]}, meet_box),
    "plane": ({"point_mm": [0, 0.6, 0.8], "normal": [0, 0.6, 0.8]}, meet_plane),
}


def dot(a: Array, b: Array) -> Array:
    return np.maximum((a * b).sum(axis=1), 0.0)[:, None]


def picture_of(
    scene_of: Callable[..., Any], shape: str, light: str, material: Any, **more: Any
) -> Any:
    tables: dict[str, Any] = {
        "camera": {
            "kind": "orthographic",
            "position_mm": EYE.tolist(),
            "target_mm": [0, 0, 0],
            "height_mm": SPAN,
        },
        "image": {"width": WIDTH, "height": HEIGHT, "wavelength_range_nm": [LOW, HIGH]},
        "hall": {"max_depth": 1, "shadows": False},
        "background": {"kind": "constant", "source": SKY, "luminance_cd_m2": 200.0},
        "ambient": {"source": HAZE, "luminance_cd_m2": 150.0},
        "lights": [LIGHTS[light] | {"source": LAMP, "luminance_cd_m2": 900.0}],
        "materials": {"stuff": material},
        "objects": [{"name": "it", "kind": shape, "material": "stuff"} | SHAPES[shape][0]],
    }
    return scene_of(**(tables | more))


def check(image: Any, expected: Array) -> None:
    """Compare every pixel's 16 wavelengths, and its X, Y and Z."""
    np.testing.assert_allclose(image.band_centres_nm, NM)
    lanes = image.spectral_radiance.reshape(-1, 16)
    np.testing.assert_allclose(lanes, expected, rtol=1e-6)
    xyz = 683.0 * expected @ observer()
    np.testing.assert_allclose(image.xyz.reshape(-1, 3), xyz, rtol=1e-6)


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("kind", ["diffuse", "mirror"])
def test_reflection_at_an_opaque_surface_is_equation_4(
    scene_of: Callable[..., Any], kind: str, shape: str, light: str
) -> None:
    exponent = 3.5
    material = {"kind": kind, "reflectance": 0.25, "hall": TERMS | {"highlight_exponent": exponent}}
    image = ll.render(picture_of(scene_of, shape, light, material), spectral_bands=True)

    o, d = rays()
    t, leave, n, _ = SHAPES[shape][1](o, d)
    towards = towards_light(light, o + t[:, None] * d)
    seen = 0.7 * I_L * value(F_SR) * dot(towards, n) ** exponent + 0.9 * I_A * value(F_SA)
    if kind == "mirror":
        seen = seen + 0.7 * value(F_SR) * I_B
    hits = (t < leave)[:, None]
    assert hits.mean() > 0.3
    assert (dot(towards, n)[hits[:, 0]] > 0).mean() > 0.1
    check(image, np.where(hits, seen, I_B))


@pytest.mark.parametrize("kind", ["diffuse", "mirror"])
def test_what_a_material_does_not_say_of_halls_terms_follows_from_it(
    scene_of: Callable[..., Any], kind: str
) -> None:
    own = ramp(0.3, 0.8)
    image = ll.render(
        picture_of(scene_of, "sphere", "point", {"kind": kind, "reflectance": own}),
        spectral_bands=True,
    )
    o, d = rays()
    t, leave, n, _ = meet_sphere(o, d)
    cosine = dot(towards_light("point", o + t[:, None] * d), n)
    matt = value(own) * (I_L * cosine + I_A)
    mirror = value(own) * (I_L * cosine**60 + I_B)
    seen = matt if kind == "diffuse" else mirror
    check(image, np.where((t < leave)[:, None], seen, I_B))


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("shape", ["sphere", "box"])
def test_a_transparent_body_is_equation_4_in_front_and_equation_3_behind(
    scene_of: Callable[..., Any], shape: str, light: str
) -> None:
    exponent = 2.5
    glass = {
        "kind": "dielectric",
        "refractive_index": 1.0,
        "internal_transmittance": {"thickness_mm": 1.0} | T_PER_MM,
        "hall": TERMS | {"highlight_exponent": exponent},
    }
    behind = {"kind": "point", "position_mm": (-POSITION).tolist()}
    both = [one | {"source": LAMP, "luminance_cd_m2": 900.0} for one in (LIGHTS[light], behind)]
    scene = picture_of(scene_of, shape, light, glass, lights=both)
    image = ll.render(scene, spectral_bands=True)

    o, d = rays()
    enter, leave, n_in, n_out = SHAPES[shape][1](o, d)
    first, last = o + enter[:, None] * d, o + leave[:, None] * d

    def highlight(point: Array, normal: Array) -> Array:
        other = -POSITION - point
        other /= np.linalg.norm(other, axis=1, keepdims=True)
        ways = (towards_light(light, point), other)
        return sum(I_L * dot(way, normal) ** exponent for way in ways)

    ambient = 0.9 * I_A * value(F_SA)
    equation_4 = 0.7 * value(F_SR) * highlight(first, n_in) + ambient
    through = value(T_PER_MM) ** np.maximum(leave - enter, 0.0)[:, None]
    equation_3 = 0.8 * value(F_ST) * highlight(last, n_out) * through + ambient * through
    inner = 0.7 * value(F_SR) * highlight(last, -n_out) * through
    seen = equation_4 + 0.7 * value(F_SR) * I_B + 0.8 * value(F_ST) * (equation_3 + inner)
    hits = (enter < leave)[:, None]
    check(image, np.where(hits, seen, I_B))


def test_seen_from_inside_a_body_is_equation_3_with_the_distance_from_the_eye(
    lane_scene: Callable[[], Any],
) -> None:
    exponent, k_st, k_sa = 3.0, 0.8, 0.6
    f_st, f_sa, alpha = (
        np.linspace(0.2, 0.9, 16),
        np.linspace(0.5, 0.1, 16),
        np.linspace(0, 0.2, 16),
    )
    scene = lane_scene()
    scene.surround(0.0)
    scene.builder.set_ambient(scene.spectrum(0.3))
    scene.builder.add_point_light(scene.spectrum(7.0), (30.0, 40.0, -90.0))
    glass = scene.glass(
        1.3,
        alpha,
        k_sr=0.0,
        k_st=k_st,
        k_sa=k_sa,
        highlight_exponent=exponent,
        f_sr=0.3,
        f_st=f_st,
        f_sa=f_sa,
    )
    scene.body("sphere", [0, 0, 0, 10], glass)
    scene.look((1, 2, 3), (1, 2, -10), field_of_view_deg=70.0)
    got = scene.radiance(12, 10, max_depth=0)

    half = np.tan(np.radians(35))
    x = ((np.arange(12) + 0.5) - 6) / 5 * half
    y = (5 - (np.arange(10) + 0.5)) / 5 * half
    d = np.stack([*np.meshgrid(x, y), np.full((10, 12), -1.0)], axis=-1)
    d /= np.linalg.norm(d, axis=-1, keepdims=True)
    o = np.array([1.0, 2.0, 3.0])
    b = -(d @ o) + np.sqrt((d @ o) ** 2 + 100.0 - o @ o)
    point = o + b[..., None] * d
    way = np.array([30.0, 40.0, -90.0]) - point
    cosine = (way * point).sum(-1) / 10 / np.linalg.norm(way, axis=-1)
    lit = 7.0 * k_st * f_st * np.maximum(cosine, 0.0)[..., None] ** exponent
    expected = (lit + k_sa * 0.3 * f_sa) * np.exp(-alpha * b[..., None])
    assert (cosine > 0).any()
    np.testing.assert_allclose(got, expected, rtol=1e-6)


def test_a_sphere_light_averages_over_its_surface(lane_scene: Callable[[], Any]) -> None:
    scene, radius, centre = lane_scene(), 6.0, np.array([3.0, 10.0, 4.0])
    scene.builder.add_sphere_light(scene.spectrum(1.0), tuple(centre), radius)
    scene.body("plane", [0, 0, 0, 0, 1, 0], scene.matt(1.0, highlight_exponent=2.0))
    scene.look((0, 50, 0), (0, 0, 0), up=(0, 0, 1))
    got = scene.radiance(samples=4096, sampling="sobol")[0]
    z, w = np.polynomial.legendre.leggauss(64)
    azimuth = 2 * np.pi * (np.arange(128) + 0.5) / 128
    across = np.sqrt(1 - z**2)[:, None]
    points = centre + radius * np.stack(
        [
            across * np.cos(azimuth),
            np.broadcast_to(z[:, None], (64, 128)),
            across * np.sin(azimuth),
        ],
        -1,
    )
    cosine = points[..., 1] / np.linalg.norm(points, axis=-1)
    expected = (np.maximum(cosine, 0.0) ** 2).mean(axis=1) @ w / 2
    spread = np.sqrt((np.maximum(cosine, 0.0) ** 4).mean(axis=1) @ w / 2 - expected**2)
    assert spread > 0.05
    assert abs(got - expected) < 3 * spread / np.sqrt(4096)


@pytest.mark.parametrize("height", [40.0, 5.0, -5.0])
def test_interpolated_normals_shade_but_no_light_comes_through_the_true_surface(
    lane_scene: Callable[[], Any], height: float
) -> None:
    scene = lane_scene()
    corners = [[-90, -90, 0], [90, -90, 0], [90, 90, 0], [-90, 90, 0]]
    tilted = np.array([0.5, 0.0, np.sqrt(0.75)])
    matt = scene.matt(0.8, highlight_exponent=2.0)
    scene.mesh(corners, [[0, 1, 2], [0, 2, 3]], matt, normals=np.tile(tilted, (4, 1)))
    scene.builder.add_point_light(scene.spectrum(1.0), (50.0, 0.0, height))
    scene.look((0, 0, 50), (0, 0, 0))
    way = np.array([50.0, 0.0, height]) / np.hypot(50.0, height)
    expected = 0.8 * (way @ tilted) ** 2 if height > 0 else 0.0
    assert way @ tilted > 0
    np.testing.assert_allclose(scene.radiance(), expected, rtol=1e-6)

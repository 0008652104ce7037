# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The RGB half of a comparison: eqs. (2) to (4) with three numbers, against NumPy.

The numbers of a light are its tristimulus values in linear sRGB, those of a reflectance what the
scene's white becomes by it over the white itself, those of an absorption that of 1 mm.
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

NM = 380.5 + np.arange(400.0)
CMF = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
OBSERVER = np.stack([np.interp(NM, CMF.wavelengths, column) for column in CMF.values.T], 1)

#: Linear sRGB from XYZ: the columns of the inverse are the primaries, scaled to sum to the white.
PRIMARIES = np.array([[0.64, 0.30, 0.15], [0.33, 0.60, 0.06], [0.03, 0.10, 0.79]])
WHITE_POINT = np.array([0.3127, 0.3290, 0.3583]) / 0.3290
TO_XYZ = PRIMARIES * np.linalg.solve(PRIMARIES, WHITE_POINT)
TO_RGB = np.linalg.inv(TO_XYZ)

WHITE = {
    "wavelengths_nm": [380, 500, 600, 780],
    "values": [0.6, 1.0, 0.9, 0.7],
    "interpolation": "linear",
}
LAMP = {
    "wavelengths_nm": [380, 500, 620, 780],
    "values": [0.3, 0.7, 0.9, 1.0],
    "interpolation": "linear",
}
PAINT = {
    "wavelengths_nm": [380, 480, 560, 780],
    "values": [0.3, 0.2, 0.6, 0.5],
    "interpolation": "linear",
}
LENS = {
    "wavelengths_nm": [380, 550, 620, 780],
    "values": [0.7, 0.6, 0.9, 0.95],
    "interpolation": "linear",
}


def value(spec: dict[str, Any]) -> Array:
    return np.interp(NM, spec["wavelengths_nm"], spec["values"])


def light_rgb(spec: dict[str, Any], luminance: float) -> Array:
    xyz = value(spec) @ OBSERVER
    return TO_RGB @ (xyz * luminance / xyz[1])


def matter_rgb(values: Array) -> Array:
    white = value(WHITE)
    return (TO_RGB @ ((white * values) @ OBSERVER)) / (TO_RGB @ (white @ OBSERVER))


def test_a_matt_sphere_in_rgb_is_equation_4_with_three_numbers(
    scene_of: Callable[..., Any],
) -> None:
    light = {
        "kind": "directional",
        "direction": [-1, -2, -3],
        "source": LAMP,
        "luminance_cd_m2": 500.0,
    }
    ball = {"name": "ball", "kind": "sphere", "centre_mm": [0, 0, 0], "radius_mm": 8}
    scene = scene_of(
        display={"white": WHITE},
        ambient={"source": LAMP, "luminance_cd_m2": 60.0},
        lights=[light],
        materials={
            "paint": {
                "kind": "diffuse",
                "reflectance": PAINT,
                "hall": {"k_sr": 0.8, "k_sa": 0.5, "highlight_exponent": 2.0},
            }
        },
        background={"kind": "constant", "source": LAMP, "luminance_cd_m2": 30.0},
        objects=[ball | {"material": "paint"}],
    )
    got = ll.render(scene, colour="rgb").xyz
    offsets = ((np.arange(8) + 0.5) / 8 - 0.5) * 20
    x, y = np.meshgrid(offsets, -offsets)
    hits = x**2 + y**2 < 64
    normal = np.stack([x, y, np.sqrt(np.where(hits, 64 - x**2 - y**2, 0.0))], -1) / 8
    cosine = np.maximum(normal @ np.array([1, 2, 3]) / np.sqrt(14), 0.0)[..., None]
    paint = matter_rgb(value(PAINT))
    assert (paint > 0).all()
    assert (paint < 1).all()
    rgb = paint * (0.8 * light_rgb(LAMP, 500.0) * cosine**2 + 0.5 * light_rgb(LAMP, 60.0))
    expected = np.where(hits[..., None], rgb, light_rgb(LAMP, 30.0)) @ TO_XYZ.T
    np.testing.assert_allclose(got, expected, rtol=1e-6)


@pytest.mark.parametrize("thickness", [0.5, 1.0, 7.0])
def test_a_slab_in_rgb_dims_by_the_power_of_its_rgb_at_1_mm(
    scene_of: Callable[..., Any], thickness: float
) -> None:
    slab = {"name": "slab", "kind": "box", "min_mm": [-50, -50, 0], "max_mm": [50, 50, thickness]}
    scene = scene_of(
        display={"white": WHITE},
        materials={
            "lens": {
                "kind": "dielectric",
                "refractive_index": 1.0,
                "internal_transmittance": {"thickness_mm": 2.0} | LENS,
            }
        },
        background={"kind": "constant", "source": LAMP, "luminance_cd_m2": 30.0},
        objects=[slab | {"material": "lens"}],
    )
    got = ll.render(scene, colour="rgb").xyz
    t = matter_rgb(np.sqrt(value(LENS)))
    expected = TO_XYZ @ (light_rgb(LAMP, 30.0) * t**thickness)
    np.testing.assert_allclose(got, np.broadcast_to(expected, got.shape), rtol=1e-6)


def test_both_halves_of_a_comparison_agree_where_one_reflection_of_white_is_all(
    scene_of: Callable[..., Any],
) -> None:
    floor = {"name": "floor", "kind": "plane", "point_mm": [0, 0, 0], "normal": [0, 0, 1]}
    scene = scene_of(
        image={"samples": 25},
        display={"white": WHITE},
        lights=[
            {
                "kind": "directional",
                "direction": [0, 0, -1],
                "source": WHITE,
                "luminance_cd_m2": 400.0,
            }
        ],
        materials={"paint": {"kind": "diffuse", "reflectance": PAINT}},
        objects=[floor | {"material": "paint"}],
    )
    both = ll.compare(scene)
    np.testing.assert_allclose(both.rgb.xyz, both.spectral.xyz, rtol=1e-9)

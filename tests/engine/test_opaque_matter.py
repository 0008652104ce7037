# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Metals, gloss over a matt base, and checkers, against complex Fresnel equations in NumPy."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

Array = NDArray[np.float64]
Maker = Callable[[], Any]

N, K = np.linspace(0.1, 1.8, 16), np.linspace(7.0, 2.0, 16)


def fresnel(angle: float, here: Any, there: Any) -> Array:
    """Return the unpolarised |r|² from the index ``here`` to the complex index ``there``."""
    cos_i = np.cos(angle)
    cos_t = np.sqrt(1 - (here * np.sin(angle) / there) ** 2 + 0j)
    s = (here * cos_i - there * cos_t) / (here * cos_i + there * cos_t)
    p = (there * cos_i - here * cos_t) / (there * cos_i + here * cos_t)
    return (np.abs(s) ** 2 + np.abs(p) ** 2) / 2


@pytest.mark.parametrize("degrees", [0.0, 40.0, 75.0, 88.0])
def test_a_metal_reflects_by_its_complex_index_times_its_factor(
    lane_scene: Maker, degrees: float
) -> None:
    scene, angle = lane_scene(), np.radians(degrees)
    scene.surround(3.0)
    scene.metal(N, K, 0.85)
    scene.body("plane", [0, 0, 0, 0, 0, 1], 0)
    scene.look((90 * np.sin(angle), 0, 90 * np.cos(angle)), (0, 0, 0))
    expected = 3.0 * 0.85 * fresnel(angle, 1.0, N + 1j * K)
    np.testing.assert_allclose(scene.radiance(), expected, rtol=1e-9)


def test_a_metal_under_glass_reflects_by_its_index_relative_to_the_glass(
    lane_scene: Maker,
) -> None:
    scene, n, angle = lane_scene(), 1.6, np.radians(30.0)
    scene.surround()
    scene.metal(N, K)
    scene.body("box", [-90, -90, -5, 90, 90, 5], scene.glass(n, f_sr=0.0, f_st=1.0))
    scene.body("disc", [0, 0, 0, 0, 0, 1, 80], 0)
    scene.look((90 * np.sin(angle), 0, 90 * np.cos(angle)), (0, 0, 0))
    inner = np.arcsin(np.sin(angle) / n)
    np.testing.assert_allclose(scene.radiance(), fresnel(inner, n, N + 1j * K), rtol=1e-6)


def test_gloss_takes_its_share_and_leaves_the_rest_to_the_base(lane_scene: Maker) -> None:
    scene, angle = lane_scene(), np.radians(50.0)
    n, base = np.linspace(1.3, 1.7, 16), np.linspace(0.02, 0.6, 16)
    scene.surround(2.0)
    scene.builder.set_ambient(scene.spectrum(0.5))
    scene.builder.add_directional_light(scene.spectrum(7.0), (0.0, -0.6, -0.8))
    scene.glossy(n, base, k_sr=0.9, k_sa=0.7, highlight_exponent=5.0)
    scene.body("plane", [0, 0, 0, 0, 0, 1], 0)
    scene.look((90 * np.sin(angle), 0, 90 * np.cos(angle)), (0, 0, 0))
    f = fresnel(angle, 1.0, n)
    highlight = 0.9 * 7.0 * (f * 0.8**5 + (1 - f) * base * 0.8)
    expected = highlight + 0.7 * 0.5 * (1 - f) * base + 0.9 * f * 2.0
    np.testing.assert_allclose(scene.radiance(), expected, rtol=1e-9)


def test_a_checker_changes_reflectance_from_square_to_square(lane_scene: Maker) -> None:
    scene, first, second = lane_scene(), np.linspace(0.1, 0.2, 16), np.linspace(0.9, 0.6, 16)
    scene.builder.set_ambient(scene.spectrum(1.0))
    scene.checker(first, second, 3.0)
    scene.body("plane", [0, 0, 0, 0, 1, 0], 0)
    scene.look((0, 90, 0), (0, 0, 0), up=(0, 0, -1), height_mm=20.0)
    got = scene.radiance(10, 10)
    places = np.arange(10) * 2.0 - 9.0
    x, z = np.meshgrid(places, places)
    is_first = (np.floor(x / 3) + np.floor(z / 3)) % 2 == 0
    assert 0.4 < is_first.mean() < 0.6
    np.testing.assert_allclose(got, np.where(is_first[..., None], first, second), rtol=1e-12)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Glare on a picture: nothing is lost, nothing is gained, and it lies where the formula says."""

from __future__ import annotations

import math
import tracemalloc

import numpy as np
import pytest

from lamplit.colour.eye import Eye
from lamplit.colour.glare import field_deg2, spread_weights, with_glare

EYE = Eye(35.0, 4.0, 0.5)


def whole(quadrant: np.ndarray) -> float:
    """Return the sum over the four quadrants about the first pixel."""
    counts = np.full(quadrant.shape, 4.0)
    counts[0], counts[:, 0], counts[0, 0] = 2.0, 2.0, 1.0
    return float((counts * quadrant).sum())


def pixel_by_quadrature(eye: Eye, row: int, column: int, pitch: float) -> float:
    """Return the light into one pixel by the midpoint rule on 800 by 800 places."""
    places = (np.arange(800) + 0.5) / 800 - 0.5
    y, x = np.meshgrid(pitch * (row + places), pitch * (column + places), indexing="ij")
    square = x * x + y * y
    spread = eye.spread_per_sr(np.degrees(np.arctan(np.sqrt(square))))
    return float((spread / (1.0 + square) ** 1.5).mean() * pitch**2)


@pytest.mark.parametrize("pitch", [1e-4, 7e-4, 5e-3])
@pytest.mark.parametrize("place", [(0, 0), (0, 1), (2, 3), (5, 6), (9, 0), (30, 40)])
def test_weights_are_the_integral_of_the_spread_over_each_pixel(
    pitch: float, place: tuple[int, int]
) -> None:
    weights = spread_weights(EYE, 31, 41, pitch)
    expected = pixel_by_quadrature(EYE, *place, pitch)
    assert weights[place] == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize("eye", [Eye(20.0, 2.0, 0.0), EYE, Eye(80.0, 8.0, 1.2)])
def test_over_the_half_space_the_weights_add_up_to_all_light(eye: Eye) -> None:
    """1500 pixels of 0.2 on the plane reach 89.8°."""
    assert whole(spread_weights(eye, 1500, 1500, 0.2)) == pytest.approx(1.0, abs=3e-3)


def test_a_point_of_light_becomes_the_weights_about_it() -> None:
    xyz = np.zeros((20, 33, 3))
    xyz[12, 7] = (5e6, 3e6, 1e4)
    seen = with_glare(xyz, EYE, 1e-3).xyz
    weights = spread_weights(EYE, 20, 33, 1e-3)
    for row, column in ((12, 7), (0, 0), (19, 32), (12, 8), (3, 20)):
        expected = weights[abs(row - 12), abs(column - 7)]
        np.testing.assert_allclose(seen[row, column], expected * xyz[12, 7], rtol=1e-6)


def test_no_light_is_lost_but_what_is_said_to_leave_the_frame() -> None:
    rng = np.random.default_rng(2)
    xyz = np.zeros((61, 81, 3))
    xyz[28:33, 37:44] = rng.uniform(1e3, 1e6, (5, 7, 3))
    glare = with_glare(xyz, EYE, 2e-3)
    kept = glare.xyz.sum(axis=(0, 1)) / xyz.sum(axis=(0, 1))
    assert kept == pytest.approx(1.0 - glare.left_frame_share, abs=1e-2)
    assert float(glare.xyz[..., 1].sum()) == pytest.approx(
        (1.0 - glare.left_frame_share) * float(xyz[..., 1].sum()), rel=1e-12
    )
    inside = whole(spread_weights(EYE, 28, 37, 2e-3)), whole(spread_weights(EYE, 33, 44, 2e-3))
    assert inside[0] < 1.0 - glare.left_frame_share < inside[1]


def test_a_wide_field_of_one_luminance_keeps_it_in_the_middle() -> None:
    """A veil takes from each place what it brings there from the others."""
    xyz = np.full((301, 301, 3), 200.0)
    seen = with_glare(xyz, EYE, 0.05).xyz
    np.testing.assert_allclose(seen[150, 150], 200.0, rtol=5e-3)


def test_an_older_eye_sees_less_beside_a_lamp_and_loses_more_of_its_light() -> None:
    xyz = np.zeros((50, 50, 3))
    xyz[25, 25] = 1e6
    young, old = (with_glare(xyz, Eye(age, 4.0), 1e-3) for age in (20.0, 80.0))
    beside = np.hypot(*np.mgrid[-25:25, -25:25]) > 10
    assert (old.xyz[beside] > 1.5 * young.xyz[beside]).all()
    assert old.left_frame_share > 1.5 * young.left_frame_share > 0.0


def test_the_picture_itself_is_not_changed() -> None:
    xyz = np.random.default_rng(1).uniform(0.0, 1e5, (12, 9, 3))
    before = xyz.copy()
    with_glare(xyz, EYE, 1e-3)
    np.testing.assert_array_equal(xyz, before)


def test_it_takes_the_memory_that_is_reckoned_with() -> None:
    """210 bytes a pixel, in the estimate of a render."""
    xyz = np.ones((250, 400, 3))
    tracemalloc.start()
    try:
        with_glare(xyz, EYE, 1e-3)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert 0.7 * 210.0 < peak / 1e5 < 1.05 * 210.0


def test_a_black_picture_stays_black() -> None:
    glare = with_glare(np.zeros((4, 1, 3)), EYE, 1e-3)
    assert not glare.xyz.any()
    assert glare.left_frame_share == 0.0


def test_the_field_of_a_small_picture_is_width_times_height() -> None:
    """2° by 3° is 6 square degrees; and half the sphere is 2π sr = 20 626.5 square degrees."""
    pitch = math.radians(0.01)
    assert field_deg2(200, 300, pitch) == pytest.approx(6.0, rel=1e-3)
    assert field_deg2(10**6, 10**6, 1e3) == pytest.approx(20_626.48, rel=1e-5)

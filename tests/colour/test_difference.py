# SPDX-License-Identifier: Apache-2.0 OR MIT
"""CIEDE2000 against its published test data."""

from __future__ import annotations

import numpy as np
import pytest

from lamplit.colour.difference import delta_e_2000, delta_e_2000_lab, xyz_to_lab

#: L*, a*, b* of two colours and their ΔE00. Sharma, Wu, Dalal 2005, table 1.
SHARMA_TABLE_1 = np.array(
    [
        [50.0000, 2.6772, -79.7751, 50.0000, 0.0000, -82.7485, 2.0425],
        [50.0000, 3.1571, -77.2803, 50.0000, 0.0000, -82.7485, 2.8615],
        [50.0000, 2.8361, -74.0200, 50.0000, 0.0000, -82.7485, 3.4412],
        [50.0000, -1.3802, -84.2814, 50.0000, 0.0000, -82.7485, 1.0000],
        [50.0000, -1.1848, -84.8006, 50.0000, 0.0000, -82.7485, 1.0000],
        [50.0000, -0.9009, -85.5211, 50.0000, 0.0000, -82.7485, 1.0000],
        [50.0000, 0.0000, 0.0000, 50.0000, -1.0000, 2.0000, 2.3669],
        [50.0000, -1.0000, 2.0000, 50.0000, 0.0000, 0.0000, 2.3669],
        [50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0009, 7.1792],
        [50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0010, 7.1792],
        [50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0011, 7.2195],
        [50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0012, 7.2195],
        [50.0000, -0.0010, 2.4900, 50.0000, 0.0009, -2.4900, 4.8045],
        [50.0000, -0.0010, 2.4900, 50.0000, 0.0010, -2.4900, 4.8045],
        [50.0000, -0.0010, 2.4900, 50.0000, 0.0011, -2.4900, 4.7461],
        [50.0000, 2.5000, 0.0000, 50.0000, 0.0000, -2.5000, 4.3065],
        [50.0000, 2.5000, 0.0000, 73.0000, 25.0000, -18.0000, 27.1492],
        [50.0000, 2.5000, 0.0000, 61.0000, -5.0000, 29.0000, 22.8977],
        [50.0000, 2.5000, 0.0000, 56.0000, -27.0000, -3.0000, 31.9030],
        [50.0000, 2.5000, 0.0000, 58.0000, 24.0000, 15.0000, 19.4535],
        [50.0000, 2.5000, 0.0000, 50.0000, 3.1736, 0.5854, 1.0000],
        [50.0000, 2.5000, 0.0000, 50.0000, 3.2972, 0.0000, 1.0000],
        [50.0000, 2.5000, 0.0000, 50.0000, 1.8634, 0.5757, 1.0000],
        [50.0000, 2.5000, 0.0000, 50.0000, 3.2592, 0.3350, 1.0000],
        [60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644],
        [63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630],
        [61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731],
        [35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645],
        [22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373],
        [36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146],
        [90.8027, -2.0831, 1.4410, 91.1528, -1.6435, 0.0447, 1.4441],
        [90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381],
        [6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377],
        [2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082],
    ]
)
D65_XYZ = np.array([0.95047, 1.0, 1.08883])


def test_the_published_pairs_have_their_published_difference() -> None:
    first, second, printed = SHARMA_TABLE_1[:, :3], SHARMA_TABLE_1[:, 3:6], SHARMA_TABLE_1[:, 6]
    np.testing.assert_allclose(delta_e_2000_lab(first, second), printed, atol=0.5e-4, rtol=0)
    np.testing.assert_allclose(delta_e_2000_lab(second, first), printed, atol=0.5e-4, rtol=0)


def test_random_colours_differ_as_colour_science_says() -> None:
    import colour

    random = np.random.default_rng(7)
    low, high = [0.0, -120.0, -120.0], [100.0, 120.0, 120.0]
    first, second = random.uniform(low, high, (2, 40, 25, 3))
    expected = colour.difference.delta_E_CIE2000(first, second)
    np.testing.assert_allclose(delta_e_2000_lab(first, second), expected, rtol=1e-9, atol=1e-9)


def test_lab_equals_colour_science_from_black_to_white() -> None:
    import colour

    xyz = np.random.default_rng(3).uniform(0.0, 1.0, (200, 3)) ** 4
    white_xy = colour.XYZ_to_xy(D65_XYZ)
    expected = colour.XYZ_to_Lab(xyz, white_xy)
    np.testing.assert_allclose(xyz_to_lab(xyz, white_xyz=D65_XYZ), expected, atol=1e-9)


def test_a_picture_differs_from_itself_by_nothing() -> None:
    xyz = np.random.default_rng(5).uniform(0.0, 1.0, (6, 4, 3))
    assert delta_e_2000(xyz, xyz, white_xyz=D65_XYZ).shape == (6, 4)
    assert delta_e_2000(xyz, xyz, white_xyz=D65_XYZ).max() == 0.0


def test_the_unit_of_xyz_does_not_matter() -> None:
    first, second = np.random.default_rng(6).uniform(0.0, 1.0, (2, 10, 3))
    relative = delta_e_2000(first, second, white_xyz=D65_XYZ)
    absolute = delta_e_2000(500 * first, 500 * second, white_xyz=500 * D65_XYZ)
    np.testing.assert_allclose(absolute, relative, rtol=1e-12)


@pytest.mark.parametrize("negative", [-0.01, -0.2])
def test_a_colour_outside_every_gamut_still_has_a_difference(negative: float) -> None:
    outside = np.array([0.3, 0.2, negative])
    assert np.isfinite(delta_e_2000(outside, [0.3, 0.2, 0.0], white_xyz=D65_XYZ))

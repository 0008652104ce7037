# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From XYZ in cd/m² to display values."""

from __future__ import annotations

import numpy as np
import pytest

from lamplit.colour.display import Display
from lamplit.colour.picture import Picture, to_picture
from lamplit.colour.tristimulus import xyz_of_xy
from lamplit.errors import LamplitError

D65 = (0.3127, 0.3290)
A = (0.44758, 0.40745)


def _picture(xyz: np.ndarray, **options: object) -> Picture:
    settings = {
        "display": Display.named("srgb"),
        "white_luminance_cd_m2": 500.0,
        "white_xy": D65,
        **options,
    }
    return to_picture(xyz, **settings)


@pytest.mark.parametrize("name", ["srgb", "display-p3", "rec2020"])
@pytest.mark.parametrize("adaptation", ["cat16", "bradford"])
def test_the_scenes_white_at_the_white_luminance_is_display_white(
    name: str, adaptation: str
) -> None:
    white = xyz_of_xy(A, 500.0)[None, None]
    picture = _picture(white, display=Display.named(name), white_xy=A, adaptation=adaptation)
    np.testing.assert_allclose(picture.encoded, 1.0, atol=1e-9)
    assert picture.gamut_share == 0.0


def test_without_adaptation_lamplight_stays_yellow() -> None:
    red, green, blue = _picture(xyz_of_xy(A, 250.0)[None, None], adaptation="none").linear[0, 0]
    assert red > green > blue > 0


@pytest.mark.parametrize("name", ["srgb", "display-p3", "rec2020"])
def test_display_values_come_back_through_xyz(name: str) -> None:
    display = Display.named(name)
    encoded = np.random.default_rng(8).uniform(0.0, 1.0, (20, 30, 3))
    xyz = 500.0 * display.decode(encoded) @ display.rgb_to_xyz.T
    picture = _picture(xyz, display=display)
    np.testing.assert_allclose(picture.encoded, encoded, atol=1e-6)
    assert picture.gamut_share == 0.0


def test_a_mid_grey_has_the_code_that_srgb_gives_it() -> None:
    """18 % of white is 117.6 of 255 by IEC 61966-2-1: 255 (1.055 0.18^(1/2.4) − 0.055)."""
    grey = xyz_of_xy(D65, 90.0)[None, None]
    np.testing.assert_allclose(255.0 * _picture(grey).encoded, 117.643, atol=1e-2)


def test_shares_count_the_deep_reds_and_the_too_bright_apart() -> None:
    deep_red, dim_grey, glare = (
        xyz_of_xy((0.70, 0.29), 20.0),
        xyz_of_xy(D65, 90.0),
        xyz_of_xy(D65, 9000.0),
    )
    picture = _picture(np.array([[deep_red, dim_grey], [glare, dim_grey]]))
    assert picture.out_of_gamut.tolist() == [[True, False], [False, False]]
    assert picture.gamut_share == 0.25
    assert picture.over_white_share == 0.25


def test_linear_rgb_is_kept_as_it_was_before_the_mapping() -> None:
    picture = _picture(xyz_of_xy((0.70, 0.29), 20.0)[None, None])
    assert picture.linear.min() < 0.0
    assert picture.encoded.min() >= 0.0


def test_clipping_cuts_each_channel_and_mapping_does_not() -> None:
    xyz = xyz_of_xy((0.70, 0.29), 20.0)[None, None]
    clipped, mapped = _picture(xyz, gamut="clip"), _picture(xyz, gamut="map")
    expected = Display.named("srgb").encode(np.clip(clipped.linear, 0.0, 1.0))
    np.testing.assert_allclose(clipped.encoded, expected)
    assert np.abs(clipped.encoded - mapped.encoded).max() > 0.01


@pytest.mark.parametrize("white", [0.0, -1.0, float("nan"), float("inf")])
def test_a_white_without_luminance_is_refused(white: float) -> None:
    with pytest.raises(LamplitError, match="display white"):
        _picture(np.ones((1, 1, 3)), white_luminance_cd_m2=white)


def test_numbers_that_are_not_finite_are_named_by_pixel() -> None:
    xyz = np.ones((2, 3, 3))
    xyz[1, 2, 0] = np.nan
    with pytest.raises(LamplitError, match=r"\[1, 2, 0\]"):
        _picture(xyz)

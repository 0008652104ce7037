# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The photographic tone curve: five decades fit the display, and no colour changes its hue."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lamplit.colour.display import Display
from lamplit.colour.gamut import rgb_to_oklab
from lamplit.colour.picture import to_picture
from lamplit.colour.tone import key_luminance, photographic, shoulder_rate, tone_curve

DECADES = np.geomspace(1e-4, 1e5, 2000)


@pytest.mark.parametrize("brightest", [1.5, 30.0, 1e5, 1e9])
def test_the_curve_rises_from_0_to_1_and_stays_there(brightest: float) -> None:
    light = np.concatenate([[0.0], np.geomspace(1e-6, brightest, 5000)])
    shown = tone_curve(light, brightest)
    assert shown[0] == 0.0
    assert (np.diff(shown) > 0.0).all()
    assert shown[-1] == pytest.approx(1.0, abs=1e-12)
    assert tone_curve([2.0 * brightest, 1e12], brightest).tolist() == [1.0, 1.0]
    assert tone_curve([-1.0], brightest).tolist() == [0.0]


def test_middle_tones_stay_as_they_are_and_the_shoulder_begins_without_a_kink() -> None:
    below = np.linspace(0.0, 0.18, 50)
    np.testing.assert_array_equal(tone_curve(below, 1e5), below)
    step = 1e-7
    after = (tone_curve(0.18 + step, 1e5) - 0.18) / step
    assert after == pytest.approx(1.0, abs=1e-4)


def test_what_fits_the_display_is_not_touched() -> None:
    light = np.linspace(0.0, 1.0, 50)
    for brightest in (0.4, 1.0):
        np.testing.assert_allclose(tone_curve(light, brightest), light, atol=1e-15)


def test_far_up_equal_ratios_become_equal_steps() -> None:
    """ln(1 + s u) with s u >> 1: a decade is 0.82 ln 10/s, whatever the decade."""
    decades = np.diff(tone_curve([1e2, 1e3, 1e4, 1e5], 1e5))
    np.testing.assert_allclose(decades, 0.82 * math.log(10.0) / shoulder_rate(1e5), rtol=2e-3)
    assert decades.min() > 0.12


def test_the_rate_solves_its_equation() -> None:
    """With s = 2, ln(1 + 2 U) = 2 has the solution U = (e² - 1)/2, M = 0.18 + 0.82 U."""
    brightest = 0.18 + 0.82 * (math.e**2 - 1.0) / 2.0
    assert shoulder_rate(brightest) == pytest.approx(2.0, rel=1e-12)
    assert tone_curve(1.0, brightest) == pytest.approx(0.18 + 0.82 * math.log(3.0) / 2.0)


def colours_by_decades() -> np.ndarray:
    """Return colours of a display, ever brighter: the largest component is that of DECADES."""
    colours = np.random.default_rng(4).uniform(0.0, 1.0, (DECADES.size, 3)) ** 2
    return colours / colours.max(axis=-1, keepdims=True) * DECADES[:, None]


@pytest.mark.parametrize("name", ["srgb", "display-p3", "rec2020"])
def test_every_colour_of_a_display_keeps_its_hue_over_five_decades(name: str) -> None:
    display = Display.named(name)
    colours = colours_by_decades()
    shown = photographic(colours, 1e5, display)
    assert shown.min() >= -1e-3
    np.testing.assert_allclose(shown.max(axis=-1), tone_curve(DECADES, 1e5), rtol=1e-9)
    before, after = (rgb_to_oklab(rgb, display)[..., 1:] for rgb in (colours, shown))
    chroma = np.hypot(*after.T)
    coloured = chroma > 1e-3
    turned = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turned = turned[coloured] / (np.hypot(*before.T) * chroma)[coloured]
    assert coloured.mean() > 0.9
    assert np.abs(np.degrees(np.arcsin(turned))).max() < 1e-3


def test_chromaticity_stays_up_to_white_and_pales_with_the_decades_above() -> None:
    display = Display.named("srgb")
    colours = colours_by_decades()
    shown = photographic(colours, 1e5, display)
    dim = DECADES <= 1.0
    expected = colours * (tone_curve(DECADES, 1e5) / DECADES)[:, None]
    np.testing.assert_allclose(shown[dim], expected[dim], atol=1e-12)
    reds = photographic(np.outer([1.0, 10.0, 1e3, 1e5, 1e6], [1.0, 0.02, 0.0]), 1e5, display)
    saturation = 1.0 - reds.min(axis=-1) / reds.max(axis=-1)
    assert (np.diff(saturation[:4]) < 0.0).all()
    assert saturation[:3] == pytest.approx([1.0, 1.0, 0.9], abs=0.1)
    np.testing.assert_allclose(reds[3:], 1.0, atol=1e-9)


def test_greys_are_the_curve_itself() -> None:
    greys = np.repeat(DECADES[:, None], 3, axis=1)
    shown = photographic(greys, 1e5, Display.named("display-p3"))
    np.testing.assert_allclose(shown, tone_curve(greys, 1e5), rtol=1e-9)


def test_a_bright_red_stays_red_where_a_linear_picture_pales_it() -> None:
    """An LED lens of 30 000 cd/m² where 500 cd/m² is white, of the red that sRGB has."""
    red = 30_000.0 * np.array([[[0.4124, 0.2126, 0.0193]]]) / 0.2126
    settings = {"display": Display.named("srgb"), "white_luminance_cd_m2": 500.0}
    linear = to_picture(red, white_xy=(0.3127, 0.3290), **settings)
    toned = to_picture(red, white_xy=(0.3127, 0.3290), brightest_luminance_cd_m2=1e6, **settings)
    assert linear.encoded[0, 0].min() > 0.9
    assert toned.encoded[0, 0, 0] > 0.8
    assert toned.encoded[0, 0, 1:].max() < 0.4
    np.testing.assert_array_equal(toned.linear, linear.linear)


def test_a_colour_outside_the_display_is_brought_in_with_its_hue() -> None:
    display = Display.named("srgb")
    deep = np.array([[[0.6, 0.25, 0.0]]]) * 900.0
    picture = to_picture(
        deep,
        display=display,
        white_luminance_cd_m2=10.0,
        white_xy=(0.3127, 0.3290),
        brightest_luminance_cd_m2=5000.0,
    )
    assert picture.linear.min() < -0.1
    before = rgb_to_oklab(picture.linear[0, 0], display)
    after = rgb_to_oklab(display.decode(picture.encoded[0, 0]), display)
    hues = [math.degrees(math.atan2(lab[2], lab[1])) for lab in (before, after)]
    assert hues[0] == pytest.approx(hues[1], abs=0.05)


def test_the_key_is_the_geometric_mean_of_what_is_not_black() -> None:
    assert key_luminance([1.0, 100.0, 0.0, -1e-9]) == pytest.approx(10.0)
    assert key_luminance([0.0, 0.0]) == 0.0
    assert key_luminance([]) == 0.0

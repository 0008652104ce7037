# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Gamut mapping: hue and lightness stay, chroma gives way, and nothing more than it must."""

from __future__ import annotations

import time

import numpy as np
import pytest

from lamplit.colour.display import Display
from lamplit.colour.gamut import map_to_gamut, outside_gamut, rgb_to_oklab
from lamplit.colour.tristimulus import chromaticity_xy, tristimulus, xyz_of_xy
from lamplit.sources import source

SRGB = Display.named("srgb")
NAMES = ("srgb", "display-p3", "rec2020")

#: UN R48 (07 series) 2.29, as in R148: the corners of the red and of the amber region.
UN_RED = {"R1": (0.645, 0.335), "R2": (0.665, 0.335), "R3": (0.735, 0.265), "R4": (0.721, 0.259)}
UN_AMBER = {"A1": (0.545, 0.425), "A2": (0.560, 0.440), "A3": (0.609, 0.390), "A4": (0.597, 0.390)}


def _brightest(display: Display, xy: tuple[float, float]) -> np.ndarray:
    """Return linear RGB of ``xy`` with its largest component 1."""
    rgb = display.xyz_to_rgb @ xyz_of_xy(xy)
    return rgb / rgb.max()


def _hue(lab: np.ndarray) -> np.ndarray:
    return np.arctan2(lab[..., 2], lab[..., 1])


@pytest.mark.parametrize("corner", [*UN_RED, *UN_AMBER])
def test_every_corner_of_un_red_and_amber_is_outside_srgb(corner: str) -> None:
    assert outside_gamut(_brightest(SRGB, {**UN_RED, **UN_AMBER}[corner]))


def test_the_red_of_a_624_nm_led_is_outside_p3_and_inside_rec2020() -> None:
    xy = chromaticity_xy(tristimulus(source("red-led-624").distribution()))
    assert outside_gamut(_brightest(Display.named("display-p3"), tuple(xy)))
    assert not outside_gamut(_brightest(Display.named("rec2020"), tuple(xy)))


def test_the_deepest_un_red_is_outside_rec2020() -> None:
    assert outside_gamut(_brightest(Display.named("rec2020"), UN_RED["R4"]))


def _wide_colours(count: int) -> np.ndarray:
    return np.random.default_rng(11).uniform(-0.4, 1.3, (count, 3))


@pytest.mark.parametrize("name", NAMES)
def test_hue_and_lightness_stay_while_chroma_gives_way(name: str) -> None:
    display = Display.named(name)
    rgb = _wide_colours(20_000)
    mapped, _ = map_to_gamut(rgb, display)
    before, after = rgb_to_oklab(rgb, display), rgb_to_oklab(mapped, display)
    displayable = (before[:, 0] > 0.02) & (before[:, 0] < 0.98)
    chroma = np.hypot(after[:, 1], after[:, 2])
    turn = np.angle(np.exp(1j * (_hue(after) - _hue(before))))
    assert displayable.sum() > 15_000
    np.testing.assert_allclose((chroma * turn)[displayable], 0.0, atol=1e-5)
    np.testing.assert_allclose(after[displayable, 0], before[displayable, 0], atol=1e-5)
    assert (chroma <= np.hypot(before[:, 1], before[:, 2]) + 1e-6)[displayable].all()


def test_no_more_chroma_is_taken_than_needed() -> None:
    rgb = _wide_colours(5_000)
    rgb = rgb[outside_gamut(rgb)]
    mapped, _ = map_to_gamut(rgb, SRGB)
    touches = np.minimum(mapped.min(axis=1), (1.0 - mapped).min(axis=1))
    assert touches.max() < 1e-6


def test_a_clip_turns_the_hue_of_a_red_led_and_the_mapping_does_not() -> None:
    xy = chromaticity_xy(tristimulus(source("red-led-624").distribution()))
    rgb = 0.6 * _brightest(SRGB, tuple(xy))
    mapped, outside = map_to_gamut(rgb, SRGB)
    hue = _hue(rgb_to_oklab(rgb, SRGB))
    assert outside
    assert abs(_hue(rgb_to_oklab(mapped, SRGB)) - hue) < 1e-5
    assert abs(_hue(rgb_to_oklab(np.clip(rgb, 0, 1), SRGB)) - hue) > 0.01


def test_colours_that_the_display_has_stay_exactly_as_they_are() -> None:
    rgb = np.random.default_rng(12).uniform(0.0, 1.0, (64, 64, 3))
    mapped, outside = map_to_gamut(rgb, SRGB)
    assert (mapped == rgb).all()
    assert not outside.any()


def test_greys_brighter_than_white_become_white_and_are_not_out_of_gamut() -> None:
    mapped, outside = map_to_gamut([[4.0, 4.0, 4.0], [1e6, 1e6, 1e6]], SRGB)
    np.testing.assert_allclose(mapped, 1.0, atol=1e-9)
    assert not outside.any()


def test_a_light_that_grows_goes_through_its_own_hue_to_white() -> None:
    red = np.array([1.0, 0.04, 0.02])
    strengths = np.geomspace(0.2, 30.0, 60)[:, None]
    mapped, outside = map_to_gamut(strengths * red, SRGB)
    assert not outside.any()
    assert (np.diff(mapped @ SRGB.rgb_to_xyz[1]) > -1e-9).all()
    np.testing.assert_allclose(mapped[-1], 1.0, atol=1e-9)


def test_black_stays_black() -> None:
    mapped, outside = map_to_gamut(np.zeros((2, 3)), SRGB)
    assert (mapped == 0).all()
    assert not outside.any()


def test_mapping_is_continuous_across_the_edge_of_the_gamut() -> None:
    inside = np.array([0.5, 0.0, 0.1])
    just_out = np.array([0.5, -1e-9, 0.1])
    np.testing.assert_allclose(
        map_to_gamut(just_out, SRGB)[0], map_to_gamut(inside, SRGB)[0], atol=1e-4
    )


def test_the_shape_of_what_comes_in_comes_out() -> None:
    mapped, outside = map_to_gamut(np.full((3, 5, 3), -0.1), SRGB)
    assert mapped.shape == (3, 5, 3)
    assert outside.shape == (3, 5)


def test_oklab_equals_colour_science() -> None:
    """To the 5e-4 by which Oklab's published matrices miss their own white."""
    import colour

    rgb = np.random.default_rng(13).uniform(0.0, 1.0, (200, 3))
    expected = colour.XYZ_to_Oklab(rgb @ SRGB.rgb_to_xyz.T)
    np.testing.assert_allclose(rgb_to_oklab(rgb, SRGB), expected, atol=5e-4)


@pytest.mark.parametrize("name", NAMES)
def test_greys_have_no_hue(name: str) -> None:
    greys = np.linspace(0.0, 1.0, 11)[:, None].repeat(3, axis=1)
    np.testing.assert_allclose(rgb_to_oklab(greys, Display.named(name))[:, 1:], 0.0, atol=1e-12)


def test_a_million_pixels_out_of_gamut_take_less_than_two_seconds() -> None:
    rgb = np.tile([1.0, -0.1, -0.05], (1000, 1000, 1)) * np.linspace(0.2, 1.5, 1000)[:, None, None]
    fastest = np.inf
    for _ in range(3):
        start = time.process_time()
        map_to_gamut(rgb, SRGB)
        fastest = min(fastest, time.process_time() - start)
    assert fastest < 2.0

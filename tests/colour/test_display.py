# SPDX-License-Identifier: Apache-2.0 OR MIT
"""RGB spaces: their matrices, their transfer functions, and what they refuse."""

from __future__ import annotations

import numpy as np
import pytest

from lamplit.colour.adaptation import adaptation_matrix
from lamplit.colour.display import Display
from lamplit.colour.tristimulus import xyz_of_xy
from lamplit.errors import LamplitError

NAMES = ("srgb", "display-p3", "rec2020")
IN_COLOUR_SCIENCE = {"srgb": "sRGB", "display-p3": "Display P3", "rec2020": "ITU-R BT.2020"}
CUSTOM = Display.from_primaries([[0.67, 0.32], [0.21, 0.71], [0.15, 0.05]], [0.3457, 0.3585], 2.2)


def test_the_srgb_matrix_is_the_printed_one() -> None:
    """IEC 61966-2-1:1999, eq. (7), printed to four digits."""
    printed = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]]
    np.testing.assert_allclose(Display.named("srgb").xyz_to_rgb, printed, atol=4e-4)


@pytest.mark.parametrize("name", NAMES)
def test_matrices_equal_those_derived_by_colour_science(name: str) -> None:
    import colour

    space = colour.RGB_COLOURSPACES[IN_COLOUR_SCIENCE[name]]
    expected = colour.normalised_primary_matrix(space.primaries, space.whitepoint)
    np.testing.assert_allclose(Display.named(name).rgb_to_xyz, expected, atol=1e-12)


@pytest.mark.parametrize(
    ("name", "rounding"), [("srgb", 3e-5), ("display-p3", 3e-5), ("rec2020", 3e-4)]
)
def test_transfer_functions_equal_colour_science(name: str, rounding: float) -> None:
    """To the rounding of the standards' constants: BT.2020's are 1.099 and 0.018 for 10 bits."""
    import colour

    space = colour.RGB_COLOURSPACES[IN_COLOUR_SCIENCE[name]]
    linear = np.linspace(0.0, 1.0, 1001)[:, None].repeat(3, axis=1)
    np.testing.assert_allclose(
        Display.named(name).encode(linear), space.cctf_encoding(linear), atol=rounding
    )


@pytest.mark.parametrize("display", [*map(Display.named, NAMES), CUSTOM], ids=lambda d: d.name)
class TestEveryDisplay:
    """What holds for any display."""

    def test_encoding_and_decoding_undo_each_other(self, display: Display) -> None:
        encoded = np.random.default_rng(2).uniform(0.0, 1.0, (50, 40, 3))
        np.testing.assert_allclose(display.encode(display.decode(encoded)), encoded, atol=1e-6)

    def test_rgb_to_xyz_and_back_is_the_same_rgb(self, display: Display) -> None:
        rgb = np.random.default_rng(2).uniform(-0.5, 1.5, (100, 3))
        back = rgb @ display.rgb_to_xyz.T @ display.xyz_to_rgb.T
        np.testing.assert_allclose(back, rgb, atol=1e-12)

    def test_full_red_green_and_blue_make_the_white(self, display: Display) -> None:
        white = display.rgb_to_xyz @ np.ones(3)
        np.testing.assert_allclose(white, xyz_of_xy(display.white_xy), atol=1e-12)

    def test_each_primary_has_its_chromaticity(self, display: Display) -> None:
        columns = display.rgb_to_xyz
        np.testing.assert_allclose((columns[:2] / columns.sum(axis=0)).T, display.primaries_xy)

    def test_black_and_white_are_the_ends_of_the_signal(self, display: Display) -> None:
        ends = np.array([[0.0] * 3, [1.0] * 3])
        np.testing.assert_allclose(display.encode(ends), ends, atol=1e-12)
        np.testing.assert_allclose(display.decode(ends), ends, atol=1e-12)

    def test_encoding_rises(self, display: Display) -> None:
        steps = np.diff(
            display.encode(np.linspace(0.0, 1.0, 4001)[:, None].repeat(3, axis=1)), axis=0
        )
        assert (steps >= -1e-7).all()
        assert (steps[:, 0] > 0).mean() > 0.99

    def test_what_lies_outside_is_cut_to_the_signal(self, display: Display) -> None:
        encoded = display.encode([[-0.2, 0.5, 7.0]])
        assert encoded[0, 0] == pytest.approx(0.0, abs=1e-12)
        assert encoded[0, 2] == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("method", ["cat16", "bradford"])
def test_adaptation_brings_white_to_white_and_back(method: str) -> None:
    a, d65 = (0.44758, 0.40745), (0.3127, 0.3290)
    there = adaptation_matrix(a, d65, method=method)
    back = adaptation_matrix(d65, a, method=method)
    np.testing.assert_allclose(there @ xyz_of_xy(a), xyz_of_xy(d65), atol=1e-12)
    np.testing.assert_allclose(there @ back, np.eye(3), atol=1e-12)


@pytest.mark.parametrize(("method", "title"), [("cat16", "CAT16"), ("bradford", "Bradford")])
def test_adaptation_equals_colour_science(method: str, title: str) -> None:
    import colour

    a, d65 = (0.44758, 0.40745), (0.3127, 0.3290)
    expected = colour.adaptation.matrix_chromatic_adaptation_VonKries(
        colour.xy_to_XYZ(a), colour.xy_to_XYZ(d65), title
    )
    np.testing.assert_allclose(adaptation_matrix(a, d65, method=method), expected, atol=1e-6)


def test_no_adaptation_changes_nothing() -> None:
    assert (adaptation_matrix((0.45, 0.41), (0.31, 0.33), method="none") == np.eye(3)).all()


def test_an_unknown_display_is_named_with_the_nearest() -> None:
    with pytest.raises(LamplitError, match="did you mean 'display-p3'"):
        Display.named("displayp3")


@pytest.mark.parametrize(
    ("primaries", "white", "gamma", "message"),
    [
        (
            [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]],
            [0.7, 0.25],
            2.2,
            "between the three primaries",
        ),
        ([[0.60, 0.30], [0.40, 0.20], [0.20, 0.10]], [0.3, 0.3], 2.2, "no triangle"),
        ([[0.64, 0.33], [0.30, 0.60], [0.15, 0.00]], [0.3, 0.3], 2.2, "above 0"),
        ([[0.64, 0.33], [0.30, 0.60], [0.15, np.nan]], [0.3, 0.3], 2.2, "finite"),
        ([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]], [0.31, 0.33], 0.0, "gamma"),
        ([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]], [0.31, 0.33], np.nan, "gamma"),
        ([[0.64, 0.33], [0.30, 0.60]], [0.31, 0.33], 2.2, "three primaries"),
    ],
)
def test_an_impossible_display_is_refused(
    primaries: list[list[float]], white: list[float], gamma: float, message: str
) -> None:
    with pytest.raises(LamplitError, match=message):
        Display.from_primaries(primaries, white, gamma)

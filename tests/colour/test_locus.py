# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Dominant wavelength and purity."""

from __future__ import annotations

import numpy as np
import pytest

from lamplit.colour.locus import dominant_wavelength, spectral_locus
from lamplit.colour.tristimulus import chromaticity_xy, tristimulus
from lamplit.sources import source


def _source_xy(name: str) -> np.ndarray:
    return chromaticity_xy(tristimulus(source(name).distribution()))


@pytest.mark.parametrize("wavelength_nm", [430.0, 480.25, 520.0, 575.5, 612.0, 660.0])
def test_a_spectral_light_is_its_own_dominant_wavelength(wavelength_nm: float) -> None:
    nm, locus = spectral_locus()
    xy = [np.interp(wavelength_nm, nm, locus[:, i]) for i in range(2)]
    found = dominant_wavelength(xy)
    assert found.wavelength_nm == pytest.approx(wavelength_nm, abs=1e-6)
    assert found.purity == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("white_xy", [(1 / 3, 1 / 3), (0.3127, 0.3290), (0.4476, 0.4074)])
@pytest.mark.parametrize("name", ["red-led-624", "red-led-645", "amber-led-593", "pc-amber-led"])
def test_leds_agree_with_colour_science_to_its_one_nanometre(
    name: str, white_xy: tuple[float, float]
) -> None:
    import colour

    xy = _source_xy(name)
    expected = float(colour.dominant_wavelength(xy, np.array(white_xy))[0])
    found = dominant_wavelength(xy, white_xy=white_xy).wavelength_nm
    assert found == pytest.approx(expected, abs=0.75)


@pytest.mark.parametrize("xy", [(0.35, 0.20), (0.45, 0.22), (0.25, 0.12), (0.50, 0.24)])
def test_purples_are_named_by_their_complement(xy: tuple[float, float]) -> None:
    import colour

    found = dominant_wavelength(xy)
    if float(colour.dominant_wavelength(np.array(xy), np.array([1 / 3, 1 / 3]))[0]) < 0:
        expected = float(colour.complementary_wavelength(np.array(xy), np.array([1 / 3, 1 / 3]))[0])
        assert found.wavelength_nm == pytest.approx(-abs(expected), abs=0.75)
    assert 0.0 < found.purity < 1.0


@pytest.mark.parametrize(
    ("xy", "wavelength_nm"),
    [((0.665, 0.335), 609.7), ((0.560, 0.440), 587.4), ((0.609, 0.390), 596.3)],
)
def test_the_un_boundaries_meet_the_locus_where_they_should(
    xy: tuple[float, float], wavelength_nm: float
) -> None:
    """UN R48 prints the corners to three digits: 0.0005 in x is 0.2 nm here."""
    assert dominant_wavelength(xy).wavelength_nm == pytest.approx(wavelength_nm, abs=0.2)


def test_the_white_has_no_hue() -> None:
    found = dominant_wavelength((0.3127, 0.3290), white_xy=(0.3127, 0.3290))
    assert np.isnan(found.wavelength_nm)
    assert found.purity == 0.0


def test_purity_is_the_share_of_the_way_to_the_locus() -> None:
    _, locus = spectral_locus()
    white = np.array([1 / 3, 1 / 3])
    halfway = white + 0.5 * (locus[200] - white)
    assert dominant_wavelength(halfway).purity == pytest.approx(0.5, abs=1e-9)


def test_a_white_outside_the_locus_is_refused() -> None:
    with pytest.raises(ValueError, match="outside the spectral locus"):
        dominant_wavelength((0.95, 0.9), white_xy=(0.9, 0.9))

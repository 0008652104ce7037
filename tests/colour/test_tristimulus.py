# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Eq. (1): XYZ and chromaticity against colour-science and against the CIE's printed values."""

from __future__ import annotations

import numpy as np
import pytest

from lamplit.colour.observer import OBSERVERS, colour_matching_functions
from lamplit.colour.tristimulus import (
    K_M,
    chromaticity_xy,
    luminous_efficacy,
    tristimulus,
    xyz_of_xy,
)
from lamplit.errors import LamplitError, SpectrumError
from lamplit.sources import source
from lamplit.spectrum import SpectralDistribution

#: Twenty spectra of every kind that a lamp meets: smooth, spiky, narrow, and one of the invisible.
TWENTY = {
    **{
        name: source(name).distribution()
        for name in (
            *("A", "D50", "D55", "D65", "D75", "E", "FL2", "FL7", "FL11", "HP1", "LED-B3"),
            *("LED-RGB1", "p21w-filament", "red-led-624", "red-led-645", "amber-led-593"),
            *("pc-amber-led", "white-led"),
        )
    },
    "gaussian green": SpectralDistribution.gaussian(530.0, 30.0),
    "blackbody 6500 K": SpectralDistribution.blackbody(6500.0),
}

#: A signal red of FACTS §4 at 3 mm.
RED_FILTER = SpectralDistribution(lambda nm: 2.0 ** -np.exp(-(nm - 612.0) / 15.0))

_TITLES = {
    "cie-1931-2": "CIE 1931 2 Degree Standard Observer",
    "cie-1964-10": "CIE 1964 10 Degree Standard Observer",
    "cie-2015-2": "CIE 2015 2 Degree Standard Observer",
}


def _in_colour_science(
    spd: SpectralDistribution, observer: str, reflectance: SpectralDistribution | None = None
) -> np.ndarray:
    """Return XYZ with Y = 100 for the source, as colour-science integrates it each nm."""
    import colour

    functions = colour.MSDS_CMFS[_TITLES[observer]]
    nm = functions.wavelengths
    sample = (reflectance or SpectralDistribution.constant(1.0))(nm)
    return colour.sd_to_XYZ(
        colour.SpectralDistribution(sample, nm),
        functions,
        colour.SpectralDistribution(spd(nm), nm),
        method="Integration",
    )


@pytest.mark.parametrize("observer", OBSERVERS)
@pytest.mark.parametrize("name", TWENTY)
def test_xyz_and_xy_of_twenty_spectra_equal_colour_science(name: str, observer: str) -> None:
    expected = _in_colour_science(TWENTY[name], observer)
    relative = tristimulus(TWENTY[name], observer=observer, normalisation="relative")
    np.testing.assert_allclose(relative, expected, rtol=1e-6, atol=1e-9)
    expected_xy = expected[:2] / expected.sum()
    np.testing.assert_allclose(chromaticity_xy(relative), expected_xy, rtol=0, atol=1e-6)


@pytest.mark.parametrize("name", TWENTY)
def test_absolute_values_are_683_times_the_integral(name: str) -> None:
    import colour

    functions = colour.MSDS_CMFS[_TITLES["cie-1931-2"]]
    spd = colour.SpectralDistribution(TWENTY[name](functions.wavelengths), functions.wavelengths)
    expected = colour.sd_to_XYZ(spd, functions, k=683, method="Integration")
    np.testing.assert_allclose(tristimulus(TWENTY[name]), expected, rtol=1e-6)


@pytest.mark.parametrize("name", ["A", "D65", "red-led-624", "FL11"])
def test_a_filter_before_a_source_equals_colour_science(name: str) -> None:
    expected = _in_colour_science(TWENTY[name], "cie-1931-2", RED_FILTER)
    ours = tristimulus(TWENTY[name], reflectance=RED_FILTER, normalisation="relative")
    np.testing.assert_allclose(ours, expected, rtol=1e-6)


#: CIE 015:2018, tables 1 and 5.
PRINTED_XY = {
    "A": (0.44758, 0.40745),
    "D50": (0.34567, 0.35851),
    "D55": (0.33243, 0.34744),
    "D65": (0.31272, 0.32903),
    "D75": (0.29903, 0.31488),
    "E": (0.33333, 0.33333),
}


@pytest.mark.parametrize("name", PRINTED_XY)
def test_standard_illuminants_have_the_chromaticity_that_the_cie_prints(name: str) -> None:
    xy = chromaticity_xy(tristimulus(source(name).distribution()))
    np.testing.assert_allclose(xy, PRINTED_XY[name], atol=5e-5, rtol=0)


#: CIE 015:2018, tables 10.1 to 12, printed to four digits for sums in steps of 5 nm.
PRINTED_LAMP_XY = {
    "FL1": (0.3131, 0.3371),
    "FL2": (0.3721, 0.3751),
    "FL3": (0.4091, 0.3941),
    "FL4": (0.4402, 0.4031),
    "FL7": (0.3129, 0.3292),
    "FL8": (0.3458, 0.3586),
    "FL11": (0.3805, 0.3769),
    "FL12": (0.4370, 0.4042),
    "HP1": (0.5330, 0.4150),
    "HP3": (0.4302, 0.4075),
    "LED-B3": (0.3756, 0.3723),
    "LED-RGB1": (0.4557, 0.4211),
}


@pytest.mark.parametrize("name", PRINTED_LAMP_XY)
def test_lamps_have_the_chromaticity_that_the_cie_prints(name: str) -> None:
    nm = np.arange(380.0, 781.0, 5.0)
    xyz = source(name).distribution()(nm) @ colour_matching_functions("cie-1931-2", nm)
    np.testing.assert_allclose(chromaticity_xy(xyz), PRINTED_LAMP_XY[name], atol=1.0e-4, rtol=0)


def test_one_watt_at_555_nm_gives_683_lumens() -> None:
    line = SpectralDistribution.tabulated([554, 555, 556], [0, 1, 0], extension="zero")
    assert tristimulus(line)[1] == pytest.approx(683.0, rel=1e-6)
    assert luminous_efficacy(line) == pytest.approx(K_M, rel=1e-6)


def test_the_colour_matching_functions_hold_printed_values() -> None:
    """CIE 018:2019 table 6, at 600 nm: 1.0622, 0.631, 0.0008."""
    at_600 = colour_matching_functions("cie-1931-2", [600.0])[0]
    np.testing.assert_allclose(at_600, [1.0622, 0.6310, 0.0008], atol=1e-9)


def test_nothing_is_seen_outside_the_tables() -> None:
    for observer in OBSERVERS:
        assert not colour_matching_functions(observer, [300.0, 359.0, 831.0, 1000.0]).any()


def test_a_narrower_range_sees_less() -> None:
    equal = SpectralDistribution.constant(1.0)
    whole = tristimulus(equal)
    cut = tristimulus(equal, range_nm=(380.0, 780.0))
    assert (cut < whole).all()
    np.testing.assert_allclose(cut, whole, rtol=1e-3)


def test_a_source_that_ends_early_must_say_how_to_go_on() -> None:
    short = SpectralDistribution.tabulated([400, 700], [1, 1], label="short.csv")
    with pytest.raises(SpectrumError, match=r"short\.csv .* 400 to 700 nm"):
        tristimulus(short)


def test_light_that_nobody_sees_is_nothing_to_be_relative_to() -> None:
    with pytest.raises(SpectrumError, match="gives no light"):
        tristimulus(SpectralDistribution.constant(0.0), normalisation="relative")


def test_an_unknown_observer_is_named_with_the_nearest() -> None:
    with pytest.raises(LamplitError, match="did you mean 'cie-1931-2'"):
        colour_matching_functions("cie-1931", [500.0])


def test_black_has_no_chromaticity() -> None:
    xy = chromaticity_xy([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]])
    assert np.isnan(xy[0]).all()
    np.testing.assert_allclose(xy[1], [1 / 3, 1 / 3])


def test_chromaticity_and_luminance_give_back_xyz() -> None:
    xyz = np.random.default_rng(1).uniform(0.1, 1.0, (5, 3))
    np.testing.assert_allclose(xyz_of_xy(chromaticity_xy(xyz), xyz[:, 1]), xyz, rtol=1e-12)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`SpectralDistribution` as a function of wavelength."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lamplit.errors import SpectrumError
from lamplit.spectrum import OHNO_FWHM, SpectralDistribution

NM = np.arange(380.0, 781.0)


def test_a_table_goes_through_its_points_and_straight_between_them() -> None:
    table = SpectralDistribution.tabulated([400, 500, 700], [0.1, 0.9, 0.3])
    np.testing.assert_allclose(table([400, 500, 700, 450, 600]), [0.1, 0.9, 0.3, 0.5, 0.6])


@given(st.lists(st.floats(0.0, 1.0), min_size=3, max_size=12))
def test_the_cubic_goes_through_its_points_and_never_beyond_their_neighbours(
    values: list[float],
) -> None:
    nm = 400.0 + 10.0 * np.arange(len(values))
    curve = SpectralDistribution.tabulated(nm, values, interpolation="cubic")
    np.testing.assert_allclose(curve(nm), values, atol=1e-12)
    fine = curve(np.linspace(nm[0], nm[-1], 50 * (len(values) - 1) + 1))
    for i in range(len(values) - 1):
        piece = fine[50 * i : 50 * i + 51]
        assert piece.min() >= min(values[i : i + 2]) - 1e-12
        assert piece.max() <= max(values[i : i + 2]) + 1e-12


@pytest.mark.parametrize(("extension", "beyond"), [("constant", [0.1, 0.3]), ("zero", [0.0, 0.0])])
def test_outside_the_table_the_extension_answers(extension: str, beyond: list[float]) -> None:
    table = SpectralDistribution.tabulated([400, 500], [0.1, 0.3], extension=extension)
    assert table([399.9, 500.1]).tolist() == beyond
    assert table([400.0, 500.0]).tolist() == [0.1, 0.3]


def test_outside_the_table_is_an_error_that_names_range_and_remedy() -> None:
    table = SpectralDistribution.tabulated([400, 500], [0.1, 0.3], label="lens.csv")
    with pytest.raises(SpectrumError, match=r"lens\.csv .* 400 to 500 nm, and 501 nm .*extension"):
        table([450.0, 501.0])
    with pytest.raises(SpectrumError, match="nan nm is asked for"):
        table([np.nan])


@pytest.mark.parametrize(
    ("nm", "values", "message"),
    [
        ([400, 500], [1], "as many values"),
        ([400], [1], "two at least"),
        ([400, 400], [1, 1], "400 nm follows 400 nm"),
        ([500, 400], [1, 1], "400 nm follows 500 nm"),
        ([400, np.nan], [1, 1], "not finite"),
        ([400, 500], [1, np.inf], "not finite"),
    ],
)
def test_a_malformed_table_is_refused(nm: list[float], values: list[float], message: str) -> None:
    with pytest.raises(SpectrumError, match=message):
        SpectralDistribution.tabulated(nm, values)


def test_a_table_does_not_change_when_its_array_does() -> None:
    values = np.array([0.1, 0.3])
    table = SpectralDistribution.tabulated([400, 500], values)
    values[:] = 7.0
    assert table([400.0]).tolist() == [0.1]


@pytest.mark.parametrize("kelvin", [1500.0, 2856.0, 6504.0, 12000.0])
def test_a_blackbody_equals_colour_science(kelvin: float) -> None:
    import colour

    # colour-science gives W·sr⁻¹·m⁻³ and takes c₂ of its own: 1.4388e-2 against 1.438777e-2.
    expected = 1e-9 * colour.colorimetry.planck_law(NM * 1e-9, kelvin, c2=1.438776877e-2)
    np.testing.assert_allclose(SpectralDistribution.blackbody(kelvin)(NM), expected, rtol=1e-6)


def test_a_blackbody_gives_off_what_stefan_and_boltzmann_say() -> None:
    """∫ π L dλ = σ T⁴ with σ = 5.670374e-8 W·m⁻²·K⁻⁴ (CODATA 2018)."""
    nm = np.geomspace(100.0, 1e6, 200_001)
    exitance = np.pi * np.trapezoid(SpectralDistribution.blackbody(2856.0)(nm), nm)
    assert exitance == pytest.approx(5.670374e-8 * 2856.0**4, rel=1e-4)


def test_a_blackbody_peaks_where_wien_says() -> None:
    nm = np.arange(900.0, 1150.0, 0.01)
    peak = nm[np.argmax(SpectralDistribution.blackbody(2856.0)(nm))]
    assert peak == pytest.approx(2.897771955e6 / 2856.0, abs=0.02)


def test_a_blackbody_far_in_the_ultraviolet_is_dark_without_a_warning() -> None:
    assert SpectralDistribution.blackbody(300.0)([1.0]).tolist() == [0.0]


@pytest.mark.parametrize("model", ["ohno", "gaussian"])
@pytest.mark.parametrize(("peak", "fwhm"), [(624.0, 18.0), (593.0, 15.0), (450.0, 25.0)])
def test_an_led_is_half_as_strong_half_its_width_from_the_peak(
    model: str, peak: float, fwhm: float
) -> None:
    led = SpectralDistribution.led(peak, fwhm, model=model)
    np.testing.assert_allclose(led([peak, peak - fwhm / 2, peak + fwhm / 2]), [1.0, 0.5, 0.5])


def test_ohnos_led_equals_colour_science() -> None:
    import colour

    shape = colour.SpectralShape(380, 780, 1)
    expected = colour.sd_single_led(624, half_spectral_width=20, shape=shape, method="Ohno 2005")
    ours = SpectralDistribution.ohno_led(624.0, 20.0)(NM)
    np.testing.assert_allclose(ours, expected.values, atol=1e-12)


def test_the_width_of_ohnos_led_solves_its_equation() -> None:
    g = np.exp(-((OHNO_FWHM / 2) ** 2))
    assert (g + 2 * g**5) / 3 == pytest.approx(0.5, abs=1e-12)


@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_a_temperature_or_width_that_no_source_has_is_refused(value: float) -> None:
    with pytest.raises(SpectrumError, match="positive temperature"):
        SpectralDistribution.blackbody(value)
    with pytest.raises(SpectrumError, match="positive peak and width"):
        SpectralDistribution.led(624.0, value)


def test_scaling_keeps_range_and_extension() -> None:
    table = SpectralDistribution.tabulated([400, 500], [0.1, 0.3], extension="zero").scaled(10.0)
    np.testing.assert_allclose(table([400.0, 500.0, 600.0]), [1.0, 3.0, 0.0])


def test_values_keep_the_shape_of_the_wavelengths() -> None:
    assert SpectralDistribution.constant(0.5)(np.full((3, 4), 500.0)).shape == (3, 4)
    assert SpectralDistribution.tabulated([400, 500], [0, 1])(450.0).shape == ()

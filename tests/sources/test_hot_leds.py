# SPDX-License-Identifier: Apache-2.0 OR MIT
"""An LED's junction temperature moves its peak, and so its colour and its luminous flux."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from lamplit.colour.tristimulus import chromaticity_xy, luminous_efficacy, tristimulus
from lamplit.spectra_spec import SourceSpec

SOURCE: TypeAdapter[Any] = TypeAdapter(SourceSpec)
NM = np.arange(400.0, 781.0, 0.01)


def led(peak_nm: float, fwhm_nm: float, celsius: float, **more: float) -> Any:
    return SOURCE.validate_python(
        {
            "led_peak_nm": peak_nm,
            "led_fwhm_nm": fwhm_nm,
            "junction_temperature_celsius": celsius,
            **more,
        }
    )


def peak_of(spec: Any) -> float:
    return float(NM[np.argmax(spec.distribution()(NM))])


@pytest.mark.parametrize(
    ("peak_nm", "celsius", "hot_nm"),
    [
        (624.0, 25.0, 624.0),
        (624.0, 85.0, 632.4),
        (624.0, -40.0, 614.9),
        (645.0, 125.0, 659.0),
        (593.0, 85.0, 600.8),
        (605.0, 35.0, 606.4),
    ],
)
def test_the_peak_drifts_as_colours_do(peak_nm: float, celsius: float, hot_nm: float) -> None:
    """0.14 nm/K for red (Osram LA A67F), 0.13 nm/K for amber: FACTS §3."""
    assert peak_of(led(peak_nm, 18.0, celsius)) == pytest.approx(hot_nm, abs=0.01)


def test_a_drift_of_the_data_sheet_goes_before_the_usual_one() -> None:
    assert peak_of(led(624.0, 18.0, 125.0, peak_drift_nm_per_kelvin=0.05)) == pytest.approx(629.0)
    assert peak_of(led(470.0, 25.0, 125.0, peak_drift_nm_per_kelvin=0.04)) == pytest.approx(474.0)
    assert peak_of(led(624.0, 18.0, 125.0, peak_drift_nm_per_kelvin=0.0)) == pytest.approx(624.0)


def test_sixty_kelvin_take_a_red_led_from_233_to_174_lumens_per_watt() -> None:
    """FACTS §3, from colour-science's own Ohno model."""
    assert luminous_efficacy(led(624.0, 18.0, 25.0).distribution()) == pytest.approx(233, abs=0.5)
    assert luminous_efficacy(led(624.0, 18.0, 85.0).distribution()) == pytest.approx(174, abs=0.5)


def is_un_amber(spec: Any) -> bool:
    """UN R48 §2.29: y ≤ x − 0.120, y ≥ 0.390, y ≥ 0.790 − 0.670x, within the spectral locus."""
    x, y = chromaticity_xy(tristimulus(spec.distribution()))
    return bool(y <= x - 0.120 and y >= 0.390 and y >= 0.790 - 0.670 * x)


def test_an_amber_led_leaves_the_amber_region_between_thirty_and_sixty_kelvin() -> None:
    """FACTS §3; a 593 nm LED 15 nm wide at 25 °C."""
    amber = [is_un_amber(led(593.0, 15.0, 25.0 + kelvin)) for kelvin in (0.0, 30.0, 60.0)]
    assert amber == [True, True, False]


def test_at_25_degrees_nothing_changes_and_no_drift_needs_to_be_known() -> None:
    plain = SOURCE.validate_python({"led_peak_nm": 470.0, "led_fwhm_nm": 25.0})
    same = led(470.0, 25.0, 25.0)
    np.testing.assert_array_equal(plain.distribution()(NM), same.distribution()(NM))
    assert plain == same


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"led_peak_nm": 470.0}, "no usual drift is known of a peak at 470 nm; give peak_drift"),
        ({"led_peak_nm": 700.0}, "no usual drift is known"),
        ({"junction_temperature_celsius": 300.0}, "less than or equal to 200"),
        ({"junction_temperature_celsius": float("nan")}, "finite|greater than"),
        ({"radiant_drop_per_kelvin": 0.019}, "leaves no light"),
        ({"radiant_drop_per_kelvin": -0.001}, "greater than or equal to 0"),
        ({"junction_temperature_kelvin": 350.0}, "Extra inputs"),
    ],
)
def test_a_wrong_temperature_is_refused(more: dict[str, float], message: str) -> None:
    table = {"led_peak_nm": 624.0, "led_fwhm_nm": 18.0, "junction_temperature_celsius": 85.0}
    with pytest.raises(ValidationError, match=message):
        SOURCE.validate_python({**table, **more})

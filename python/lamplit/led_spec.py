# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`LedSource`: a single-colour LED as a scene writes it, at any temperature of its junction."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from lamplit.spec_forms import Form, Number, Positive, spec_fault
from lamplit.spectrum import LedModel, SpectralDistribution

#: Data sheets give LEDs at this temperature.
LED_REFERENCE_CELSIUS = 25.0

#: From and to a peak, in nm, and how heat moves it, in nm/K: AlInGaP, amber and red. Red is the
#: data sheet of Osram's LA A67F; amber is from experience.
_USUAL_DRIFTS = ((580.0, 605.0, 0.13), (605.0, 680.0, 0.14))


def usual_led_drift(peak_nm: float) -> float | None:
    """Return how a junction's heat moves the peak of an LED of this colour, in nm/K, if known.

    >>> usual_led_drift(624.0), usual_led_drift(470.0)
    (0.14, None)
    """
    return next((drift for low, high, drift in _USUAL_DRIFTS if low <= peak_nm < high), None)


class LedSource(Form):
    """A single-colour LED by its peak and its full width at half maximum."""

    led_peak_nm: Annotated[Positive, Field(ge=100, le=3000)] = Field(
        description="where it shines most"
    )
    led_fwhm_nm: Annotated[Positive, Field(ge=0.1, le=500)] = Field(
        description="full width at half of the maximum"
    )
    model: LedModel = Field(
        default="ohno", description="shape of the spectrum: Ohno's, or a plain Gaussian"
    )
    junction_temperature_celsius: Annotated[Number, Field(ge=-60, le=200)] = Field(
        default=LED_REFERENCE_CELSIUS, description="peak and width are those at 25 °C"
    )
    peak_drift_nm_per_kelvin: Annotated[Number, Field(ge=-1, le=1)] | None = Field(
        default=None,
        description="how heat moves the peak; default: 0.13 from 580 nm, 0.14 from 605 to 680 nm",
    )
    radiant_drop_per_kelvin: Annotated[Number, Field(ge=0, lt=0.02)] = Field(
        default=0.0,
        description="share of its radiant flux that a kelvin takes; for flux_lm_at_25_celsius",
    )

    @model_validator(mode="after")
    def _drifts_by_a_known_rate(self) -> LedSource:
        if self.heated_by_kelvin != 0.0:
            if self._drift() is None:
                raise spec_fault(
                    f"no usual drift is known of a peak at {self.led_peak_nm:g} nm; "
                    "give peak_drift_nm_per_kelvin, from the data sheet"
                )
            if self.radiant_share <= 0.0:
                raise spec_fault("radiant_drop_per_kelvin leaves no light at that temperature")
        return self

    @property
    def heated_by_kelvin(self) -> float:
        """How much warmer the junction is than at its 25 °C."""
        return self.junction_temperature_celsius - LED_REFERENCE_CELSIUS

    @property
    def radiant_share(self) -> float:
        """The radiant flux at the junction's temperature, as a share of that at 25 °C."""
        return 1.0 - self.radiant_drop_per_kelvin * self.heated_by_kelvin

    def at_reference(self) -> LedSource:
        """Return this LED at 25 °C."""
        return self.model_copy(update={"junction_temperature_celsius": LED_REFERENCE_CELSIUS})

    def distribution(self) -> SpectralDistribution:
        """Return the relative spectral power, 1 at the peak, at the junction's temperature.

        Heat moves the peak and leaves the width.
        """
        peak = self.led_peak_nm + (self._drift() or 0.0) * self.heated_by_kelvin
        return SpectralDistribution.led(peak, self.led_fwhm_nm, model=self.model)

    def _drift(self) -> float | None:
        if self.peak_drift_nm_per_kelvin is not None:
            return self.peak_drift_nm_per_kelvin
        return usual_led_drift(self.led_peak_nm)

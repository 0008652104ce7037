# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What burns in a rear lamp: the filament bulb, and LEDs as analytic models.

No package that may be shipped carries a measured single-colour red or amber LED, so these are
models with the peak and width of named parts. An LED that you measured goes into the scene as a
CSV or TM-27 file.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np

from lamplit.sources.entry import SourceEntry
from lamplit.spectrum import Array, SpectralDistribution

_OWN = "own model; Apache-2.0 OR MIT"
_OHNO = "model of Y. Ohno, Opt. Eng. 44 (2005) 111302"


def _two_sided(nm: Array, peak_nm: float, left_nm: float, right_nm: float) -> Array:
    """Return a Gaussian with half widths at half maximum ``left_nm`` and ``right_nm``."""
    offset = nm - peak_nm
    return np.exp(-np.log(2.0) * (offset / np.where(offset < 0, left_nm, right_nm)) ** 2)


def _phosphor_amber() -> SpectralDistribution:
    return SpectralDistribution(
        lambda nm: _two_sided(nm, 618.0, 45.7, 51.3), label="phosphor-converted amber LED"
    )


def _phosphor_white() -> SpectralDistribution:
    def power(nm: Array) -> Array:
        return _two_sided(nm, 450.0, 10.0, 10.0) + 0.4815 * _two_sided(nm, 552.2, 45.0, 75.0)

    return SpectralDistribution(power, label="phosphor-converted white LED")


def _led(name: str, what: str, part: str, peak_nm: float, fwhm_nm: float) -> SourceEntry:
    return SourceEntry(
        name,
        f"{what} LED, peak {peak_nm:g} nm, FWHM {fwhm_nm:g} nm at 25 °C",
        f"{_OHNO}; peak and width of {part}",
        _OWN,
        partial(SpectralDistribution.led, peak_nm, fwhm_nm),
    )


def lamp_entries() -> Iterator[SourceEntry]:
    """Yield the light sources of lamps: filament, red, amber and white LEDs."""
    yield SourceEntry(
        "p21w-filament",
        "Tungsten filament of a P21W bulb at 13.5 V as a blackbody at 2856 K (CIE A to 0.1 %)",
        "Planck's law; regulations test filament lamps with illuminant A",
        _OWN,
        partial(SpectralDistribution.blackbody, 2856.0),
    )
    yield _led("red-led-624", "Red", "Osram LA E67F (automotive rear lamps)", 624.0, 18.0)
    yield _led("red-led-629", "Red", "Epileds red (measured)", 629.2, 17.2)
    yield _led("red-led-645", "Deep red", "Norlux red (measured 643 nm)", 645.0, 18.0)
    yield _led("amber-led-593", "Amber", "Osram LY 5436 (measured 594 nm)", 593.0, 15.0)
    yield SourceEntry(
        "pc-amber-led",
        "Amber LED, blue die under a full-conversion phosphor, peak 618 nm, FWHM 97 nm",
        "two-sided Gaussian with the peak and width measured on a LedEngin PC amber; its skew "
        "brings the model to that part's chromaticity (0.589, 0.406) within 0.003",
        _OWN,
        _phosphor_amber,
    )
    yield SourceEntry(
        "white-led",
        "White LED, blue die at 450 nm and a yellow phosphor, for reversing lamps",
        "two Gaussians in the ratio that meets CIE daylight at 6000 K, (0.3217, 0.3378)",
        _OWN,
        _phosphor_white,
    )

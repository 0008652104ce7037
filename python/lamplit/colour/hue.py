# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Dominant wavelength and colour temperature of a measured light, with their standard errors."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.colour.locus import dominant_wavelength
from lamplit.colour.temperature import colour_temperature

Array = NDArray[np.float64]

#: Half of the step of the differences that stand in for derivatives, in x and y: wider than the
#: kinks of a locus that is known each nm, where it turns most, and than rounding.
_STEP = 2e-4


class Hue(NamedTuple):
    """Dominant wavelength and CCT of a chromaticity; NaN where it has none, or σ is not known."""

    #: In nm, against the equal-energy white; of purples the complementary one with a minus sign.
    dominant_wavelength_nm: float
    dominant_wavelength_standard_error_nm: float
    #: In K; only of what is no farther than 0.05 from the Planckian locus in (u, v).
    colour_temperature_k: float
    colour_temperature_standard_error_k: float


def hue(chromaticity: ArrayLike, covariance: ArrayLike) -> Hue:
    """Return the hue of ``chromaticity`` (2,), CIE 1931 x and y, with ``covariance`` (2, 2).

    Standard errors are of first order (delta method): σ² = g Σ gᵀ, with the derivatives g of each
    quantity by x and y as central differences. They grow without bound towards the white, which has
    no dominant wavelength, and towards the limits of the CCT, next to which none is given.

    Source: JCGM 100:2008, 5.2.2, eq. (13).

    >>> [round(value, 1) for value in hue([0.69, 0.305], 1e-6 * np.eye(2))[:2]]
    [621.9, 0.6]
    """
    place, spread = np.asarray(chromaticity, np.float64), np.asarray(covariance, np.float64)
    if not np.isfinite(place).all():
        return Hue(np.nan, np.nan, np.nan, np.nan)
    return Hue(*_with_error(_dominant, place, spread), *_with_error(_temperature, place, spread))


def _with_error(
    quantity: Callable[[Array], float], place: Array, covariance: Array
) -> tuple[float, float]:
    """Return a quantity of x and y, and its standard error."""
    steps = _STEP * np.eye(2)
    ends = np.array([[quantity(place + step), quantity(place - step)] for step in steps])
    value = quantity(place)
    # A purple beside a colour with a dominant wavelength: there is no derivative.
    if not (np.sign(ends) == np.sign(value)).all():
        return value, np.nan
    gradient = (ends[:, 0] - ends[:, 1]) / (2.0 * _STEP)
    return value, float(np.sqrt(np.maximum(gradient @ covariance @ gradient, 0.0)))


def _dominant(place: Array) -> float:
    return dominant_wavelength(place).wavelength_nm


def _temperature(place: Array) -> float:
    found = colour_temperature(place)
    return np.nan if found is None else found.kelvin

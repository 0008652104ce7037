# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Refractive index as a formula of wavelength: the nine forms of refractiveindex.info.

λ is in µm and C₁, C₂ … are the coefficients in the order in which the database lists them.

1 Sellmeier     n² − 1 = C₁ + Σ C₂ᵢ λ² / (λ² − C₂ᵢ₊₁²)
2 Sellmeier-2   n² − 1 = C₁ + Σ C₂ᵢ λ² / (λ² − C₂ᵢ₊₁)
3 polynomial    n² = C₁ + Σ C₂ᵢ λ^C₂ᵢ₊₁
4 combined      n² = C₁ + C₂ λ^C₃ / (λ² − C₄^C₅) + C₆ λ^C₇ / (λ² − C₈^C₉) + Σ C₂ᵢ λ^C₂ᵢ₊₁
5 Cauchy        n = C₁ + Σ C₂ᵢ λ^C₂ᵢ₊₁
6 gases         n − 1 = C₁ + Σ C₂ᵢ / (C₂ᵢ₊₁ − λ⁻²)
7 Herzberger    n = C₁ + C₂ L + C₃ L² + C₄ λ² + C₅ λ⁴ + C₆ λ⁶,  L = 1 / (λ² − 0.028)
8 retro         (n² − 1) / (n² + 2) = C₁ + C₂ λ² / (λ² − C₃) + C₄ λ²
9 exotic        n² = C₁ + C₂ / (λ² − C₃) + C₄ (λ − C₅) / ((λ − C₅)² + C₆)

Source: M. N. Polyanskiy, "Dispersion formulas", refractiveindex.info database documentation;
"Refractiveindex.info database of optical constants", Sci. Data 11, 94 (2024).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from lamplit.errors import SpectrumError
from lamplit.spectrum import Array

#: Herzberger's constant, in µm².
_HERZBERGER_UM2 = 0.028

_Formula = Callable[[Sequence[float], Array], Array]


def refractive_index(
    formula: int, coefficients: Sequence[float], wavelengths_um: ArrayLike
) -> Array:
    """Return n(λ) by one of the nine formulas; ``nan`` where the formula has no real value.

    ``wavelengths_um`` may have any shape, and n comes back in the same.

    >>> crown = [0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653]
    >>> round(float(refractive_index(2, crown, 0.5875618)), 4)
    1.5168

    Raises:
        SpectrumError: There is no such formula, or its coefficients are too few or too many.
    """
    check_coefficients(formula, coefficients)
    um = np.asarray(wavelengths_um, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return _FORMULAS[formula](coefficients, um)


def check_coefficients(formula: int, coefficients: Sequence[float]) -> None:
    """Refuse a formula number or a number of coefficients that does not exist.

    Raises:
        SpectrumError: The message says which numbers the formula can have.
    """
    if formula not in _FORMULAS:
        raise SpectrumError(f"formula {formula} is unknown; refractiveindex.info numbers them 1-9")
    allowed = _COUNTS[formula]
    if len(coefficients) not in allowed:
        listed = ", ".join(str(count) for count in allowed)
        raise SpectrumError(
            f"formula {formula} takes {listed} coefficients, and {len(coefficients)} are given"
        )


def _pairs(coefficients: Sequence[float], first: int = 1) -> list[tuple[float, float]]:
    return list(zip(coefficients[first::2], coefficients[first + 1 :: 2], strict=True))


def _sellmeier(c: Sequence[float], um: Array) -> Array:
    return np.sqrt(1 + c[0] + sum(b * um**2 / (um**2 - pole**2) for b, pole in _pairs(c)))


def _sellmeier_2(c: Sequence[float], um: Array) -> Array:
    return np.sqrt(1 + c[0] + sum(b * um**2 / (um**2 - pole) for b, pole in _pairs(c)))


def _polynomial(c: Sequence[float], um: Array) -> Array:
    return np.sqrt(_cauchy(c, um))


def _combined(c: Sequence[float], um: Array) -> Array:
    squared = np.full(um.shape, c[0])
    for b, power, pole, pole_power in (c[1:5], c[5:9]):
        if b != 0.0:  # files fill an unused resonance with zeros, and 0/(λ² − 0⁰) fails at 1 µm
            squared = squared + b * um**power / (um**2 - np.power(pole, pole_power))
    return np.sqrt(squared + sum(b * um**power for b, power in _pairs(c, 9)))


def _cauchy(c: Sequence[float], um: Array) -> Array:
    return np.full(um.shape, c[0]) + sum(b * um**power for b, power in _pairs(c))


def _gases(c: Sequence[float], um: Array) -> Array:
    return np.full(um.shape, 1 + c[0]) + sum(b / (pole - um**-2.0) for b, pole in _pairs(c))


def _herzberger(c: Sequence[float], um: Array) -> Array:
    resonance = 1 / (um**2 - _HERZBERGER_UM2)
    infrared = sum(b * um ** (2 * power) for power, b in enumerate(c[3:], start=1))
    return c[0] + c[1] * resonance + c[2] * resonance**2 + infrared


def _retro(c: Sequence[float], um: Array) -> Array:
    lorentz = c[0] + c[1] * um**2 / (um**2 - c[2]) + c[3] * um**2
    return np.sqrt((1 + 2 * lorentz) / (1 - lorentz))


def _exotic(c: Sequence[float], um: Array) -> Array:
    bump = c[3] * (um - c[4]) / ((um - c[4]) ** 2 + c[5])
    return np.sqrt(c[0] + c[1] / (um**2 - c[2]) + bump)


_FORMULAS: dict[int, _Formula] = {
    1: _sellmeier,
    2: _sellmeier_2,
    3: _polynomial,
    4: _combined,
    5: _cauchy,
    6: _gases,
    7: _herzberger,
    8: _retro,
    9: _exotic,
}

_ODD = tuple(range(1, 18, 2))
_COUNTS: dict[int, tuple[int, ...]] = {
    1: _ODD,
    2: _ODD,
    3: _ODD,
    4: tuple(range(9, 18, 2)),
    5: _ODD[:6],
    6: _ODD[:6],
    7: (3, 4, 5, 6),
    8: (4,),
    9: (6,),
}

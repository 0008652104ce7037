# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The nine dispersion formulas: published indices, closed forms, refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lamplit.errors import SpectrumError
from lamplit.materials.dispersion import refractive_index

CROWN = [0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653]


@pytest.mark.parametrize(
    ("um", "published"),
    [
        (0.4046561, 1.53024),
        (0.4861327, 1.52238),
        (0.5875618, 1.51680),
        (0.6562725, 1.51432),
        (0.7065188, 1.51289),
        (1.0139800, 1.50731),
    ],
)
def test_crown_glass_has_its_catalogue_indices(um: float, published: float) -> None:
    # The catalogue values of N-BK7 at h, F, d, C, r, t.
    assert refractive_index(2, CROWN, um) == pytest.approx(published, abs=5.1e-6)


def test_sellmeier_with_roots_equals_sellmeier_with_squares() -> None:
    roots = [c if at % 2 or at == 0 else math.sqrt(c) for at, c in enumerate(CROWN)]
    um = np.linspace(0.35, 1.0, 27)
    np.testing.assert_allclose(
        refractive_index(1, roots, um), refractive_index(2, CROWN, um), rtol=1e-14
    )


def test_rutile_has_devores_index_at_the_sodium_line() -> None:
    # J. R. DeVore, J. Opt. Soc. Am. 41, 416 (1951): ordinary ray, n = 2.613 at 589.3 nm.
    rutile = [5.913, 0.2441, 0, 0.0803, 1, 0, 0, 0, 1]
    assert refractive_index(4, rutile, 0.5893) == pytest.approx(2.613, abs=5e-4)


def test_standard_air_has_ciddors_refractivity() -> None:
    # P. E. Ciddor, Appl. Opt. 35, 1566 (1996): dry air, 15 °C, at 633 nm.
    air = [0, 0.05792105, 238.0185, 0.00167917, 57.362]
    assert refractive_index(6, air, 0.633) - 1.0 == pytest.approx(2.765e-4, abs=5e-8)


@pytest.mark.parametrize(
    ("formula", "coefficients", "by_hand"),
    [
        (3, [2.2, 0.01, 2, 0.02, -2], math.sqrt(2.2 + 0.01 * 0.36 + 0.02 / 0.36)),
        (
            4,
            [2.0, 0.5, 2, 0.1, 2, 0.1, 0, 3.0, 1, 0.01, 2, -0.02, 4],
            math.sqrt(
                2.0 + 0.5 * 0.36 / (0.36 - 0.01) + 0.1 / (0.36 - 3.0) + 0.01 * 0.36 - 0.02 * 0.36**2
            ),
        ),
        (5, [1.48, 0.004, -2, 1e-4, -4], 1.48 + 0.004 / 0.36 + 1e-4 / 0.36**2),
        (6, [1e-5, 0.05, 238.0], 1 + 1e-5 + 0.05 / (238.0 - 1 / 0.36)),
        (
            7,
            [3.4, 0.16, -0.12, 1e-3, 2e-3, 3e-3],
            3.4 + 0.16 / 0.332 - 0.12 / 0.332**2 + 1e-3 * 0.36 + 2e-3 * 0.36**2 + 3e-3 * 0.36**3,
        ),
        (
            9,
            [2.5, 0.024, 0.03, 0.02, 1.52, 0.8771],
            math.sqrt(2.5 + 0.024 / 0.33 + 0.02 * -0.92 / (0.92**2 + 0.8771)),
        ),
    ],
)
def test_a_formula_at_600_nm_is_what_a_hand_computes(
    formula: int, coefficients: list[float], by_hand: float
) -> None:
    assert refractive_index(formula, coefficients, 0.6) == pytest.approx(by_hand, rel=1e-14)


def test_the_retro_formula_gives_the_lorentz_lorenz_quotient_back() -> None:
    silver_bromide = [0.452505, 0.09939, 0.070537, -0.000150]
    um = np.linspace(0.5, 0.67, 9)
    n = refractive_index(8, silver_bromide, um)
    quotient = 0.452505 + 0.09939 * um**2 / (um**2 - 0.070537) - 0.00015 * um**2
    np.testing.assert_allclose((n**2 - 1) / (n**2 + 2), quotient, rtol=1e-14)


def test_an_unused_resonance_of_zeros_does_not_fail_at_one_micrometre() -> None:
    glass = [2.25, 0.01, 0, 0.02, 1, 0, 0, 0, 0]
    assert refractive_index(4, glass, 1.0) == pytest.approx(math.sqrt(2.25 + 0.01 / 0.98))


def test_a_formula_without_a_real_value_gives_nan() -> None:
    assert np.isnan(refractive_index(3, [-1.0], 0.5))


@pytest.mark.parametrize(
    ("formula", "coefficients", "said"),
    [
        (0, [1.5], "formula 0 is unknown"),
        (10, [1.5], "formula 10 is unknown"),
        (2, [0, 1.0], "takes 1, 3, 5"),
        (4, [1.0, 2.0], "and 2 are given"),
        (8, [1.0], "takes 4 coefficients"),
        (9, [1.0] * 7, "takes 6 coefficients"),
        (2, [], "and 0 are given"),
    ],
)
def test_a_formula_that_cannot_be_is_refused(
    formula: int, coefficients: list[float], said: str
) -> None:
    with pytest.raises(SpectrumError, match=said):
        refractive_index(formula, coefficients, 0.5)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The eye's point spread against the published formulas, written out once more from the papers."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from lamplit.colour.eye import Eye, pupil_diameter_mm


def cie_total(theta: float, age: float, p: float) -> float:
    """CIE 135/1 (1999), the total glare function, in 1/sr, θ in degrees."""
    a = (age / 70.0) ** 4
    core = 9.2e6 / (1 + (theta / 0.0046) ** 2) ** 1.5 + 1.5e5 / (1 + (theta / 0.045) ** 2) ** 1.5
    q = 1 + (theta / 0.1) ** 2
    scatter = 400 / q + 3e-8 * theta**2 + p * (1300 / q**1.5 + 0.8 / q**0.5)
    return (1 - 0.08 * a) * core + (1 + 1.6 * a) * scatter + 2.5e-3 * p


def cie_146_general(theta: float, age: float, p: float) -> float:
    """CIE 146:2002, the general disability glare equation, in 1/sr, 0.1° to 100°."""
    older = 1 + (age / 62.5) ** 4
    return 10 / theta**3 + (5 / theta**2 + 0.1 * p / theta) * older + 0.0025 * p


@pytest.mark.parametrize(
    ("theta", "age", "pigmentation", "by_hand"),
    [
        # q = 101: 400/q = 3.96040, p (1300/q^1.5 + 0.8/q^0.5) = 0.5 (1.28075 + 0.07960)
        (1.0, 35.0, 0.5, 1.1 * (3.960396 + 3e-8 + 0.680176) + 0.00125),
        # q = 10 001: 400/q = 0.0399960; A = 70 multiplies by 2.6; no pigment
        (10.0, 70.0, 0.0, 2.6 * (0.0399960 + 3e-6)),
        # q = 90 001: 0.00444440 + 2.7e-5 + 1.2 (4.8148e-5 + 0.00266665)
        (30.0, 35.0, 1.2, 1.1 * (0.00444440 + 2.7e-5 + 0.00325776) + 0.003),
    ],
)
def test_scatter_is_the_published_formula_worked_by_hand(
    theta: float, age: float, pigmentation: float, by_hand: float
) -> None:
    assert Eye(age, 4.0, pigmentation).scatter_per_sr(theta) == pytest.approx(by_hand, rel=2e-5)


@pytest.mark.parametrize("theta", [0.0, 0.002, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 80.0])
@pytest.mark.parametrize("age", [25.0, 35.0])
def test_at_a_pupil_of_4_mm_the_spread_is_the_cies_total_glare_function(
    theta: float, age: float
) -> None:
    """IJspeert's image of a point is what that function was made from: the half-widths agree."""
    spread = Eye(age, 4.0, 0.5).spread_per_sr(theta)
    assert spread == pytest.approx(cie_total(theta, age, 0.5), rel=0.05)


@pytest.mark.parametrize("age", [25.0, 50.0, 75.0])
def test_the_veil_is_that_of_the_general_equation_of_cie_146(age: float) -> None:
    """Two fits of the CIE to the same data, which differ by 26 % at 1° and less beyond."""
    angles = np.geomspace(1.0, 60.0, 40)
    expected = np.array([cie_146_general(theta, age, 0.5) for theta in angles])
    assert Eye(age, 4.0, 0.5).spread_per_sr(angles) == pytest.approx(expected, rel=0.28)


@pytest.mark.parametrize("age", [20.0, 50.0, 80.0])
@pytest.mark.parametrize("pupil_mm", [2.0, 4.0, 8.0])
@pytest.mark.parametrize("pigmentation", [0.0, 1.2])
def test_all_light_goes_somewhere(age: float, pupil_mm: float, pigmentation: float) -> None:
    """The integral over the half space is 1, by quadrature that knows nothing of the terms."""
    eye = Eye(age, pupil_mm, pigmentation)
    edges = np.concatenate([[0.0], np.geomspace(1e-6, 90.0, 200_001)])
    middles = 0.5 * (edges[1:] + edges[:-1])
    rings = 2.0 * np.pi * -np.diff(np.cos(np.radians(edges)))
    assert (eye.spread_per_sr(middles) * rings).sum() == pytest.approx(1.0, abs=2e-4)


def test_an_older_eye_and_a_lighter_iris_veil_more() -> None:
    angles = np.geomspace(0.5, 90.0, 50)
    ages = [Eye(age, 4.0).spread_per_sr(angles) for age in (20.0, 40.0, 60.0, 80.0)]
    irises = [Eye(40.0, 4.0, p).spread_per_sr(angles) for p in (0.0, 0.5, 1.0, 1.2)]
    for rows in (ages, irises):
        for less, more in itertools.pairwise(rows):
            assert (more > less).all()
    assert Eye(80.0, 4.0).scattered_share > 2.5 * Eye(20.0, 4.0).scattered_share


def test_the_pupil_changes_the_image_and_not_the_veil() -> None:
    """Diffraction widens the image at 2 mm, aberration at 8 mm; CIE 146 knows no pupil."""
    small, middle, large = (Eye(35.0, pupil) for pupil in (2.0, 4.0, 8.0))
    veil = np.geomspace(1.0, 90.0, 30)
    for eye in (small, large):
        assert eye.spread_per_sr(veil) == pytest.approx(middle.spread_per_sr(veil), rel=0.01)
    assert large.spread_per_sr(0.05) > 1.2 * middle.spread_per_sr(0.05)
    assert middle.spread_per_sr(0.05) > 1.2 * small.spread_per_sr(0.05)


def test_half_of_a_terms_light_lies_within_its_known_angle() -> None:
    """∫ f_β up to tan θ = t is 1 - β/√(t² + β²): a half at t = √3 β."""
    ((share, width), _) = Eye(35.0, 4.0).image_terms
    assert width == pytest.approx(math.radians(0.0046), rel=0.01)
    assert share == pytest.approx(0.39 * (1.0 - Eye(35.0, 4.0).scattered_share), rel=0.01)


def test_pupils_are_those_of_watson_and_yellott() -> None:
    """By hand: at 846 cd/m² deg² D = 7.75 - 5.75/3 = 5.8333 mm at 28.58 years, and at 60 years

    D + 31.42 (0.02132 - 0.009562 · 5.8333) = 5.8333 - 1.0827 mm.
    """
    assert pupil_diameter_mm(84.6, 10.0, 28.58) == pytest.approx(7.75 - 5.75 / 3.0)
    assert pupil_diameter_mm(846.0, 1.0, 60.0) == pytest.approx(4.7507, abs=2e-4)
    assert pupil_diameter_mm(0.0, 100.0, 28.58) == pytest.approx(7.75)
    assert pupil_diameter_mm(1e12, 1e4, 28.58) == pytest.approx(2.0, abs=1e-3)

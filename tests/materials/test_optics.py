# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Closed forms of plane interfaces."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lamplit.materials.optics import (
    abbe_number,
    fresnel_reflectances,
    normal_reflectance,
    slab_transmittance,
)

ANGLES_DEG = (0.0, 30.0, 45.0, 60.0, 80.0)


@pytest.mark.parametrize(
    ("n", "expected"),
    [
        (1.52, (0.9183, 0.9160, 0.9025, 0.8435, 0.4560)),
        (1.4915, (0.9251, 0.9228, 0.9094, 0.8501, 0.4596)),
        (1.585, (0.9026, 0.9002, 0.8869, 0.8291, 0.4498)),
    ],
)
def test_a_clear_slab_lets_through_what_fresnel_says(n: float, expected: tuple[float]) -> None:
    # CIE 171:2006, 5.5 (directional transmittance of clear glass), without absorption.
    found = [float(slab_transmittance(n, 0.0, 3.0, angle_deg=angle)) for angle in ANGLES_DEG]
    np.testing.assert_allclose(found, expected, atol=5e-5)


@pytest.mark.parametrize("angle_deg", ANGLES_DEG)
def test_a_slab_sums_every_reflection_between_its_faces(angle_deg: float) -> None:
    n, absorption, thickness = 1.49, 0.05, 4.0
    cos_inside = math.sqrt(1 - (math.sin(math.radians(angle_deg)) / n) ** 2)
    tau = math.exp(-absorption * thickness / cos_inside)
    summed = 0.0
    for reflectance in fresnel_reflectances(n, angle_deg):
        r = float(reflectance)
        summed += 0.5 * sum((1 - r) ** 2 * tau * (r * tau) ** (2 * turn) for turn in range(200))
    found = slab_transmittance(n, absorption, thickness, angle_deg=angle_deg)
    assert found == pytest.approx(summed, rel=1e-12)


def test_a_slab_of_index_one_is_bouguer_and_beer_alone() -> None:
    absorption = -math.log(0.9)
    assert slab_transmittance(1.0, absorption, 3.0) == pytest.approx(0.729, rel=1e-14)


def test_nothing_polarised_in_the_plane_reflects_at_brewsters_angle() -> None:
    r_s, r_p = fresnel_reflectances(1.5, math.degrees(math.atan(1.5)))
    assert r_p == pytest.approx(0.0, abs=1e-30)
    assert r_s == pytest.approx(((1 - 1.5**2) / (1 + 1.5**2)) ** 2)


def test_both_polarisations_reflect_alike_at_normal_incidence() -> None:
    n = np.array([1.0, 1.33, 1.4915, 1.585])
    r_s, r_p = fresnel_reflectances(n, 0.0)
    np.testing.assert_allclose(r_s, normal_reflectance(n), atol=1e-16)
    np.testing.assert_allclose(r_p, normal_reflectance(n), atol=1e-16)


def test_matter_without_dispersion_has_an_infinite_abbe_number() -> None:
    assert abbe_number(lambda nm: np.full(np.shape(nm), 1.5)) == math.inf

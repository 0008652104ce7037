# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Dominant wavelength and CCT of a light that is known with an uncertainty."""

from __future__ import annotations

import numpy as np
import pytest

from lamplit.colour.hue import hue


def test_along_the_locus_the_wavelength_scatters_as_the_printed_locus_runs() -> None:
    """CIE 1931: x is 0.6658 at 610 nm, 0.6801 at 615, 0.6915 at 620: 389 nm for 1 in x."""
    sigma = 1e-3
    found = hue([0.6801, 0.3197], sigma**2 * np.array([[1.0, -1.0], [-1.0, 1.0]]))
    assert found.dominant_wavelength_nm == pytest.approx(615.0, abs=0.1)
    assert found.dominant_wavelength_standard_error_nm == pytest.approx(0.389, rel=0.05)


def test_towards_the_white_the_wavelength_does_not_scatter() -> None:
    """Saturation is not hue: along the line from the white the dominant wavelength is the same."""
    along = np.array([0.5, 0.45]) - 1.0 / 3.0
    found = hue([0.5, 0.45], 1e-6 * np.outer(along, along))
    assert found.dominant_wavelength_standard_error_nm < 2e-6


@pytest.mark.parametrize("xy", [(0.3804, 0.3768), (0.3451, 0.3516), (0.4369, 0.4041)])
def test_the_cct_and_its_error_are_those_of_mccamys_formula(xy: tuple[float, float]) -> None:
    """C. S. McCamy, Color Res. Appl. 17 (1992) 142: good to 10 K, its slope to 5 %."""

    def mccamy(x: float, y: float) -> float:
        n = (x - 0.3320) / (0.1858 - y)
        return 449.0 * n**3 + 3525.0 * n**2 + 6823.3 * n + 5520.33

    covariance = 1e-6 * np.array([[1.0, 0.3], [0.3, 0.5]])
    step = 1e-4
    slope = np.array(
        [
            mccamy(xy[0] + step, xy[1]) - mccamy(xy[0] - step, xy[1]),
            mccamy(xy[0], xy[1] + step) - mccamy(xy[0], xy[1] - step),
        ]
    ) / (2.0 * step)
    found = hue(xy, covariance)
    assert found.colour_temperature_k == pytest.approx(mccamy(*xy), rel=3e-3)
    expected = float(np.sqrt(slope @ covariance @ slope))
    assert found.colour_temperature_standard_error_k == pytest.approx(expected, rel=0.05)


def test_scattered_chromaticities_scatter_in_hue_as_the_delta_method_says() -> None:
    covariance = 1e-6 * np.array([[2.0, -1.5], [-1.5, 1.8]])
    draws = np.random.default_rng(4).multivariate_normal([0.58, 0.415], covariance, 1500)
    dominant = [hue(xy, covariance).dominant_wavelength_nm for xy in draws]
    found = hue([0.58, 0.415], covariance).dominant_wavelength_standard_error_nm
    assert np.std(dominant, ddof=1) == pytest.approx(found, rel=0.08)


def test_what_has_no_hue_gets_none() -> None:
    unknown = np.full((2, 2), np.nan)
    assert np.isnan(hue([1.0 / 3.0, 1.0 / 3.0], 1e-6 * np.eye(2))[:2]).all()
    assert np.isnan(hue([0.69, 0.305], 1e-6 * np.eye(2))[2:]).all()
    assert np.isnan(hue([np.nan, np.nan], unknown)).all()
    red = hue([0.69, 0.305], unknown)
    assert np.isfinite(red[0])
    assert np.isnan(red[1])
    purple = hue([0.35, 0.2], 1e-6 * np.eye(2))
    assert purple.dominant_wavelength_nm < 0.0 < purple.dominant_wavelength_standard_error_nm

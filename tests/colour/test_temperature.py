# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Correlated colour temperature, against colour-science and the illuminants' own definitions."""

from __future__ import annotations

import colour
import numpy as np
import pytest

from lamplit.colour.temperature import colour_temperature


@pytest.mark.parametrize("kelvin", [1500.0, 2856.0, 4000.0, 6504.0, 15_000.0])
@pytest.mark.parametrize("duv", [-0.03, -0.004, 0.0, 0.006, 0.04])
def test_it_agrees_with_ohnos_method(kelvin: float, duv: float) -> None:
    uv = colour.temperature.CCT_to_uv_Ohno2013([kelvin, duv])
    xy = colour.UCS_uv_to_xy(uv)
    found = colour_temperature(xy)
    assert found is not None
    assert found.kelvin == pytest.approx(kelvin, rel=2e-3)
    assert found.duv == pytest.approx(duv, abs=2e-5)


def test_illuminant_a_has_2856_kelvin_and_d65_6504() -> None:
    for name, kelvin in (("A", 2856.0), ("D65", 6504.0)):
        xy = colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"][name]
        found = colour_temperature(xy)
        assert found is not None
        assert found.kelvin == pytest.approx(kelvin, abs=3.0)


def test_red_and_green_lights_have_none() -> None:
    assert colour_temperature([0.70, 0.299]) is None
    assert colour_temperature([0.25, 0.65]) is None
    assert colour_temperature([np.nan, np.nan]) is None

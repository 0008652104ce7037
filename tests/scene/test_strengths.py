# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The flux of an emission from a bulb's sheet, and from an LED's sheet and its heat."""

from __future__ import annotations

from pathlib import Path

import pytest

from lamplit.errors import LamplitError, SceneError
from lamplit.scene import parse_scene
from lamplit.scene.emission import ResolvedEmission

Table = dict[str, object]

LED: Table = {"led_peak_nm": 624, "led_fwhm_nm": 18, "junction_temperature_celsius": 85.0}


def emission_of(emission: Table, root: Path, **more: object) -> ResolvedEmission:
    written: Table = {
        "lamplit": 1,
        "camera": {"kind": "pinhole", "position_mm": [3, 4, 400], "target_mm": [0, 0, 0]},
        "objects": [
            {
                "name": "ball",
                "kind": "sphere",
                "centre_mm": [0, 0, 0],
                "radius_mm": 10.0,
                "material": "grey-18",
                "emission": emission,
            }
        ],
    }
    (ball,) = parse_scene(written | more, root=root).resolved_objects()
    assert ball.emission is not None
    return ball.emission


@pytest.mark.parametrize(("name", "flux_lm"), [("p21w", 460.0), ("p21-5w-dim", 35.0)])
def test_a_bulb_gives_the_flux_of_its_sheet(name: str, flux_lm: float, tmp_path: Path) -> None:
    found = emission_of({"source": "A", "bulb": name}, tmp_path)
    assert (found.quantity, found.amount) == ("flux_lm", flux_lm)


def test_a_hot_led_has_the_share_of_its_cold_flux_that_the_eye_keeps(tmp_path: Path) -> None:
    """FACTS §3: 233 lm/W at 25 °C, 174 lm/W at 85 °C: 100 lm become 74.7 lm."""
    for source, more in ((LED, {}), ("die", {"sources": {"die": LED}})):
        found = emission_of({"source": source, "flux_lm_at_25_celsius": 100.0}, tmp_path, **more)
        assert found.quantity == "flux_lm"
        assert found.amount == pytest.approx(100.0 * 174.0 / 233.0, abs=0.3)


def test_a_drop_of_the_radiant_flux_comes_on_top(tmp_path: Path) -> None:
    """0.3 % a kelvin over 60 K: 82 % of what the eye keeps."""
    drops = LED | {"radiant_drop_per_kelvin": 0.003}
    plain = emission_of({"source": LED, "flux_lm_at_25_celsius": 100.0}, tmp_path)
    found = emission_of({"source": drops, "flux_lm_at_25_celsius": 100.0}, tmp_path)
    assert found.amount == pytest.approx(0.82 * plain.amount)


def test_a_cold_led_keeps_its_flux(tmp_path: Path) -> None:
    cold = {"led_peak_nm": 624, "led_fwhm_nm": 18}
    found = emission_of({"source": cold, "flux_lm_at_25_celsius": 100.0}, tmp_path)
    assert found.amount == 100.0


@pytest.mark.parametrize("source", ["red-led-624", {"temperature_kelvin": 2856}])
def test_only_an_led_has_a_cold_flux(source: object, tmp_path: Path) -> None:
    with pytest.raises(
        SceneError, match=r"objects\[0\].emission.flux_lm_at_25_celsius: .* LED|led"
    ):
        emission_of({"source": source, "flux_lm_at_25_celsius": 100.0}, tmp_path)


@pytest.mark.parametrize(
    ("emission", "says"),
    [
        ({"source": "A", "bulb": "p21w", "flux_lm": 5.0}, "flux_lm and bulb are given"),
        ({"source": "A", "bulb": "p22w"}, "'p21w'"),
        ({"bulb": "p21w"}, "a source with a strength is needed"),
        ({"source": LED, "flux_lm_at_25_celsius": -1.0}, "0"),
    ],
)
def test_a_strength_that_does_not_fit_is_refused(
    emission: Table, says: str, tmp_path: Path
) -> None:
    with pytest.raises(LamplitError, match=says) as fault:
        emission_of(emission, tmp_path)
    assert "emission" in str(fault.value)
    assert "\n" not in str(fault.value)

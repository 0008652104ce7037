# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Materials as a scene writes them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from lamplit.materials import Checker, Conductor, Dielectric, Glossy, Material
from lamplit.materials.appearance import surface_reflectance

_ADAPTER = TypeAdapter[Material](Material)
_GLASS: dict[str, Any] = {"kind": "dielectric", "refractive_index": 1.5}
_MATT: dict[str, Any] = {"kind": "diffuse", "reflectance": 0.5}


def parsed(written: dict[str, Any]) -> Material:
    return _ADAPTER.validate_python(written)


def test_a_dielectric_without_transmittance_is_perfectly_clear() -> None:
    glass = parsed(_GLASS)
    assert isinstance(glass, Dielectric)
    nm = np.linspace(380, 780, 16).reshape(4, 4)
    assert np.array_equal(glass.absorption_per_mm(nm), np.zeros((4, 4)))
    assert np.array_equal(glass.transmittance(nm, 1e6), np.ones((4, 4)))


def test_a_dielectric_of_0_9_per_millimetre_lets_0_729_through_three() -> None:
    lens = parsed({**_GLASS, "internal_transmittance": {"thickness_mm": 1.0, "value": 0.9}})
    assert isinstance(lens, Dielectric)
    absorption = lens.absorption_per_mm(np.arange(380.0, 781.0))
    np.testing.assert_allclose(np.exp(-3.0 * absorption), 0.729, atol=1e-12)


def test_a_conductors_factor_scales_its_reflectance() -> None:
    metal = {"kind": "conductor", "refractive_index": {"n": 1.0, "k": 6.0}}
    bare, lacquered = parsed(metal), parsed({**metal, "factor": 0.92})
    assert isinstance(lacquered, Conductor)
    assert float(surface_reflectance(bare, 550.0)) == pytest.approx(0.9, rel=1e-12)
    assert float(surface_reflectance(lacquered, 550.0)) == pytest.approx(0.828, rel=1e-12)


def test_a_glossy_body_adds_its_base_to_fresnels_gloss() -> None:
    body = parsed({"kind": "glossy", "refractive_index": 1.5, "reflectance": 0.5})
    assert isinstance(body, Glossy)
    assert float(surface_reflectance(body, 550.0)) == pytest.approx(0.04 + 0.96**2 * 0.5)


def test_a_checker_has_two_reflectances() -> None:
    floor = parsed(
        {"kind": "checker", "reflectance_a": 0.8, "reflectance_b": 0.2, "square_mm": 20.0}
    )
    assert isinstance(floor, Checker)
    assert float(floor.reflectance_a_at(550.0)) == 0.8
    assert float(floor.reflectance_b_at(550.0)) == 0.2


@pytest.mark.parametrize(("written", "exponent"), [(_GLASS, 60.0), (_MATT, 1.0)])
def test_the_highlight_exponent_follows_the_kind_unless_stated(
    written: dict[str, Any], exponent: float
) -> None:
    assert parsed(written).hall_terms().highlight_exponent == exponent
    assert parsed({**written, "hall": {"k_sr": 0.5}}).hall_terms().highlight_exponent == exponent
    stated = parsed({**written, "hall": {"highlight_exponent": 7.0}}).hall_terms()
    assert stated.highlight_exponent == 7.0


def test_the_boundary_values_0_and_1_are_reflectances() -> None:
    for value in (0.0, 1.0):
        matt = parsed({**_MATT, "reflectance": value})
        assert float(surface_reflectance(matt, 550.0)) == value


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ({"kind": "glass"}, "does not match any of the expected tags"),
        ({"refractive_index": 1.5}, "Unable to extract tag"),
        ({**_GLASS, "refractive_indx": 1.5}, "refractive_indx"),
        ({**_GLASS, "reflectance": 0.5}, "reflectance"),
        ({**_MATT, "reflectance": 1.01}, "above 1"),
        ({**_MATT, "reflectance": -0.01}, "below 0"),
        ({**_MATT, "reflectance": "0.5"}, "a spectrum is"),
        ({**_MATT, "hall": {"k_sr": -1.0}}, "greater than or equal to 0"),
        ({**_MATT, "hall": {"k_sr": float("inf")}}, "finite"),
        ({**_MATT, "hall": {"highlight_exponent": 0.0}}, "greater than 0"),
        ({**_MATT, "hall": {"k_s": 1.0}}, "k_s"),
        ({**_MATT, "hall": {"ambient_reflectance": 2.0}}, "above 1"),
        (
            {"kind": "conductor", "refractive_index": {"n": 1.0, "k": 6.0}, "factor": 1.2},
            "less than or equal to 1",
        ),
        (
            {"kind": "checker", "reflectance_a": 0.8, "reflectance_b": 0.2, "square_mm": 0.0},
            "greater than 0",
        ),
    ],
)
def test_a_material_that_cannot_be_is_refused(written: dict[str, Any], said: str) -> None:
    with pytest.raises(ValidationError, match=said):
        parsed(written)


def test_a_material_cannot_be_changed() -> None:
    with pytest.raises(ValidationError, match="frozen"):
        parsed(_MATT).licence = "mine"  # type: ignore[misc]

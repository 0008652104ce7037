# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The refractive index in every form that a file may have."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from lamplit.errors import SpectrumError
from lamplit.materials.index_spec import AnyComplexIndex, AnyIndex, ComplexIndexSpec, IndexSpec

_CLEAR = TypeAdapter[AnyIndex](IndexSpec)
_METAL = TypeAdapter[AnyComplexIndex](ComplexIndexSpec)

CROWN_B = [1.03961212, 0.231792344, 1.01046945]
CROWN_C = [0.00600069867, 0.0200179144, 103.560653]


def index(written: object, nm: float) -> float:
    return float(_CLEAR.validate_python(written).index()(nm))


def test_a_bare_number_is_the_index_at_every_wavelength() -> None:
    assert index(1.49, 200.0) == index(1.49, 5000.0) == 1.49


def test_cauchys_coefficients_go_with_even_negative_powers() -> None:
    found = index({"cauchy": [1.48, 0.004, 0.0001]}, 500.0)
    assert found == pytest.approx(1.48 + 0.004 / 0.25 + 0.0001 / 0.0625, rel=1e-14)


def test_sellmeiers_terms_pair_each_b_with_its_c() -> None:
    written = {"sellmeier_b": CROWN_B, "sellmeier_c_um2": CROWN_C}
    assert index(written, 587.5618) == pytest.approx(1.51680, abs=5.1e-6)


def test_a_numbered_formula_takes_the_databases_coefficients() -> None:
    pairs = [number for pair in zip(CROWN_B, CROWN_C, strict=True) for number in pair]
    written = {"formula": 2, "coefficients": [0, *pairs]}
    assert index(written, 486.1327) == pytest.approx(1.52238, abs=5.1e-6)


def test_a_table_is_joined_by_straight_lines_unless_it_says_cubic() -> None:
    written = {"wavelengths_nm": [400, 500, 600], "n": [1.52, 1.50, 1.49]}
    assert index(written, 450.0) == pytest.approx(1.51)
    assert 1.50 < index({**written, "interpolation": "cubic"}, 450.0) < 1.51


def test_outside_its_range_a_formula_raises_holds_or_goes_on_as_it_says() -> None:
    written = {"cauchy": [1.48, 0.004], "range_nm": [420, 700]}
    with pytest.raises(SpectrumError, match="from 420 to 700 nm, and 400 nm is asked"):
        index(written, 400.0)
    assert index({**written, "extension": "constant"}, 400.0) == index(written, 420.0)
    on = index({**written, "extension": "formula"}, 400.0)
    assert on == pytest.approx(1.48 + 0.004 / 0.16, rel=1e-14)


def test_a_page_of_refractiveindex_info_is_read_below_the_scenes_folder(tmp_path: Path) -> None:
    (tmp_path / "pmma.yml").write_text(
        "DATA:\n  - type: formula 2\n    wavelength_range: 0.4047 1.083\n"
        "    coefficients: 0 0.99654 0.00787 0.18964 0.02191 0.00411 3.85727\n"
    )
    context = {"root": tmp_path}
    spec = _CLEAR.validate_python({"refractiveindex_info": "pmma.yml"}, context=context)
    assert float(spec.index()(587.5618)) == pytest.approx(1.4906, abs=5e-5)
    with pytest.raises(ValidationError, match="leads out of the scene's folder"):
        _CLEAR.validate_python({"refractiveindex_info": "../pmma.yml"}, context=context)
    with pytest.raises(ValidationError, match="holds no k"):
        _METAL.validate_python({"refractiveindex_info": "pmma.yml"}, context=context)


def test_a_metal_has_n_and_k() -> None:
    table = {"wavelengths_nm": [500, 600], "n": [0.8, 1.2], "k": [6.0, 7.0]}
    for written in ({"n": 1.0, "k": 6.5}, table):
        spec = _METAL.validate_python(written)
        assert float(spec.index()(550.0)) == pytest.approx(1.0)
        assert float(spec.extinction()(550.0)) == pytest.approx(6.5)


@pytest.mark.parametrize(
    ("written", "said"),
    [
        (0.9, "n is 0.9 at 380 nm, and 1 to 5"),
        (float("nan"), "finite"),
        ("1.49", "a refractive index is a number"),
        (True, "a refractive index is a number"),
        ({}, "a refractive index is a number"),
        ({"glass": "BK7"}, "a refractive index is a number"),
        ({"caucy": [1.48]}, "cauchy"),
        ({"cauchy": []}, "at least 1"),
        ({"cauchy": [1.48, float("inf")]}, "finite"),
        ({"cauchy": [0.004, 1.48]}, "n is"),
        ({"cauchy": [1.48], "range_nm": [700, 420]}, "rises from a positive"),
        ({"cauchy": [1.48], "extension": "zero"}, "'error', 'constant' or 'formula'"),
        ({"sellmeier_b": CROWN_B, "sellmeier_c_um2": [0.01]}, "each B needs its C"),
        ({"sellmeier_b": [1.0], "sellmeier_c_um2": [0.25]}, "at 380 nm"),
        ({"formula": 10, "coefficients": [1.5]}, "less than or equal to 9"),
        ({"formula": 8, "coefficients": [1.5]}, "takes 4 coefficients"),
        ({"formula": 3, "coefficients": [-2.0]}, "no real number at 380 nm"),
        ({"wavelengths_nm": [500, 400], "n": [1.5, 1.5]}, "must rise"),
        ({"wavelengths_nm": [0.4, 0.7], "n": [1.5, 1.5]}, "times 1000"),
        ({"wavelengths_nm": [400, 700], "n": [1.5, 1.5, 1.5]}, "2 wavelengths and 3 values"),
        ({"wavelengths_nm": [400, 410, 420, 600], "n": [1.5] * 4}, "between 420 and 600 nm"),
        ({"wavelengths_nm": [400, 700], "n": [1.5, 0.5]}, "n is 0.99"),
        ({"refractiveindex_info": "x.yml"}, "no folder is given"),
    ],
)
def test_an_index_that_cannot_be_is_refused(written: object, said: str) -> None:
    with pytest.raises(ValidationError, match=said):
        _CLEAR.validate_python(written)


@pytest.mark.parametrize(
    ("written", "said"),
    [
        (1.5, "a metal's index is"),
        ({"n": 1.0}, "k"),
        ({"n": 1.0, "k": -6.0}, "greater than or equal to 0"),
        ({"wavelengths_nm": [500, 600], "n": [1.0, 1.0], "k": [6.0, -7.0]}, "k is -"),
        ({"wavelengths_nm": [500, 600], "n": [1.0, 1.0], "k": [6.0]}, "2 wavelengths and 1 values"),
    ],
)
def test_a_metals_index_that_cannot_be_is_refused(written: object, said: str) -> None:
    with pytest.raises(ValidationError, match=said):
        _METAL.validate_python(written)


def test_a_formula_fitted_in_the_infrared_alone_is_no_fault_until_it_is_asked() -> None:
    written = {
        "formula": 7,
        "coefficients": [3.41983, 0.159906, -0.123109],
        "range_nm": [2437, 25000],
    }
    assert index(written, 10000.0) == pytest.approx(3.4214, abs=1e-4)
    with pytest.raises(SpectrumError, match="2437 to 25000 nm"):
        index(written, 550.0)


def test_an_index_has_the_shape_of_its_wavelengths() -> None:
    nm = np.full((4, 16), 550.0)
    for written in (1.5, {"cauchy": [1.5]}, {"formula": 5, "coefficients": [1.5, 0.01, -2]}):
        assert _CLEAR.validate_python(written).index()(nm).shape == (4, 16)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Internal transmittance: Bouguer–Beer's law from every form that a file may have."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from lamplit.errors import SpectrumError
from lamplit.materials.optics import slab_transmittance
from lamplit.materials.transmittance import AnyTransmittance, TransmittanceSpec

_ADAPTER = TypeAdapter[AnyTransmittance](TransmittanceSpec)


def parsed(written: dict[str, Any], root: Path | None = None) -> AnyTransmittance:
    return _ADAPTER.validate_python(written, context={"root": root} if root else None)


def test_nine_tenths_at_one_millimetre_are_0_729_at_three() -> None:
    spec = parsed({"thickness_mm": 1.0, "value": 0.9})
    assert spec.transmittance(550.0, 3.0) == pytest.approx(0.729, abs=1e-12)


@pytest.mark.parametrize("thickness_mm", [0.0, 0.01, 1.0, 2.5, 3.0, 7.25, 40.0])
def test_any_thickness_is_the_power_of_the_measured_one(thickness_mm: float) -> None:
    written = {"thickness_mm": 3.0, "wavelengths_nm": [380, 580, 780], "values": [0.02, 0.5, 1.0]}
    spec = parsed({**written, "interpolation": "linear"})
    nm = np.array([380.0, 480.0, 580.0, 700.0, 780.0])
    t = np.array([0.02, 0.26, 0.5, 0.8, 1.0])
    np.testing.assert_allclose(
        spec.transmittance(nm, thickness_mm), t ** (thickness_mm / 3.0), rtol=1e-12
    )


def test_two_plates_let_through_the_product() -> None:
    spec = parsed({"dye": {"lambda50_nm": 612.0, "width_nm": 15.0}})
    nm = np.arange(380.0, 781.0)
    np.testing.assert_allclose(
        spec.transmittance(nm, 1.2) * spec.transmittance(nm, 1.8),
        spec.transmittance(nm, 3.0),
        rtol=1e-12,
    )


def test_a_dye_lets_half_through_at_its_wavelength_and_thickness() -> None:
    dye = {"lambda50_nm": 551.0, "width_nm": 11.0, "thickness_mm": 3.0, "floor_per_mm": 0.0}
    assert parsed({"dye": dye}).transmittance(551.0, 3.0) == pytest.approx(0.5, rel=1e-14)


def test_a_dye_is_capped_below_its_edge_and_rests_on_its_floor_above() -> None:
    dye = {"lambda50_nm": 612.0, "width_nm": 15.0, "cap_per_mm": 5.0, "floor_per_mm": 0.0017}
    absorption = parsed({"dye": dye}).absorption_per_mm([380.0, 2000.0])
    np.testing.assert_allclose(absorption, [5.0017, 0.0017], rtol=1e-12)


def test_the_dye_model_follows_a_measured_red_sheet() -> None:
    # Signal red PMMA sheet of 3 mm, total transmittance as measured ("Cherry", CRAN
    # photobiologyFilters 0.6.0); the model's 50 % wavelength and width were fitted to it.
    nm = np.array([540, 560, 580, 600, 620, 640, 660, 700], dtype=float)
    measured = [0.000, 0.001, 0.001, 0.029, 0.246, 0.600, 0.816, 0.916]
    spec = parsed({"dye": {"lambda50_nm": 631.1, "width_nm": 17.7}})
    total = slab_transmittance(1.49, spec.absorption_per_mm(nm), 3.0)
    np.testing.assert_allclose(total, measured, atol=0.02)


def test_an_extinction_coefficient_absorbs_four_pi_k_over_lambda() -> None:
    spec = parsed({"wavelengths_nm": [400, 410], "k": [1.12e-5, 1.12e-5]})
    assert spec.absorption_per_mm(400.0) == pytest.approx(4 * np.pi * 1.12e-5 / 400e-6)


def test_a_text_file_gives_the_same_as_its_numbers(tmp_path: Path) -> None:
    (tmp_path / "red.csv").write_text("nm, percent\n600, 20\n610, 50\n620, 80\n")
    spec = parsed({"thickness_mm": 2.0, "csv": "red.csv", "scale": 0.01}, tmp_path)
    np.testing.assert_allclose(spec.transmittance([600, 610, 620], 4.0), [0.04, 0.25, 0.64])


def test_a_page_of_refractiveindex_info_gives_its_k(tmp_path: Path) -> None:
    (tmp_path / "page.yml").write_text(
        "DATA:\n  - type: tabulated nk\n    data: |\n"
        "        0.40 1.50 2.0E-7\n        0.80 1.48 2.0E-7\n"
    )
    spec = parsed({"refractiveindex_info": "page.yml"}, tmp_path)
    assert spec.absorption_per_mm(500.0) == pytest.approx(4 * np.pi * 2e-7 / 500e-6)


def test_a_page_without_k_is_refused(tmp_path: Path) -> None:
    (tmp_path / "n.yml").write_text(
        "DATA:\n  - type: formula 5\n    wavelength_range: 0.3 1\n    coefficients: 1.5\n"
    )
    with pytest.raises(ValidationError, match="holds no k"):
        parsed({"refractiveindex_info": "n.yml"}, tmp_path)


def test_outside_its_table_a_transmittance_is_an_error_unless_it_says_how_to_go_on() -> None:
    written = {"thickness_mm": 1.0, "wavelengths_nm": [400, 410], "values": [0.5, 0.25]}
    with pytest.raises(SpectrumError, match="from 400 to 410 nm, and 420 nm"):
        parsed(written).absorption_per_mm(420.0)
    held = parsed({**written, "extension": "constant"})
    assert held.transmittance(420.0, 1.0) == pytest.approx(0.25)


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ({"thickness_mm": 1.0, "value": 0.0}, "smallest value that was measured"),
        ({"thickness_mm": 1.0, "value": 1.2}, "at most 1, and 1.2"),
        ({"thickness_mm": 1.0, "value": -0.1}, "above 0, and -0.1"),
        ({"thickness_mm": 1.0, "value": float("nan")}, "finite"),
        ({"thickness_mm": -3.0, "value": 0.9}, "greater than 0"),
        ({"thickness_mm": 0.0, "value": 0.9}, "greater than 0"),
        ({"thickness_mm": float("inf"), "value": 0.9}, "finite"),
        ({"thickness_cm": 1.0, "value": 0.9}, "thickness_cm"),
        ({"value": 0.9}, "thickness_mm"),
        (
            {"thickness_mm": 3.0, "wavelengths_nm": [400, 410], "values": [50, 92]},
            "add scale = 0.01",
        ),
        (
            {"thickness_mm": 3.0, "wavelengths_nm": [400, 410], "values": [0.0, 0.92]},
            "exactly 0",
        ),
        (
            {"thickness_mm": 3.0, "wavelengths_nm": [410, 400], "values": [0.1, 0.92]},
            "must rise",
        ),
        (
            {
                "thickness_mm": 3.0,
                "wavelengths_nm": [400, 410],
                "values": [0.1, 0.92],
                "extension": "zero",
            },
            'use "constant"',
        ),
        ({"dye": {"lambda50_nm": 612.0, "width_nm": -1.0}}, "width_nm"),
        ({"dye": {"lambda50_nm": 612.0, "width_nm": 10.0, "thickness_mm": -1.0}}, "greater than 0"),
        ({"dye": {"lambda50_nm": 612.0, "width": 15.0}}, "dye.width"),
        ({"wavelengths_nm": [400, 410], "k": [1e-7, -1e-7]}, "k is 0 or more"),
        ({"wavelengths_nm": [400, 410], "k": [1e-7]}, "2 wavelengths and 1 values"),
        ({}, "an internal transmittance is"),
        ({"colour": "red"}, "an internal transmittance is"),
    ],
)
def test_a_transmittance_that_cannot_be_is_refused(written: dict[str, Any], said: str) -> None:
    with pytest.raises(ValidationError, match=said):
        parsed(written)

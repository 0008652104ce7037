# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The library's materials against the numbers that their sources print."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from lamplit.colour.tristimulus import chromaticity_xy
from lamplit.errors import SceneError
from lamplit.materials import Conductor, Dielectric, material, material_names
from lamplit.materials.appearance import (
    VISIBLE_NM,
    plate_transmittance,
    seen_xyz,
    surface_reflectance,
)
from lamplit.materials.optics import (
    LINE_C_NM,
    LINE_D_NM,
    LINE_F_NM,
    abbe_number,
    normal_reflectance,
)

PROMISED = (
    *("pmma-clear", "red-pmma", "amber-pmma", "smoke-pmma"),
    *("pc-clear", "red-pc", "amber-pc", "smoke-pc"),
    *("bk7", "aluminium", "aluminium-bezel", "black-abs", "white-diffuser"),
)


def plastic(name: str) -> Dielectric:
    found = material(name)
    assert isinstance(found, Dielectric)
    return found


def under_a(name: str, thickness_mm: float) -> tuple[float, float, float]:
    """Return x, y and Y of a plate under illuminant A."""
    xyz = seen_xyz(plate_transmittance(plastic(name), VISIBLE_NM, thickness_mm), "A")
    x, y = chromaticity_xy(xyz)
    return float(x), float(y), float(xyz[1])


def test_the_library_has_what_it_promises() -> None:
    assert set(PROMISED) <= set(material_names())


@pytest.mark.parametrize("name", material_names())
def test_every_material_says_what_it_is_and_covers_the_working_range(name: str) -> None:
    found = material(name)
    assert found.description
    assert found.references
    assert found.licence
    reflectance = surface_reflectance(found, VISIBLE_NM)
    assert ((reflectance >= 0) & (reflectance <= 1)).all()
    if isinstance(found, Dielectric):
        through = found.transmittance(VISIBLE_NM, 3.0)
        assert ((through > 0) & (through <= 1)).all()


@pytest.mark.parametrize(
    "name", [n for n in material_names() if n.startswith(("red", "amber", "smoke"))]
)
def test_a_dyed_plastic_says_plainly_that_it_is_a_model(name: str) -> None:
    assert "Generic" in material(name).description
    assert any("not a supplier's grade" in text for text in material(name).references)


@pytest.mark.parametrize(
    ("name", "lines", "r_0", "v_d"),
    [
        ("pmma-clear", (1.4984, 1.4925, 1.4901), 0.0390, 59.37),
        ("pc-clear", (1.5996, 1.5848, 1.5786), 0.0512, 27.86),
        ("bk7", (1.5224, 1.5168, 1.5143), 0.0422, 64.17),
    ],
)
def test_an_index_has_its_published_values(
    name: str, lines: tuple[float, ...], r_0: float, v_d: float
) -> None:
    # refractiveindex.info: Beadie 2015, Sultanova 2009, N-BK7 catalogue.
    found = plastic(name)
    index = found.index([LINE_F_NM, LINE_D_NM, LINE_C_NM])
    np.testing.assert_allclose(index, lines, atol=5e-5)
    assert float(normal_reflectance(index[1])) == pytest.approx(r_0, abs=5e-5)
    assert abbe_number(found.index) == pytest.approx(v_d, abs=5e-3)


def test_beyond_its_measurement_pmma_agrees_with_another_laboratory() -> None:
    # X. Zhang et al., Appl. Opt. 59, 2337 (2020): n(400 nm) = 1.50818, another maker's PMMA.
    assert float(plastic("pmma-clear").index(400.0)) == pytest.approx(1.508, abs=1.5e-3)


@pytest.mark.parametrize(
    ("name", "per_mm"),
    [("pmma-clear", (0.993, 0.996, 0.997)), ("pc-clear", (0.70, 0.991, 0.995))],
)
def test_a_clear_plastic_has_zhangs_transmittance(name: str, per_mm: tuple[float, ...]) -> None:
    found = plastic(name).transmittance([400.0, 550.0, 650.0], 1.0)
    np.testing.assert_allclose(found, per_mm, atol=5e-3 if name == "pc-clear" else 5e-4)


def test_aluminium_reflects_what_rakic_tabulates() -> None:
    metal = material("aluminium")
    assert isinstance(metal, Conductor)
    assert float(metal.index(550.0)) == pytest.approx(1.015, abs=5e-4)
    assert float(metal.extinction(550.0)) == pytest.approx(6.627, abs=5e-4)
    found = surface_reflectance(metal, [450.0, 550.0, 650.0])
    np.testing.assert_allclose(found, [0.922, 0.915, 0.906], atol=5e-4)


def test_a_lacquered_bezel_reflects_within_what_production_gives() -> None:
    found = surface_reflectance(material("aluminium-bezel"), VISIBLE_NM)
    assert ((found > 0.80) & (found < 0.88)).all()


@pytest.mark.parametrize("name", ["red-pmma", "red-pc"])
def test_a_red_lens_under_a_filament_lamp_lies_in_un_red(name: str) -> None:
    x, y, luminous = under_a(name, 2.5)
    assert (x, y) == pytest.approx((0.693, 0.307), abs=5e-4)
    assert luminous == pytest.approx(17.0, abs=0.5)
    # UN R48 2.29: y <= 0.335 and y >= 0.980 - x; x + y < 1 holds for every spectral light.
    assert 0.980 - x <= y <= 0.335
    assert x + y < 1.0


@pytest.mark.parametrize("name", ["amber-pmma", "amber-pc"])
def test_an_amber_lens_under_a_filament_lamp_lies_in_un_amber(name: str) -> None:
    x, y, _ = under_a(name, 2.5)
    assert (x, y) == pytest.approx((0.586, 0.413), abs=5e-4)
    # UN R48 2.29: y <= x - 0.120, y >= 0.390, y >= 0.790 - 0.670 x.
    assert max(0.390, 0.790 - 0.670 * x) <= y <= x - 0.120


def test_a_thicker_red_lens_is_deeper_red_and_darker() -> None:
    plates = [under_a("red-pmma", thickness) for thickness in (1.0, 2.0, 3.0, 5.0, 10.0)]
    assert all(thin[0] < thick[0] for thin, thick in pairwise(plates))
    assert all(thin[2] > thick[2] for thin, thick in pairwise(plates))


def test_a_smoke_lens_is_grey_with_forty_percent_in_three_millimetres() -> None:
    found = plastic("smoke-pmma").transmittance([380.0, 550.0, 640.0], 3.0)
    np.testing.assert_allclose(found, 0.40, rtol=1e-12)
    x, y, _ = under_a("smoke-pmma", 3.0)
    assert (x, y) == pytest.approx((0.4476, 0.4074), abs=2e-3)


def test_black_abs_gives_back_a_few_percent() -> None:
    found = surface_reflectance(material("black-abs"), VISIBLE_NM)
    assert ((found > 0.04) & (found <= 0.05)).all()


def test_a_misspelt_name_gets_the_nearest() -> None:
    with pytest.raises(SceneError, match="no material 'red-pma'; did you mean 'red-pmma'"):
        material("red-pma")


@pytest.mark.parametrize("name", ["", "../pmma-clear", "library/bk7", "/etc/passwd"])
def test_a_name_is_never_a_path(name: str) -> None:
    with pytest.raises(SceneError, match="the library has no material"):
        material(name)

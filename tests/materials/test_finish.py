# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Roughness, textures, lacquers, scattering, and sheets that light comes through."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from lamplit.errors import SceneError
from lamplit.materials import (
    Conductor,
    Dielectric,
    DiffuseTransmitter,
    Material,
    Mirror,
    material,
    material_names,
)
from lamplit.materials.appearance import surface_reflectance
from lamplit.materials.optics import lacquered_reflectance, normal_reflectance
from lamplit.scene import Scene, parse_scene

_ADAPTER = TypeAdapter[Material](Material)
_GLASS: dict[str, Any] = {"kind": "dielectric", "refractive_index": 1.5}
_METAL: dict[str, Any] = {"kind": "conductor", "refractive_index": {"n": 1.0, "k": 6.0}}
_MIRROR: dict[str, Any] = {"kind": "mirror", "reflectance": 0.9}
_GLOSSY: dict[str, Any] = {"kind": "glossy", "refractive_index": 1.5, "reflectance": 0.5}
_SHEET: dict[str, Any] = {"kind": "diffuse-transmitter", "reflectance": 0.4}
_NM = np.array([400.0, 550.0, 700.0])


def parsed(written: dict[str, Any]) -> Material:
    return _ADAPTER.validate_python(written)


@pytest.mark.parametrize("written", [_GLASS, _METAL, _MIRROR, _GLOSSY])
@pytest.mark.parametrize("roughness", [0, 0.001, 0.3, 1.0])
def test_four_kinds_can_be_rough(written: dict[str, Any], roughness: float) -> None:
    assert getattr(parsed({**written, "roughness": roughness}), "roughness", None) == roughness
    assert getattr(parsed(written), "roughness", None) == 0.0


def test_a_texture_is_the_front_within_80_degrees_unless_told() -> None:
    glass = parsed({**_GLASS, "roughness": 0.2, "texture": {}})
    assert isinstance(glass, Dielectric)
    assert glass.texture is not None
    assert (glass.texture.facing, glass.texture.within_deg) == ((0.0, 0.0, 1.0), 80.0)


def test_the_library_is_smooth() -> None:
    rough = [name for name in material_names() if getattr(material(name), "roughness", 0.0)]
    assert rough == []


def test_scattering_is_a_number_or_a_spectrum() -> None:
    even = parsed({**_GLASS, "scattering": {"coefficient_per_mm": 2.5, "anisotropy": -0.3}})
    assert isinstance(even, Dielectric)
    assert even.scattering is not None
    assert even.scattering.anisotropy == -0.3
    np.testing.assert_array_equal(even.scattering.per_mm(_NM), [2.5, 2.5, 2.5])
    table = {"wavelengths_nm": [400, 700], "values": [8, 2], "interpolation": "linear"}
    coloured = parsed({**_GLASS, "scattering": {"coefficient_per_mm": table}})
    assert isinstance(coloured, Dielectric)
    assert coloured.scattering is not None
    np.testing.assert_allclose(coloured.scattering.per_mm(_NM), [8.0, 5.0, 2.0], rtol=1e-14)


def test_a_lacquers_optical_depth_is_that_of_its_thickness() -> None:
    dyed = {"thickness_mm": 0.1, "value": 0.5}
    coat = {"refractive_index": 1.5, "thickness_um": 25.0, "internal_transmittance": dyed}
    metal = parsed({**_METAL, "lacquer": coat})
    assert isinstance(metal, Conductor)
    assert metal.lacquer is not None
    np.testing.assert_allclose(metal.lacquer.optical_depth(_NM), np.log(2.0) / 4.0, rtol=1e-14)
    np.testing.assert_array_equal(metal.lacquer.index(_NM), 1.5)
    clear = parsed({**_METAL, "lacquer": {"refractive_index": 1.5, "thickness_um": 25.0}})
    assert isinstance(clear, Conductor)
    assert clear.lacquer is not None
    np.testing.assert_array_equal(clear.lacquer.optical_depth(_NM), 0.0)


def test_a_lacquered_metal_sums_its_inter_reflections() -> None:
    """The series F + (1 − F)² M τ² Σ (F M τ²)^i, summed term by term, against the closed form."""
    n, k, coat, depth, factor = 1.0, 6.0, 1.5, 0.2, 0.95
    f, m = 0.04, factor * float(normal_reflectance(n / coat, k / coat))
    once = m * np.exp(-2.0 * depth)
    series = f + (1 - f) ** 2 * once * sum((f * once) ** i for i in range(60))
    closed = float(lacquered_reflectance(coat, n, k, depth, factor=factor))
    assert closed == pytest.approx(series, rel=1e-14)
    lacquer = {
        "refractive_index": coat,
        "thickness_um": 1000.0,
        "internal_transmittance": {"thickness_mm": 1.0, "value": float(np.exp(-depth))},
    }
    metal = parsed({**_METAL, "factor": factor, "lacquer": lacquer})
    assert float(surface_reflectance(metal, 550.0)) == pytest.approx(series, rel=1e-12)


def test_a_coat_of_airs_index_is_the_bare_metal() -> None:
    bare = float(normal_reflectance(1.3, 7.0))
    assert float(lacquered_reflectance(1.0, 1.3, 7.0, 0.0)) == pytest.approx(bare, rel=1e-14)


def test_a_sheet_gives_back_and_lets_through() -> None:
    sheet = parsed({**_SHEET, "transmittance": 0.6})
    assert isinstance(sheet, DiffuseTransmitter)
    assert float(sheet.reflectance_at(550.0)) == 0.4
    assert float(sheet.transmittance_at(550.0)) == 0.6
    assert sheet.hall_terms().highlight_exponent == 1.0


def _table(*values: float, extension: str = "error") -> dict[str, Any]:
    nm = np.linspace(380.0, 780.0, len(values)).tolist()
    return {
        "wavelengths_nm": nm,
        "values": list(values),
        "interpolation": "linear",
        "extension": extension,
    }


def test_a_sheet_is_held_to_1_where_both_of_its_spectra_have_values() -> None:
    parsed({**_SHEET, "reflectance": _table(0.9, 0.1), "transmittance": _table(0.1, 0.9)})
    with pytest.raises(ValidationError, match=r"at most 1, and 1\.1 at 580 nm"):
        parsed({**_SHEET, "reflectance": _table(0.1, 0.6, 0.1), "transmittance": 0.5})
    far = {"wavelengths_nm": [900, 950], "values": [0.9, 0.9]}
    end = _table(0.1, 0.5, extension="constant")
    with pytest.raises(ValidationError, match=r"at most 1, and 1\.4"):
        parsed({**_SHEET, "reflectance": end, "transmittance": far})


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ({**_GLASS, "roughness": -0.1}, "greater than or equal to 0"),
        ({**_GLASS, "roughness": 1.1}, "less than or equal to 1"),
        ({**_GLASS, "roughness": 0.0005}, "0 .smooth. or 0.001 to 1, and 0.0005"),
        ({**_GLASS, "roughness": float("nan")}, "finite"),
        ({**_GLASS, "texture": {}}, "roughness says how much"),
        ({**_GLASS, "roughness": 0.1, "texture": {"within_deg": 0.0}}, "greater than 0"),
        ({**_GLASS, "roughness": 0.1, "texture": {"within_deg": 181}}, "less than or equal"),
        ({**_GLASS, "roughness": 0.1, "texture": {"facing": [0, 0, 0]}}, "length"),
        ({"kind": "diffuse", "reflectance": 0.5, "roughness": 0.1}, "roughness"),
        ({**_SHEET, "transmittance": 0.5, "roughness": 0.1}, "roughness"),
        ({**_SHEET, "transmittance": 0.61}, "together are at most 1, and 1.01"),
        (_SHEET, "transmittance"),
        ({**_GLASS, "scattering": {"coefficient_per_mm": -1.0}}, "below 0"),
        ({**_GLASS, "scattering": {}}, "coefficient_per_mm"),
        (
            {**_GLASS, "scattering": {"coefficient_per_mm": 1.0, "anisotropy": 1.0}},
            "less than 1",
        ),
        (
            {**_GLASS, "scattering": {"coefficient_per_mm": 1.0, "anisotropy": -1.0}},
            "greater than -1",
        ),
        ({**_MIRROR, "lacquer": {"refractive_index": 1.5, "thickness_um": 9}}, "lacquer"),
        ({**_METAL, "lacquer": {"refractive_index": 1.5}}, "thickness_um"),
        ({**_METAL, "lacquer": {"refractive_index": 0.5, "thickness_um": 9}}, "index n is 0.5"),
        ({**_METAL, "lacquer": {"refractive_index": 1.5, "thickness_um": 0}}, "greater than 0"),
    ],
)
def test_a_finish_that_cannot_be_is_refused(written: dict[str, Any], said: str) -> None:
    with pytest.raises(ValidationError, match=said):
        parsed(written)


def _scene(own: dict[str, Any], root: Any) -> Scene:
    ball = {"name": "ball", "kind": "sphere", "centre_mm": [0, 0, 0], "radius_mm": 10.0}
    camera = {"kind": "pinhole", "position_mm": [0, 0, 400], "target_mm": [0, 0, 0]}
    written: dict[str, Any] = {"lamplit": 1, "camera": camera, "materials": {"own": own}}
    return parse_scene(written | {"objects": [ball | {"material": "own"}]}, root=root)


def test_a_library_material_takes_the_scenes_finish(tmp_path: Any) -> None:
    texture = {"facing": [0, 0, -1], "within_deg": 30.0}
    own = {"library": "red-pmma", "roughness": 0.2, "texture": texture}
    found = _scene(own, tmp_path).resolve_material("own")
    assert isinstance(found, Dielectric)
    assert found.roughness == 0.2
    assert found.texture is not None
    assert found.texture.facing == (0.0, 0.0, -1.0)
    library = material("red-pmma")
    assert isinstance(library, Dielectric)
    assert (library.roughness, library.texture) == (0.0, None)


@pytest.mark.parametrize(
    ("own", "where", "said"),
    [
        ({"library": "white-paint", "roughness": 0.2}, "materials.own.roughness", "no roughness"),
        ({"library": "red-pmma", "texture": {}}, "materials.own", "give both"),
        ({"library": "red-pmma", "roughness": 2}, "materials.own.roughness", "less than"),
    ],
)
def test_a_finish_that_the_library_material_cannot_have_is_refused(
    own: dict[str, Any], where: str, said: str, tmp_path: Any
) -> None:
    with pytest.raises(SceneError, match=said) as caught:
        _scene(own, tmp_path)
    assert caught.value.where == where


@pytest.mark.parametrize(
    ("own", "where"),
    [
        (
            {**_GLASS, "scattering": {"coefficient_per_mm": _table(1, 1) | {"values": [1, 2]}}},
            "materials.own.scattering.coefficient_per_mm",
        ),
        ({**_SHEET, "transmittance": _table(0.1, 0.1)}, "materials.own.transmittance"),
        (
            {
                **_METAL,
                "lacquer": {
                    "refractive_index": {"wavelengths_nm": [380, 780], "n": [1.5, 1.5]}
                    | {"interpolation": "linear"},
                    "thickness_um": 9,
                },
            },
            "materials.own",
        ),
    ],
)
def test_spectra_of_a_finish_must_reach_over_the_picture(
    own: dict[str, Any], where: str, tmp_path: Any
) -> None:
    from lamplit.scene.spectra import spectral_faults

    scene = _scene(own, tmp_path)
    assert spectral_faults(scene) == []
    wider = scene.image.model_copy(update={"wavelength_range_nm": (380.0, 800.0)})
    (fault,) = spectral_faults(scene.changed(image=wider))
    assert fault.where == where
    assert "800" in fault.message


def test_a_mirror_keeps_its_keys_whatever_its_bases() -> None:
    mirror = parsed({**_MIRROR, "description": "chrome", "hall": {"k_sr": 0.5}})
    assert isinstance(mirror, Mirror)
    assert (mirror.description, mirror.hall_terms().highlight_exponent) == ("chrome", 60.0)

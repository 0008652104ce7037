# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Spectra as scene and library files write them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from lamplit.spectra_spec import FractionSpec, SourceSpec, SpectrumSpec

SPECTRUM: TypeAdapter[Any] = TypeAdapter(SpectrumSpec)
FRACTION: TypeAdapter[Any] = TypeAdapter(FractionSpec)
SOURCE: TypeAdapter[Any] = TypeAdapter(SourceSpec)

TM27 = (
    '<IESTM2714 xmlns="iestm2714"><SpectralDistribution>'
    '<SpectralData wavelength="400">0.25</SpectralData>'
    '<SpectralData wavelength="500">0.75</SpectralData>'
    "</SpectralDistribution></IESTM2714>"
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a scene's folder with one spectrum of each kind, and one file outside it."""
    scene = tmp_path / "scene"
    scene.mkdir()
    (scene / "half.csv").write_text("nm,T\n400,0.25\n500,0.75\n")
    (scene / "percent.csv").write_text("400,25\n500,75\n")
    (scene / "led.spdx").write_text(TM27)
    (tmp_path / "secret.csv").write_text("400,0.1\n500,0.2\n")
    (scene / "link.csv").symlink_to(tmp_path / "secret.csv")
    return scene


def _faults(adapter: TypeAdapter[Any], value: object, root: Path | None = None) -> str:
    with pytest.raises(ValidationError) as caught:
        adapter.validate_python(value, context={"root": root})
    errors = caught.value.errors()
    return "; ".join(f"{'.'.join(map(str, error['loc']))}: {error['msg']}" for error in errors)


@pytest.mark.parametrize(
    "value",
    [
        0.5,
        {"wavelengths_nm": [400, 500], "values": [0.25, 0.75]},
        {"wavelengths_nm": [400, 500], "values": [25, 75], "scale": 0.01},
        {"csv": "half.csv"},
        {"csv": "percent.csv", "scale": 0.01},
        {"spdx": "led.spdx", "interpolation": "cubic"},
    ],
)
def test_every_form_gives_its_function(value: object, folder: Path) -> None:
    for adapter in (SPECTRUM, FRACTION):
        spec = adapter.validate_python(value, context={"root": folder})
        assert spec.distribution()(450.0) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("value", "peak_nm"),
    [
        ({"led_peak_nm": 624, "led_fwhm_nm": 18}, 624.0),
        ({"led_peak_nm": 593.0, "led_fwhm_nm": 15, "model": "gaussian"}, 593.0),
        ({"temperature_kelvin": 5000}, 579.55),
        ({"wavelengths_nm": [400, 500], "values": [1, 9], "extension": "zero"}, 500.0),
    ],
)
def test_every_form_of_source_gives_its_function(value: object, peak_nm: float) -> None:
    nm = np.arange(380.0, 781.0, 0.05)
    spd = SOURCE.validate_python(value).distribution()
    assert nm[np.argmax(spd(nm))] == pytest.approx(peak_nm, abs=0.1)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (True, "a spectrum is a number"),
        ("D65", "a spectrum is a number"),
        ([1, 2], "a spectrum is a number"),
        ({}, "a spectrum is a number"),
        ({"temperature_kelvin": 2856}, "a spectrum is a number"),
        (float("nan"), "finite"),
        (float("inf"), "finite"),
        ({"wavelengths_nm": [400, 500], "values": [1, float("inf")]}, "values.1: .*finite"),
        ({"wavelengths_nm": [400, 500], "values": [1, "2"]}, "values.1: .*number"),
        ({"wavelengths_nm": [400, 500], "values": [1, True]}, "values.1: .*number"),
        ({"wavelengths_nm": [500, 400], "values": [1, 2]}, "400 nm follows 500 nm; sort"),
        ({"wavelengths_nm": [400, 500], "values": [1]}, "2 wavelengths and 1 values"),
        ({"wavelengths_nm": [], "values": []}, "empty"),
        ({"wavelengths_nm": [0.4, 0.5], "values": [1, 2]}, "micrometres"),
        ({"wavelengths_nm": [400, 410, 420, 500], "values": [1] * 4}, "between 420 and 500 nm"),
        ({"wavelengths_nm": [400, 500], "values": [1, 2], "scale": 0}, "greater than 0"),
        ({"wavelengths_nm": [400, 500], "values": [1, 2], "extension": "mirror"}, "extension"),
        ({"wavelenghts_nm": [400, 500], "values": [1, 2]}, "wavelenghts_nm: Extra inputs"),
        ({"csv": "half.csv", "spdx": "led.spdx"}, "Extra inputs"),
        ({"csv": "absent.csv"}, "'absent.csv' does not exist"),
        ({"csv": "../secret.csv"}, "leads out"),
        ({"csv": "link.csv"}, "leads out"),
        ({"csv": "/etc/passwd"}, "relative to the scene's folder"),
        ({"csv": "https://example.org/a.csv"}, "relative to the scene's folder"),
        ({"csv": 7}, "string"),
        ({"spdx": "half.csv"}, "half.csv: line 1: the XML is broken"),
        ({"csv": "led.spdx"}, "led.spdx"),
    ],
)
def test_a_wrong_spectrum_is_refused_in_one_clear_line(
    value: object, message: str, folder: Path
) -> None:
    found = _faults(SPECTRUM, value, folder)
    assert re.search(message, found), found
    assert "\n" not in found


def test_a_hole_is_accepted_when_interpolation_is_stated() -> None:
    table = {"wavelengths_nm": [400, 410, 420, 500], "values": [1, 1, 1, 2]}
    spec = SPECTRUM.validate_python({**table, "interpolation": "linear"})
    assert spec.distribution()(460.0) == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (1.2, "1.2 is above 1"),
        (-0.1, "-0.1 is below 0"),
        ({"wavelengths_nm": [400, 500], "values": [0.1, 1.01]}, "1.01 is above 1$"),
        ({"wavelengths_nm": [400, 500], "values": [10, 92]}, "92 is above 1; .*scale = 0.01"),
        ({"csv": "percent.csv"}, "75 is above 1; .*scale = 0.01"),
    ],
)
def test_a_fraction_stays_between_nothing_and_all(
    value: object, message: str, folder: Path
) -> None:
    assert re.search(message, _faults(FRACTION, value, folder))


@pytest.mark.parametrize("value", [0, 1, 0.0, 1.0])
def test_nothing_and_all_are_fractions(value: float) -> None:
    assert FRACTION.validate_python(value).distribution()([500.0]).tolist() == [value]


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (0.5, "a source is a name"),
        ("", "at least 1 character"),
        ({"wavelengths_nm": [400, 500], "values": [1, -1]}, "-1 is below 0"),
        ({"wavelengths_nm": [400, 500], "values": [0, 0]}, "emits nothing"),
        ({"temperature_kelvin": -5}, "greater than"),
        ({"temperature_kelvin": "2856"}, "number"),
        ({"temperature_k": 2856}, "temperature_kelvin: Field required.*temperature_k: Extra"),
        ({"led_peak_nm": 624}, "led_fwhm_nm: Field required"),
        ({"led_peak_nm": 624, "led_fwhm_nm": 0}, "greater than"),
        ({"led_peak_nm": 624, "led_fwhm_nm": 18, "model": "cauchy"}, "'ohno' or 'gaussian'"),
    ],
)
def test_a_wrong_source_is_refused_in_one_clear_line(value: object, message: str) -> None:
    found = _faults(SOURCE, value)
    assert re.search(message, found), found


def test_a_file_needs_a_folder_to_be_looked_for_in() -> None:
    assert "no folder is given" in _faults(SPECTRUM, {"csv": "half.csv"})


def test_equal_specs_are_equal_and_hash_alike(folder: Path) -> None:
    for value in (0.5, {"csv": "half.csv"}, {"wavelengths_nm": [400, 500], "values": [0, 1]}):
        one, other = (SPECTRUM.validate_python(value, context={"root": folder}) for _ in range(2))
        assert one == other
        assert hash(one) == hash(other)


def test_a_spec_dumps_to_what_was_written_and_is_taken_back(folder: Path) -> None:
    context = {"root": folder}
    for value in (0.5, {"csv": "half.csv", "scale": 0.5}, {"spdx": "led.spdx"}):
        spec = SPECTRUM.validate_python(value, context=context)
        assert SPECTRUM.validate_python(spec) is spec
        again = SPECTRUM.validate_python(spec.model_dump(mode="json"), context=context)
        assert again == spec


def test_a_table_in_a_scene_does_not_change() -> None:
    spec = SPECTRUM.validate_python({"wavelengths_nm": [400, 500], "values": [0, 1]})
    with pytest.raises(ValidationError, match="frozen"):
        spec.values = (1.0, 2.0)


@pytest.mark.parametrize("adapter", [SPECTRUM, FRACTION, SOURCE])
def test_there_is_a_json_schema_for_editors(adapter: TypeAdapter[Any]) -> None:
    schema = adapter.json_schema()
    assert schema["$defs"]["CsvSpectrum"]["required"] == ["csv"]
    assert schema["$defs"]["CsvSpectrum"]["additionalProperties"] is False

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Each fault of a user's gives one line with the file, the key path, and what to do."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from lamplit.errors import LamplitError
from lamplit.scene import load_scene

Spoil = Callable[[str, str], Path]

BALL = 'name = "ball"'
TABLE = "wavelengths_nm = [380, 600, 780]\nvalues = [0.01, 0.1, 0.9]"


def fault(path: Path) -> LamplitError:
    """Return the error that reading and resolving the scene raises, one line long."""
    with pytest.raises(LamplitError) as caught:
        load_scene(path).resolved_objects()
    text = str(caught.value)
    assert "\n" not in text
    assert len(text) < 500
    assert str(path) in text
    return caught.value


def test_the_scene_that_the_tests_spoil_is_sound(sound: Path) -> None:
    names = [thing.name for thing in load_scene(sound).resolved_objects()]
    assert names == ["ball", "part"]


@pytest.mark.parametrize(
    ("piece", "by", "where", "says"),
    [
        # Unknown names, with the nearest one.
        ("samples = 4", "sampels = 4", "image.sampels", "did you mean 'samples'"),
        ("[image]", "[imgae]", "imgae", "did you mean 'image'"),
        ('material = "cover"', 'material = "covr"', "objects[0].material", "did you mean 'cover'"),
        ('material = "cover"', 'material = "red-pmm"', "objects[0].material", "'red-pmma'"),
        ('source = "D65"', 'source = "D66"', "lights[0].source", "did you mean 'D65'"),
        ('source = "D65"', 'source = "my-lde"', "lights[0].source", "did you mean 'my-led'"),
        ('kind = "sphere"', 'kind = "spher"', "objects[0].kind", "did you mean 'sphere'"),
        ("reflectance = 0.5", "reflectanse = 0.5", "materials.paint.reflectanse", "'reflectance'"),
        ('kind = "diffuse"', 'kind = "difuse"', "materials.paint.kind", "did you mean 'diffuse'"),
        ("led_fwhm_nm = 18", "led_fwmh_nm = 18", "sources.my-led.led_fwmh_nm", "'led_fwhm_nm'"),
        ("samples = 4", 'filter = "gausian"', "image.filter", "did you mean 'gaussian'"),
        # Missing keys and files.
        ("radius_mm = 10.0\n", "", "objects[0].radius_mm", "missing"),
        ("lamplit = 1\n", "", "lamplit", "lamplit = 1"),
        ('file = "part.obj"', 'file = "gone.obj"', "objects[1].file", "does not exist"),
        (
            "reflectance = 0.5",
            'reflectance = { csv = "gone.csv" }',
            "materials.paint.reflectance",
            "does not exist",
        ),
        # Wrong units, of keys and of values.
        ("radius_mm = 10.0", "radius_cm = 1.0", "objects[0].radius_cm", "did you mean 'radius_mm'"),
        (
            "position_mm = [0.0, 0.0",
            "position_m = [0.0, 0.0",
            "camera.position_m",
            "did you mean 'position_mm'",
        ),
        ('unit = "mm"', 'unit = "feet"', "objects[1].unit", "'feet'"),
        ('unit = "mm"\n', "", "objects[1].unit", "missing"),
        # Spectra.
        (
            TABLE,
            "wavelengths_nm = [380, 600, 500]\nvalues = [0.1, 0.1, 0.9]",
            "materials.cover.internal_transmittance",
            "500",
        ),
        (
            TABLE,
            "wavelengths_nm = [380, 385, 390, 395, 400, 780]\nvalues = [1,1,1,1,1,1]",
            "materials.cover.internal_transmittance",
            "400",
        ),
        (
            TABLE,
            "wavelengths_nm = [400, 450, 500]\nvalues = [0.1, 0.1, 0.9]",
            "materials.cover.internal_transmittance",
            "380",
        ),
        (
            TABLE,
            "wavelengths_nm = [380, 600, 780]\nvalues = [0.1, 0.1, 1.9]",
            "materials.cover.internal_transmittance",
            "1.9",
        ),
        (
            TABLE,
            "wavelengths_nm = [380, 600, 780]\nvalues = [0.1, -0.1, 0.9]",
            "materials.cover.internal_transmittance",
            "-0.1",
        ),
        (
            TABLE,
            "wavelengths_nm = [380, 600, 780]\nvalues = [0.1, nan, 0.9]",
            "materials.cover.internal_transmittance.values[1]",
            "finite",
        ),
        (
            "thickness_mm = 3.0",
            "thickness_mm = -3.0",
            "materials.cover.internal_transmittance.thickness_mm",
            "greater than 0",
        ),
        ("reflectance = 0.5", "reflectance = 50", "materials.paint.reflectance", "50"),
        # Numbers that are none, or too large.
        ("radius_mm = 10.0", "radius_mm = inf", "objects[0].radius_mm", "finite"),
        ("radius_mm = 10.0", "radius_mm = -1.0", "objects[0].radius_mm", "greater than 0"),
        ("radius_mm = 10.0", "radius_mm = 1e300", "objects[0].radius_mm", "less than"),
        ("radius_mm = 10.0", 'radius_mm = "10"', "objects[0].radius_mm", "number"),
        ("radius_mm = 10.0", "radius_mm = true", "objects[0].radius_mm", "number"),
        (
            "luminance_cd_m2 = 1000.0",
            "luminance_cd_m2 = nan",
            "lights[0].luminance_cd_m2",
            "finite",
        ),
        (
            "target_mm = [0.0, 0.0, 0.0]",
            "target_mm = [0.0, nan, 0.0]",
            "camera.target_mm[1]",
            "finite",
        ),
        ("target_mm = [0.0, 0.0, 0.0]", "target_mm = [0.0, 0.0]", "camera.target_mm", "too short"),
        (
            "target_mm = [0.0, 0.0, 0.0]",
            "target_mm = [0, 0, 0, 0]",
            "camera.target_mm",
            "3 at most",
        ),
        # The camera.
        ("target_mm = [0.0, 0.0, 0.0]", "target_mm = [0.0, 0.0, 400.0]", "camera", "looks nowhere"),
        ("field_of_view_deg = 30.0", "up = [0.0, 0.0, 1.0]", "camera", "parallel"),
        (
            "field_of_view_deg = 30.0",
            "field_of_view_deg = 180.0",
            "camera.field_of_view_deg",
            "less than 180",
        ),
        ("target_mm = [0.0, 0.0, 0.0]", "target_mm = [0.0, 0.0, 900.0]", "camera", "sees none"),
        (
            "position_mm = [0.0, 0.0, 400.0]",
            "position_mm = [31.0, 1.0, 1.0]",
            "camera.position_mm",
            "inside 'part'",
        ),
        # The image.
        ("width = 32", "width = 0", "image.width", "greater than or equal to 1"),
        ("width = 32", "width = 100000000", "image.width", "less than or equal to 16384"),
        ("width = 32\nheight = 20", "width = 16000\nheight = 16000", "image", "pixels"),
        ("width = 32", "width = 32.5", "image.width", "whole number"),
        ("samples = 4", "samples = 5", "image", "square"),
        ("samples = 4", "wavelength_range_nm = [780, 380]", "image", "wavelength_range_nm"),
        # Objects that cannot be what they say.
        (BALL, 'name = "part"', "objects[1].name", "another name"),
        (
            'kind = "sphere"\ncentre_mm = [0.0, 0.0, 0.0]\nradius_mm = 10.0',
            'kind = "plane"\npoint_mm = [0, 0, 0]\nnormal = [0, 1, 0]',
            "objects[0]",
            "no inside",
        ),
        (
            'kind = "sphere"\ncentre_mm = [0.0, 0.0, 0.0]\nradius_mm = 10.0',
            'kind = "disc"\ncentre_mm = [0, 0, 0]\nnormal = [0, 0, 0]\nradius_mm = 1',
            "objects[0].normal",
            "length",
        ),
        (
            'kind = "sphere"\ncentre_mm = [0.0, 0.0, 0.0]\nradius_mm = 10.0',
            'kind = "box"\nmin_mm = [0, 0, 0]\nmax_mm = [1, 0, 1]',
            "objects[0]",
            "min_mm",
        ),
        (
            'kind = "sphere"\ncentre_mm = [0.0, 0.0, 0.0]\nradius_mm = 10.0',
            'kind = "tetrahedron"\npoints_mm = [[0,0,0],[1,0,0],[0,1,0],[1,1,0]]',
            "objects[0]",
            "no volume",
        ),
        # Text that is not TOML.
        ("radius_mm = 10.0", "radius_mm = = 10.0", "line 35, column 13", "TOML"),
        ("radius_mm = 10.0", "radius_mm = 10.0\nradius_mm = 11.0", "line", "TOML"),
    ],
)
def test_a_fault_is_named_with_its_key_path(
    spoilt: Spoil, piece: str, by: str, where: str, says: str
) -> None:
    found = fault(spoilt(piece, by))
    assert found.where == where or (where == "line" and found.where), str(found)
    assert says in found.message, str(found)


def test_a_scene_without_objects_is_refused(sound: Path) -> None:
    text = sound.read_text()
    sound.write_text(text[: text.index("[[objects]]")])
    assert fault(sound).where == "objects"


def test_an_open_mesh_cannot_be_a_transparent_body(spoilt: Spoil) -> None:
    path = spoilt('material = "paint"', 'material = "cover"')
    load_scene(path).resolved_objects()
    mesh = path.with_name("part.obj")
    mesh.write_text(mesh.read_text().replace("f 3 1 4\n", ""))
    found = fault(path)
    assert found.where == "objects[1]"
    assert "'part' is open: 3 edges" in found.message


def test_a_missing_scene_file_is_named(tmp_path: Path) -> None:
    assert "does not exist" in fault(tmp_path / "nothing.toml").message
    assert "not a file" in fault(tmp_path).message


def test_an_override_replaces_one_value(sound: Path) -> None:
    scene = load_scene(sound, overrides={"image.samples": 9, "objects[0].radius_mm": 3.0})
    assert scene.image.samples == 9
    assert scene.objects[0].model_dump()["radius_mm"] == 3.0
    assert load_scene(sound, overrides={"display.space": "rec2020"}).display.space == "rec2020"


@pytest.mark.parametrize(
    ("key", "where"),
    [
        ("image.sampels", "image.sampels"),
        ("objects[7].radius_mm", "objects[7].radius_mm"),
        ("name.first", "name.first"),
        ("image..samples", ""),
        ("[0].x", ""),
        ("", ""),
    ],
)
def test_an_override_without_a_place_is_refused(sound: Path, key: str, where: str) -> None:
    with pytest.raises(LamplitError) as caught:
        load_scene(sound, overrides={key: 1})
    assert (caught.value.where or "") == where

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What shines from objects: how a scene writes it, what it resolves to, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lamplit.errors import LamplitError, SceneError
from lamplit.scene import Scene, check_scene, parse_scene
from lamplit.scene.emission import ResolvedEmission
from lamplit.scene.shining import light_groups, path_notices
from lamplit.spectrum import SpectralDistribution

Table = dict[str, object]

BALL: Table = {"kind": "sphere", "centre_mm": [0, 0, 0], "radius_mm": 10.0}
SHEET_OBJ = "v 0 0 0\nv 9 0 0\nv 9 9 0\nf 1 2 3\n"
#: Type C, one plane, 1 cd straight ahead to 0 cd at the side.
IES = """IESNA:LM-63-2002
TILT=NONE
1 -1 1 2 1 1 2 0 0 0
1 1 1
0 90
0
1 0
"""


def scene_of(emission: Table | None, root: Path, **more: object) -> Scene:
    """Return a scene of one ball, or of the object ``body``, that shines."""
    body = {"name": "ball", "material": "grey-18", **BALL, **more.pop("body", {})}  # type: ignore[dict-item]
    if emission is not None:
        body["emission"] = emission
    written: Table = {
        "lamplit": 1,
        "camera": {"kind": "pinhole", "position_mm": [3, 4, 400], "target_mm": [0, 0, 0]},
        "objects": [body],
    }
    return parse_scene(written | more, root=root)


def emission_of(emission: Table, root: Path, **more: object) -> ResolvedEmission:
    (ball,) = scene_of(emission, root, **more).resolved_objects()
    assert ball.emission is not None
    return ball.emission


def fault(emission: Table, root: Path, **more: object) -> LamplitError:
    with pytest.raises(LamplitError) as caught:
        scene_of(emission, root, **more).resolved_objects()
    assert "\n" not in str(caught.value)
    return caught.value


@pytest.mark.parametrize("quantity", ["flux_lm", "radiant_flux_w", "luminance_cd_m2"])
def test_an_emission_keeps_its_source_and_its_strength(quantity: str, tmp_path: Path) -> None:
    found = emission_of({"source": "A", quantity: 12.5}, tmp_path)
    assert (found.quantity, found.amount) == (quantity, 12.5)
    assert float(found.spectrum(560.0)) == 100.0
    assert (found.group, found.cosine_exponent, found.photometry) == ("ball", 1.0, None)
    assert found.shines


def test_an_emission_of_zero_does_not_shine(tmp_path: Path) -> None:
    assert not emission_of({"source": "A", "flux_lm": 0.0}, tmp_path).shines


def test_a_source_may_be_one_of_the_scene(tmp_path: Path) -> None:
    led = {"key": {"led_peak_nm": 600, "led_fwhm_nm": 10}}
    found = emission_of({"source": "key", "flux_lm": 1.0}, tmp_path, sources=led)
    assert float(found.spectrum(600.0)) == pytest.approx(1.0)
    assert float(found.spectrum(700.0)) < 1e-6


def test_what_glows_has_plancks_radiance_times_its_emissivity(tmp_path: Path) -> None:
    table = {"wavelengths_nm": [380, 780], "values": [0.5, 0.3], "interpolation": "linear"}
    nm = np.array([400.0, 580.0, 780.0])
    planck = SpectralDistribution.blackbody(2700.0)(nm)
    black = emission_of({"temperature_kelvin": 2700}, tmp_path)
    assert (black.quantity, black.amount) == ("spectral_radiance", 1.0)
    np.testing.assert_array_equal(black.spectrum(nm), planck)
    grey = emission_of({"temperature_kelvin": 2700, "emissivity": table}, tmp_path)
    np.testing.assert_allclose(grey.spectrum(nm) / planck, [0.49, 0.4, 0.3], rtol=1e-14)


def test_an_exponent_is_kept_and_lambert_is_one(tmp_path: Path) -> None:
    for written, exponent in (("lambert", 1.0), ({"cosine_exponent": 4.0}, 4.0)):
        own: Table = {"source": "A", "flux_lm": 1.0, "distribution": written}
        assert emission_of(own, tmp_path).cosine_exponent == exponent


def test_a_photometric_file_turns_with_its_object(tmp_path: Path) -> None:
    (tmp_path / "lamp.ies").write_text(IES)
    spread = {"file": "lamp.ies", "axis": [0, 0, 2], "up": [0, 1, 1]}
    own: Table = {"source": "A", "flux_lm": 1.0, "distribution": spread}
    still = emission_of(own, tmp_path)
    assert still.photometry is not None
    ahead, aside = still.photometry.intensity_cd(np.array([[0.0, 0, 1], [1, 0, 0]]))
    assert (float(ahead), float(aside)) == (1.0, 0.0)
    np.testing.assert_allclose(still.frame, np.eye(3), atol=1e-15)
    # About x by 90°: up goes from y to z, and the axis from z to -y.
    turned = {"transform": {"rotate_deg": [90, 0, 0], "scale": 3.0}}
    frame = emission_of(own, tmp_path, body=turned).frame
    np.testing.assert_allclose(frame, [[1, 0, 0], [0, 0, 1], [0, -1, 0]], atol=1e-15)
    assert np.linalg.det(frame) == pytest.approx(1.0)


def test_the_hash_follows_the_photometric_file(tmp_path: Path) -> None:
    own: Table = {"source": "A", "flux_lm": 1.0, "distribution": {"file": "lamp.ies"}}
    (tmp_path / "lamp.ies").write_text(IES)
    before = scene_of(own, tmp_path).scene_hash
    assert scene_of(own, tmp_path).scene_hash == before
    (tmp_path / "lamp.ies").write_text(IES.replace("1 0\n", "2 0\n"))
    assert scene_of(own, tmp_path).scene_hash != before


SOURCE: Table = {"source": "A", "flux_lm": 1.0}


@pytest.mark.parametrize(
    ("emission", "where", "says"),
    [
        ({}, "", "a source with a strength is needed"),
        ({"source": "A"}, "", "none is given"),
        ({**SOURCE, "luminance_cd_m2": 2.0}, "", "flux_lm and luminance_cd_m2 are given"),
        ({"flux_lm": 1.0}, "", "a source with a strength is needed"),
        ({**SOURCE, "temperature_kelvin": 2700}, "", "both given"),
        ({"temperature_kelvin": 2700, "flux_lm": 1.0}, "", "source = { temperature_kelvin = 2700"),
        ({**SOURCE, "emissivity": 0.5}, "", "emissivity belongs to temperature_kelvin"),
        ({"temperature_kelvin": 2700, "emissivity": 1.5}, ".emissivity", "above 1"),
        ({"temperature_kelvin": 2700, "distribution": {"cosine_exponent": 2}}, "", "Lambert's law"),
        ({"temperature_k": 2700}, ".temperature_k", "did you mean 'temperature_kelvin'"),
        ({"source": "A", "flux_lm": -1.0}, ".flux_lm", "greater than or equal to 0"),
        ({"source": "A", "flux_lm": float("nan")}, ".flux_lm", "finite"),
        ({"source": "B65", "flux_lm": 1.0}, ".source", "did you mean 'D65'"),
        ({**SOURCE, "distribution": "lambertian"}, ".distribution", "'lambertian' is not"),
        (
            {**SOURCE, "distribution": {"cosine_exponent": -0.5}},
            ".distribution.cosine_exponent",
            "greater than or equal to 0",
        ),
        ({**SOURCE, "distribution": {"fiel": "a"}}, ".distribution.fiel", "did you mean 'file'"),
        ({**SOURCE, "distribution": {"file": "a.ies"}}, ".distribution.file", "does not exist"),
        ({**SOURCE, "distribution": {"file": "../a.ies"}}, ".distribution.file", "leads out"),
        (
            {**SOURCE, "distribution": {"file": "a.ies", "axis": [0, 1, 0]}},
            ".distribution",
            "parallel to axis",
        ),
        (
            {"source": "A", "luminance_cd_m2": 1.0, "distribution": {"file": "a.ies"}},
            "",
            "spreads a flux",
        ),
        ({**SOURCE, "group": "stop.left"}, ".group", "'stop.left' is given"),
        ({**SOURCE, "group": "a=b"}, ".group", "light group's name"),
        ({**SOURCE, "group": ""}, ".group", "text"),
    ],
)
def test_an_emission_that_cannot_be_is_refused(
    emission: Table, where: str, says: str, tmp_path: Path
) -> None:
    found = fault(emission, tmp_path)
    assert found.where == f"objects[0].emission{where}", str(found)
    assert says in found.message, str(found)


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ({"material": "bk7"}, "'bk7' is transparent"),
        ({"name": "stop.left"}, "give a group"),
        (
            {"kind": "plane", "point_mm": [0, 0, 0], "normal": [0, 0, 1]},
            "a plane without end cannot shine",
        ),
    ],
)
def test_an_object_that_cannot_shine_is_refused(body: Table, says: str, tmp_path: Path) -> None:
    scene = _object_scene(body, tmp_path)
    with pytest.raises(LamplitError) as caught:
        scene.resolved_objects()
    assert caught.value.where == "objects[0].emission"
    assert says in caught.value.message
    errors = [f for f in check_scene(scene).findings if f.level == "error"]
    assert [f.subject for f in errors] == ["objects[0].emission"]


def test_a_mesh_without_area_cannot_shine(tmp_path: Path) -> None:
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    scene = _object_scene({"kind": "mesh", "file": "flat.obj", "unit": "mm"}, tmp_path)
    with pytest.raises(LamplitError, match="no triangle has an area"):
        scene.resolved_objects()


@pytest.mark.parametrize(
    "body",
    [
        {**BALL, "material": "sheet"},
        {"kind": "disc", "centre_mm": [0, 0, 0], "normal": [0, 0, 1], "radius_mm": 5.0},
        {"kind": "mesh", "file": "sheet.obj", "unit": "mm"},
    ],
    ids=["diffuse-transmitter", "disc", "open mesh"],
)
def test_sheets_and_transmitters_may_shine(body: Table, tmp_path: Path) -> None:
    (tmp_path / "sheet.obj").write_text(SHEET_OBJ)
    (thing,) = _object_scene(body, tmp_path).resolved_objects()
    assert thing.emission is not None


def _object_scene(body: Table, root: Path) -> Scene:
    shape = {} if "kind" in body else BALL
    own = {"name": "body", "material": "grey-18", "emission": SOURCE, **shape, **body}
    sheet = {"kind": "diffuse-transmitter", "reflectance": 0.4, "transmittance": 0.5}
    return parse_scene(
        {
            "lamplit": 1,
            "camera": {"kind": "pinhole", "position_mm": [3, 4, 400], "target_mm": [0, 0, 0]},
            "materials": {"sheet": sheet},
            "objects": [own],
        },
        root=root,
    )


@pytest.mark.parametrize(
    ("emission", "where"),
    [
        ({"source": {"wavelengths_nm": [400, 500], "values": [1, 1]}, "flux_lm": 1.0}, "source"),
        (
            {
                "temperature_kelvin": 2700,
                "emissivity": {"wavelengths_nm": [400, 500], "values": [0.4, 0.4]},
            },
            "emissivity",
        ),
    ],
)
def test_spectra_of_an_emission_must_reach_over_the_picture(
    emission: Table, where: str, tmp_path: Path
) -> None:
    for key in ("source", "emissivity"):
        if key in emission:
            emission[key] |= {"interpolation": "linear"}  # type: ignore[operator]
    found = fault(emission, tmp_path)
    assert found.where == f"objects[0].emission.{where}"
    assert "380 to 780" in found.message


def test_a_lying_photometric_file_is_named_by_its_key_and_its_line(tmp_path: Path) -> None:
    (tmp_path / "lamp.ies").write_text(IES.replace("1 -1 1 2 1", "1 -1 1 7 1"))
    own: Table = {"source": "A", "flux_lm": 1.0, "distribution": {"file": "lamp.ies"}}
    found = fault(own, tmp_path)
    assert found.where == "objects[0].emission.distribution.file"
    assert found.message.startswith("lamp.ies: line ")


def test_groups_come_once_each_the_backgrounds_first(tmp_path: Path) -> None:
    def die(name: str, **more: object) -> Table:
        return {"name": name, "material": "grey-18", **BALL, "emission": {**SOURCE, **more}}

    box = {"source": "E", "luminance_cd_m2": 1.0, "centre_mm": [0, 0, 90], "width_mm": 1}
    sun = {"direction": [0, 1, 0], "source": "E", "illuminance_lx": 1.0, "group": "sun"}
    scene = scene_of(
        None,
        tmp_path,
        objects=[die("a", group="dies"), die("b", group="dies"), die("c")],
        background={
            "kind": "studio",
            "source": "E",
            "luminance_cd_m2": 1.0,
            "group": "room",
            "soft_boxes": [{**box, "height_mm": 1, "group": "dies"}, {**box, "height_mm": 2}],
            "suns": [sun],
        },
    )
    assert light_groups(scene) == ("room", "dies", "background", "sun", "c")


LAMP: Table = {"kind": "point", "source": "A", "luminance_cd_m2": 5.0, "position_mm": [0, 99, 0]}
WHITE: Table = {"source": "E", "luminance_cd_m2": 1.0}
BLACK: Table = {"source": "E", "luminance_cd_m2": 0.0}


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"lights": [LAMP], "ambient": WHITE},
        {"background": {"kind": "constant", **BLACK}},
        {"background": {"kind": "gradient", "zenith": BLACK, "nadir": BLACK}},
    ],
)
def test_path_transport_refuses_a_scene_in_which_nothing_shines(
    more: Table, tmp_path: Path
) -> None:
    scene = scene_of(None, tmp_path, **more)
    with pytest.raises(SceneError, match="nothing shines") as caught:
        path_notices(scene)
    assert caught.value.where == "image.method"
    assert ("belong to the Hall method" in caught.value.message) == ("lights" in more)
    assert not check_scene(scene).sound
    assert check_scene(scene_of(None, tmp_path, image={"method": "hall"}, **more)).sound


@pytest.mark.parametrize(
    "more",
    [
        {"background": {"kind": "constant", **WHITE}},
        {"background": {"kind": "gradient", "zenith": BLACK, "nadir": WHITE}},
        {
            "background": {
                "kind": "constant",
                **BLACK,
                "suns": [{"direction": [0, 1, 0], "source": "E", "illuminance_lx": 1.0}],
            }
        },
        {
            "background": {
                "kind": "studio",
                **BLACK,
                "soft_boxes": [{**WHITE, "centre_mm": [0, 0, 9], "width_mm": 1, "height_mm": 1}],
            }
        },
        {
            "background": {
                "kind": "sky",
                "model": "cie-overcast",
                "source": "E",
                "zenith_luminance_cd_m2": 0.0,
                "ground": WHITE,
            }
        },
    ],
)
def test_each_kind_of_background_is_light_enough(more: Table, tmp_path: Path) -> None:
    assert path_notices(scene_of(None, tmp_path, **more)) == ()


def test_path_transport_says_what_it_leaves_out(tmp_path: Path) -> None:
    assert path_notices(scene_of(SOURCE, tmp_path)) == ()
    scene = scene_of(SOURCE, tmp_path, lights=[LAMP, LAMP], ambient=WHITE)
    (notice,) = path_notices(scene)
    assert "leaves out [ambient] and 2 of [[lights]]" in notice
    assert [f.message for f in check_scene(scene).findings] == [notice]
    dark = scene_of(SOURCE, tmp_path, lights=[LAMP | {"luminance_cd_m2": 0.0}], ambient=BLACK)
    assert path_notices(dark) == ()


def test_other_sources_are_looked_up_anew(tmp_path: Path) -> None:
    led = {"key": {"led_peak_nm": 600, "led_fwhm_nm": 10}}
    own: Table = {"source": "key", "flux_lm": 1.0}
    scene = scene_of(own, tmp_path, sources=led)
    other = scene_of(own, tmp_path, sources={"key": {"led_peak_nm": 500, "led_fwhm_nm": 10}})
    assert scene.resolved_objects()[0].emission is not None
    (ball,) = scene.changed(sources=other.sources).resolved_objects()
    assert ball.emission is not None
    assert float(ball.emission.spectrum(500.0)) == pytest.approx(1.0)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Skies, suns, pictures and the thin lens: what a scene may say of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from lamplit.errors import LamplitError, SceneError
from lamplit.scene import Scene, check_scene, parse_scene
from lamplit.scene.camera import ThinLensCamera
from lamplit.scene.lighting import SkyBackground, Sun
from lamplit.scene.shining import path_notices
from lamplit.spectra_spec import NamedSource

Table = dict[str, object]

SKY: Table = {"kind": "sky", "source": "D65", "zenith_luminance_cd_m2": 3000.0}
CAMERA: Table = {"kind": "pinhole", "position_mm": [3, 4, 400], "target_mm": [0, 0, 0]}


def scene_of(root: Path, **more: object) -> Scene:
    ball = {"name": "ball", "kind": "sphere", "centre_mm": [0, 0, 0], "radius_mm": 10.0}
    written: Table = {
        "lamplit": 1,
        "camera": CAMERA,
        "objects": [ball | {"material": "grey-18"}],
        "background": {"kind": "constant", "source": "E", "luminance_cd_m2": 1.0},
    }
    return parse_scene(written | more, root=root)


def background_of(background: Table, root: Path) -> object:
    scene = scene_of(root, background=background)
    scene.resolved_objects()
    return scene.background


def write_picture(path: Path, rgb: np.ndarray) -> None:
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"RGB": rgb.astype(np.float32)}) as file:
        file.write(str(path))


@pytest.mark.parametrize(
    ("model", "kind"),
    [
        ({"model": "cie-overcast"}, None),
        ({"model": "cie-clear", "sun_direction": [0, 1, 1]}, 12),
        ({"model": "cie-general", "type": 7, "sun_direction": [1, 0, 0]}, 7),
    ],
)
def test_a_sky_is_one_of_the_standards(model: Table, kind: int | None, tmp_path: Path) -> None:
    found = background_of(SKY | model, tmp_path)
    assert isinstance(found, SkyBackground)
    assert found.general_type == kind


@pytest.mark.parametrize(
    ("angular_diameter_deg", "share"),
    [(0.533, None), (90.0, 0.5), (60.0, 0.25)],
)
def test_a_suns_illuminance_is_its_luminance_times_its_projected_solid_angle(
    angular_diameter_deg: float, share: float | None
) -> None:
    """E = π L sin² of its radius; for a small one, L times the solid angle."""
    sun = Sun(
        direction=(0.0, 1.0, 0.0),
        source=NamedSource("D65"),
        angular_diameter_deg=angular_diameter_deg,
        illuminance_lx=1e5,
    )
    if share is not None:
        assert sun.disc_luminance_cd_m2 == pytest.approx(1e5 / (np.pi * share), rel=1e-14)
    else:
        solid_angle = np.pi * np.radians(0.533 / 2.0) ** 2
        assert sun.disc_luminance_cd_m2 == pytest.approx(1e5 / solid_angle, rel=1e-5)
    given = sun.model_copy(update={"illuminance_lx": None, "luminance_cd_m2": 7.0})
    assert given.disc_luminance_cd_m2 == 7.0


SUN: Table = {"direction": [0, 1, 0], "source": "D65", "illuminance_lx": 1.0}
WHITE: Table = {"kind": "constant", "source": "E", "luminance_cd_m2": 1.0}


@pytest.mark.parametrize(
    ("background", "where", "says"),
    [
        (SKY, ".model", "missing"),
        (SKY | {"model": "cie-cloudy"}, ".model", "'cie-cloudy' is not"),
        (SKY | {"model": "cie-clear"}, "", "all others need it"),
        (SKY | {"model": "cie-overcast", "sun_direction": [0, 1, 0]}, "", "no sun_direction"),
        (SKY | {"model": "cie-clear", "sun_direction": [0, -0.1, 1]}, "", "below the horizon"),
        (SKY | {"model": "cie-general", "sun_direction": [0, 1, 0]}, "", "type (1 to 15)"),
        (SKY | {"model": "cie-clear", "type": 3, "sun_direction": [0, 1, 0]}, "", "belongs to"),
        (SKY | {"model": "cie-general", "type": 16, "sun_direction": [0, 1, 0]}, ".type", "15"),
        (SKY | {"model": "cie-overcast", "source": "D66"}, ".source", "did you mean 'D65'"),
        (WHITE | {"suns": [SUN | {"luminance_cd_m2": 1.0}]}, ".suns[0]", "either"),
        (WHITE | {"suns": [{"direction": [0, 1, 0], "source": "E"}]}, ".suns[0]", "either"),
        (WHITE | {"suns": [SUN | {"direction": [0, 0, 0]}]}, ".suns[0].direction", "length"),
        (
            WHITE | {"suns": [SUN | {"angular_diameter_deg": 0.009}]},
            ".suns[0].angular_diameter_deg",
            "0.01",
        ),
        (
            WHITE | {"suns": [SUN | {"angular_diameter_deg": 91}]},
            ".suns[0].angular_diameter_deg",
            "90",
        ),
        (WHITE | {"suns": [SUN | {"group": " sun"}]}, ".suns[0].group", "' sun'"),
        (WHITE | {"group": "a/b"}, ".group", "'a/b'"),
        ({"kind": "image", "file": "gone.hdr"}, ".file", "does not exist"),
        ({"kind": "image", "file": "../sky.hdr"}, ".file", "leads out"),
        ({"kind": "image", "file": "sky.exr", "scale": 0.0}, ".scale", "greater than 0"),
    ],
)
def test_a_background_that_cannot_be_is_refused(
    background: Table, where: str, says: str, tmp_path: Path
) -> None:
    with pytest.raises(LamplitError) as caught:
        background_of(background, tmp_path)
    assert "\n" not in str(caught.value)
    assert caught.value.where == f"background{where}", str(caught.value)
    assert says in caught.value.message, str(caught.value)


def test_files_are_looked_for_when_the_scene_is_loaded(tmp_path: Path) -> None:
    with pytest.raises(SceneError) as caught:
        scene_of(tmp_path, background={"kind": "image", "file": "gone.hdr"})
    assert caught.value.where == "background.file"
    spread = {"source": "A", "flux_lm": 1.0, "distribution": {"file": "gone.ies"}}
    disc = {"name": "a", "kind": "disc", "centre_mm": [0, 0, 0], "normal": [0, 0, 1]}
    with pytest.raises(SceneError) as caught:
        scene_of(
            tmp_path,
            objects=[disc | {"radius_mm": 1.0, "material": "grey-18", "emission": spread}],
        )
    assert caught.value.where == "objects[0].emission.distribution.file"


def test_spectra_of_a_sun_must_reach_over_the_picture(tmp_path: Path) -> None:
    short = {"wavelengths_nm": [400, 420], "values": [1, 1]}
    with pytest.raises(LamplitError, match="380 to 780") as caught:
        background_of(WHITE | {"suns": [SUN | {"source": short}]}, tmp_path)
    assert caught.value.where == "background.suns[0].source"


def test_a_picture_is_read_once_and_hashed(tmp_path: Path) -> None:
    rgb = np.linspace(0.0, 5.0, 4 * 8 * 3).reshape(4, 8, 3)
    write_picture(tmp_path / "sky.exr", rgb)
    surround = {"kind": "image", "file": "sky.exr", "scale": 250.0, "rotate_deg": 45.0}
    scene = scene_of(tmp_path, background=surround)
    scene.resolved_objects()
    assert scene.environment is scene.environment
    np.testing.assert_array_equal(scene.environment, rgb.astype(np.float32))
    assert path_notices(scene) == ()
    before = scene.scene_hash
    write_picture(tmp_path / "sky.exr", rgb + 1.0)
    assert scene_of(tmp_path, background=surround).scene_hash != before
    assert scene.changed(background=scene_of(tmp_path).background).environment is None


def test_a_black_picture_does_not_shine(tmp_path: Path) -> None:
    write_picture(tmp_path / "sky.exr", np.zeros((2, 4, 3)))
    scene = scene_of(tmp_path, background={"kind": "image", "file": "sky.exr"})
    with pytest.raises(SceneError, match="nothing shines"):
        path_notices(scene)


def test_a_pixel_that_is_no_number_is_named_once_by_its_row_and_column(tmp_path: Path) -> None:
    rgb = np.ones((4, 8, 3))
    rgb[2, 5, 1] = np.nan
    write_picture(tmp_path / "sky.exr", rgb)
    scene = scene_of(tmp_path, background={"kind": "image", "file": "sky.exr"})
    with pytest.raises(SceneError, match=r"sky\.exr: row 2, column 5: G is nan") as caught:
        scene.resolved_objects()
    assert caught.value.where == "background.file"
    errors = [f for f in check_scene(scene).findings if f.level == "error"]
    assert [f.subject for f in errors] == ["background.file"]


LENS: Table = CAMERA | {"kind": "thin-lens", "aperture_mm": 20.0}


def test_a_thin_lens_focuses_on_the_target_unless_told(tmp_path: Path) -> None:
    for more, distance in (({}, np.sqrt(9 + 16 + 160_000)), ({"focus_mm": 55.0}, 55.0)):
        camera = scene_of(tmp_path, camera=LENS | more).camera
        assert isinstance(camera, ThinLensCamera)
        assert camera.focus_distance_mm == pytest.approx(distance, rel=1e-15)


@pytest.mark.parametrize(
    ("more", "where"),
    [
        ({"aperture_mm": 0.0}, "camera.aperture_mm"),
        ({"aperture_mm": -1.0}, "camera.aperture_mm"),
        ({"focus_mm": 0.0}, "camera.focus_mm"),
        ({"focus_mm": float("inf")}, "camera.focus_mm"),
        ({"field_of_view_deg": 180.0}, "camera.field_of_view_deg"),
        ({"f_number": 8.0}, "camera.f_number"),
    ],
)
def test_a_lens_that_cannot_be_is_refused(more: Table, where: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError) as caught:
        scene_of(tmp_path, camera=LENS | more)
    assert caught.value.where == where


def test_a_wide_lens_sees_past_the_edge_of_a_pinholes_picture(tmp_path: Path) -> None:
    """The ball, 10 mm wide at 60 mm below the axis, lies out of a picture 53 mm high from there."""
    narrow = {"position_mm": [0, 70, 100], "target_mm": [0, 70, 0], "field_of_view_deg": 30.0}
    square = {"width": 10, "height": 10}
    with pytest.raises(LamplitError, match=r"sees none.*field_of_view_deg"):
        scene_of(tmp_path, camera=CAMERA | narrow, image=square).resolved_objects()
    # A ray from 30 mm above the axis through the picture's lower edge, 13 mm below, in focus at 50.
    wide = LENS | narrow | {"aperture_mm": 60.0, "focus_mm": 50.0}
    assert scene_of(tmp_path, camera=wide, image=square).resolved_objects()
    slight = LENS | narrow | {"aperture_mm": 2.0, "focus_mm": 100.0}
    with pytest.raises(LamplitError, match="sees none"):
        scene_of(tmp_path, camera=slight, image=square).resolved_objects()


def test_a_wide_lens_sees_a_floor_that_a_narrow_one_does_not(tmp_path: Path) -> None:
    """All of the picture looks up; rays from the upper rim of a wide lens go down all the same."""
    floor = {"name": "floor", "kind": "plane", "point_mm": [0, -50, 0], "normal": [0, 1, 0]}
    view = {"position_mm": [0, 0, 0], "target_mm": [0, 30, -100], "field_of_view_deg": 30.0}

    def scene(aperture_mm: float) -> Scene:
        lens = LENS | view | {"aperture_mm": aperture_mm, "focus_mm": 100.0}
        return scene_of(tmp_path, camera=lens, objects=[floor | {"material": "grey-18"}])

    assert scene(60.0).resolved_objects()
    with pytest.raises(LamplitError, match="sees none"):
        scene(2.0).resolved_objects()


def test_a_grid_needs_a_square_number_of_samples_in_halls_method_alone(tmp_path: Path) -> None:
    assert scene_of(tmp_path, image={"samples": 5}).image.method == "auto"
    with pytest.raises(SceneError, match="square"):
        scene_of(tmp_path, image={"samples": 5, "method": "hall"})


@pytest.mark.parametrize("table", ["path", "hall"])
def test_each_method_has_its_settings(table: str, tmp_path: Path) -> None:
    scene = scene_of(tmp_path, **{table: {"max_depth": 7}})
    depths = {"path": scene.path_settings.max_depth, "hall": scene.hall.max_depth}
    assert depths[table] == 7
    assert depths != {"path": 7, "hall": 7}
    assert scene.path is None
    with pytest.raises(SceneError, match="did you mean 'max_depth'") as caught:
        scene_of(tmp_path, **{table: {"max_dept": 7}})
    assert caught.value.where == f"{table}.max_dept"


@pytest.mark.parametrize(
    ("image", "where"),
    [
        ({"error": 0.0}, "image.error"),
        ({"error": 1.5}, "image.error"),
        ({"method": "paths"}, "image.method"),
    ],
)
def test_a_picture_that_cannot_be_asked_for_is_refused(
    image: Table, where: str, tmp_path: Path
) -> None:
    with pytest.raises(SceneError) as caught:
        scene_of(tmp_path, image=image)
    assert caught.value.where == where
    assert scene_of(tmp_path, image={"error": 0.01}).image.error == 0.01


def test_the_hash_follows_the_settings_of_path_transport(tmp_path: Path) -> None:
    one, two = (scene_of(tmp_path, path={"max_depth": depth}) for depth in (7, 8))
    assert one.scene_hash != two.scene_hash

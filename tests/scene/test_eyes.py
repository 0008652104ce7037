# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Eye points: round the lamp, from the scene file, and from files of their own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lamplit.errors import LamplitError
from lamplit.scene import check_scene, load_scene
from lamplit.scene.camera import PinholeCamera
from lamplit.scene.eye_files import read_eyes
from lamplit.scene.eyes import turntable_eyes

Array = np.ndarray
Spoil = Callable[[str, str], Path]


def places(camera: PinholeCamera, frames: int, sweep_deg: float) -> Array:
    return np.array([eye.position_mm for eye in turntable_eyes(camera, frames, sweep_deg)])


def test_a_sweep_goes_from_the_left_to_the_right_with_the_camera_in_its_middle() -> None:
    """By hand: 45° off the axis at 400 mm are 400·√½ mm beside it and before it."""
    camera = PinholeCamera(kind="pinhole", position_mm=(10, 50, 400), target_mm=(10, 20, 0))
    side = 400.0 * 0.5**0.5
    expected = [[10 - side, 50, side], [10, 50, 400], [10 + side, 50, side]]
    np.testing.assert_allclose(places(camera, 3, 90.0), expected, rtol=0, atol=1e-9)


def test_a_full_circle_begins_at_the_camera_and_ends_one_step_before_it() -> None:
    camera = PinholeCamera(kind="pinhole", position_mm=(0, 30, 200), target_mm=(0, 0, 0))
    expected = [[0, 30, 200], [200, 30, 0], [0, 30, -200], [-200, 30, 0]]
    np.testing.assert_allclose(places(camera, 4, 360.0), expected, rtol=0, atol=1e-9)
    assert turntable_eyes(camera, 4, 360.0)[0].position_mm == camera.position_mm


def test_whichever_way_is_up_the_eye_keeps_its_distance_and_its_height() -> None:
    up, target = (1.0, -2.0, 0.5), (3.0, -4.0, 5.0)
    camera = PinholeCamera(
        kind="pinhole", position_mm=(100.0, 20.0, -30.0), target_mm=target, up=up
    )
    arms = places(camera, 7, 300.0) - target
    axis = np.array(up) / np.linalg.norm(up)
    usual = np.subtract(camera.position_mm, target)
    np.testing.assert_allclose(np.linalg.norm(arms, axis=1), np.linalg.norm(usual), rtol=1e-12)
    np.testing.assert_allclose(arms @ axis, usual @ axis, rtol=1e-12)
    flat = arms - np.outer(arms @ axis, axis)
    turns = np.sum(flat[:-1] * flat[1:], axis=1) / np.sum(flat[0] ** 2)
    np.testing.assert_allclose(turns, np.cos(np.radians(50.0)), rtol=1e-12)


@pytest.mark.parametrize("frames", [1, 0, -3, 1000])
def test_a_turntable_of_too_few_or_too_many_frames_is_refused(frames: int) -> None:
    camera = PinholeCamera(kind="pinhole", position_mm=(0, 0, 1), target_mm=(0, 0, 0))
    with pytest.raises(LamplitError, match="2 to 999 frames"):
        turntable_eyes(camera, frames)


@pytest.mark.parametrize("sweep", [0.0, -90.0, 360.5, float("nan"), float("inf")])
def test_a_sweep_that_is_no_angle_is_refused(sweep: float) -> None:
    camera = PinholeCamera(kind="pinhole", position_mm=(0, 0, 1), target_mm=(0, 0, 0))
    with pytest.raises(LamplitError, match="at most 360°"):
        turntable_eyes(camera, 5, sweep)


@pytest.mark.parametrize(
    "text",
    [
        "1.5, 2, 3\n4,5,6\n",
        "x_mm y_mm z_mm\n1.5 2 3\n4 5 6\n",
        "# walk\nx;y;z\n1,5;2;3 # first\n\n4;5;6\n",
        "1,5\t2\t3\n4\t5\t6",
    ],
)
def test_a_table_of_places_is_read_however_its_columns_part(tmp_path: Path, text: str) -> None:
    file = tmp_path / "walk.csv"
    file.write_text(text)
    eyes = read_eyes(file)
    assert [eye.position_mm for eye in eyes] == [(1.5, 2.0, 3.0), (4.0, 5.0, 6.0)]
    assert {eye.target_mm for eye in eyes} == {None}


def test_a_row_may_have_a_target_and_toml_says_the_same(tmp_path: Path) -> None:
    table, tables = tmp_path / "walk.csv", tmp_path / "walk.toml"
    table.write_text("1,2,3\n4,5,6,7,8,9\n")
    tables.write_text(
        "[[eyes]]\nposition_mm = [1, 2, 3]\n"
        "[[eyes]]\nposition_mm = [4, 5, 6]\ntarget_mm = [7, 8, 9]\n"
    )
    assert read_eyes(table) == read_eyes(tables)
    assert read_eyes(table)[1].target_mm == (7.0, 8.0, 9.0)


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        ("a.csv", "", "there is no eye point"),
        ("a.csv", "x,y,z\n# nothing\n", "there is no eye point"),
        ("a.csv", "x,y,z\n1,2\n", "line 2: x, y and z of the eye in mm are expected"),
        ("a.csv", "1,2,3,4\n", "here are 4 columns"),
        ("a.csv", "1,2,3\nfour,5,6\n", "line 2: 'four' is not a number"),
        ("a.csv", "1,2,nan\n", "line 1: nan is no coordinate"),
        ("a.csv", "1,2,1e12\n", "line 1: 1e+12 is no coordinate"),
        ("a.csv", "1,2,3\n" * 1000, "line 1000: these are more than 999"),
        ("a.csv", b"\xff\xfe1", "no UTF-8 text"),
        ("a.csv", None, "does not exist"),
        ("a.toml", None, "does not exist"),
        ("a.toml", "eyes = []", "there is no eye point"),
        ("a.toml", "", "eyes: this key is missing"),
        ("a.toml", "[[eye]]\nposition_mm = [1, 2, 3]", "did you mean 'eyes'"),
        ("a.toml", "[[eyes]]\nposition = [1, 2, 3]", "did you mean 'position_mm'"),
        ("a.toml", "[[eyes]]\nposition_mm = [1, 2]", "eyes[0].position_mm"),
        ("a.toml", "[[eyes]", "line 1"),
    ],
)
def test_a_bad_file_of_eye_points_is_one_line_with_its_place(
    tmp_path: Path, name: str, text: str | bytes | None, says: str
) -> None:
    file = tmp_path / name
    if text is not None:
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(LamplitError) as caught:
        read_eyes(file)
    assert str(caught.value).startswith(str(file))
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


EYES = "[[eyes]]\nposition_mm = {}\n[[objects]]"


def test_a_scene_has_eye_points_of_its_own(spoilt: Spoil) -> None:
    scene = load_scene(spoilt("[[objects]]", EYES.format("[200.0, 0.0, 350.0]")))
    assert [eye.position_mm for eye in scene.eyes] == [(200.0, 0.0, 350.0)]
    assert check_scene(scene).sound


@pytest.mark.parametrize(
    ("place", "says"),
    [
        ("[0.0, 0.0, 0.0]", "eyes[0]: the camera looks nowhere"),
        ("[0.0, 400.0, 0.0]", "eyes[0]: up is parallel to the view"),
        ("[0.0, 400.0]", "eyes[0].position_mm"),
    ],
)
def test_an_eye_point_that_looks_nowhere_is_refused_on_loading(
    spoilt: Spoil, place: str, says: str
) -> None:
    path = spoilt("[[objects]]", EYES.format(place))
    with pytest.raises(LamplitError) as caught:
        load_scene(path)
    assert f"{path}: {says}" in str(caught.value)


def test_the_check_finds_an_eye_point_inside_an_opaque_body(spoilt: Spoil) -> None:
    report = check_scene(load_scene(spoilt("[[objects]]", EYES.format("[32.0, 2.0, 2.0]"))))
    found = [finding for finding in report.findings if finding.level == "error"]
    assert [finding.subject for finding in found] == ["eyes[0]"]
    assert "from (32, 2, 2) mm, the camera is inside 'part'" in found[0].message

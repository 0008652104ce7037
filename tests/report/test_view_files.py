# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Frames under one white, and an animation that any reader of animated PNG plays."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PIL import Image as Pillow

import lamplit as ll
from lamplit.report.exr_file import read_exr
from lamplit.report.view_files import write_views

MakeImage = Callable[..., Any]

D65 = np.array([0.95047, 1.0, 1.08883])


@pytest.fixture
def grey(make_image: MakeImage) -> Callable[..., Any]:
    """Return a maker of pictures of even luminance from a place of their own."""

    def make(luminance: float, white: float | str = "auto", **settings: Any) -> Any:
        image = make_image(xyz=np.full((6, 8, 1), luminance) * np.ones(3))
        scene = image.scene
        scene.white_luminance_cd_m2 = white
        scene.settings = {"adaptation": "none"}
        scene.space = settings.get("space", "srgb")
        scene.camera = SimpleNamespace(position_mm=(luminance, 0.0, 9.0), target_mm=(0.0,) * 3)
        return image

    return make


def shown(path: Path, at: int = 0) -> np.ndarray:
    """Return the codes of a picture as Pillow reads them."""
    with Pillow.open(path) as picture:
        picture.seek(at)
        return np.asarray(picture.convert("RGB"))


def test_the_animation_shows_the_frames_there_and_back(
    tmp_path: Path, grey: Callable[..., Any]
) -> None:
    write_views([grey(value, 900.0) for value in (100.0, 200.0, 400.0, 800.0)], tmp_path)
    frames = [shown(tmp_path / f"frame-00{at}.png") for at in (1, 2, 3, 4)]
    with Pillow.open(tmp_path / "animation.png") as film:
        assert (film.n_frames, film.info["loop"], film.is_animated) == (6, 0, True)
        assert film.info["duration"] == 100.0
        assert film.info["srgb"] == 1
    for at, frame in enumerate((0, 1, 2, 3, 2, 1)):
        np.testing.assert_array_equal(shown(tmp_path / "animation.png", at), frames[frame])
    assert len({frame.tobytes() for frame in frames}) == 4


def test_a_circle_goes_on_with_its_first_frame(tmp_path: Path, grey: Callable[..., Any]) -> None:
    images = [grey(value, 900.0) for value in (100.0, 200.0, 400.0)]
    numbers = write_views(images, tmp_path, circle=True)
    with Pillow.open(tmp_path / "animation.png") as film:
        assert film.n_frames == 3
    assert numbers["animation"]["frames_in_a_round"] == 3


def test_one_frame_is_a_still_picture(tmp_path: Path, grey: Callable[..., Any]) -> None:
    write_views([grey(100.0)], tmp_path)
    np.testing.assert_array_equal(
        shown(tmp_path / "animation.png"), shown(tmp_path / "frame-001.png")
    )


def test_left_to_the_picture_the_white_is_that_of_all_frames(
    tmp_path: Path, grey: Callable[..., Any]
) -> None:
    """Of two even greys the brighter one is white, and the other a quarter of it, in any order."""
    numbers = write_views([grey(100.0), grey(400.0)], tmp_path / "rising")
    write_views([grey(400.0), grey(100.0)], tmp_path / "falling")
    for folder, names in {"rising": "12", "falling": "21"}.items():
        dark, bright = (tmp_path / folder / f"frame-00{name}" for name in names)
        files = [read_exr(path.with_suffix(".exr")) for path in (dark, bright)]
        largest = [np.stack([file.channels[c] for c in "RGB"]).max() for file in files]
        assert largest == pytest.approx([0.25, 1.0], rel=1e-6)
        assert files[0].attributes["whiteLuminance"] == files[1].attributes["whiteLuminance"]
        # sRGB writes a quarter as 1.055·0.25^(1/2.4) − 0.055, which is code 137 of 255.
        assert shown(dark.with_suffix(".png")).max() == 137
        assert shown(bright.with_suffix(".png")).max() == 255
    whites = [frame["display"]["white_luminance_cd_m2"] for frame in numbers["frames"]]
    assert whites == [numbers["white_luminance_cd_m2"]] * 2


def test_the_values_are_those_of_the_pictures_whatever_the_white(
    tmp_path: Path, grey: Callable[..., Any]
) -> None:
    """The first frame is written anew under the white of both; its values must not change."""
    images = [grey(100.0), grey(400.0)]
    write_views(images, tmp_path)
    for at, image in enumerate(images, start=1):
        file = read_exr(tmp_path / f"frame-00{at}.exr")
        np.testing.assert_array_equal(file.xyz, image.xyz.astype(np.float32))
        errors = file.vectors("standard_error.")
        np.testing.assert_array_equal(errors, image.xyz_standard_error.astype(np.float32))
        np.testing.assert_array_equal(file.channels["samples"], 16)


def test_many_large_frames_are_pooled_by_a_part_of_their_pixels(
    tmp_path: Path, grey: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("lamplit.report.view_files._MOST_POOLED", 20)
    numbers = write_views([grey(value) for value in (10.0, 400.0, 20.0, 30.0)], tmp_path)
    alone = write_views([grey(400.0)], tmp_path / "alone")
    assert numbers["white_luminance_cd_m2"] == alone["white_luminance_cd_m2"]


def test_the_summary_tells_place_and_numbers_of_each_frame(
    tmp_path: Path, grey: Callable[..., Any]
) -> None:
    numbers = write_views([grey(100.0, 500.0), grey(200.0, 500.0)], tmp_path)
    assert json.loads(json.dumps(numbers)) == json.loads((tmp_path / "summary.json").read_text())
    assert numbers["complete"] is True
    assert numbers["white_luminance_cd_m2"] == 500.0
    assert [frame["luminance_cd_m2"]["mean"] for frame in numbers["frames"]] == [100.0, 200.0]
    assert [frame["position_mm"][0] for frame in numbers["frames"]] == [100.0, 200.0]
    assert numbers["frames"][1]["files"] == ["frame-002.png", "frame-002.exr"]


def test_frames_of_a_longer_run_before_are_removed(
    tmp_path: Path, grey: Callable[..., Any]
) -> None:
    kept = ["frame-0003.png", "frame-003.jpg", "my-frame-003.png"]
    for name in [*kept, "frame-003.png", "frame-003.exr", "frame-120.png"]:
        (tmp_path / name).write_text("older")
    write_views([grey(100.0), grey(200.0)], tmp_path)
    written = {f"frame-00{at}.{end}" for at in (1, 2) for end in ("png", "exr")}
    expected = {*kept, *written, "animation.png", "summary.json"}
    assert {path.name for path in tmp_path.iterdir()} == expected


def test_what_came_before_ctrl_c_is_written(tmp_path: Path, grey: Callable[..., Any]) -> None:
    def two_of_three() -> Iterator[Any]:
        yield grey(100.0)
        yield grey(400.0)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_views(two_of_three(), tmp_path)
    with Pillow.open(tmp_path / "animation.png") as film:
        assert film.n_frames == 2
    assert len(json.loads((tmp_path / "summary.json").read_text())["frames"]) == 2


def test_no_picture_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ll.LamplitError, match="there is no picture"):
        write_views([], tmp_path)


def test_a_wide_display_is_tagged_in_the_animation_as_in_the_frames(
    tmp_path: Path, grey: Callable[..., Any]
) -> None:
    write_views([grey(value, space="display-p3") for value in (100.0, 200.0)], tmp_path)
    profiles = []
    for name in ("animation.png", "frame-001.png"):
        with Pillow.open(tmp_path / name) as picture:
            profiles.append(picture.info["icc_profile"])
    assert profiles[0] == profiles[1]

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit render --turntable`` and ``--eyes``, from the command line to the files."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from PIL import Image as Pillow

from lamplit.engine import Image, Views

Run = Callable[..., int]

#: The ball is opaque, and the middle of the circle is half-way to it.
INTO_THE_BALL = ["--set", "objects[0].material=black-abs"]
INTO_THE_BALL += ["--set", "camera.target_mm=[0.0, 0.0, 150.0]"]


def names(directory: Path) -> set[str]:
    return {path.name for path in directory.iterdir()}


def frames_of(count: int) -> set[str]:
    frames = {f"frame-{at:03d}.{end}" for at in range(1, count + 1) for end in ("png", "exr")}
    return frames | {"animation.png", "summary.json"}


def test_a_turntable_writes_frames_an_animation_and_one_summary(
    lamplit: Run, scene_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out, "--turntable", 3) == 0
    assert names(out) == frames_of(3)
    with Pillow.open(out / "animation.png") as film:
        assert (film.n_frames, film.size) == (4, (16, 10))
    numbers = json.loads((out / "summary.json").read_text())
    assert numbers["command"] == f"lamplit render {scene_file} -o {out} --turntable 3"
    assert numbers["complete"] is True
    assert numbers["frames"][1]["position_mm"] == [0.0, 0.0, 300.0]
    shown = capsys.readouterr()
    assert "Red ball: 3 frames of 16 × 10" in shown.out
    assert "frame-001.png to frame-003.png" in shown.out
    assert "300 cd/m² in all frames" in shown.out


def test_the_same_seed_gives_the_same_files_again(lamplit: Run, scene_file: Path) -> None:
    out = scene_file.parent / "out"
    runs: list[dict[str, bytes]] = []
    for threads in (1, 2):
        options = ["--turntable", 4, "--sweep", 360, "--threads", threads]
        assert lamplit("render", scene_file, "-o", out, *options) == 0
        runs.append({path.name: path.read_bytes() for path in out.glob("frame-*.png")})
    assert len(runs[0]) == 4
    # The command, which is in the files, names the threads.
    pixels = [{name: file[file.index(b"IDAT") :] for name, file in run.items()} for run in runs]
    assert pixels[0] == pixels[1]


def test_eye_points_come_from_a_file_or_from_the_scene(lamplit: Run, scene_file: Path) -> None:
    out = scene_file.parent / "out"
    walk = scene_file.parent / "walk.csv"
    walk.write_text("x_mm,y_mm,z_mm\n0,50,300\n80,50,280\n")
    scene_file.write_text(scene_file.read_text() + "[[eyes]]\nposition_mm = [9.0, 9.0, 250.0]\n")
    assert lamplit("render", scene_file, "-o", out, "--eyes", walk) == 0
    frames = json.loads((out / "summary.json").read_text())["frames"]
    assert [frame["position_mm"] for frame in frames] == [[0, 50, 300], [80, 50, 280]]
    assert lamplit("render", scene_file, "-o", out, "--eyes", "scene") == 0
    frames = json.loads((out / "summary.json").read_text())["frames"]
    assert [frame["position_mm"] for frame in frames] == [[9, 9, 250]]
    assert names(out) == frames_of(1)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--turntable", 1], "2 to 999 frames, not 1"),
        (["--turntable", 3, "--sweep", 400], "at most 360°"),
        (["--sweep", 90], "--sweep: a sweep is that of a --turntable"),
        (["--turntable", 3, "--eyes", "walk.csv"], "either --turntable or --eyes"),
        (["--eyes", "gone.csv"], "gone.csv: this file does not exist"),
        (["--eyes", "scene"], "the scene has no [[eyes]]"),
        (["--turntable", 3, "--layers"], "--layers: this is for a single picture"),
        (["--turntable", 3, "--features"], "--features: this is for a single picture"),
        (["--turntable", 3, "--spectral"], "--spectral: this is for a single picture"),
        (["--turntable", 3, "--gamut-mask"], "--gamut-mask: this is for a single picture"),
        (
            ["--turntable", 2, "--sweep", 360, *INTO_THE_BALL],
            "turntable[1]: from (0, 0, 0) mm, the camera is inside 'ball'",
        ),
    ],
)
def test_what_cannot_be_done_is_one_line_before_anything_is_written(
    lamplit: Run,
    scene_file: Path,
    capsys: pytest.CaptureFixture[str],
    options: list[object],
    says: str,
) -> None:
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out, *options) == 2
    error = capsys.readouterr().err
    assert says in error
    assert error.count("\n") == 1
    assert not out.exists()


@pytest.fixture
def stopped_after(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Return what lets Ctrl-C come once so many frames are done."""
    images = Views.images

    def stop(count: int) -> None:
        def few(views: Views, **options: Any) -> Iterator[Image]:
            frames = images(views, **options)
            for _ in range(count):
                yield next(frames)
            raise KeyboardInterrupt

        monkeypatch.setattr(Views, "images", few)

    return stop


def test_ctrl_c_keeps_the_frames_that_are_done_and_animates_them(
    lamplit: Run,
    scene_file: Path,
    capsys: pytest.CaptureFixture[str],
    stopped_after: Callable[[int], None],
) -> None:
    out = scene_file.parent / "out"
    stopped_after(3)
    assert lamplit("render", scene_file, "-o", out, "--turntable", 6, "--sweep", 360) == 130
    assert names(out) == frames_of(3)
    with Pillow.open(out / "animation.png") as film:
        assert film.n_frames == 4  # there and back, since the circle is not closed
    numbers = json.loads((out / "summary.json").read_text())
    assert (numbers["complete"], numbers["frames_asked"]) == (False, 6)
    assert "stopped with 3 of 6 frames" in capsys.readouterr().out


def test_ctrl_c_before_the_first_frame_leaves_older_results_alone(
    lamplit: Run, scene_file: Path, stopped_after: Callable[[int], None]
) -> None:
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out, "--turntable", 2) == 0
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    stopped_after(0)
    assert lamplit("render", scene_file, "-o", out, "--turntable", 2) == 130
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before


def test_a_frame_with_too_many_lost_rays_is_named_and_the_code_is_1(
    lamplit: Run,
    scene_file: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    images = Views.images
    lost = {"lost_rays": {"ball": {"ended_inside": 10**9}}}

    def one_bad(views: Views, **options: Any) -> Iterator[Image]:
        for at, image in enumerate(images(views, **options)):
            spoilt = dict(image.statistics) | (lost if at == 1 else {})
            yield replace(image, statistics=spoilt)

    monkeypatch.setattr(Views, "images", one_bad)
    out = scene_file.parent / "out"
    options = ["--turntable", 3]
    assert lamplit("render", scene_file, "-o", out, *options) == 1
    shown = capsys.readouterr()
    assert "error: the frames are written, but frame 2: " in shown.err
    assert "warning: frame 2: " in " ".join(shown.out.split())
    assert lamplit("render", scene_file, "-o", out, *options, "--allow-lost") == 0

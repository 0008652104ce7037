# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit mix``: from the layers of a render to another picture, without tracing."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lamplit import engine
from lamplit.report.exr_file import read_exr

Run = Callable[..., int]

MIXED = {"picture.png", "picture.exr", "summary.json"}

LAMP = """
[[objects]]
name = "filament"
kind = "sphere"
centre_mm = [60.0, 20.0, 0.0]
radius_mm = 8.0
material = "black-abs"
emission = { source = "A", luminance_cd_m2 = 5000.0 }
"""


@pytest.fixture
def render(lamplit: Run, scene_file: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder of a render with the layers ``background`` and ``filament``."""
    scene_file.write_text(scene_file.read_text() + LAMP)
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out, "--layers", "--samples", 16) == 0
    monkeypatch.setattr(engine, "render", None)  # nothing is traced from here on
    return out


def luminance(folder: Path) -> np.ndarray:
    return read_exr(folder / "picture.exr").channels["Y"].astype(np.float64)


def test_all_groups_together_are_the_picture_and_it_stays(lamplit: Run, render: Path) -> None:
    before = {path.name: path.read_bytes() for path in render.iterdir()}
    assert lamplit("mix", render) == 0
    assert {path.name for path in (render / "mix").iterdir()} == MIXED
    np.testing.assert_allclose(luminance(render / "mix"), luminance(render), rtol=1e-5)
    whole, mixed = (folder / "picture.png" for folder in (render, render / "mix"))
    assert whole.stat().st_size > 100 and mixed.stat().st_size > 100
    assert {path.name: path.read_bytes() for path in render.iterdir() if path.is_file()} == before


def test_a_dimmed_group_counts_as_it_is_told_and_the_others_once(
    lamplit: Run, render: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    layers = read_exr(render / "layers.exr").channels
    out = render.parent / "dimmed"
    assert lamplit("mix", render, "--set", "filament=0.5", "-o", out) == 0
    expected = layers["background.Y"] + 0.5 * layers["filament.Y"]
    np.testing.assert_allclose(luminance(out), expected, rtol=1e-6)
    assert layers["filament.Y"].max() > 1000.0
    shown = capsys.readouterr().out
    assert "1 × background + 0.5 × filament" in shown
    assert "at most" in shown
    numbers = json.loads((out / "summary.json").read_text())
    assert numbers["weights"] == {"background": 1.0, "filament": 0.5}
    assert numbers["command"] == f"lamplit mix {render} --set filament=0.5 -o {out}"
    assert "lamplit render" in numbers["render"]["command"]


def test_the_exposure_is_the_scenes_unless_it_is_named(lamplit: Run, render: Path) -> None:
    for words, white in ([], 300.0), (["--white", "1200"], 1200.0):
        assert lamplit("mix", render, *words) == 0
        display = json.loads((render / "mix" / "summary.json").read_text())["display"]
        assert display["white_luminance_cd_m2"] == white
    assert lamplit("mix", render, "--white", "auto", "--display", "rec2020") == 0
    display = json.loads((render / "mix" / "summary.json").read_text())["display"]
    assert display["label"] == "Rec. 2020"
    assert display["white_luminance_cd_m2"] not in (300.0, 1200.0)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--set", "filamnt=1"], "did you mean 'filament'?"),
        (["--set", "filament=-1"], "must be 0 or more"),
        (["--set", "filament=nan"], "is no weight"),
        (["--set", "filament"], "is no weight"),
        (["--set", "filament=1", "--set", "filament=2"], "two weights"),
        (["--white", "-3"], "is no luminance"),
        (["--white", "bright"], "is no luminance"),
        (["-o", "{render}"], "the render itself lies there"),
    ],
)
def test_what_cannot_be_mixed_is_one_line_and_leaves_no_file(
    lamplit: Run,
    render: Path,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
    told: str,
) -> None:
    capsys.readouterr()
    assert lamplit("mix", render, *(word.format(render=render) for word in words)) == 2
    error = capsys.readouterr().err
    assert told in error and error.count("\n") == 1
    assert not (render / "mix").exists()


def test_a_folder_without_layers_says_how_to_get_them(
    lamplit: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert lamplit("mix", tmp_path) == 2
    assert "`lamplit render --layers` writes it" in capsys.readouterr().err

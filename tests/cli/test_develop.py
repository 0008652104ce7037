# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit develop`` and the options that say how a picture is to be seen."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image as Raster

from lamplit import engine
from lamplit.report.exr_file import read_exr, save_exr

Run = Callable[..., int]


@pytest.fixture
def render(lamplit: Run, scene_file: Path, painter: Any, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder of a picture that was rendered once."""
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out) == 0
    monkeypatch.setattr(engine, "render", None)  # nothing is traced from here on
    return out


def numbers(folder: Path) -> dict[str, Any]:
    return json.loads((folder / "develop.json").read_text())


def test_without_options_it_is_the_picture_again_and_nothing_of_the_render_changes(
    lamplit: Run, render: Path
) -> None:
    before = {path.name: path.read_bytes() for path in render.iterdir()}
    assert lamplit("develop", render / "picture.exr") == 0
    made = render / "developed"
    assert {path.name for path in made.iterdir()} == {"picture.png", "develop.json"}
    pictures = [np.asarray(Raster.open(folder / "picture.png")) for folder in (render, made)]
    assert np.abs(pictures[0].astype(int) - pictures[1]).max() <= 1  # the EXR is float32
    assert {path.name: path.read_bytes() for path in render.iterdir() if path.is_file()} == before
    summary = json.loads((render / "summary.json").read_text())
    assert numbers(made)["display"] == pytest.approx(summary["display"])
    assert numbers(made)["picture"]["scene_hash"] == summary["scene_hash"]
    assert numbers(made)["command"] == f"lamplit develop {render / 'picture.exr'}"


def test_every_option_counts_as_it_would_in_the_scene(
    lamplit: Run, render: Path, scene_file: Path, monkeypatch: pytest.MonkeyPatch, painter: Any
) -> None:
    words = ["--white", "80", "--tone", "photographic", "--brightest", "9000"]
    words += ["--display", "rec2020", "--false-colour", "--glare", "--age", "70", "--pupil-mm", "5"]
    assert lamplit("develop", render, "-o", render.parent / "a", *words) == 0
    monkeypatch.setattr(engine, "render", painter.render)
    assert lamplit("render", scene_file, "-o", render.parent / "b", *words) == 0
    developed = numbers(render.parent / "a")
    rendered = json.loads((render.parent / "b" / "summary.json").read_text())
    assert developed["display"] == pytest.approx(rendered["display"])
    assert developed["display"]["white_luminance_cd_m2"] == 80.0
    assert developed["display"]["brightest_luminance_cd_m2"] == 9000.0
    assert developed["glare"] == pytest.approx(rendered["glare"])
    assert (developed["glare"]["age"], developed["glare"]["pupil_mm"]) == (70.0, 5.0)
    assert developed["false_colour"] == pytest.approx(rendered["false_colour"])
    names = {"picture.png", "false-colour.png", "picture-glare.png"}
    assert names <= {path.name for path in (render.parent / "a").iterdir()}


def test_a_scenes_own_display_table_asks_for_the_same(
    lamplit: Run, scene_file: Path, painter: Any
) -> None:
    text = scene_file.read_text()
    table = '[display]\ntone = "photographic"\nfalse_colour = true\nglare = true\neye.age = 64\n'
    scene_file.write_text(text.replace("[display]\n", table))
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out) == 0
    assert (out / "false-colour.png").stat().st_size > 1000
    assert lamplit("develop", out) == 0
    found = numbers(out / "developed")
    assert found["display"]["tone"] == "photographic"
    assert found["glare"]["age"] == 64.0
    assert lamplit("develop", out, "--age", "30", "--tone", "linear") == 0
    found = numbers(out / "developed")
    assert found["display"]["tone"] == "linear"
    assert found["glare"]["age"] == 30.0


@pytest.mark.parametrize("option", [["--age", "50"], ["--pupil-mm", "4"]])
def test_who_names_an_eye_wants_its_glare(lamplit: Run, render: Path, option: list[str]) -> None:
    assert lamplit("develop", render, *option) == 0
    assert (render / "developed" / "picture-glare.png").exists()


def test_both_halves_of_a_comparison_share_the_exposure_that_is_asked_for(
    lamplit: Run, scene_file: Path, painter: Any
) -> None:
    out = scene_file.parent / "out"
    words = ["--white", "auto", "--tone", "photographic"]
    assert lamplit("compare", scene_file, "-o", out, *words) == 0
    found = json.loads((out / "comparison.json").read_text())
    exposures = [
        [found[half]["display"][f"{name}_luminance_cd_m2"] for name in ("white", "brightest")]
        for half in ("rgb", "spectral")
    ]
    assert exposures[0] == exposures[1]
    assert exposures[0][0] != 300.0


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--white", "0"], "--white: '0' is no luminance; write cd/m²"),
        (["--brightest", "much"], "--brightest: 'much' is no luminance"),
        (["--age", "12"], "20"),
        (["--pupil-mm", "9"], "8"),
        (["--tone", "filmic"], "photographic"),
        (["-o", "{render}"], "the picture itself lies there"),
    ],
)
def test_what_cannot_be_developed_is_one_line_and_leaves_no_file(
    lamplit: Run,
    render: Path,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
    told: str,
) -> None:
    capsys.readouterr()
    assert lamplit("develop", render, *(word.format(render=render) for word in words)) == 2
    error = capsys.readouterr().err
    assert told in error
    assert error.count("\n") == 1
    assert not (render / "developed").exists()


def test_glare_of_an_orthographic_picture_is_refused_before_and_after_the_render(
    lamplit: Run, scene_file: Path, painter: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    text = scene_file.read_text().replace('kind = "pinhole"', 'kind = "orthographic"')
    scene_file.write_text(text.replace("field_of_view_deg = 30.0", "height_mm = 200.0"))
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out, "--glare") == 2
    assert painter.calls == []
    assert lamplit("render", scene_file, "-o", out) == 0
    assert lamplit("develop", out, "--glare") == 2
    errors = [line for line in capsys.readouterr().err.splitlines() if line.startswith("error")]
    assert len(errors) == 2
    assert all("an orthographic picture has none" in error for error in errors)
    assert str(out / "picture.exr") in errors[1]


@pytest.mark.parametrize("spoilt", ["missing", "text", "foreign", "view"])
def test_a_file_that_is_no_picture_of_lamplit_is_refused_in_one_line(
    lamplit: Run, render: Path, capsys: pytest.CaptureFixture[str], spoilt: str
) -> None:
    file = render.parent / "other.exr"
    kept = read_exr(render / "picture.exr")
    if spoilt == "text":
        file.write_text("no picture")
    elif spoilt == "foreign":
        save_exr(file, {name: kept.channels[name] for name in "RGB"}, {})
    elif spoilt == "view":
        view = json.loads(kept.attributes["lamplit.view"]) | {"tone": "filmic"}
        save_exr(file, kept.channels, {"lamplit.view": json.dumps(view)})
    capsys.readouterr()
    assert lamplit("develop", file, "-o", render.parent / "x") == 2
    error = capsys.readouterr().err
    assert error.startswith(f"error: {file}: ")
    assert error.count("\n") == 1
    assert not (render.parent / "x").exists()


def test_a_mixture_can_be_developed(
    lamplit: Run, scene_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lamp = '[[objects]]\nname = "lamp"\nkind = "sphere"\ncentre_mm = [60.0, 20.0, 0.0]\n'
    lamp += 'radius_mm = 8.0\nmaterial = "black-abs"\n'
    lamp += 'emission = { source = "A", luminance_cd_m2 = 5000.0 }\n'
    scene_file.write_text(scene_file.read_text() + lamp)
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out, "--layers", "--samples", 4) == 0
    assert lamplit("mix", out, "--set", "background=0", "--glare", "--false-colour") == 0
    assert (out / "mix" / "picture-glare.png").exists()
    assert (out / "mix" / "false-colour.png").exists()
    assert lamplit("develop", out / "mix", "--white", "9000") == 0
    found = numbers(out / "mix" / "developed")
    assert found["display"]["white_luminance_cd_m2"] == 9000.0
    assert found["picture"]["weights"]["background"] == 0.0
    assert found["glare"] is not None

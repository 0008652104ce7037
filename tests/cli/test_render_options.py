# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How ``lamplit render`` is told to sample: what reaches the engine, and what contradicts."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from lamplit.report.exr_file import read_exr

if TYPE_CHECKING:
    from tests.cli.conftest import Painter

Run = Callable[..., int]


@pytest.mark.parametrize(
    ("words", "asked"),
    [
        ([], {"error": None, "time_s": None, "adaptive": None, "layers": False}),
        (["--error", "0.02"], {"error": 0.02}),
        (["--time", "90"], {"time_s": 90.0}),
        (["--adaptive", "--samples", "64"], {"adaptive": True, "samples": 64}),
        (["--uniform"], {"adaptive": False}),
        (["--layers", "--features"], {"layers": True, "features": True}),
    ],
)
def test_what_is_asked_for_reaches_the_engine(
    lamplit: Run, painter: Painter, scene_file: Path, words: list[str], asked: dict[str, object]
) -> None:
    assert lamplit("render", scene_file, "-o", scene_file.parent / "out", *words) == 0
    call = painter.calls[0]
    assert {name: call[name] for name in asked} == asked


@pytest.mark.parametrize("method", ["path", "hall"])
def test_the_method_stands_in_for_the_scenes(
    lamplit: Run, painter: Painter, scene_file: Path, method: str
) -> None:
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out, "--method", method) == 0
    assert painter.calls[0]["scene"].image.method == painter.calls[0]["method"] == method


def test_a_comparison_is_by_hall_unless_another_method_is_asked_for(
    lamplit: Run, painter: Painter, scene_file: Path
) -> None:
    out = scene_file.parent / "out"
    assert lamplit("compare", scene_file, "-o", out) == 0
    assert lamplit("compare", scene_file, "-o", out, "--method", "path") == 0
    assert [call["method"] for call in painter.calls[::2]] == ["hall", "path"]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--uniform", "--error", "0.1"], "uniform sampling cannot reach a target error"),
        (["--method", "hall", "--error", "0.1"], "a target error needs the method path"),
        (["--method", "hall", "--time", "1"], "a time budget needs the method path"),
        (["--method", "hall", "--adaptive"], "adaptive sampling needs the method path"),
        (["--method", "hall", "--layers"], "a layer per light group needs the method path"),
        (["--method", "pth"], "'pth'"),
        (["--error", "2"], "a target error is a share above 0 and at most 1"),
        (["--time", "-3"], "a time budget is a number of seconds above 0"),
        (["--method", "hall", "--samples", "5"], "a grid needs a square number"),
    ],
)
def test_a_contradiction_is_one_line_before_anything_is_done(
    lamplit: Run,
    painter: Painter,
    scene_file: Path,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
    told: str,
) -> None:
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out, *words) == 2
    error = capsys.readouterr().err
    assert told in error
    assert error.count("\n") == 1
    assert painter.calls == [] and not out.exists()


def test_a_path_render_tells_error_speed_and_where_the_walks_ended(
    lamplit: Run, scene_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = scene_file.parent / "out"
    words = ["--error", "0.2", "--features"]
    assert lamplit("render", scene_file, "-o", out, *words) == 0
    shown = capsys.readouterr().out
    assert "%, 20 % was asked" in shown
    assert "million rays/s" in shown
    assert "where the walks ended" in shown and "background" in shown and "ball" in shown
    numbers = json.loads((out / "summary.json").read_text())
    assert numbers["method"] == "path"
    assert numbers["error_asked"] == 0.2
    assert 0.0 < numbers["relative_error_rms"] < 0.3
    assert abs(numbers["ledger"]["gap"]) < 1e-9
    assert numbers["speed"]["rays_per_s"] > numbers["speed"]["paths_per_s"] > 0
    depth = read_exr(out / "picture.exr").channels["depth.mm"]
    assert depth[5, 8] == pytest.approx(260.0, abs=3.0)


def test_what_path_leaves_out_is_told(
    lamplit: Run, scene_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene_file.write_text(
        scene_file.read_text() + '[ambient]\nsource = "D65"\nluminance_cd_m2 = 9.0\n'
    )
    assert lamplit("render", scene_file, "-o", scene_file.parent / "out") == 0
    assert "notice: path transport leaves out [ambient]" in capsys.readouterr().out

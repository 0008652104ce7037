# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit render`` and ``lamplit compare`` from the scene file to the files on disk."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from lamplit.cli.stopping import stop_signals
from lamplit.report.comparison import COMPARISON_FILES
from lamplit.report.exr_file import read_exr

if TYPE_CHECKING:
    from tests.cli.conftest import Painter

Run = Callable[..., int]


def names(directory: Path) -> set[str]:
    return {path.name for path in directory.iterdir()}


def test_a_render_writes_picture_values_and_summary(
    lamplit: Run, painter: Painter, scene_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out) == 0
    assert names(out) == {"picture.png", "picture.exr", "summary.json"}
    shown = capsys.readouterr().out
    assert "Red ball: 16 × 10, 4 samples per pixel" in shown
    assert f"Files in {out}\n  picture.png" in shown


def test_the_folder_of_a_scene_is_enough(lamplit: Run, painter: Painter, scene_file: Path) -> None:
    assert lamplit("render", scene_file.parent, "-o", scene_file.parent / "out") == 0


def test_options_reach_the_scene_that_is_rendered(
    lamplit: Run, painter: Painter, scene_file: Path
) -> None:
    out = scene_file.parent / "out"
    options = ["--samples", 9, "--seed", 7, "--size", "20x12", "--threads", 2]
    more = ["--display", "display-p3", "--set", "camera.field_of_view_deg=20.0"]
    assert lamplit("render", scene_file, "-o", out, *options, *more) == 0
    call = painter.calls[0]
    scene = call["scene"]
    assert (scene.image.samples, scene.image.seed) == (9, 7)
    assert (scene.image.width, scene.image.height) == (20, 12)
    assert scene.display.space == "display-p3"
    assert scene.camera.field_of_view_deg == 20.0
    assert call["threads"] == 2


def test_the_summary_holds_the_command_that_makes_it_again(
    lamplit: Run, painter: Painter, scene_file: Path
) -> None:
    out = scene_file.parent / "with space"
    assert lamplit("render", scene_file, "-o", out, "--seed", 5) == 0
    numbers = json.loads((out / "summary.json").read_text())
    assert numbers["seed"] == 5
    assert numbers["scene_hash"] == painter.calls[0]["scene"].scene_hash
    assert numbers["command"] == f"lamplit render {scene_file} -o '{out}' --seed 5"
    header = read_exr(out / "picture.exr").attributes
    assert header["lamplit.command"] == numbers["command"]


def test_spectra_and_mask_come_on_request(lamplit: Run, painter: Painter, scene_file: Path) -> None:
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out, "--spectral", "--gamut-mask", "--bits", 16) == 0
    assert painter.calls[0]["spectral_bands"] is True
    assert "gamut-mask.png" in names(out)
    assert "S0.450,000nm" in read_exr(out / "picture.exr").channels
    assert (out / "picture.png").read_bytes()[24] == 16


def test_an_unwritable_output_is_refused_before_the_render(
    lamplit: Run, painter: Painter, scene_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert lamplit("render", scene_file, "-o", scene_file / "out") == 2
    assert painter.calls == []
    assert capsys.readouterr().err.count("\n") == 1


def test_an_icc_profile_that_is_missing_is_refused_before_the_render(
    lamplit: Run, painter: Painter, scene_file: Path
) -> None:
    override = 'display.space={icc = "missing.icc"}'
    assert lamplit("render", scene_file, "-o", scene_file.parent / "o", "--set", override) == 2
    assert painter.calls == []


@pytest.mark.parametrize("command", ["render", "compare"])
def test_ctrl_c_keeps_what_is_done_and_ends_with_130(
    lamplit: Run,
    painter: Painter,
    scene_file: Path,
    capsys: pytest.CaptureFixture[str],
    command: str,
) -> None:
    painter.samples_before_stop = 1
    out = scene_file.parent / "out"
    assert lamplit(command, scene_file, "-o", out) == 130
    kept = {"picture.png", "picture.exr", "summary.json"}
    assert names(out) == (kept if command == "render" else {"spectral.png", "spectral.exr"})
    assert "stopped with 1 of 4 samples" in capsys.readouterr().out


@pytest.mark.parametrize("command", ["render", "compare"])
def test_ctrl_c_before_the_first_sample_leaves_older_results_alone(
    lamplit: Run, painter: Painter, scene_file: Path, command: str
) -> None:
    out = scene_file.parent / "out"
    assert lamplit(command, scene_file, "-o", out) == 0
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    painter.samples_before_stop = 0
    assert lamplit(command, scene_file, "-o", out) == 130
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)], ids=["INT", "TERM"]
)
def test_a_signal_becomes_an_interrupt_and_its_exit_code(number: int, code: int) -> None:
    before = signal.getsignal(number)
    with stop_signals() as stop:
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), number)
        assert stop.exit_code == code
    assert signal.getsignal(number) == before


class CorePanic(BaseException):
    """A panic of the compiled core is not an Exception either."""


@pytest.mark.parametrize("fault", [ZeroDivisionError("a\nb"), MemoryError(), CorePanic("x")])
def test_an_internal_fault_is_one_line_and_says_how_to_see_more(
    lamplit: Run,
    painter: Painter,
    scene_file: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    fault: BaseException,
) -> None:
    monkeypatch.delenv("LAMPLIT_TRACEBACK", raising=False)
    painter.fault = fault
    assert lamplit("render", scene_file, "-o", scene_file.parent / "out") == 1
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert type(fault).__name__ in error
    assert "LAMPLIT_TRACEBACK=1" in error
    monkeypatch.setenv("LAMPLIT_TRACEBACK", "1")
    assert lamplit("render", scene_file, "-o", scene_file.parent / "out") == 1
    assert "Traceback" in capsys.readouterr().err


def test_a_comparison_writes_its_files_and_tells_the_difference(
    lamplit: Run, painter: Painter, scene_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = scene_file.parent / "out"
    assert lamplit("compare", scene_file, "-o", out, "--mark", "12,4") == 0
    assert names(out) == set(COMPARISON_FILES)
    numbers = json.loads((out / "comparison.json").read_text())
    assert numbers["marks"][0]["column"] == 12
    shown = capsys.readouterr().out
    assert f"{numbers['delta_e_2000']['mean']:.2f}" in shown


def test_a_mark_outside_the_picture_is_refused_before_the_render(
    lamplit: Run, painter: Painter, scene_file: Path
) -> None:
    assert lamplit("compare", scene_file, "-o", scene_file.parent / "o", "--mark", "16,0") == 2
    assert painter.calls == []


def lost(rays: int) -> dict[str, Any]:
    return {"eye_rays": 8000, "shadow_rays": 2000, "lost_rays": {"ball": {"ended_inside": rays}}}


@pytest.mark.parametrize("command", ["render", "compare"])
@pytest.mark.parametrize(
    ("statistics", "allowed", "code", "told"),
    [
        (lost(0), False, 0, ""),
        (lost(1), False, 0, ""),
        (lost(2), False, 0, "warning: 0.02 % of the rays were lost: 2 at 'ball' ended inside"),
        (lost(100), False, 0, "warning: 1 % of the rays were lost"),
        (lost(101), False, 1, "warning: 1 % of the rays were lost"),
        (lost(900), True, 0, "warning: 9 % of the rays were lost"),
        ({"dropped_samples": 1}, True, 1, "warning: 1 samples were not finite or negative"),
    ],
)
def test_a_picture_with_losses_is_written_and_warned_of_or_refused(
    lamplit: Run,
    painter: Painter,
    scene_file: Path,
    capsys: pytest.CaptureFixture[str],
    *,
    command: str,
    statistics: dict[str, Any],
    allowed: bool,
    code: int,
    told: str,
) -> None:
    painter.statistics = statistics
    out = scene_file.parent / "out"
    more = ["--allow-lost"] if allowed else []
    assert lamplit(command, scene_file, "-o", out, *more) == code
    shown = capsys.readouterr()
    assert told in " ".join(shown.out.split())
    assert ("warning" in shown.out) == bool(told)
    assert shown.err.count("error: the picture is written, but") == code
    assert ("--allow-lost" in shown.err) == (code == 1 and not allowed)
    assert {"picture.png", "comparison.png"} & names(out)


def test_a_render_of_one_sample_has_no_error_and_says_none(
    lamplit: Run, painter: Painter, scene_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    painter.standard_error = np.inf
    out = scene_file.parent / "out"
    assert lamplit("render", scene_file, "-o", out) == 0
    numbers = json.loads((out / "summary.json").read_text())
    assert numbers["luminance_cd_m2"]["mean_standard_error"] is None
    assert "±" not in capsys.readouterr().out

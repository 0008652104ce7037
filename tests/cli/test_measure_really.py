# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`lamplit measure` with its engine: a lamp of a closed form, and Ctrl-C on a real run."""

from __future__ import annotations

import json
import os
import signal
import struct
import subprocess
import sys
import time
from collections.abc import Callable
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamplit.photometry.rays import RaySet, write_tm25

#: A disc that sends out 100 lm by Lambert's law, in a dark room: I = Φ/π · cos θ.
LAMBERT = """
lamplit = 1
name = "Lambert disc"
[camera]
kind = "pinhole"
position_mm = [0.0, 0.0, 300.0]
target_mm = [0.0, 0.0, 0.0]
up = [0.0, 1.0, 0.0]
field_of_view_deg = 30.0
[[objects]]
name = "disc"
kind = "disc"
centre_mm = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
radius_mm = 10.0
material = "black-abs"
emission = { source = "A", flux_lm = 100.0, group = "disc" }
[measure]
axis = [0.0, 0.0, 1.0]
receiver_deg = 1.0
[[measure.functions]]
name = "reversing"
rule = "un-r148/AR"
"""


@pytest.fixture
def lambert(tmp_path: Path) -> Path:
    path = tmp_path / "scene.toml"
    path.write_text(LAMBERT)
    return path


def test_a_lambertian_disc_has_its_candela_its_flux_and_its_verdict(
    lamplit: Callable[..., int], lambert: Path, tmp_path: Path
) -> None:
    """100 lm give 31.83 cd on the axis: below the 80 cd of a reversing lamp, and 22.5 at 45°."""
    out = tmp_path / "out"
    assert lamplit("measure", lambert, "-o", out, "--paths", "400000", "--threads", "1") == 0
    numbers = json.loads((out / "measurement.json").read_text())
    (function,) = numbers["functions"]
    spots = function["spots"]
    expected = [
        100.0 / pi * np.cos(np.radians(spot["h_deg"])) * np.cos(np.radians(spot["v_deg"]))
        for spot in spots
    ]
    off = np.array([spot["intensity_cd"] for spot in spots]) - expected
    sigmas = off / [spot["standard_error_cd"] for spot in spots]
    assert np.abs(sigmas).max() < 4.5
    assert numbers["outcome"] == "fail"
    on_axis = next(
        one for one in function["verdict"]["findings"]
        if one["h_deg"] == one["v_deg"] == 0.0 and one["sense"] == "min"
    )  # fmt: skip
    assert (on_axis["required"], on_axis["outcome"]) == (80.0, "fail")
    energy = numbers["energy"]
    assert energy["out_lm"] == pytest.approx(energy["emitted_lm"]["disc"], rel=1e-9)
    assert abs(energy["gap_lm"]) < 1e-7
    assert lamplit("report", out, "-o", tmp_path / "page.html") == 0
    assert "✗ fail" in (tmp_path / "page.html").read_text()


def test_the_same_seed_gives_the_same_numbers_on_any_number_of_threads(
    lamplit: Callable[..., int], lambert: Path, tmp_path: Path
) -> None:
    for threads in ("1", "2"):
        out = tmp_path / threads
        assert lamplit("measure", lambert, "-o", out, "--paths", "20000", "--threads", threads) == 0
    first, second = ((tmp_path / threads / "candela.csv").read_bytes() for threads in "12")
    assert first == second


def test_a_cross_check_has_the_closed_form_by_both_ways(
    lamplit: Callable[..., int], lambert: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """31.83 cd times the cosine, by walks from the light and from the receiver."""
    out = tmp_path / "out"
    assert lamplit("measure", lambert, "-o", out, "--paths", "200000", "--cross-check") == 0
    lines = (out / "cross-check.csv").read_text().splitlines()
    assert lines[0].startswith("H_deg,V_deg,from_light_cd,standard_error_from_light_cd,from_rec")
    rows = np.array([line.split(",") for line in lines[1:]], dtype=float)
    numbers = json.loads((out / "measurement.json").read_text())
    assert len(rows) == len(numbers["functions"][0]["spots"])
    assert "looks from the receivers" in numbers["geometry"]["test points"]
    h, v = np.radians(rows[:, :2].T)
    exact = 100.0 / pi * np.cos(h) * np.cos(v)
    for value, error, most in ((*rows[:, 2:4].T, 0.8), (*rows[:, 4:6].T, 0.03)):
        assert (np.abs(value - exact) <= 4.0 * error + 1e-3 * exact).all()
        assert (error < most * exact).all()
    shown = capsys.readouterr()
    assert "both ways agree within what chance explains" in shown.out
    assert "Drawing: 100 %" in shown.err


def test_a_cross_check_refuses_what_no_eye_can_see_before_walking(
    lamplit: Callable[..., int], lambert: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    floor = '[[objects]]\nname = "floor"\nkind = "plane"\nmaterial = "black-abs"\n'
    floor += "point_mm = [0.0, -20.0, 0.0]\nnormal = [0.0, 1.0, 0.0]\n"
    lambert.write_text(LAMBERT + floor)
    assert lamplit("measure", lambert, "-o", tmp_path / "out", "--cross-check") == 2
    assert "objects[1]: no eye sees the endless plane 'floor' whole" in capsys.readouterr().err
    left_out = LAMBERT.replace("[measure]\n", '[measure]\nleave_out = ["floor"]\n')
    lambert.write_text(left_out + floor)
    asked = ("--cross-check", "--paths", "5000")
    assert lamplit("measure", lambert, "-o", tmp_path / "out", *asked) == 0


def test_a_cross_check_refuses_ray_files_before_walking(
    lamplit: Callable[..., int], lambert: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    along = np.array([[0.0, 0.0, 1.0]])
    write_tm25(tmp_path / "led.tm25ray", RaySet(along, along, np.ones(1), quantity="luminous"))
    rays = '[[ray_files]]\nname = "led"\nfile = "led.tm25ray"\nsource = "A"\n'
    lambert.write_text(LAMBERT + rays)
    assert lamplit("measure", lambert, "-o", tmp_path / "out", "--cross-check") == 2
    assert "ray_files: the rays of a file are followed forward only" in capsys.readouterr().err


def test_what_ray_files_lack_is_told_with_the_verdict(
    lamplit: Callable[..., int], lambert: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A header of 60 lm over rays of 30 lm, and 100 rays that 5000 paths start from."""
    rows = np.zeros((100, 7), dtype="<f4")
    rows[:, [2, 5, 6]] = 1.0, 1.0, 0.3
    header = struct.pack("<iI100s7f", 1010, 100, b"", 0.0, 60.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    header += struct.pack("<i13f4i", 4, *[0.0] * 13, 0, 1, 0, 0)
    (tmp_path / "led.dat").write_bytes(header + rows.tobytes())
    rays = '[[ray_files]]\nname = "led"\nfile = "led.dat"\nsource = "A"\n'
    lambert.write_text(LAMBERT + rays)
    out = tmp_path / "out"
    assert lamplit("measure", lambert, "-o", out, "--paths", "5000") == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "led.dat: its header says 60 lm, and its rays have 30 lm" in shown
    assert "led: its file has 100 rays, fewer than the paths that were walked" in shown
    notices = json.loads((out / "measurement.json").read_text())["notices"]
    assert sum("led" in notice for notice in notices) == 2


def test_sigterm_before_walking_says_so_and_ends_with_its_number(
    lamplit: Callable[..., int], lambert: Path, tmp_path: Path,
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    def stopped(*_: Any, **__: Any) -> Any:
        os.kill(os.getpid(), signal.SIGTERM)

    monkeypatch.setattr("lamplit.scene.load_scene", stopped)
    assert lamplit("measure", lambert, "-o", tmp_path) == 143
    assert capsys.readouterr().err == "stopped before anything was finished\n"


def test_results_that_are_being_replaced_are_not_left_half_new(
    lamplit: Callable[..., int], lambert: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While plots are drawn the old files stand; while files are written, none says it is whole."""
    assert lamplit("measure", lambert, "-o", tmp_path, "--paths", "5000") == 0
    before = (tmp_path / "measurement.json").read_bytes()

    def stopped(*_: Any, **__: Any) -> Any:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr("lamplit.report.photometry.files.draw_plots", stopped)
        assert lamplit("measure", lambert, "-o", tmp_path, "--paths", "9000") == 130
    assert (tmp_path / "measurement.json").read_bytes() == before
    monkeypatch.setattr("lamplit.report.photometry.files.candela_csv", stopped)
    assert lamplit("measure", lambert, "-o", tmp_path, "--paths", "9000") == 130
    assert not (tmp_path / "measurement.json").exists()


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)], ids=["INT", "TERM"]
)
def test_a_signal_ends_a_running_measurement_and_keeps_its_paths(
    lambert: Path, number: signal.Signals, code: int
) -> None:
    out = lambert.parent / "out"
    options = ["--paths", "4000000000", "--threads", "1"]
    running = subprocess.Popen(
        [sys.executable, "-m", "lamplit.cli", "measure", str(lambert), "-o", str(out), *options],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        deadline = time.monotonic() + 30.0
        while not out.is_dir() and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(3.0)
        running.send_signal(number)
        _, error = running.communicate(timeout=60)
    finally:
        running.kill()
    assert running.returncode == code, error
    assert "Traceback" not in error
    numbers = json.loads((out / "measurement.json").read_text())
    assert numbers["complete"] is False
    assert 0 < numbers["paths"] < 4_000_000_000
    assert not list(out.glob(".*"))

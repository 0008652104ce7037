# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`lamplit measure` and `lamplit report` on retro-reflectors, with the engine."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lamplit import engine
from lamplit.cli.functions import asked_functions, asked_reflectors
from lamplit.errors import LamplitError
from lamplit.report.photometry.kept import read_results
from lamplit.scene import load_scene

#: A matt disc of ½ m² and reflectance 0.9: R = 0.9 A cos β cos (β + observation)/π.
DISC = """
lamplit = 1
name = "Matt disc"
[camera]
kind = "pinhole"
position_mm = [0.0, 0.0, 3000.0]
target_mm = [0.0, 0.0, 0.0]
up = [0.0, 1.0, 0.0]
field_of_view_deg = 30.0
[materials.paper]
kind = "diffuse"
reflectance = 0.9
[[objects]]
name = "disc"
kind = "disc"
centre_mm = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
radius_mm = 398.94
material = "paper"
[measure]
axis = [0.0, 0.0, 1.0]
[[measure.reflectors]]
name = "plate"
rule = "un-r150/IA"
source_deg = 1.0
receiver_deg = 1.0
"""
LIT = """
[[measure.functions]]
name = "stop"
rule = "un-r148/S1"
[[ray_files]]
name = "led"
file = "led.tm25ray"
source = "red-led-624"
"""


@pytest.fixture
def paper(tmp_path: Path) -> Path:
    path = tmp_path / "scene.toml"
    path.write_text(DISC)
    return path


def test_a_reflector_gets_its_coefficients_its_verdict_and_its_page(
    lamplit: Callable[..., int], paper: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A sheet of paper of ½ m² sends back 143 mcd/lx at 0°: below 300, far above 5 at 1°30′."""
    out = tmp_path / "out"
    options = ["--paths", "800000", "--threads", "1"]
    assert lamplit("measure", paper, "-o", out, *options) == 0
    told = capsys.readouterr().out
    assert "plate: Retro-reflector, class IA or IB, un-r150/IA" in told
    assert "observed at" in told
    assert "1°30′" in told
    numbers = json.loads((out / "measurement.json").read_text())
    assert numbers["functions"] == []
    (plate,) = numbers["reflectors"]
    assert plate["paths"] == numbers["paths"] == 7 * 800_000
    assert len(plate["readings"]) == 14
    for reading in plate["readings"]:
        v, h, apart = (
            np.radians(reading[key])
            for key in ("entrance_v_deg", "entrance_h_deg", "observation_deg")
        )
        expected = 450.0 / np.pi * np.cos(v) * np.cos(h) * np.cos(v + apart) * np.cos(h)
        sigma = reading["standard_error_mcd_per_lx"]
        assert abs(reading["cil_mcd_per_lx"] - expected) < 4.5 * sigma
        assert sigma < 0.4 * expected
    outcomes = {
        (one["requirement"], one["v_deg"], one["h_deg"]): one["outcome"]
        for one in plate["verdict"]["findings"]
    }
    assert outcomes["CIL at observation 20′", 0.0, 0.0] == "fail"
    assert outcomes["CIL at observation 1°30′", 0.0, 0.0] == "pass"
    assert numbers["outcome"] == plate["verdict"]["outcome"] == "fail"
    rows = list(csv.DictReader((out / "reflex.csv").read_text("utf-8").splitlines()))
    assert [float(row["CIL_mcd_per_lx"]) for row in rows] == [
        reading["cil_mcd_per_lx"] for reading in plate["readings"]
    ]
    points = list(csv.DictReader((out / "points.csv").read_text("utf-8").splitlines()))
    assert {row["unit"] for row in points} == {"mcd/lx"}
    assert len(points) == 14
    assert not (out / "candela.csv").exists()
    assert vars(read_results(out).reflectors[0].readings[3]) == plate["readings"][3]
    assert lamplit("report", out, "-o", tmp_path / "page.html") == 0
    page = (tmp_path / "page.html").read_text()
    assert "Coefficients of luminous intensity" in page
    assert "illuminant A from 1°, receiver of 1° above it, far field" in page
    assert page.count("≥ 100 mcd/lx") == 4


def test_the_rule_of_a_reflector_may_be_another(
    lamplit: Callable[..., int], paper: Path, tmp_path: Path
) -> None:
    options = ["--rule", "sae-j594/red", "--paths", "3200", "--seed", "5"]
    assert lamplit("measure", paper, "-o", tmp_path / "out", *options) == 0
    numbers = json.loads((tmp_path / "out" / "measurement.json").read_text())
    (plate,) = numbers["reflectors"]
    assert (plate["verdict"]["rule"], len(plate["readings"])) == ("sae-j594/red", 10)
    assert numbers["seed"] == 5


def test_without_a_rule_a_reflector_is_measured_where_the_scene_says(
    lamplit: Callable[..., int], paper: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    angles = "entrance_deg = [[0.0, 0.0], [0.0, 30.0]]\nobservation_deg = [0.2]"
    paper.write_text(DISC.replace('rule = "un-r150/IA"', angles))
    assert lamplit("measure", paper, "-o", tmp_path / "out", "--paths", "3200") == 0
    assert "plate: no rule, nothing is judged" in capsys.readouterr().out
    numbers = json.loads((tmp_path / "out" / "measurement.json").read_text())
    readings = numbers["reflectors"][0]["readings"]
    assert [(one["entrance_h_deg"], one["observation_deg"]) for one in readings] == [
        (0.0, 0.2), (30.0, 0.2),
    ]  # fmt: skip
    assert numbers["outcome"] is None
    assert not (tmp_path / "out" / "points.csv").exists()
    assert lamplit("report", tmp_path / "out", "-o", tmp_path / "page.html") == 0
    assert lamplit("measure", paper, "-o", tmp_path / "out", "--until-decided") == 2


def test_it_goes_on_until_every_coefficient_is_decided(
    lamplit: Callable[..., int], paper: Path, tmp_path: Path
) -> None:
    """A sheet of 4 m² has 1146 mcd/lx: decided at once, whatever is asked."""
    paper.write_text(DISC.replace("398.94", "1128.38"))
    assert lamplit("measure", paper, "-o", tmp_path / "out", "--until-decided") == 0
    numbers = json.loads((tmp_path / "out" / "measurement.json").read_text())
    findings = numbers["reflectors"][0]["verdict"]["findings"]
    assert {one["outcome"] for one in findings} == {"pass"}
    assert numbers["complete"]


def test_a_lamp_may_shine_and_reflect(
    lamplit: Callable[..., int], paper: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from lamplit.photometry.rays import RaySet, write_tm25

    monkeypatch.setattr("lamplit.report.photometry.files.draw_plots", lambda *_: [])
    ways = np.array([[0.0, 0.0, 1.0], [0.1, 0.0, 0.995]])
    rays = RaySet(np.full((2, 3), 5.0), ways, np.array([3.0, 1.0]), quantity="luminous")
    write_tm25(tmp_path / "led.tm25ray", rays)
    paper.write_text(DISC + LIT)
    assert lamplit("measure", paper, "-o", tmp_path / "out", "--paths", "3200") == 0
    results = read_results(tmp_path / "out")
    assert [name for name, _ in results.verdicts()] == ["stop", "plate"]
    assert results.paths == 8 * 3200
    assert (tmp_path / "out" / "candela.csv").exists()


def test_ctrl_c_keeps_what_is_done(
    lamplit: Callable[..., int], paper: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    measure_reflector = engine.measure_reflector

    def stopped(*given: object, **options: object) -> None:
        def interrupt(_done: int, _total: int) -> None:
            raise KeyboardInterrupt

        measure_reflector(*given, **options | {"progress": interrupt, "time_s": 60.0})

    monkeypatch.setattr(engine, "measure_reflector", stopped)
    assert lamplit("measure", paper, "-o", tmp_path / "out") == 130
    numbers = json.loads((tmp_path / "out" / "measurement.json").read_text())
    assert numbers["complete"] is False
    assert numbers["paths"] > 0


def test_rules_are_for_what_they_are_about(paper: Path) -> None:
    scene = load_scene(paper)
    assert asked_functions(scene) == ()
    (plate,) = asked_reflectors(scene, rules=["plate=un-r150/IA?emits=amber"])
    assert plate.rule is not None
    assert plate.rule.options["emits"] == "amber"
    for rules, said in (
        (["un-r148/S1"], "rule for lit functions, and the scene has none"),
        (["plate=un-r148/S1"], "rule for lamps, and 'plate' is a retro-reflector"),
        (["plait=un-r150/IA"], "no function or reflector 'plait'; did you mean 'plate'?"),
    ):
        with pytest.raises(LamplitError, match=said.replace("?", r"\?")):
            asked_reflectors(scene, rules=rules)

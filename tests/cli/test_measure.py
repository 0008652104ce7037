# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`lamplit measure` and `lamplit report`: what is asked of the engine, and what is written."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamplit import engine
from lamplit.cli.functions import asked_functions, directions
from lamplit.engine import Goniometer, LumenLedger, MeasureInterrupted, Measurement
from lamplit.errors import LamplitError
from lamplit.scene import load_scene

MEASURE = """
[objects.emission]
source = "A"
flux_lm = 100.0
group = "filament"
[measure]
axis = [0.0, 0.0, 1.0]
distance_m = 10.0
[[measure.functions]]
name = "stop"
rule = "un-r148/S1"
light = { filament = 1.0 }
with_position = "position"
[[measure.functions]]
name = "position"
rule = "un-r148/R1"
light = { filament = 0.1 }
side = "left"
"""
BATCHES = 16
#: The meter never walks more paths, whatever is asked.
_MOST = 64_000


class Meter:
    """Stands in for the engine: intensity I₀ cos θ in every batch, with a spread between them."""

    def __init__(self) -> None:
        self.calls: list[dict[str, Any]] = []
        self.on_axis_cd = 100.0
        self.spread = 0.01
        self.paths_before_stop: int | None = None
        self.asked = 0

    def measure(self, scene: Any, **options: Any) -> Measurement:
        """Measure in rounds of twice as many paths, as the engine does."""
        self.calls.append({"scene": scene, **options})
        if self.paths_before_stop is not None:
            raise MeasureInterrupted(
                replace(
                    self.read(scene, self.paths_before_stop, options),
                    complete=False,
                    interrupted=True,
                )
            )
        paths = 1000
        while True:
            options["progress"](paths, _MOST)
            result = self.read(scene, paths, options)
            self.asked += 1
            enough = options["until"](result)
            if enough or paths >= _MOST:
                return replace(result, complete=enough)
            paths *= 2

    def read(self, scene: Any, paths: int, options: dict[str, Any]) -> Measurement:
        """Return what is caught with ``paths``."""
        spots, (h, v) = options["spots"], options["grid"]
        grid_h, grid_v = np.meshgrid(0.5 * (h[1:] + h[:-1]), 0.5 * (v[1:] + v[:-1]))
        dark = len(scene.background.group) * 0  # the background's group sends out nothing
        turn = np.linspace(-1.0, 1.0, BATCHES) * self.spread * np.sqrt(1000.0 / max(paths, 1)) * 4
        weights = np.array([0.69, 0.305, 0.005]) / 0.305
        groups = ("background", "filament")

        def intensity(h_deg: Any, v_deg: Any) -> np.ndarray:
            cosine = np.cos(np.radians(h_deg)) * np.cos(np.radians(v_deg))
            lit = np.multiply.outer(1.0 + turn, self.on_axis_cd * cosine)
            both = np.stack([dark * lit, lit], axis=1)
            return both[..., None] * weights

        gonio = Goniometer(
            axis=(0.0, 0.0, 1.0), up=(0.0, 1.0, 0.0), centre_mm=(0.0, 0.0, 0.0),
            distance_m=scene.measure.distance_m, receiver_deg=0.5,
            spot_h_deg=spots[:, 0], spot_v_deg=spots[:, 1], h_edges_deg=h, v_edges_deg=v,
        )  # fmt: skip
        return Measurement(
            goniometer=gonio, groups=groups,
            emitted_xyz=np.array([np.zeros(3), 100.0 * weights]),
            out_xyz=np.tile(40.0 * weights, (BATCHES, 2, 1)),
            spot_xyz=intensity(*spots.T), grid_xyz=intensity(grid_h, grid_v), plane_xyz=None,
            spot_spectra_by_batch=np.ones((BATCHES, 2, len(spots), 4)),
            out_spectra_by_batch=np.ones((BATCHES, 2, 4)),
            grid_spectra=None, band_centres_nm=np.array([430.0, 530.0, 630.0, 730.0]),
            grid_band_centres_nm=np.empty(0), paths=paths,
            ledgers={"filament": LumenLedger(100.0, 40.0, {"lens": 59.0}, 1.0, 0.0, 0.0, 0.0)},
            scene=scene, light=None, seed=scene.image.seed, elapsed_s=0.1, version="0.1.0",
        )  # fmt: skip


@pytest.fixture
def meter(monkeypatch: pytest.MonkeyPatch) -> Meter:
    """Put a meter in the engine's place, and draw no plots, which take seconds."""
    found = Meter()
    monkeypatch.setattr("lamplit.report.photometry.files.draw_plots", lambda *_: [])
    monkeypatch.setattr(engine, "measure", found.measure)
    return found


@pytest.fixture
def lamp(scene_file: Path) -> Path:
    """A scene with two functions."""
    scene_file.write_text(scene_file.read_text() + MEASURE)
    return scene_file


def numbers_in(folder: Path) -> dict[str, Any]:
    return json.loads((folder / "measurement.json").read_text())


def test_a_lamp_is_measured_where_its_rules_ask_and_judged(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    assert lamplit("measure", lamp, "-o", tmp_path / "out") == 0
    (call,) = meter.calls
    assert [0.0, 0.0] in call["spots"].tolist()
    assert [20.0, -5.0] in call["spots"].tolist()
    assert call["grid"][0][0] == -90.0 and np.diff(call["grid"][0]).max() == 1.0
    numbers = numbers_in(tmp_path / "out")
    stop, position = numbers["functions"]
    assert stop["verdict"]["outcome"] == "pass"
    assert position["verdict"]["options"]["side"] == "left"
    on_axis = next(s for s in stop["spots"] if s["h_deg"] == s["v_deg"] == 0.0)
    assert on_axis["intensity_cd"] == pytest.approx(100.0)
    assert numbers["energy"]["absorbed_lm"] == {"lens": 59.0}
    assert numbers["command"].startswith("lamplit measure ")
    told = capsys.readouterr().out
    assert "100 lm emitted, 40 lm (40 %) leave the lamp" in told
    assert "stop: Stop lamp, steady (S1), un-r148/S1" in told
    assert all((tmp_path / "out" / name).is_file() for name in ("stop.ies", "position.ldt"))


def test_nothing_in_a_name_steers_the_terminal_or_the_page(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    """Controls, and marks that turn the direction of writing; the files keep the name."""
    assert meter
    odd = "st\u202eop\x1b[2J"
    escaped = '"st\\u202eop\\u001b[2J"'
    lamp.write_text(lamp.read_text().replace('name = "stop"', f"name = {escaped}"))
    assert lamplit("check", lamp) in (0, 1)
    assert lamplit("measure", lamp, "-o", tmp_path / "out") == 0
    assert lamplit("measure", lamp, "-o", tmp_path / "out", "--rule", f"{odd}x=un-r148/S1") == 2
    told = capsys.readouterr()
    assert "\\u202eop\\x1b[2J: Stop lamp, steady (S1)" in told.out
    assert lamplit("report", tmp_path / "out", "-o", tmp_path / "page.html") == 0
    page = (tmp_path / "page.html").read_text()
    assert all(own.isprintable() or own == "\n" for own in told.out + told.err + page)
    assert numbers_in(tmp_path / "out")["functions"][0]["name"] == odd


def test_stop_and_position_from_one_filament_are_compared_as_they_are_lit_together(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path
) -> None:
    """Both lit, one filament shines as the brighter asks: 1 : 0.1, not 1.1 : 0.1."""
    assert lamplit("measure", lamp, "-o", tmp_path) == 0
    findings = numbers_in(tmp_path)["functions"][0]["verdict"]["findings"]
    ratios = [one["got"] for one in findings if one["requirement"].startswith("ratio")]
    assert ratios and np.allclose(ratios, 10.0)


def test_a_failed_verdict_is_no_failed_run(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path
) -> None:
    meter.on_axis_cd = 10.0
    assert lamplit("measure", lamp, "-o", tmp_path) == 0
    assert numbers_in(tmp_path)["outcome"] == "fail"


@pytest.mark.parametrize(
    ("options", "paths", "error", "time_s"),
    [
        ([], 1 << 20, None, None),
        (["--paths", "5000"], 5000, None, None),
        (["--time", "2"], None, None, 2.0),
        (["--error", "0.02"], None, 0.02, None),
        (["--until-decided"], 1 << 30, None, None),
        (["--until-decided", "--time", "2"], None, None, 2.0),
    ],
)
def test_the_budget_reaches_the_engine(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path,
    options: list[str], paths: int | None, error: float | None, time_s: float | None,
) -> None:  # fmt: skip
    assert lamplit("measure", lamp, "-o", tmp_path, *options) == 0
    (call,) = meter.calls
    assert (call["paths"], call["error"], call["time_s"]) == (paths, error, time_s)


def test_it_goes_on_until_no_limit_is_within_two_sigma(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path
) -> None:
    """60.3 cd on the axis, 60 are asked: the first rounds cannot tell."""
    meter.on_axis_cd = 60.3
    assert lamplit("measure", lamp, "-o", tmp_path, "--until-decided", "--rule", "un-r148/S1") == 0
    assert meter.asked > 1
    factors = [
        finding["paths_factor"]
        for one in numbers_in(tmp_path)["functions"]
        for finding in one["verdict"]["findings"]
    ]
    assert not any(factors)


def test_without_a_rule_nothing_can_be_decided(
    lamplit: Callable[..., int], scene_file: Path, meter: Meter, tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    scene_file.write_text(scene_file.read_text() + "[measure]\naxis = [0.0, 0.0, 1.0]\n")
    assert lamplit("measure", scene_file, "-o", tmp_path, "--until-decided") == 2
    assert "no function has a rule" in capsys.readouterr().err
    assert lamplit("measure", scene_file, "-o", tmp_path) == 0
    assert "no rule, nothing is judged" in capsys.readouterr().out
    assert numbers_in(tmp_path)["outcome"] is None
    assert not (tmp_path / "points.csv").exists()


def test_ctrl_c_keeps_what_is_done(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path
) -> None:
    meter.paths_before_stop = 500
    assert lamplit("measure", lamp, "-o", tmp_path) == 130
    assert numbers_in(tmp_path)["complete"] is False
    assert numbers_in(tmp_path)["paths"] == 500


def test_ctrl_c_before_the_first_path_leaves_older_results_alone(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path
) -> None:
    assert lamplit("measure", lamp, "-o", tmp_path) == 0
    before = (tmp_path / "measurement.json").read_bytes()
    meter.paths_before_stop = 0
    assert lamplit("measure", lamp, "-o", tmp_path) == 130
    assert (tmp_path / "measurement.json").read_bytes() == before


@pytest.mark.parametrize(("written", "asked"), [("25", 25.0), ("far", float("inf"))])
def test_a_distance_is_metres_or_far(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path,
    written: str, asked: float,
) -> None:  # fmt: skip
    assert lamplit("measure", lamp, "-o", tmp_path, "--distance", written) == 0
    assert meter.calls[0]["distance_m"] == asked


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--distance", "near"], "'near' is no distance"),
        (["--distance", "-3"], "'-3' is no distance"),
        (["--distance", "nan"], "'nan' is no distance"),
        (["--distance", "0"], "'0' is no distance"),
        (["--receiver", "0.1"], "1/6° (0.1667) to 1°, not 0.1°"),
        (["--receiver", "2"], "to 1°, not 2°"),
        (["--receiver", "nan"], "not nan°"),
        (["--threads", "100000"], "--threads"),
        (["--rule", "un-r148/S9"], "no entry 'S9'"),
        (["--rule", "un-r148/S1?period=day&period=night"], "names an option twice"),
        (["--rule", "un-r184/S1"], "did you mean 'un-r148'? It has"),
        (["--set", "measure.functions[0].light.filament=0"], "every weight is 0"),
        (["--set", "objects[0].emission.flux_lm=1e300"], "less than or equal to 1000000000"),
        (["--rule", "stopp=un-r148/S1"], "no function or reflector 'stopp'; did you mean 'stop'?"),
        (["--rule", "un-r148/S1?period=noon"], "no choice"),
        (["--rule", "un-r150/IA"], "retro-reflectors"),
    ],
)
def test_what_cannot_be_asked_is_one_line(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path,
    capsys: pytest.CaptureFixture[str], options: list[str], said: str,
) -> None:  # fmt: skip
    assert lamplit("measure", lamp, "-o", tmp_path, *options) == 2
    (line,) = [line for line in capsys.readouterr().err.splitlines() if line.startswith("error")]
    assert said in line
    assert not meter.calls


def test_a_function_whose_groups_are_dark_is_told_so(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    lamp.write_text(lamp.read_text().replace("{ filament = 0.1 }", "{ background = 1.0 }"))
    assert lamplit("measure", lamp, "-o", tmp_path) == 0
    assert "position: none of its light groups (background) gives any light" in (
        capsys.readouterr().out
    )
    assert numbers_in(tmp_path)["outcome"] == "fail"


def test_ctrl_c_before_walking_says_so(
    lamplit: Callable[..., int], lamp: Path, tmp_path: Path,
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    def stopped(*_: Any, **__: Any) -> Any:
        raise KeyboardInterrupt

    monkeypatch.setattr("lamplit.scene.load_scene", stopped)
    assert lamplit("measure", lamp, "-o", tmp_path) == 130
    assert capsys.readouterr().err == "stopped before anything was finished\n"


def test_a_rule_may_be_for_one_function_and_have_options(lamp: Path) -> None:
    scene = load_scene(lamp)
    stop, position = asked_functions(scene, rules=["stop=un-r148/S2?period=night&side=right"])
    assert stop.rule is not None and position.rule is not None
    assert (stop.rule.id, stop.rule.options["period"]) == ("un-r148/S2", "night")
    assert stop.rule.options["side"] == "right"
    assert (position.rule.id, position.rule.options["side"]) == ("un-r148/R1", "left")


def test_the_grid_covers_all_rules_with_the_finest_cells(lamp: Path) -> None:
    scene = load_scene(lamp)
    functions = asked_functions(scene, rules=["stop=fmvss-108/stop"])
    spots, (h, v) = directions(functions)
    assert np.allclose(np.diff(h), 0.5) and np.allclose(np.diff(v), 0.5)
    assert 0.0 in h and 0.0 in v
    assert len(np.unique(spots, axis=0)) == len(spots)


def test_without_rules_a_lamp_is_measured_in_the_usual_field(scene_file: Path) -> None:
    scene = load_scene(scene_file)
    (only,) = asked_functions(scene)
    assert only.rule is None
    spots, (h, v) = directions([only])
    assert spots.tolist() == [[0.0, 0.0]]
    assert (h[0], h[-1], v[0], v[-1]) == (-45.0, 45.0, -15.0, 15.0)


def test_a_report_is_made_of_a_folder_or_of_a_scene(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path
) -> None:
    assert lamplit("measure", lamp, "-o", tmp_path / "out") == 0
    assert lamplit("report", tmp_path / "out", "-o", tmp_path / "kept.html") == 0
    assert len(meter.calls) == 1
    assert lamplit("report", lamp, "-o", tmp_path / "new.html", "--seed", "1") == 0
    assert meter.calls[1]["scene"].image.seed == 1
    for name in ("kept.html", "new.html"):
        text = (tmp_path / name).read_text()
        assert "stop: Stop lamp, steady (S1)" in text


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["out", "-o", "page.pdf"], "a report is a .html file"),
        (["out", "-o", "page.html", "--paths", "9"], "measured already"),
        (["out", "-o", "page.html", "--rule", "un-r148/S1"], "measured already"),
        (["gone", "-o", "page.html"], "gone"),
        (["out", "-o", "page.html", "--picture", "gone.png"], "gone.png"),
    ],
)
def test_a_report_that_cannot_be_is_one_line(
    lamplit: Callable[..., int], lamp: Path, meter: Meter, tmp_path: Path, words: list[str],
    said: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert lamplit("measure", lamp, "-o", "out") == 0
    capsys.readouterr()
    assert lamplit("report", *words) == 2
    assert said in capsys.readouterr().err
    assert not list(tmp_path.glob("page.*"))


def test_an_unknown_function_of_a_rule_is_refused(lamp: Path) -> None:
    with pytest.raises(LamplitError, match="no function or reflector 'fog'"):
        asked_functions(load_scene(lamp), rules=["fog=un-r148/F1"])

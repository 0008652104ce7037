# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A measurement in files says what the lamp did, to the last digit, and reads back the same."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image as Raster

from lamplit.errors import LamplitError
from lamplit.photometry import read_photometry
from lamplit.report.photometry.csv_files import CANDELA_HEADER, POINTS_HEADER
from lamplit.report.photometry.files import write_measurement
from lamplit.report.photometry.kept import read_results
from lamplit.report.photometry.plots import draw_plots, stems
from lamplit.report.photometry.results import FunctionResults, Results


@pytest.fixture
def folder(tmp_path: Path, make_results: Callable[..., Results]) -> Path:
    write_measurement(make_results(), tmp_path / "out")
    return tmp_path / "out"


def lines_of(path: Path) -> list[list[str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.reader(file, strict=True))


def test_each_finding_is_a_line_with_its_numbers_to_the_last_digit(
    folder: Path, make_results: Callable[..., Results]
) -> None:
    header, *lines = lines_of(folder / "points.csv")
    assert tuple(header) == POINTS_HEADER
    findings = [
        one for part in make_results().functions if part.verdict for one in part.verdict.findings
    ]
    assert len(lines) == len(findings)
    for line, found in zip(lines, findings, strict=True):
        said = dict(zip(header, line, strict=True))
        assert float(said["got"]) == found.got
        assert said["required"] == ("" if found.required is None else repr(found.required))
        assert float(said["standard_error"]) == found.standard_error
        assert (said["outcome"], said["clause"]) == (found.outcome, found.clause)


def test_each_cell_of_the_grid_is_a_line_about_its_middle(
    folder: Path, make_results: Callable[..., Results]
) -> None:
    header, *lines = lines_of(folder / "candela.csv")
    assert tuple(header) == CANDELA_HEADER
    seen = make_results().functions[0].observed
    own = np.array([line[1:] for line in lines if line[0] == "stop"], dtype=np.float64)
    assert len(own) == 30 * 90
    at = int(np.flatnonzero((own[:, 0] == 4.5) & (own[:, 1] == -9.5))[0])
    assert own[at, 2] == seen.grid_cd[5, 49]
    assert own[at, 3] == seen.grid_standard_error_cd[5, 49]
    assert own[at, 4] == seen.grid_xyz[5, 49, 0]


def test_lines_end_with_cr_lf_and_text_with_commas_and_quotes_stays_one_cell(
    tmp_path: Path, make_results: Callable[..., Results]
) -> None:
    usual = make_results()
    one = usual.functions[0]
    name = 'stop, "left"'
    odd = replace(one, observed=replace(one.observed, name=name))
    write_measurement(replace(usual, functions=(odd,)), tmp_path)
    for file in ("points.csv", "candela.csv", "spots.csv"):
        content = (tmp_path / file).read_bytes()
        assert content.count(b"\n") == content.count(b"\r\n")
        assert {line[0] for line in lines_of(tmp_path / file)[1:]} == {name}


def test_what_is_written_reads_back_the_same(
    folder: Path, make_results: Callable[..., Results]
) -> None:
    before, after = make_results(), read_results(folder)
    for name in (
        "scene",
        "scene_hash",
        "seed",
        "paths",
        "geometry",
        "command",
        "energy",
        "outcome",
    ):
        assert getattr(after, name) == getattr(before, name), name
    for old, new in zip(before.functions, after.functions, strict=True):
        assert new.verdict == old.verdict
        assert new.fields_deg == old.fields_deg
        for name, array in vars(old.observed).items():
            assert np.array_equal(getattr(new.observed, name), array), name


def test_the_summary_says_who_decides_and_how_it_was_made(folder: Path) -> None:
    numbers = json.loads((folder / "measurement.json").read_text())
    assert numbers["outcome"] == "undecided"
    stop = numbers["functions"][0]
    assert stop["verdict"]["count"] == {"fail": 0, "undecided": 4, "pass": 17}
    assert stop["verdict"]["findings"][0]["trust"] == "V2"
    assert "H −20, V +5" in stop["verdict"]["decided_by"]
    assert numbers["command"] == "lamplit measure p21w -o out"
    assert numbers["scene_hash"].endswith("beef")
    assert numbers["energy"]["gap_lm"] == pytest.approx(0.0, abs=1e-9)


def test_a_spot_without_light_is_zero_candela_without_a_colour(
    tmp_path: Path, make_results: Callable[..., Results]
) -> None:
    usual = make_results()
    seen = usual.functions[0].observed
    dark = replace(
        seen,
        spot_xyz=np.zeros_like(seen.spot_xyz),
        grid_xyz=np.zeros_like(seen.grid_xyz),
        grid_standard_error_cd=np.zeros_like(seen.grid_standard_error_cd),
    )
    write_measurement(replace(usual, functions=(FunctionResults(dark),)), tmp_path)
    spot = json.loads((tmp_path / "measurement.json").read_text())["functions"][0]["spots"][0]
    assert (spot["intensity_cd"], spot["chromaticity_xy"]) == (0.0, None)
    assert lines_of(tmp_path / "spots.csv")[1][7:9] == ["", ""]
    assert not (tmp_path / "points.csv").exists()
    assert np.array_equal(read_results(tmp_path).functions[0].observed.grid_cd, dark.grid_cd)


def spoil(numbers: dict[str, Any], how: str) -> None:
    """Damage the summary."""
    if how == "version":
        numbers["lamplit_measurement"] = 2
    elif how == "extra":
        numbers["colour"] = "red"
    elif how == "outcome":
        numbers["functions"][0]["verdict"]["findings"][0]["outcome"] = "passed"
    elif how == "grid":
        numbers["functions"][0]["grid"]["h_edges_deg"].append(46.0)
    elif how == "name":
        numbers["functions"][0]["name"] = "brake"


@pytest.mark.parametrize(
    ("how", "said"),
    [
        ("version", "lamplit_measurement"),
        ("extra", "colour"),
        ("outcome", "outcome"),
        ("grid", "does not hold 30 × 91 cells of 'stop'"),
        ("name", "cells of 'brake'"),
    ],
)
def test_a_damaged_measurement_is_one_clear_line(folder: Path, how: str, said: str) -> None:
    path = folder / "measurement.json"
    numbers = json.loads(path.read_text())
    spoil(numbers, how)
    path.write_text(json.dumps(numbers))
    with pytest.raises(LamplitError) as refused:
        read_results(folder)
    assert said in str(refused.value)
    assert str(folder) in str(refused.value)


@pytest.mark.parametrize("content", [b"", b"a,b\r\n1,2\r\n", b"\xff\xfe", b'"open'])
def test_a_damaged_grid_is_one_clear_line(folder: Path, content: bytes) -> None:
    (folder / "candela.csv").write_bytes(content)
    with pytest.raises(LamplitError, match=r"candela\.csv"):
        read_results(folder)


def test_a_number_that_is_not_finite_is_refused(folder: Path) -> None:
    path = folder / "candela.csv"
    lines = path.read_text().splitlines()
    cells = lines[1].split(",")
    lines[1] = ",".join([*cells[:3], "nan", *cells[4:]])
    path.write_text("\r\n".join(lines) + "\r\n")
    with pytest.raises(LamplitError, match="not finite"):
        read_results(folder)


def test_a_folder_without_a_measurement_says_what_to_name(tmp_path: Path) -> None:
    with pytest.raises(LamplitError, match="`lamplit measure` wrote"):
        read_results(tmp_path)


def test_every_plot_is_a_picture_that_is_not_blank(make_results: Callable[..., Results]) -> None:
    plots = draw_plots(make_results())
    kinds = ["points", "isocandela", "cuts", "colour", "solid"]
    assert [plot.kind for plot in plots] == [*kinds, *kinds, "spectra", "energy"]
    for plot in plots:
        picture = Raster.open(io.BytesIO(plot.content)).convert("L")
        assert min(picture.size) > 500
        assert np.asarray(picture).std() > 4.0, plot.file


def test_functions_whose_names_make_no_file_names_get_safe_ones(
    make_results: Callable[..., Results],
) -> None:
    usual = make_results()
    one = usual.functions[0]
    names = ["../../etc/passwd", "stop", "Stop", "…", "a b"]
    parts = tuple(replace(one, observed=replace(one.observed, name=name)) for name in names)
    found = stems(replace(usual, functions=parts))
    assert found == ["etc-passwd", "stop", "Stop-2", "function", "a-b"]


def test_other_programs_get_the_grid_and_it_reads_back_in_their_frame(
    folder: Path, make_results: Callable[..., Results]
) -> None:
    """In IES files of type A, H has the other sign."""
    seen = make_results().functions[0].observed
    table = read_photometry(folder / "stop.ies")
    assert table.photometric_type == "A"
    assert np.allclose(table.horizontal_deg, np.arange(-44.5, 45.0))
    assert np.allclose(table.candela[::-1].T, seen.grid_cd, rtol=1e-5)
    c_planes = read_photometry(folder / "stop.ldt")
    on_axis = c_planes.intensity_cd(np.array([0.0, 0.0, 1.0]))
    assert on_axis == pytest.approx(seen.grid_cd[14:16, 44:46].mean(), rel=1e-5)

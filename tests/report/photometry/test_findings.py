# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Findings in words: where, what was got, what was required, what decides."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

from lamplit.photometry.observed import Observed
from lamplit.report.photometry.results import FunctionResults, worst_finding
from lamplit.report.photometry.table import (
    elsewhere,
    findings_table,
    in_words,
    margin,
    more_paths,
    points_of,
    spots_table,
)
from lamplit.rules.verdict import Finding, Verdict


def test_points_run_from_the_upper_left_and_the_rest_is_elsewhere(
    make_observed: Callable[..., Observed], make_verdict: Callable[..., Verdict]
) -> None:
    seen = make_observed()
    verdict = make_verdict(seen)
    points = points_of(verdict, seen)
    assert len(points) == 19
    assert (points[0].h_deg, points[0].v_deg) == (-5.0, 10.0)
    assert (points[-1].h_deg, points[-1].v_deg) == (5.0, -10.0)
    others = [finding.requirement for finding in elsewhere(verdict, seen)]
    assert others == ["maximum in the field", "colour: red"]


def test_a_point_is_as_good_as_the_worst_that_is_found_there(
    make_observed: Callable[..., Observed], make_finding: Callable[..., Finding]
) -> None:
    seen = make_observed()
    at = {"h_deg": 5.0, "v_deg": 0.0}
    good, bad = make_finding(80.0, 1.0, 60.0, **at), make_finding(80.0, 1.0, 70.0, "max", **at)
    verdict = Verdict("r/x", "title", "stop", (good, bad))
    (point,) = points_of(verdict, seen)
    assert (point.outcome, point.deciding) == ("fail", bad)


def test_the_worst_finding_fails_before_it_is_undecided_and_has_the_least_margin(
    make_finding: Callable[..., Finding],
) -> None:
    passed = make_finding(61.0, 0.1, 60.0)
    near = make_finding(59.9, 1.0, 60.0)
    failed, worse = make_finding(50.0, 0.5, 60.0), make_finding(30.0, 0.5, 60.0)
    every = (passed, failed, near, worse)
    assert worst_finding(every) is worse
    assert worst_finding(()) is None
    assert worst_finding((passed, near)) is near


@pytest.mark.parametrize(
    ("got", "said"),
    [(66.0, "+10 %"), (60.6, "+1.0 %"), (59.99, "−0.02 %"), (30.0, "−50 %"), (60.0, "0 %")],
)
def test_a_small_margin_never_reads_as_none(
    make_finding: Callable[..., Finding], got: float, said: str
) -> None:
    assert margin(make_finding(got, 0.0, 60.0)) == said


def test_how_many_paths_would_decide_is_said_where_a_number_would(
    make_finding: Callable[..., Finding],
) -> None:
    assert more_paths(make_finding(61.0, 1.0, 60.0)) == "4 × as many paths would decide it"
    on_it = replace(make_finding(61.0, 1.0, 60.0), paths_factor=float("inf"))
    assert more_paths(on_it) == "on the limit: no number of paths decides it"
    assert more_paths(make_finding(90.0, 1.0, 60.0)) == ""
    faint = make_finding(0.0, 3625.0, 1.6)
    assert more_paths(faint) == "more than a million × as many paths would decide it"


def test_a_terminal_of_80_columns_has_room_for_what_is_required(
    make_observed: Callable[..., Observed], make_verdict: Callable[..., Verdict]
) -> None:
    seen = make_observed()
    console = Console(width=80)
    with console.capture() as captured:
        console.print(findings_table(FunctionResults(seen, make_verdict(seen)), width=80))
    lines = captured.get().splitlines()
    assert max(map(len, lines)) <= 80
    assert "H °" not in lines[0]
    column = lines[0].index("requirement")
    assert 80 - column >= 28, "a remark of ten words takes three lines, not ten"


def test_what_decides_is_one_sentence(make_finding: Callable[..., Finding]) -> None:
    found = make_finding(18.3, 0.2, 21.0, h_deg=10.0, v_deg=0.0)
    assert in_words(Verdict("r", "t", "f", (found,))) == (
        "minimum at the test point (H +10, V 0): 18.3 cd ± 0.4, required ≥ 21 cd, margin −13 %"
    )


def test_no_light_is_zero_candela(make_finding: Callable[..., Finding]) -> None:
    found = make_finding(0.0, 0.01, 0.3)
    assert in_words(Verdict("r", "t", "f", (found,))).endswith(
        "0 cd ± 0.02, required ≥ 0.3 cd, margin −100 %"
    )


def test_the_terminal_shows_each_finding_with_word_and_sign(
    make_observed: Callable[..., Observed], make_verdict: Callable[..., Verdict]
) -> None:
    seen = make_observed(peak_cd=66.0)
    console = Console(width=160, record=True, file=None, color_system=None, quiet=False)
    with console.capture() as held:
        console.print(findings_table(FunctionResults(seen, make_verdict(seen))))
    text = held.get()
    assert text.count("✓ pass") == 17
    assert text.count("? undecided") == 4
    (line,) = [line for line in text.splitlines() if line.split()[:2] == ["0", "+5"]]
    assert line.split()[2:9] == ["52.0", "cd", "±", "1.4", "≥", "42", "cd"]


def test_spots_of_a_function_without_a_rule_are_listed(
    make_observed: Callable[..., Observed],
) -> None:
    table = spots_table(make_observed())
    assert table.row_count == 19
    assert np.all([len(list(column.cells)) == 19 for column in table.columns])

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""FMVSS 108's ways to pass: a case for each that passes under one and fails under another."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from lamplit.rules import RuleSet, Verdict, find_rule, judge

from .conftest import observe

#: Group 1 of Table IX, one section: minima 10, 10, 16, 16 cd, sum 50; group 3: sum 380.
OWN = """
[grids.IX]
clause = "Table IX"
trust = "V2"
unit = "cd"
h_deg = [-20, -10, -5, 0, 5, 10, 20]
v_deg = [10, 5, 0, -5, -10]
rows = [
  ["-", "-", 16, "-", 16, "-", "-"],
  [10, 30, "-", 70, "-", 30, 10],
  ["-", 40, 80, 80, 80, 40, "-"],
  [10, 30, "-", 70, "-", 30, 10],
  ["-", "-", 16, "-", 16, "-", "-"],
]
[groupings.nineteen]
groups = [
  ["5U-20L", "5D-20L", "10U-5L", "10D-5L"],
  ["5U-10L", "H-10L", "5D-10L"],
  ["5U-V", "H-5L", "H-V", "H-5R", "5D-V"],
  ["5U-10R", "H-10R", "5D-10R"],
  ["10U-5R", "10D-5R", "5U-20R", "5D-20R"],
]
"""
ENTRY = """
[entries.{name}]
title = "{name}"
[[entries.{name}.distribution]]
clause = "Table IX"
trust = "V2"
grid = "IX"
{keys}
"""
SUMS = 'groups = "nineteen"\nsums_cd = [{first}, 100, 380, 100, 50]\n'
MINIMA = {
    (h * side, v * up): cd
    for h, v, cd in (
        (20, 5, 10.0),
        (10, 5, 30.0),
        (0, 5, 70.0),
        (10, 0, 40.0),
        (5, 0, 80.0),
        (0, 0, 80.0),
        (5, 10, 16.0),
    )
    for side in (1, -1)
    for up in (1, -1)
}


@pytest.fixture
def three(own_rules: Callable[[str], RuleSet]) -> Callable[..., dict[str, Verdict]]:
    def judged(changed: dict[tuple[int, int], float], first: float = 50.0) -> dict[str, Verdict]:
        sums = SUMS.format(first=first)
        keys = {
            "each": "",
            "floor": 'rule = "floor"\nfloor_percent = 60\n' + sums,
            "either": 'rule = "point-or-group"\n' + sums,
        }
        text = OWN + "".join(ENTRY.format(name=name, keys=own) for name, own in keys.items())
        rules = own_rules(text)
        at = {**MINIMA, **changed}
        found = {}
        for name in keys:
            rule = rules.entry(name)
            dark = lambda h, v: np.zeros(np.broadcast(h, v).shape)  # noqa: E731
            found[name] = judge(rule, observe(rule, dark, at=at))
        return found

    return judged


def outcomes(verdicts: dict[str, Verdict]) -> dict[str, str]:
    return {name: verdict.outcome for name, verdict in verdicts.items()}


def test_a_lamp_that_meets_each_minimum_passes_under_all_three(three: Callable) -> None:
    assert outcomes(three({})) == {"each": "pass", "floor": "pass", "either": "pass"}


def test_a_point_at_70_percent_passes_with_its_group_but_not_alone(three: Callable) -> None:
    # 7 + 13 + 16 + 16 = 52 ≥ 50
    verdicts = three({(20, 5): 7.0, (20, -5): 13.0})
    assert outcomes(verdicts) == {"each": "fail", "floor": "pass", "either": "pass"}


def test_a_point_at_50_percent_is_below_the_floor_of_60(three: Callable) -> None:
    verdicts = three({(20, 5): 5.0, (20, -5): 15.0})
    assert outcomes(verdicts) == {"each": "fail", "floor": "fail", "either": "pass"}
    low = next(own for own in verdicts["floor"].findings if own.outcome == "fail")
    assert (low.h_deg, low.v_deg, low.required, low.got) == (20.0, 5.0, 6.0, 5.0)
    lifted = next(
        own for own in verdicts["either"].findings if (own.h_deg, own.v_deg) == (20.0, 5.0)
    )
    assert (lifted.outcome, lifted.required, lifted.got) == ("pass", 10.0, 5.0)
    assert lifted.margin_percent == -50.0
    assert "group 1's sum meets the minimum" in lifted.remark


def test_a_sum_that_is_missed_counts_where_the_floor_rule_holds(three: Callable) -> None:
    # Each point has its minimum, 10 + 10 + 16 + 16 = 52, and 60 is asked of the group.
    verdicts = three({}, 60.0)
    assert outcomes(verdicts) == {"each": "pass", "floor": "fail", "either": "pass"}


def test_neither_the_point_nor_the_sum_fails_under_every_rule(three: Callable) -> None:
    # 7 + 10 + 16 + 16 = 49 < 50
    verdicts = three({(20, 5): 7.0})
    assert outcomes(verdicts) == {"each": "fail", "floor": "fail", "either": "fail"}


def scaled(name: str, factor: float, changed: dict[tuple[float, float], float]) -> Verdict:
    """Return the verdict on a lamp with ``factor`` times each minimum, and far more between."""
    rule = find_rule(name)
    at = {(own.h_deg, own.v_deg): factor * own.minimum_cd for own in rule.points()}
    at |= changed
    between = max(at.values())
    flat = lambda h, v: np.full(np.broadcast(h, v).shape, between)  # noqa: E731
    return judge(rule, observe(rule, flat, at=at))


def test_the_stop_lamp_keeps_a_floor_that_the_tail_lamp_does_not_have() -> None:
    # 5U-20: 50 % of its minimum, and 5D-20 makes it up. Stop 5 + 15 of 10 + 10, tail .15 + .45.
    stop = scaled("fmvss-108/stop", 1.0, {(20.0, 5.0): 5.0, (20.0, -5.0): 15.0})
    tail = scaled("fmvss-108/tail", 1.0, {(20.0, 5.0): 0.15, (20.0, -5.0): 0.45})
    assert (stop.outcome, tail.outcome) == ("fail", "pass")


def test_70_percent_at_one_point_is_a_stop_lamp_of_fmvss_but_none_of_the_un() -> None:
    # UN R148: 0.7 of 12 cd at 5U-10. FMVSS: 0.7 of 30 cd, and 5D-10 makes it up.
    stop = scaled("fmvss-108/stop", 1.0, {(10.0, 5.0): 21.0, (10.0, -5.0): 39.0})
    other = scaled("un-r148/S1", 1.0, {(10.0, 5.0): 8.4})
    assert (stop.outcome, other.outcome) == ("pass", "fail")


def test_between_two_points_the_lower_of_their_minima_holds() -> None:
    rule = find_rule("fmvss-108/stop")
    at = {(own.h_deg, own.v_deg): own.minimum_cd for own in rule.points()}

    def dip(h: np.ndarray, v: np.ndarray) -> np.ndarray:
        # From H-V (80 cd) to H-5L (80 cd) the lower is 80; 5U-V and H-V ask 70 between them.
        return np.where((np.abs(v) < 0.5) & (h > 2.0) & (h < 2.5), 79.0, 100.0)

    verdict = judge(rule, observe(rule, dip, at=at))
    (low,) = [own for own in verdict.findings if own.outcome == "fail"]
    assert low.requirement == "minimum between neighbours"
    assert (low.required, low.got, low.h_deg) == (80.0, 79.0, 2.25)


def test_next_to_a_point_let_down_by_its_group_the_minimum_is_let_down_as_far() -> None:
    rule = find_rule("fmvss-108/stop")
    at = {(own.h_deg, own.v_deg): own.minimum_cd for own in rule.points()}
    at |= {(5.0, 0.0): 60.0, (-5.0, 0.0): 100.0}

    def slope(floor: float) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
        return lambda h, v: np.where((np.abs(v) < 0.5) & (h > 0.5), floor, 100.0)

    # 60 % of the lower minimum of H-V and H-5L, 80 cd, is 48 cd.
    assert judge(rule, observe(rule, slope(49.0), at=at)).outcome == "pass"
    assert judge(rule, observe(rule, slope(47.0), at=at)).outcome == "fail"

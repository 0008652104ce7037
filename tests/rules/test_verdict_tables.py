# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Analytic lamps at every test point: required, got and margin, worked out by hand.

I = I₀ (cos H cos V)ⁿ to four decimals, and the minima as the tables' percentages of their minimum.
"""

from __future__ import annotations

import numpy as np
import pytest

from lamplit.rules import Verdict, find_rule, judge

from .conftest import AMBER, WHITE, observe, power_law

#: (|H|, V): required cd, got cd, outcome.
Row = tuple[float, float, float, float, str]

#: Lambert disc of 70 cd before S1: 60 cd and Figure A3-I.
S1_LAMBERT: list[Row] = [
    (5, 10, 12.0, 68.6742, "pass"),
    (20, 5, 6.0, 65.5282, "pass"),
    (10, 5, 12.0, 68.6742, "pass"),
    (0, 5, 42.0, 69.7336, "pass"),
    (10, 0, 21.0, 68.9365, "pass"),
    (5, 0, 54.0, 69.7336, "pass"),
    (0, 0, 60.0, 70.0, "pass"),
    (20, -5, 6.0, 65.5282, "pass"),
    (10, -5, 12.0, 68.6742, "pass"),
    (0, -5, 42.0, 69.7336, "pass"),
    (5, -10, 12.0, 68.6742, "pass"),
]
#: 100 cd cos⁴⁰ before S1.
S1_NARROW: list[Row] = [
    (5, 10, 12.0, 46.5401, "pass"),
    (20, 5, 6.0, 7.1318, "pass"),
    (10, 5, 12.0, 46.5401, "pass"),
    (0, 5, 42.0, 85.8557, "pass"),
    (10, 0, 21.0, 54.2074, "pass"),
    (5, 0, 54.0, 85.8557, "pass"),
    (0, 0, 60.0, 100.0, "pass"),
    (20, -5, 6.0, 7.1318, "pass"),
    (10, -5, 12.0, 46.5401, "pass"),
    (0, -5, 42.0, 85.8557, "pass"),
    (5, -10, 12.0, 46.5401, "pass"),
]
#: 6 cd cos¹²⁰ before R1: 4 cd; too narrow.
R1_NARROW: list[Row] = [
    (5, 10, 0.8, 0.6048, "fail"),
    (20, 5, 0.4, 0.0022, "fail"),
    (10, 5, 0.8, 0.6048, "fail"),
    (0, 5, 2.8, 3.7972, "pass"),
    (10, 0, 1.4, 0.9557, "fail"),
    (5, 0, 3.6, 3.7972, "pass"),
    (0, 0, 4.0, 6.0, "pass"),
    (20, -5, 0.4, 0.0022, "fail"),
    (10, -5, 0.8, 0.6048, "fail"),
    (0, -5, 2.8, 3.7972, "pass"),
    (5, -10, 0.8, 0.6048, "fail"),
]
#: 40 cd cos²⁰ before S3: 25 cd and Figure A3-III.
S3_NARROW: list[Row] = [
    (10, 10, 8.0, 21.6829, "pass"),
    (0, 10, 16.0, 29.4503, "pass"),
    (10, 5, 16.0, 27.2881, "pass"),
    (5, 5, 25.0, 34.3423, "pass"),
    (0, 5, 25.0, 37.0633, "pass"),
    (10, 0, 16.0, 29.4503, "pass"),
    (5, 0, 25.0, 37.0633, "pass"),
    (0, 0, 25.0, 40.0, "pass"),
    (10, -5, 16.0, 27.2881, "pass"),
    (5, -5, 25.0, 34.3423, "pass"),
    (0, -5, 25.0, 37.0633, "pass"),
]
#: 100 cd cos⁶ before AR: Figure A3-V in cd; it is dark at 45°.
AR_NARROW: list[Row] = [
    (10, 10, 10.0, 83.218, "pass"),
    (0, 10, 15.0, 91.2239, "pass"),
    (45, 5, 15.0, 12.2173, "fail"),
    (10, 5, 20.0, 89.1608, "pass"),
    (0, 5, 25.0, 97.7384, "pass"),
    (45, 0, 15.0, 12.5, "fail"),
    (30, 0, 25.0, 42.1875, "pass"),
    (10, 0, 50.0, 91.2239, "pass"),
    (0, 0, 80.0, 100.0, "pass"),
    (45, -5, 15.0, 12.2173, "fail"),
    (30, -5, 25.0, 41.2334, "pass"),
    (10, -5, 50.0, 89.1608, "pass"),
    (0, -5, 80.0, 97.7384, "pass"),
]
#: Lambert disc of 82 cd before the FMVSS stop lamp of one section: 60 % at each point.
STOP_LAMBERT: list[Row] = [
    (5, 10, 9.6, 80.4469, "pass"),
    (20, 5, 6.0, 76.7616, "pass"),
    (10, 5, 18.0, 80.4469, "pass"),
    (0, 5, 42.0, 81.688, "pass"),
    (10, 0, 24.0, 80.7542, "pass"),
    (5, 0, 48.0, 81.688, "pass"),
    (0, 0, 48.0, 82.0, "pass"),
    (20, -5, 6.0, 76.7616, "pass"),
    (10, -5, 18.0, 80.4469, "pass"),
    (0, -5, 42.0, 81.688, "pass"),
    (5, -10, 9.6, 80.4469, "pass"),
]

TABLES = [
    ("un-r148/S1", 70.0, 1.0, (0.690, 0.305), S1_LAMBERT),
    ("un-r148/S1", 100.0, 40.0, (0.690, 0.305), S1_NARROW),
    ("un-r148/R1", 6.0, 120.0, (0.690, 0.305), R1_NARROW),
    ("un-r148/S3", 40.0, 20.0, (0.690, 0.305), S3_NARROW),
    ("un-r148/AR", 100.0, 6.0, WHITE, AR_NARROW),
    ("fmvss-108/stop", 82.0, 1.0, (0.690, 0.305), STOP_LAMBERT),
]


def points_of(verdict: Verdict) -> dict[tuple[float, float], tuple[float, float, float, str]]:
    found = {}
    for own in verdict.findings:
        if own.requirement.startswith("minimum at "):
            assert own.h_deg is not None and own.v_deg is not None
            assert own.required is not None and own.margin_percent is not None
            found[own.h_deg, own.v_deg] = (own.required, own.got, own.margin_percent, own.outcome)
    return found


@pytest.mark.parametrize(
    ("name", "axis_cd", "exponent", "xy", "table"), TABLES, ids=[own[0] for own in TABLES]
)
def test_each_test_point_of_an_analytic_lamp_is_judged_as_worked_out_by_hand(
    name: str, axis_cd: float, exponent: float, xy: tuple[float, float], table: list[Row]
) -> None:
    rule = find_rule(name)
    verdict = judge(rule, observe(rule, power_law(axis_cd, exponent), xy=xy))
    found = points_of(verdict)
    both_sides = {(side * h, v): row for h, v, *row in table for side in (1, -1)}
    assert found.keys() == both_sides.keys()
    for where, (required, got, outcome) in both_sides.items():
        margin = 100.0 * (got - required) / required
        assert found[where][0] == pytest.approx(required, abs=1e-12), where
        assert found[where][1] == pytest.approx(got, abs=6e-5), where
        assert found[where][2] == pytest.approx(margin, abs=0.01 * max(1.0, 1.0 / required)), where
        assert found[where][3] == outcome, where


def test_a_lambert_disc_of_70_cd_is_a_stop_lamp_and_one_of_59_is_not() -> None:
    rule = find_rule("un-r148/S1")
    assert judge(rule, observe(rule, power_law(70.0, 1.0))).outcome == "pass"
    dim = judge(rule, observe(rule, power_law(59.0, 1.0)))
    assert dim.outcome == "fail"
    failed = {(own.h_deg, own.v_deg) for own in dim.findings if own.outcome == "fail"}
    assert failed == {(0.0, 0.0)}


def test_the_group_sums_of_a_lambert_disc_are_those_worked_out_by_hand() -> None:
    rule = find_rule("fmvss-108/stop")
    verdict = judge(rule, observe(rule, power_law(82.0, 1.0), relative_error=0.01))
    sums = [own for own in verdict.findings if own.requirement.endswith(", sum")]
    assert [own.required for own in sums] == [50.0, 100.0, 380.0, 100.0, 50.0]
    # 2·76.7616 + 2·80.4469; 2·80.4469 + 80.7542; 82 + 4·81.688
    assert [round(own.got, 3) for own in sums] == [314.417, 241.648, 408.752, 241.648, 314.417]
    # 1 % of √(82² + 4·81.688²), the five of group 3
    assert sums[2].standard_error == pytest.approx(1.82798, abs=1e-4)


def test_a_third_of_a_percent_makes_the_axis_of_a_direction_indicator_pass_or_fail() -> None:
    rule = find_rule("un-r148/2a").under(side="right")
    for axis_cd, outcome in ((50.1, "pass"), (49.9, "fail")):
        assert judge(rule, observe(rule, power_law(axis_cd, 1.0), xy=AMBER)).outcome == outcome


def test_percentages_are_rounded_down_to_three_digits(own_rules: object) -> None:
    text = """
[grids.g]
clause = "1"
trust = "M"
unit = "%"
h_deg = [0, 5]
v_deg = [0]
rows = [[100, 33.33]]
[entries.x]
title = "x"
[[entries.x.distribution]]
clause = "1"
trust = "M"
grid = "g"
minimum_cd = 12.37
significant_digits = 3
"""
    rules = own_rules(text)  # type: ignore[operator]
    # 12.37 → 12.3 and 12.37 · 0.3333 = 4.122921 → 4.12
    assert [point.minimum_cd for point in rules.entry("x").points()] == [12.3, 4.12]


def test_the_verdict_is_never_better_than_its_worst_finding() -> None:
    rule = find_rule("un-r148/S1")
    readings = observe(rule, power_law(100.0, 1.0), at={(20.0, 5.0): 5.9})
    verdict = judge(rule, readings)
    worst = [own for own in verdict.findings if own.outcome != "pass"]
    assert [(own.h_deg, own.v_deg, own.got) for own in worst] == [(20.0, 5.0, 5.9)]
    assert verdict.outcome == "fail"
    assert np.isclose(worst[0].margin_percent or 0.0, -100.0 / 60.0)

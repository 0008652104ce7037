# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Undecided within 2 σ; how many more paths would decide; what no light at all says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lamplit.rules import Finding, Verdict, find_rule, judge
from lamplit.rules.decide import decision

from .conftest import AMBER, observe, power_law


def at_axis(verdict: Verdict) -> Finding:
    return next(own for own in verdict.findings if own.requirement == "minimum at H-V")


@pytest.mark.parametrize(
    ("inside_by", "sigma", "outcome"),
    [
        (4.0, 2.0, "undecided"),
        (-4.0, 2.0, "undecided"),
        (np.nextafter(4.0, 5.0), 2.0, "pass"),
        (np.nextafter(-4.0, -5.0), 2.0, "fail"),
        (0.0, 0.0, "pass"),
        (-1e-12, 0.0, "fail"),
    ],
)
def test_the_border_of_undecided_is_at_2_sigma_exactly(
    inside_by: float, sigma: float, outcome: str
) -> None:
    assert decision(inside_by, sigma).outcome == outcome


def test_a_limit_within_2_sigma_is_undecided_and_says_how_many_more_paths() -> None:
    rule = find_rule("un-r148/S1")
    # 64 cd with 4 % is 64 ± 2.56, 1.5625 σ above 60: (2/1.5625)² = 1.6384 times the paths.
    verdict = judge(rule, observe(rule, power_law(64.0, 0.0), relative_error=0.04))
    own = at_axis(verdict)
    assert (own.outcome, own.standard_error) == ("undecided", pytest.approx(2.56))
    assert own.paths_factor == pytest.approx(1.6384)
    assert own.margin_percent == pytest.approx(100 * 4 / 60)
    assert verdict.outcome == "undecided"
    # With 1.6384 times the paths σ is 2.0 and the limit 2 σ away; with a few more, decided.
    more = judge(rule, observe(rule, power_law(64.0, 0.0), relative_error=0.04 / 1.3))
    assert at_axis(more).outcome == "pass"


def test_just_above_and_below_the_limit_is_undecided_alike() -> None:
    rule = find_rule("un-r148/S1")
    for axis_cd in (59.0, 60.0, 61.0):
        verdict = judge(rule, observe(rule, power_law(axis_cd, 0.0), relative_error=0.01))
        assert at_axis(verdict).outcome == "undecided"
    exactly = judge(rule, observe(rule, power_law(60.0, 0.0), relative_error=0.01))
    assert at_axis(exactly).paths_factor == np.inf


def test_a_maximum_is_decided_by_the_brightest_cell_and_its_own_sigma() -> None:
    rule = find_rule("un-r148/S1")

    def peak(h: np.ndarray, v: np.ndarray) -> np.ndarray:
        return np.where((np.abs(h - 30.5) < 0.1) & (np.abs(v - 20.5) < 0.1), 265.0, 100.0)

    for cell_error, outcome in ((0.0, "fail"), (0.009, "fail"), (0.01, "undecided")):
        verdict = judge(rule, observe(rule, peak, cell_error=cell_error))
        own = next(one for one in verdict.findings if one.sense == "max")
        # 265 is 5 above 260: 2 σ at 0.94 %.
        assert (own.outcome, own.got, own.h_deg, own.v_deg) == (outcome, 265.0, 30.5, 20.5)


def test_a_cell_that_surely_fails_goes_before_a_darker_one_that_scatters_more() -> None:
    rule = find_rule("un-r148/S1")

    def two(h: np.ndarray, v: np.ndarray) -> np.ndarray:
        sure = (np.abs(h - 40.5) < 0.1) & (np.abs(v - 10.5) < 0.1)
        unsure = (np.abs(h - 30.5) < 0.1) & (np.abs(v - 10.5) < 0.1)
        return np.where(sure, 0.29, np.where(unsure, 0.10, 100.0))

    readings = observe(rule, two, cell_error=0.001)
    # 0.10 ± 0.15 is 1.33 σ below 0.3.
    error = np.where(readings.grid_cd == 0.10, 0.15, readings.grid_standard_error_cd)
    verdict = judge(rule, replace(readings, grid_standard_error_cd=error))
    own = next(one for one in verdict.findings if one.requirement.startswith("field"))
    assert (own.outcome, own.got, own.h_deg) == ("fail", 0.29, 40.5)


def unlit_on_axis(bound_cd: float) -> Finding:
    """Return the finding on the axis, where no light came and σ is an upper bound."""
    rule = find_rule("un-r148/S1")
    readings = observe(rule, power_law(100.0, 0.0), at={(0.0, 0.0): 0.0}, relative_error=0.01)
    covariance = readings.spot_xyz_covariance.copy()
    covariance[readings.spot_cd == 0.0] = bound_cd**2 * np.eye(3)
    return at_axis(judge(rule, replace(readings, spot_xyz_covariance=covariance)))


def test_no_light_at_a_point_is_0_cd_below_the_minimum_with_a_bound_on_sigma() -> None:
    own = unlit_on_axis(0.02)
    assert (own.outcome, own.got, own.margin_percent) == ("fail", 0.0, -100.0)
    assert own.standard_error == pytest.approx(0.02)
    assert "upper bound" in own.remark


def test_no_light_after_few_paths_is_undecided_and_never_a_pass() -> None:
    # 2 σ reach to the minimum of 60 cd from a bound of 30 cd on.
    assert unlit_on_axis(29.9).outcome == "fail"
    assert unlit_on_axis(30.1).outcome == "undecided"


def test_a_lamp_that_is_dark_everywhere_fails() -> None:
    rule = find_rule("un-r148/S1")
    verdict = judge(rule, observe(rule, power_law(0.0, 1.0), relative_error=0.1, cell_error=0.1))
    assert verdict.outcome == "fail"
    assert all(np.isfinite([own.got, own.standard_error]).all() for own in verdict.findings)
    assert not [own for own in verdict.findings if own.requirement.startswith("colour")]


def test_a_cell_without_light_in_the_field_of_visibility_is_no_pass() -> None:
    rule = find_rule("un-r148/S1")

    def hole(h: np.ndarray, v: np.ndarray) -> np.ndarray:
        return np.where((np.abs(h - 40.5) < 0.1) & (np.abs(v - 10.5) < 0.1), 0.0, 100.0)

    # The minimum there is 0.3 cd.
    for bound_cd, outcome in ((0.14, "fail"), (0.16, "undecided")):
        readings = observe(rule, hole, cell_error=0.01)
        error = np.where(readings.grid_cd == 0.0, bound_cd, readings.grid_standard_error_cd)
        verdict = judge(rule, replace(readings, grid_standard_error_cd=error))
        own = next(one for one in verdict.findings if one.requirement.startswith("field"))
        assert (own.outcome, own.got, own.h_deg, own.v_deg) == (outcome, 0.0, 40.5, 10.5)


@pytest.mark.parametrize(("error", "outcome"), [(0.21, "undecided"), (0.19, "fail")])
def test_a_colour_is_judged_where_its_intensity_is_above_5_sigma(
    error: float, outcome: str
) -> None:
    """X, Y and Z of a handful of paths scatter together: x and y do not seem to scatter at all."""
    rule = find_rule("un-r148/S1")
    readings = observe(rule, power_law(100.0, 0.0), xy=AMBER, relative_error=error)
    verdict = judge(rule, readings)
    own = next(one for one in verdict.findings if one.requirement.startswith("colour"))
    assert own.outcome == outcome
    if outcome == "undecided":
        assert (own.got, own.unit, own.standard_error) == (100.0, "cd", pytest.approx(21.0))
        assert own.paths_factor == pytest.approx((5 * 0.21) ** 2)
        assert "too few paths for a colour" in own.remark


def test_the_sigma_of_a_ratio_is_that_of_the_delta_method() -> None:
    rule = find_rule("un-r148/S1")
    stop = observe(rule, power_law(70.0, 0.0), relative_error=0.03, name="stop")
    position = observe(rule, power_law(14.0, 0.0), relative_error=0.04, name="position")
    verdict = judge(rule, stop, others={"position": position})
    own = next(one for one in verdict.findings if one.requirement.startswith("ratio"))
    # (70 + 14)/14 = 6; σ of 70/14 = 5·√(0.03² + 0.04²) = 0.25
    assert (own.got, own.standard_error) == (pytest.approx(6.0), pytest.approx(0.25))
    assert (own.required, own.unit, own.outcome) == (5.0, "1", "pass")


def test_what_scatter_says_agrees_with_a_thousand_repeated_measurements() -> None:
    rule = find_rule("fmvss-108/stop")
    random = np.random.default_rng(4)
    sums = []
    for _ in range(1000):
        noisy = {
            (own.h_deg, own.v_deg): 100.0 * (1.0 + 0.05 * random.standard_normal())
            for own in rule.points()
            if own.group == 2
        }
        sums.append(sum(noisy.values()))
    verdict = judge(rule, observe(rule, power_law(100.0, 0.0), relative_error=0.05))
    own = next(one for one in verdict.findings if one.requirement == "group 3, sum")
    # 5 % of 100 cd at five points; the spread of 1000 draws is known to 2.2 %.
    assert own.standard_error == pytest.approx(np.std(sums), rel=0.09)


def test_the_factor_of_a_verdict_is_the_largest_of_its_findings() -> None:
    rule = find_rule("un-r148/S1")
    verdict = judge(rule, observe(rule, power_law(64.0, 0.0), relative_error=0.04))
    factors = [own.paths_factor for own in verdict.findings if own.paths_factor is not None]
    assert verdict.paths_factor == max(factors)
    assert replace(verdict, findings=()).paths_factor is None

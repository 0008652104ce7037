# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Retro-reflectors: a table of readings, worked out by hand."""

from __future__ import annotations

import pytest

from lamplit.errors import RuleError
from lamplit.photometry.reflex import ReflexReading
from lamplit.rules import find_rule, judge, judge_reflex

from .conftest import observe, power_law


def readings(factor: float, error: float = 0.0) -> list[ReflexReading]:
    """Return ``factor`` times what class IA asks of red, at every pair of angles."""
    table = {
        0.3333: {(0, 0): 300.0, (10, 0): 200.0, (5, 20): 100.0},
        1.5: {(0, 0): 5.0, (10, 0): 2.8, (5, 20): 2.5},
    }
    return [
        ReflexReading(v * up, h * side, observation, factor * cil, error * cil)
        for observation, rows in table.items()
        for (v, h), cil in rows.items()
        for up in ((1, -1) if v else (1,))
        for side in ((1, -1) if h else (1,))
    ]


def test_a_reflector_is_judged_at_each_pair_of_angles() -> None:
    rule = find_rule("un-r150/IA")
    assert len(rule.reflex_angles()) == len(readings(1.0)) == 14
    verdict = judge_reflex(rule, readings(1.1), function="plate")
    assert verdict.outcome == "pass"
    assert all(own.margin_percent == pytest.approx(10.0) for own in verdict.findings)
    assert {own.unit for own in verdict.findings} == {"mcd/lx"}
    assert judge_reflex(rule, readings(0.99)).outcome == "fail"
    assert judge_reflex(rule, readings(1.01, error=0.01)).outcome == "undecided"


def test_other_colours_send_back_more_by_a_factor_from_memory() -> None:
    rule = find_rule("un-r150/IA")
    for emits, factor in (("amber", 2.5), ("colourless", 4.0)):
        own = rule.under(emits=emits)
        assert judge_reflex(own, readings(1.001 * factor)).outcome == "pass"
        verdict = judge_reflex(own, readings(0.999 * factor))
        assert verdict.outcome == "fail"
        assert {one.trust for one in verdict.findings} == {"M"}
    assert {one.trust for one in judge_reflex(rule, readings(1.0)).findings} == {"V"}


def test_production_is_let_down_by_20_percent() -> None:
    rule = find_rule("un-r150/IA")
    assert judge_reflex(rule, readings(0.81)).outcome == "fail"
    assert judge_reflex(rule, readings(0.81), production=True).outcome == "pass"


def test_a_missing_pair_of_angles_is_named() -> None:
    rule = find_rule("un-r150/IA")
    with pytest.raises(RuleError, match=r"entrance angle V -5, H -20 at observation 1\.5"):
        judge_reflex(rule, readings(1.0)[:-1])


def test_rules_for_lamps_and_for_reflectors_are_not_mixed_up() -> None:
    stop = find_rule("un-r148/S1")
    with pytest.raises(RuleError, match="rule for lamps"):
        judge_reflex(stop, readings(1.0))
    with pytest.raises(RuleError, match="rule for retro-reflectors"):
        judge(find_rule("un-r150/IA"), observe(stop, power_law(1.0, 1.0)))

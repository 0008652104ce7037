# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Retro-reflectors: what they send back, against minima in mcd/lx."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from lamplit.errors import RuleError
from lamplit.photometry.reflex import ReflexReading, arc
from lamplit.rules.case import production_of
from lamplit.rules.choices import chosen_number
from lamplit.rules.decide import Source, finding, least_trusted
from lamplit.rules.models import Reflex
from lamplit.rules.rule import Rule
from lamplit.rules.verdict import Finding, Verdict

#: Two pairs of angles closer than this are the same: 20′ is written as 0.3333° or so.
_SAME_DEG = 0.005


def judge_reflex(
    rule: Rule, readings: Sequence[ReflexReading], *, function: str = "", production: bool = False
) -> Verdict:
    """Return the verdict on a retro-reflector, from its CIL at all of ``rule.reflex_angles()``.

    Raises:
        RuleError: The rule is for lamps, or an angle was not measured.
    """
    if not rule.entry.reflex:
        raise RuleError(f"{rule.id} is a rule for lamps, not for retro-reflectors")
    share = 1.0
    if production:
        share -= production_of(rule).deviation_percent / 100.0
    findings = [one for own in rule.entry.reflex for one in _findings(rule, own, readings, share)]
    return Verdict(
        rule.id,
        rule.title,
        function,
        tuple(findings),
        tuple(rule.options.items()),
        tuple(rule.rules.file.notices),
        production,
    )


def _findings(
    rule: Rule, own: Reflex, readings: Sequence[ReflexReading], share: float
) -> Iterator[Finding]:
    factor = chosen_number(own.factor, rule.options)
    trust = own.trust
    if factor != 1.0 and own.factor_trust is not None:
        trust = least_trusted(trust, own.factor_trust)
    for (v, h), minimum in zip(own.entrance_deg, own.minimum, strict=True):
        reading = _reading(rule, readings, v, h, own.observation_deg)
        yield finding(
            f"CIL at observation {arc(own.observation_deg)}",
            Source(own.clause, trust),
            sense="min",
            required=share * factor * minimum,
            got=reading.cil_mcd_per_lx,
            standard_error=reading.standard_error_mcd_per_lx,
            unit=own.unit,
            h_deg=h,
            v_deg=v,
            remark="entrance angles",
        )


def _reading(
    rule: Rule, readings: Sequence[ReflexReading], v: float, h: float, observation: float
) -> ReflexReading:
    for reading in readings:
        off = (
            reading.entrance_v_deg - v,
            reading.entrance_h_deg - h,
            reading.observation_deg - observation,
        )
        if max(abs(part) for part in off) <= _SAME_DEG:
            return reading
    raise RuleError(
        f"{rule.id} needs the entrance angle V {v:g}, H {h:g} at observation {observation:g}°, "
        "which was not measured; measure all of rule.reflex_angles()"
    )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`judge`: a rule, and what was observed of a lamp, to a `Verdict`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from lamplit.errors import RuleError
from lamplit.photometry.observed import Observed
from lamplit.rules.case import Case, production_of
from lamplit.rules.judge_colour import judge_colour
from lamplit.rules.judge_extents import judge_field, judge_maximum, judge_zone
from lamplit.rules.judge_points import judge_distribution
from lamplit.rules.judge_ratio import judge_ratio
from lamplit.rules.rule import Rule
from lamplit.rules.verdict import Finding, Verdict


def judge(
    rule: Rule,
    observed: Observed,
    *,
    others: Mapping[str, Observed] | None = None,
    production: bool = False,
    disputed: bool = False,
) -> Verdict:
    """Return what ``rule`` says of one function of a lamp.

    ``observed`` holds all of ``rule.spots()``, and a grid that covers ``rule.field()``; where the
    grid is smaller or coarser, what it cannot show is undecided. ``others`` are further functions
    of the lamp by the names that the rule gives them in its ratios, such as "position"; and
    "both", where the two lit together are not simply their sum.
    With ``production``, limits are those of a lamp from the line (conformity of production); with
    ``disputed``, a point may be met within the rule's tolerance, by ``rule.spots(disputed=True)``.

    A value is undecided while its limit lies within 2 standard errors of it. Where a limit holds in
    many directions, the one cell that fares worst stands for all by its own 2 σ: among n cells the
    worst is also the unluckiest, so a lamp close to a limit is called undecided or failed rather
    too often than too seldom.

    Raises:
        RuleError: A spot was not measured, or the rule has no value for the options chosen.
    """
    if rule.entry.reflex:
        raise RuleError(f"{rule.id} is a rule for retro-reflectors; use judge_reflex")
    case = Case(
        rule,
        observed,
        dict(others or {}),
        production_of(rule) if production else None,
        disputed,
    )
    return Verdict(
        rule.id,
        rule.title,
        observed.name,
        tuple(_findings(case)),
        tuple(rule.options.items()),
        (*rule.rules.file.notices, *rule.entry.notes, *_not_judged(case)),
        production,
    )


def _findings(case: Case) -> Iterator[Finding]:
    entry, holds = case.rule.entry, case.rule.holds
    for own in (own for own in entry.distribution if holds(own.when)):
        yield from judge_distribution(case, own)
    for own in (own for own in entry.maximum if holds(own.when)):
        yield from judge_maximum(case, own)
    yield from (judge_zone(case, own) for own in entry.zone if holds(own.when))
    for own in (own for own in entry.field if holds(own.when)):
        yield from judge_field(case, own)
    for own in (own for own in entry.ratio if holds(own.when)):
        yield from judge_ratio(case, own)
    if entry.colour is not None:
        yield from judge_colour(case, entry.colour)


def _not_judged(case: Case) -> Iterator[str]:
    for own in case.rule.entry.ratio:
        if case.rule.holds(own.when) and own.to not in case.others:
            yield f"the ratio to {own.to!r} is not judged: no such function was given"

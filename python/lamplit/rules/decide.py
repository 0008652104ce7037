# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From a value, its standard error and a limit to a `Finding`."""

from __future__ import annotations

from typing import Literal, NamedTuple

from lamplit.rules.models import Trust
from lamplit.rules.verdict import Finding, Outcome

#: A limit so many standard errors away is decided.
SIGMAS = 2.0

_LEAST_TRUSTED_FIRST: tuple[Trust, ...] = ("M", "V2", "N", "V")


class Decision(NamedTuple):
    """An outcome, and how many times as many paths would decide it."""

    outcome: Outcome
    paths_factor: float | None


class Source(NamedTuple):
    """Where a limit stands, and how far its figure can be trusted."""

    clause: str
    trust: Trust


def decision(inside_by: float, standard_error: float) -> Decision:
    """Decide on a value that lies ``inside_by`` inside its limit (below 0: outside).

    A limit within 2 standard errors, both ends included, is undecided. σ falls as 1/√paths, so
    (2σ/distance)² times as many paths would bring it to 2σ.
    """
    if standard_error > 0.0 and abs(inside_by) <= SIGMAS * standard_error:
        if inside_by == 0.0:
            return Decision("undecided", float("inf"))
        return Decision("undecided", (SIGMAS * standard_error / inside_by) ** 2)
    return Decision("pass" if inside_by >= 0.0 else "fail", None)


def margin_percent(inside_by: float, required: float) -> float | None:
    """Return how far inside a limit, in percent of it; None where the limit is 0."""
    return 100.0 * inside_by / required if required > 0.0 else None


def least_trusted(*marks: Trust) -> Trust:
    """Return the weakest of some trust marks."""
    return min(marks, key=_LEAST_TRUSTED_FIRST.index)


def finding(
    requirement: str,
    source: Source,
    *,
    sense: Literal["min", "max"],
    required: float,
    got: float,
    standard_error: float,
    unit: str = "cd",
    h_deg: float | None = None,
    v_deg: float | None = None,
    remark: str = "",
) -> Finding:
    """Return the finding on one value against one limit."""
    inside_by = got - required if sense == "min" else required - got
    decided = decision(inside_by, standard_error)
    return Finding(
        requirement=requirement,
        clause=source.clause,
        trust=source.trust,
        h_deg=h_deg,
        v_deg=v_deg,
        sense=sense,
        required=required,
        got=got,
        standard_error=standard_error,
        unit=unit,
        margin_percent=margin_percent(inside_by, required),
        outcome=decided.outcome,
        paths_factor=decided.paths_factor,
        remark=remark,
    )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Verdict`: what a rule says of a lamp, requirement by requirement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

#: "undecided": the limit lies within 2 σ of what was measured.
Outcome = Literal["pass", "fail", "undecided"]

_WORST_FIRST: tuple[Outcome, ...] = ("fail", "undecided", "pass")


def worst(outcomes: Sequence[Outcome]) -> Outcome:
    """Return the worst of some outcomes; "undecided" where there are none."""
    return min(outcomes, key=_WORST_FIRST.index) if outcomes else "undecided"


def best(outcomes: Sequence[Outcome]) -> Outcome:
    """Return the best of some outcomes; "undecided" where there are none."""
    return max(outcomes, key=_WORST_FIRST.index) if outcomes else "undecided"


@dataclass(frozen=True)
class Finding:
    """One requirement, what it asks, and what the lamp does."""

    #: What is required, in words: "minimum at the test point", "group 3, sum", "colour".
    requirement: str
    #: Clause of the regulation, and how far its figure can be trusted (marks of the rule file).
    clause: str
    trust: str
    #: Where, in degrees; None for what has no single place, such as a sum.
    h_deg: float | None
    v_deg: float | None
    #: The limit, and on which side of it `got` must be; None where the limit is no number (colour).
    sense: Literal["min", "max"] | None
    required: float | None
    got: float
    standard_error: float
    unit: str
    #: How far inside the limit, in percent of it; below 0 outside.
    margin_percent: float | None
    outcome: Outcome
    #: How many times as many paths would decide it, if the estimate stays (infinite on the limit);
    #: None where it is decided, or where paths cannot decide it.
    paths_factor: float | None = None
    #: What else there is to say, such as the chromaticity and the border next to it.
    remark: str = ""


@dataclass(frozen=True)
class Verdict:
    """All findings of one rule on one function of a lamp."""

    #: "un-r148/S1", and its title.
    rule: str
    title: str
    #: Name of the function.
    function: str
    findings: tuple[Finding, ...]
    #: What was chosen: ("sections", "1"), …
    options: tuple[tuple[str, str], ...] = ()
    #: Where the limits were read, and what was not judged.
    notices: tuple[str, ...] = ()
    #: Whether the limits are those of a lamp from the line (conformity of production).
    production: bool = False

    @property
    def outcome(self) -> Outcome:
        """Return the worst of all findings; "undecided" where there are none."""
        return worst([finding.outcome for finding in self.findings])

    @property
    def paths_factor(self) -> float | None:
        """Return how many times as many paths would decide all that they can; None if decided.

        Infinite where something lies exactly on its limit.
        """
        factors = [own.paths_factor for own in self.findings if own.paths_factor is not None]
        return max(factors, default=None)

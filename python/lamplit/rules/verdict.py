# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Verdict`: what a rule says of a lamp, requirement by requirement."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

#: "undecided": the limit lies within 2 σ of what was measured.
Outcome = Literal["pass", "fail", "undecided"]

_WORST_FIRST: tuple[Outcome, ...] = ("fail", "undecided", "pass")


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
    #: How many times as many paths would decide it; None where it is decided.
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

    @property
    def outcome(self) -> Outcome:
        """Return the worst of all findings.

        Raises:
            ValueError: There are none.
        """
        return min((finding.outcome for finding in self.findings), key=_WORST_FIRST.index)

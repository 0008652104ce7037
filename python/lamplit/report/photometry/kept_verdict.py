# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Verdicts and reflectors as ``measurement.json`` holds them."""

from __future__ import annotations

import math
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict

from lamplit.photometry.reflex import ReflexReading
from lamplit.report.photometry import results as shown
from lamplit.report.photometry.table import in_words
from lamplit.rules.verdict import Finding, Outcome, Verdict


class Kept(BaseModel):
    """A part of the file: no other keys, and numbers that are finite."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class KeptFinding(Kept):
    """See `lamplit.rules.Finding`; ``paths_factor`` is null too where no number would do."""

    requirement: str
    clause: str
    trust: str
    h_deg: float | None
    v_deg: float | None
    sense: Literal["min", "max"] | None
    required: float | None
    got: float
    standard_error: float
    unit: str
    margin_percent: float | None
    outcome: Outcome
    paths_factor: float | None
    remark: str


class KeptVerdict(Kept):
    """See `lamplit.rules.Verdict`; ``decided_by`` says its worst finding in words."""

    rule: str
    title: str
    outcome: Outcome
    count: dict[Outcome, int]
    decided_by: str
    findings: list[KeptFinding]
    options: dict[str, str]
    notices: list[str]
    production: bool


class KeptReading(Kept):
    """See `lamplit.photometry.reflex.ReflexReading`."""

    entrance_v_deg: float
    entrance_h_deg: float
    observation_deg: float
    cil_mcd_per_lx: float
    standard_error_mcd_per_lx: float


class KeptReflector(Kept):
    """One retro-reflector."""

    name: str
    paths: int
    verdict: KeptVerdict | None
    readings: list[KeptReading]


def kept_verdict(verdict: Verdict) -> KeptVerdict:
    """Return a verdict as it is kept."""
    return KeptVerdict(
        rule=verdict.rule,
        title=verdict.title,
        outcome=verdict.outcome,
        count=shown.tally(verdict),
        decided_by=in_words(verdict),
        findings=[KeptFinding(**_finite(vars(finding))) for finding in verdict.findings],
        options=dict(verdict.options),
        notices=list(verdict.notices),
        production=verdict.production,
    )


def verdict_of(kept: KeptVerdict, name: str) -> Verdict:
    """Return the verdict on the function or reflector ``name``."""
    return Verdict(
        rule=kept.rule,
        title=kept.title,
        function=name,
        findings=tuple(Finding(**vars(found)) for found in kept.findings),
        options=tuple(kept.options.items()),
        notices=tuple(kept.notices),
        production=kept.production,
    )


def kept_reflector(one: shown.ReflectorResults) -> KeptReflector:
    """Return a reflector as it is kept."""
    return KeptReflector(
        name=one.name,
        paths=one.paths,
        verdict=None if one.verdict is None else kept_verdict(one.verdict),
        readings=[KeptReading(**vars(own)) for own in one.readings],
    )


def reflector_of(kept: KeptReflector) -> shown.ReflectorResults:
    """Return the reflector that was kept."""
    return shown.ReflectorResults(
        kept.name,
        tuple(ReflexReading(**vars(own)) for own in kept.readings),
        kept.paths,
        None if kept.verdict is None else verdict_of(kept.verdict, kept.name),
    )


def _finite(values: dict[str, Any]) -> dict[str, Any]:
    """Put None where a number may be missing and is infinite."""
    open_ended = ("paths_factor", "margin_percent")
    endless = [name for name in open_ended if not math.isfinite(values[name] or 0.0)]
    return values | dict.fromkeys(endless)

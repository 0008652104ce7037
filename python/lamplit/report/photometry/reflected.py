# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Retro-reflectors as they are shown: from what the engine measured, and as a table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from lamplit.photometry.reflex import ReflexReading, arc
from lamplit.report.photometry import table
from lamplit.report.photometry.results import ReflectorResults, Results
from lamplit.report.photometry.style import MARKS, cd, spread
from lamplit.rules import judge_reflex

if TYPE_CHECKING:
    from rich.table import Table

    from lamplit.engine.reflectors import ReflexMeasurement
    from lamplit.rules import Rule, Verdict
    from lamplit.rules.verdict import Finding, Outcome

#: The unit of a coefficient of luminous intensity (CIL).
UNIT = "mcd/lx"


class Row(NamedTuple):
    """A reading in words, and what is required of it."""

    h: str
    v: str
    observation: str
    got: str
    spread: str
    required: str
    margin: str
    outcome: Outcome | None
    note: str
    clause: str


def reflector_results(
    name: str, measured: ReflexMeasurement, rule: Rule | None, *, production: bool = False
) -> ReflectorResults:
    """Return what was measured of a reflector, and what its rule says of it.

    Raises:
        RuleError: An angle of the rule was not measured.
    """
    readings = measured.readings
    verdict = None
    if rule is not None:
        verdict = judge_reflex(rule, readings, function=name, production=production)
    return ReflectorResults(name, readings, measured.paths, verdict)


def with_reflectors(
    results: Results | None,
    reflectors: Sequence[ReflectorResults],
    measured: Sequence[ReflexMeasurement],
) -> Results:
    """Return ``results`` of the lit lamp, or results of nothing else, with its reflectors."""
    if results is None:
        part = measured[0].parts[0]
        results = Results(
            scene=part.scene.name,
            scene_hash=part.scene.scene_hash,
            version=part.version,
            seed=part.seed,
            paths=0,
            functions=(),
        )
    geometry = {
        one.name: f"illuminant A from {arc(own.source_deg)}, receiver of {arc(own.receiver_deg)} "
        "above it, far field"
        for one, own in zip(reflectors, measured, strict=True)
    }
    return replace(
        results,
        reflectors=tuple(reflectors),
        paths=results.paths + sum(own.paths for own in measured),
        geometry={**results.geometry, **geometry},
        elapsed_s=results.elapsed_s + sum(own.elapsed_s for own in measured),
        complete=results.complete and all(own.complete for own in measured),
    )


def rows(one: ReflectorResults) -> list[Row]:
    """Return each reading, the least observation angle first, with what is required of it."""
    verdict = one.verdict
    # A verdict has a finding for each pair of angles, and its readings stand in the same order.
    findings = [_finding(verdict, reading) for reading in one.readings]
    pairs = sorted(
        zip(one.readings, findings, strict=True), key=lambda pair: pair[0].observation_deg
    )
    return [_row(reading, finding) for reading, finding in pairs]


def _finding(verdict: Verdict | None, reading: ReflexReading) -> Finding | None:
    """Return the finding on ``reading``: that with its angles."""
    for finding in () if verdict is None else verdict.findings:
        place = (finding.h_deg, finding.v_deg)
        observed = finding.requirement.endswith(f" {arc(reading.observation_deg)}")
        if observed and place == (reading.entrance_h_deg, reading.entrance_v_deg):
            return finding
    return None


def _row(reading: ReflexReading, finding: Finding | None) -> Row:
    error = reading.standard_error_mcd_per_lx
    return Row(
        h=table.angle(reading.entrance_h_deg),
        v=table.angle(reading.entrance_v_deg),
        observation=arc(reading.observation_deg),
        got=f"{cd(reading.cil_mcd_per_lx)} {UNIT}",
        spread=spread(2.0 * error),
        required="" if finding is None else table.required(finding),
        margin="" if finding is None else table.margin(finding),
        outcome=None if finding is None else finding.outcome,
        note="" if finding is None else table.more_paths(finding),
        clause="" if finding is None else f"{finding.clause} [{finding.trust}]",
    )


def reflector_table(one: ReflectorResults) -> Table:
    """Return the readings of a reflector for the terminal."""
    from rich.table import Table
    from rich.text import Text

    shown = Table(box=None, header_style="bold", pad_edge=False)
    for heading in ("H °", "V °", "observed at", "CIL", "2 σ", "required", "margin"):
        shown.add_column(heading, justify="right", no_wrap=True)
    shown.add_column("")
    shown.add_column("")
    for row in rows(one):
        word = Text("")
        if row.outcome is not None:
            mark = MARKS[row.outcome]
            word = Text(f"{mark.sign} {mark.word}", style=table.STYLES[row.outcome])
        cells = (row.h, row.v, row.observation, row.got, row.spread, row.required, row.margin)
        shown.add_row(*map(Text, cells), word, Text(row.note))
    return shown

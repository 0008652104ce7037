# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Test points, group sums, and what holds between the points."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from lamplit.photometry.observed import Observed
from lamplit.rules.case import Case
from lamplit.rules.choices import chosen_name, chosen_numbers
from lamplit.rules.decide import Decision, Source, finding, least_trusted
from lamplit.rules.extents import Box
from lamplit.rules.models import Distribution
from lamplit.rules.points import Segment, TestPoint, cells, required_points, segments
from lamplit.rules.reading import Reading, spot_index, spots_within
from lamplit.rules.verdict import Finding, best, worst
from lamplit.rules.worst_cell import worst_cell


def judge_distribution(case: Case, own: Distribution) -> Iterator[Finding]:
    """Yield the findings on a distribution: points, group sums, between the points."""
    rule = case.rule
    file = rule.rules.file
    grid = file.grids[chosen_name(own.grid, rule.options)]
    source = Source(own.clause, least_trusted(own.trust, grid.trust))
    points = required_points(own, file.grids, file.groupings, rule.options)
    readings = [read_minimum(case, case.observed, point) for point in points]
    singles = list(_singles(case, own, points, readings, source))
    sums = list(_sums(case, own, points, readings, source))
    if own.rule == "point-or-group":
        yield from _either(points, singles, sums)
    else:
        yield from singles
        yield from sums
    yield from _between(case, own, points, readings, source)


def read_minimum(case: Case, observed: Observed, point: TestPoint) -> Reading:
    """Return the reading at a point; where it is disputed, the best within the tolerance."""
    readings = case.spots_of(observed)
    if not case.disputed:
        return readings[spot_index(observed, point.h_deg, point.v_deg, case.rule.id)]
    near = spots_within(observed, point.h_deg, point.v_deg, case.rule.tolerance_deg())
    at = spot_index(observed, point.h_deg, point.v_deg, case.rule.id)
    most = max([at, *near], key=lambda spot: readings[spot].cd)
    remark = "" if most == at else f"met within {case.rule.tolerance_deg():g}°, as disputed"
    return readings[most]._replace(remark=readings[most].remark or remark)


def _singles(
    case: Case,
    own: Distribution,
    points: Sequence[TestPoint],
    readings: Sequence[Reading],
    source: Source,
) -> Iterator[Finding]:
    share = 1.0 if own.floor_percent is None else own.floor_percent / 100.0
    for point, reading in zip(points, readings, strict=True):
        whole = case.least(point.minimum_cd)
        words = f"minimum at {point.name}"
        if own.floor_percent is not None:
            words += f" ({own.floor_percent:g} % of {whole:g} cd)"
        yield finding(
            words,
            source,
            sense="min",
            required=share * whole,
            got=reading.cd,
            standard_error=reading.standard_error,
            h_deg=point.h_deg,
            v_deg=point.v_deg,
            remark=reading.remark,
        )


def _sums(
    case: Case,
    own: Distribution,
    points: Sequence[TestPoint],
    readings: Sequence[Reading],
    source: Source,
) -> Iterator[Finding]:
    if own.sums_cd is None:
        return
    for group, minimum in enumerate(chosen_numbers(own.sums_cd, case.rule.options)):
        members = [
            reading for point, reading in zip(points, readings, strict=True) if point.group == group
        ]
        yield finding(
            f"group {group + 1}, sum",
            source,
            sense="min",
            required=case.least(minimum),
            got=sum(reading.cd for reading in members),
            standard_error=float(np.hypot.reduce([own.standard_error for own in members])),
            remark=f"of {len(members)} points",
        )


def _either(
    points: Sequence[TestPoint], singles: Sequence[Finding], sums: Sequence[Finding]
) -> Iterator[Finding]:
    """Yield points and sums so that a point passes with its group, and a group with its points."""
    for point, single in zip(points, singles, strict=True):
        if point.group is None:
            yield single
        else:
            group = sums[point.group]
            other = Decision(group.outcome, group.paths_factor)
            yield _lifted(single, other, f"group {point.group + 1}'s sum")
    for number, group in enumerate(sums):
        members = [own for point, own in zip(points, singles, strict=True) if point.group == number]
        factors = [own.paths_factor for own in members if own.paths_factor is not None]
        whole = Decision(worst([own.outcome for own in members]), max(factors, default=None))
        yield _lifted(group, whole, "each of its points")


def _lifted(own: Finding, other: Decision, instead: str) -> Finding:
    """Return a finding with the better of two outcomes, of which one stands in for the other."""
    outcome = best([own.outcome, other.outcome])
    if outcome == own.outcome:
        return own
    words = "meets the minimum" if outcome == "pass" else "may meet the minimum"
    remark = "; ".join(part for part in (own.remark, f"{instead} {words} in its place") if part)
    return replace(own, outcome=outcome, paths_factor=other.paths_factor, remark=remark)


def _between(
    case: Case,
    own: Distribution,
    points: tuple[TestPoint, ...],
    readings: Sequence[Reading],
    source: Source,
) -> Iterator[Finding]:
    way = chosen_name(own.between, case.rule.options)
    if way == "no":
        return
    grid = case.cells
    limit = np.full(grid.cd.shape, np.nan)
    reached: list[Box] = []
    if way == "cells":
        for cell in cells(own, case.rule.rules.file.grids, case.rule.options):
            box = Box(*cell.h_deg, *cell.v_deg)
            reached.append(box)
            limit[grid.inside(box)] = case.least(cell.minimum_cd)
    else:
        below = {
            point.name
            for point, reading in zip(points, readings, strict=True)
            if reading.cd < case.least(point.minimum_cd)
        }
        for segment in segments(points):
            box = _touching(segment, case.rule.rules.file.cell_deg)
            reached.append(_between_points(segment))
            least = _segment_minimum(case, own, segment, below)
            if least is not None:
                mask = grid.inside(box)
                limit[mask] = np.fmax(limit[mask], least)
    words = {"cells": "minimum between the points", "neighbours": "minimum between neighbours"}
    yield worst_cell(case, words[way], source, sense="min", limit=limit, reached=reached)


def _touching(segment: Segment, cell_deg: float) -> Box:
    """Return the range that holds the middles of the cells on both sides of a segment."""
    first, second = segment
    wide = 0.51 * cell_deg
    if first.v_deg == second.v_deg:
        return Box(first.h_deg, second.h_deg, first.v_deg - wide, first.v_deg + wide)
    return Box(first.h_deg - wide, first.h_deg + wide, first.v_deg, second.v_deg)


def _between_points(segment: Segment) -> Box:
    """Return the range of a segment itself, which has no width."""
    first, second = segment
    return Box(first.h_deg, second.h_deg, first.v_deg, second.v_deg)


def _segment_minimum(
    case: Case, own: Distribution, segment: Segment, below: set[str]
) -> float | None:
    """Return what holds between two points: the lower of their minima, let down with them."""
    least = case.least(min(segment.first.minimum_cd, segment.second.minimum_cd))
    least *= own.between_percent / 100.0
    if own.rule == "each" or not below & {segment.first.name, segment.second.name}:
        return least
    return None if own.floor_percent is None else least * own.floor_percent / 100.0

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The cell of a grid that decides a limit which holds in many directions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lamplit.rules.case import Case
from lamplit.rules.decide import SIGMAS, Source, finding
from lamplit.rules.extents import Box
from lamplit.rules.reading import CellReadings
from lamplit.rules.verdict import Finding

Array = NDArray[np.float64]


def worst_cell(
    case: Case,
    requirement: str,
    source: Source,
    *,
    sense: Literal["min", "max"],
    limit: Array,
    reached: Sequence[Box],
    cells: CellReadings | None = None,
    unit: str = "cd",
    remark: str = "",
) -> Finding:
    """Return the finding on the cell that fares worst against ``limit`` (v, h), NaN for no limit.

    A cell that fails goes before one that is undecided, and that before one that passes; among
    equals the one with the least margin stands for all. Its own 2 σ decide. Where the grid does
    not reach to the ``reached`` ranges, or is too coarse, nothing passes.
    """
    cells = case.cells if cells is None else cells
    valid = ~np.isnan(limit)
    short = [box for box in reached if not cells.covers(box)]
    if not valid.any():
        return _untold(requirement, source, sense, unit, short)
    inside_by = (cells.cd - limit) * (1.0 if sense == "min" else -1.0)
    near = (cells.standard_error > 0.0) & (np.abs(inside_by) <= SIGMAS * cells.standard_error)
    rank = np.where(near, 1, np.where(inside_by < 0.0, 0, 2))
    margin = inside_by / np.where(limit > 0.0, limit, 1.0)
    rank, margin = np.where(valid, rank, 3), np.where(valid, margin, np.inf)
    row, column = np.unravel_index(int(np.lexsort((margin.ravel(), rank.ravel()))[0]), rank.shape)
    count = int(valid.sum())
    which = "lowest" if sense == "min" else "highest"
    words = [f"{which} of {count} cells of {cells.size_deg:g}°", remark]
    own = finding(
        requirement,
        source,
        sense=sense,
        required=float(limit[row, column]),
        got=float(cells.cd[row, column]),
        standard_error=float(cells.standard_error[row, column]),
        unit=unit,
        h_deg=float(cells.h_deg[column]),
        v_deg=float(cells.v_deg[row]),
        remark="; ".join(part for part in words if part),
    )
    if own.outcome != "pass":
        return own
    if short:
        return replace(own, outcome="undecided", remark=f"{own.remark}; {_uncovered(short)}")
    if cells.size_deg > 1.001 * case.rule.rules.file.cell_deg:
        asked = case.rule.rules.file.cell_deg
        remark = f"{own.remark}; cells of {asked:g}° at most are needed to be sure"
        return replace(own, outcome="undecided", remark=remark)
    return own


def _uncovered(short: Sequence[Box]) -> str:
    box = Box(
        min(own.left_deg for own in short),
        max(own.right_deg for own in short),
        min(own.bottom_deg for own in short),
        max(own.top_deg for own in short),
    )
    return (
        f"the grid does not cover H {box.left_deg:g} to {box.right_deg:g}, "
        f"V {box.bottom_deg:g} to {box.top_deg:g}: measure rule.field()"
    )


def _untold(
    requirement: str,
    source: Source,
    sense: Literal["min", "max"],
    unit: str,
    short: Sequence[Box],
) -> Finding:
    """Return an undecided finding: no cell of the grid tells."""
    return Finding(
        requirement=requirement,
        clause=source.clause,
        trust=source.trust,
        h_deg=None,
        v_deg=None,
        sense=sense,
        required=None,
        got=0.0,
        standard_error=0.0,
        unit=unit,
        margin_percent=None,
        outcome="undecided",
        remark=_uncovered(short) if short else "no cell of the grid lies here",
    )

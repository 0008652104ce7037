# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Ratios between two functions in the same direction, with σ by the delta method."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamplit.photometry.observed import Observed
from lamplit.rules.case import Case
from lamplit.rules.choices import chosen_name, chosen_number
from lamplit.rules.decide import Source, finding, least_trusted
from lamplit.rules.extents import Box
from lamplit.rules.models import Ratio
from lamplit.rules.points import grid_points, point_name
from lamplit.rules.reading import CellReadings, Reading, cell_readings, spot_index, spot_readings
from lamplit.rules.verdict import Finding
from lamplit.rules.worst_cell import worst_cell

Array = NDArray[np.float64]


def judge_ratio(case: Case, own: Ratio) -> Iterator[Finding]:
    """Yield the findings on a ratio; none where the other function was not observed.

    The two functions are taken to be lit by paths of their own, so that their errors are
    independent. Where they share light groups, their errors agree in sign and σ is too large.
    """
    other = case.others.get(own.to)
    if other is None:
        return
    rule = case.rule
    source = Source(own.clause, own.trust)
    if own.grid is not None:
        grid = rule.rules.file.grids[chosen_name(own.grid, rule.options)]
        source = Source(own.clause, least_trusted(own.trust, grid.trust))
        for h, v, minimum in grid_points(grid):
            yield _at_spot(case, own, other, source, (h, v, minimum))
        return
    minimum = chosen_number(own.minimum if own.minimum is not None else 0.0, rule.options)
    box = Box(*own.h_deg, *own.v_deg)
    for point in rule.points():
        if (
            box.left_deg <= point.h_deg <= box.right_deg
            and box.bottom_deg <= point.v_deg <= box.top_deg
        ):
            yield _at_spot(case, own, other, source, (point.h_deg, point.v_deg, minimum))
    yield _between(case, own, other, Demand(source, minimum, box))


def _at_spot(
    case: Case,
    own: Ratio,
    other: Observed,
    source: Source,
    wanted: tuple[float, float, float],
) -> Finding:
    h, v, minimum = wanted
    at = spot_index(case.observed, h, v, case.rule.id)
    below = spot_readings(other)[spot_index(other, h, v, case.rule.id)]
    above = case.spots[at]
    both = case.others.get("both")
    if own.numerator == "both" and both is not None:
        above = spot_readings(both)[spot_index(both, h, v, case.rule.id)]
    value, error, remark = _ratio(above, below, add=own.numerator == "both" and both is None)
    return finding(
        f"{_words(own, case)} at {point_name(h, v)}",
        source,
        sense="min",
        required=minimum,
        got=value,
        standard_error=error,
        unit="1",
        h_deg=h,
        v_deg=v,
        remark=remark,
    )


def _words(own: Ratio, case: Case) -> str:
    name = case.observed.name
    return (
        f"ratio ({name} + {own.to}) : {own.to}"
        if own.numerator == "both"
        else f"ratio {name} : {own.to}"
    )


def _ratio(above: Reading, below: Reading, *, add: bool) -> tuple[float, float, str]:
    """Return (above + below)/below or above/below, its σ, and what to say of it."""
    whole = 1.0 if add else 0.0
    if below.cd <= 0.0:
        most = 2.0 * below.standard_error
        if most <= 0.0:
            return 0.0, 0.0, "the other function gives no light here: there is no ratio"
        words = "the other function gives no light here: at least so much, by the bound of its σ"
        return whole + above.cd / most, above.standard_error / most, words
    value = above.cd / below.cd
    error = float(np.hypot(above.standard_error, value * below.standard_error)) / below.cd
    return whole + value, error, ""


class Demand(NamedTuple):
    """A ratio that holds in a range."""

    source: Source
    minimum: float
    box: Box


def _between(case: Case, own: Ratio, other: Observed, demand: Demand) -> Finding:
    """Return the finding on the cell with the worst ratio."""
    both = case.others.get("both") if own.numerator == "both" else None
    above = case.cells if both is None else cell_readings(both)
    below = cell_readings(other)
    if below.cd.shape != above.cd.shape:
        above = below = case.cells
        limit = np.full(case.cells.cd.shape, np.nan)
    else:
        limit = np.where(case.cells.inside(demand.box), demand.minimum, np.nan)
    value, error = _cell_ratio(above, below, add=own.numerator == "both" and both is None)
    cells = CellReadings(
        value,
        error,
        case.cells.h_deg,
        case.cells.v_deg,
        case.cells.h_edges_deg,
        case.cells.v_edges_deg,
    )
    return worst_cell(
        case,
        f"{_words(own, case)}, between the points",
        demand.source,
        sense="min",
        limit=limit,
        reached=[demand.box],
        cells=cells,
        unit="1",
    )


def _cell_ratio(above: CellReadings, below: CellReadings, *, add: bool) -> tuple[Array, Array]:
    """Return the ratio in each cell and its σ; in the dark, the ratio to the other's bound."""
    dark = below.cd <= 0.0
    under = np.where(dark, 2.0 * below.standard_error, below.cd)
    safe = np.where(under > 0.0, under, 1.0)
    value = np.where(under > 0.0, above.cd / safe, 0.0)
    spread = np.where(dark, 0.0, below.standard_error)
    return (1.0 if add else 0.0) + value, np.hypot(above.standard_error, value * spread) / safe

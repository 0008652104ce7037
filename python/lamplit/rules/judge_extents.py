# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Maxima over ranges, minima of zones and of the field of visibility."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from lamplit.rules.case import Case
from lamplit.rules.choices import chosen_number
from lamplit.rules.decide import Source, finding
from lamplit.rules.extents import Box, inside, maximum_boxes, visibility_boxes
from lamplit.rules.models import Maximum, VisibilityField, Zone
from lamplit.rules.reading import CellReadings
from lamplit.rules.verdict import Finding, Outcome
from lamplit.rules.worst_cell import worst_cell

Array = NDArray[np.float64]

_RANK: dict[Outcome, int] = {"fail": 0, "undecided": 1, "pass": 2}


def judge_maximum(case: Case, own: Maximum) -> Iterator[Finding]:
    """Yield the findings on a maximum: each point, or the worst of cells and spots."""
    source = Source(own.clause, own.trust)
    limit = case.most(chosen_number(own.cd, case.rule.options))
    boxes = maximum_boxes(own, case.rule.side)
    spots = _spot_findings(case, source, limit, boxes, points=own.where == "points")
    if own.where == "points":
        yield from spots
        return
    if own.optional and not all(case.cells.covers(box) for box in boxes):
        return
    cells = _receivers(case.cells)
    size = int(2.0 * own.spot_radius_deg / cells.size_deg + 1e-6)
    remark = ""
    if own.spot_radius_deg > 0.0:
        remark = f"spots smaller than a cone of {own.spot_radius_deg:g}° radius are let through"
    limits = np.full(cells.cd.shape, np.nan)
    for box in boxes:
        limits[cells.inside(box)] = limit
    if size > 1:
        cells, limits = _blocks(cells, limits, size)
    words = "maximum" if own.h_deg == (-90.0, 90.0) else f"maximum, {_range(boxes)}"
    if own.v_deg != (-90.0, 90.0) and own.h_deg == (-90.0, 90.0):
        words = f"maximum, V {own.v_deg[0]:g} to {own.v_deg[1]:g}"
    highest = worst_cell(
        case, words, source, sense="max", limit=limits, reached=boxes, cells=cells, remark=remark
    )
    if own.spot_radius_deg > 0.0 or not spots:
        yield highest
        return
    spot = min(spots, key=lambda one: (_RANK[one.outcome], one.margin_percent or 0.0))
    worse = (_RANK[spot.outcome], spot.got < highest.got) < (_RANK[highest.outcome], False)
    yield replace(spot, requirement=words, remark="highest of all spots") if worse else highest


def _range(boxes: tuple[Box, ...]) -> str:
    return " and ".join(
        f"H {box.left_deg:g} to {box.right_deg:g}, V {box.bottom_deg:g} to {box.top_deg:g}"
        for box in boxes
    )


def _spot_findings(
    case: Case, source: Source, limit: float, boxes: tuple[Box, ...], *, points: bool
) -> list[Finding]:
    """Return the findings at the spots in a range; with ``points``, at the rule's points alone."""
    observed = case.observed
    names = {(round(p.h_deg, 6), round(p.v_deg, 6)): p.name for p in case.rule.points()}
    found: list[Finding] = []
    for h, v, reading in zip(observed.spot_h_deg, observed.spot_v_deg, case.spots, strict=True):
        name = names.get((round(float(h), 6), round(float(v), 6)))
        if not any(inside(box, float(h), float(v)) for box in boxes) or (points and name is None):
            continue
        found.append(
            finding(
                f"maximum at {name}" if name else "maximum",
                source,
                sense="max",
                required=limit,
                got=reading.cd,
                standard_error=reading.standard_error,
                h_deg=float(h),
                v_deg=float(v),
                remark=reading.remark,
            )
        )
    return found


def _receivers(cells: CellReadings) -> CellReadings:
    """Return cells averaged along H where, near a pole, they are narrower than they are high.

    So none subtends much less than the receiver that a regulation allows, and a single path in a
    sliver of a cell is not taken for a bright spot.
    """
    cd, error = cells.cd.copy(), cells.standard_error.copy()
    for row, v in enumerate(cells.v_deg):
        width = min(round(1.0 / np.cos(np.radians(v))), cd.shape[1])
        if width > 1:
            cd[row] = _running_mean(cells.cd[row], width)
            error[row] = np.sqrt(_running_mean(cells.standard_error[row] ** 2, width) / width)
    return replace(cells, cd=cd, standard_error=error)


def _running_mean(values: Array, width: int) -> Array:
    """Return the mean of ``width`` neighbours; at the ends, of the first or last so many."""
    means = sliding_window_view(values, width).mean(axis=-1)
    before = (width - 1) // 2
    return np.pad(means, (before, len(values) - len(means) - before), mode="edge")


def _blocks(cells: CellReadings, limits: Array, size: int) -> tuple[CellReadings, Array]:
    """Return, for each square of ``size`` cells a side, its darkest cell: all of it is brighter.

    A square as wide as a cone holds it, so where its darkest cell is above a maximum, the spot is
    no smaller than the cone.
    """
    shape = (size, size)
    if min(cells.cd.shape) < size:
        return cells, limits
    cd = sliding_window_view(cells.cd, shape).reshape(-1, size * size)
    error = sliding_window_view(cells.standard_error, shape).reshape(-1, size * size)
    whole = sliding_window_view(limits, shape)
    darkest = np.argmin(cd, axis=1)[:, None]
    h = sliding_window_view(cells.h_deg, size).mean(axis=-1)
    v = sliding_window_view(cells.v_deg, size).mean(axis=-1)
    new = (len(v), len(h))
    picked = replace(
        cells,
        cd=np.take_along_axis(cd, darkest, axis=1).reshape(new),
        standard_error=np.take_along_axis(error, darkest, axis=1).reshape(new),
        h_deg=h,
        v_deg=v,
    )
    return picked, whole.max(axis=(-2, -1))


def judge_zone(case: Case, own: Zone) -> Finding:
    """Return the finding on the minimum in a polygon."""
    cells = case.cells
    corners = np.array(own.polygon_deg)
    limit = np.full(cells.cd.shape, np.nan)
    least = case.least(chosen_number(own.cd, case.rule.options))
    limit[_in_polygon(corners, cells.h_deg, cells.v_deg)] = least
    low, high = corners.min(axis=0), corners.max(axis=0)
    box = Box(float(low[0]), float(high[0]), float(low[1]), float(high[1]))
    source = Source(own.clause, own.trust)
    return worst_cell(case, "minimum in the zone", source, sense="min", limit=limit, reached=[box])


def _in_polygon(corners: Array, h_deg: Array, v_deg: Array) -> NDArray[np.bool_]:
    """Return (v, h), which middles lie in a polygon."""
    h, v = np.meshgrid(h_deg, v_deg)
    found = np.zeros(h.shape, dtype=bool)
    for (h0, v0), (h1, v1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if v0 != v1:
            spans = (v0 > v) != (v1 > v)
            found ^= spans & (h < h0 + (v - v0) * (h1 - h0) / (v1 - v0))
    return found


def judge_field(case: Case, own: VisibilityField) -> Iterator[Finding]:
    """Yield the findings on a field of visibility."""
    source = Source(own.clause, own.trust)
    least = case.least_in_field(chosen_number(own.cd, case.rule.options))
    boxes, only_common = visibility_boxes(own, case.rule)
    limit = np.full(case.cells.cd.shape, np.nan)
    for box in boxes:
        limit[case.cells.inside(box)] = least
    words = "field of visibility" + (", the part common to both sides" if only_common else "")
    lowest = worst_cell(case, words, source, sense="min", limit=limit, reached=boxes)
    yield lowest
    if only_common:
        yield replace(
            lowest,
            requirement="field of visibility, outboard",
            h_deg=None,
            v_deg=None,
            required=least,
            got=0.0,
            standard_error=0.0,
            margin_percent=None,
            outcome="undecided",
            paths_factor=None,
            remark='the side of the car is not said: set side = "left" or side = "right"',
        )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The test-point chart: a cell for each point of the rule's grid, as the regulation prints it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lamplit.report.photometry.style import (
    GROUND,
    INK,
    MARKS,
    QUIET,
    cd,
    head,
    new_figure,
    shortened,
    write,
)
from lamplit.report.photometry.table import angle, margin, points_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lamplit.report.photometry.results import FunctionResults
    from lamplit.report.photometry.table import Point
    from lamplit.rules.verdict import Verdict

#: A cell's width and height in inches, and the most a page is wide.
_CELL_W, _CELL_H, _WIDEST = 1.12, 0.72, 9.6
_LEFT, _TOP, _BOTTOM = 0.62, 0.98, 0.5


def draw_chart(function: FunctionResults, verdict: Verdict) -> Figure | None:
    """Draw what was got and required at each test point; None of a rule that has no points.

    Columns and rows are the values of H and V that occur, not a scale. A cell shows the finding
    that decides there: the sign and word of its outcome, got, required, and the margin.
    """
    points = points_of(verdict, function.observed)
    if not points:
        return None
    columns = sorted({point.h_deg for point in points})
    rows = sorted({point.v_deg for point in points}, reverse=True)
    cell_w = min(_CELL_W, (_WIDEST - _LEFT - 0.2) / len(columns))
    width = max(_LEFT + cell_w * len(columns) + 0.2, 6.4)
    height = _TOP + _CELL_H * len(rows) + _BOTTOM
    figure = new_figure(width, height)
    unit = points[0].deciding.unit
    head(
        figure,
        f"{shortened(function.name, 40)}: test points, {shortened(verdict.rule, 40)}",
        f"in each cell: got, required, margin{f'; values in {unit}' if unit else ''}",
    )
    axes = figure.add_axes(
        (_LEFT / width, _BOTTOM / height, cell_w * len(columns) / width,
         _CELL_H * len(rows) / height)
    )  # fmt: skip
    axes.set(xlim=(0, len(columns)), ylim=(len(rows), 0))
    axes.set_axis_off()
    small = cell_w < 0.85
    for point in points:
        _draw_cell(axes, columns.index(point.h_deg), rows.index(point.v_deg), point, small=small)
    _draw_empty(axes, columns, rows, points)
    for place, h_deg in enumerate(columns):
        write(axes, place + 0.5, -0.12, f"{angle(h_deg)}°", size=8, ink=QUIET, align="center")
    for place, v_deg in enumerate(rows):
        write(axes, -0.1, place + 0.5, f"{angle(v_deg)}°", size=8, ink=QUIET, align="right",
              middle=True)  # fmt: skip
    write(axes, -0.1, -0.12, "V \\ H", size=8, ink=QUIET, align="right")
    _write_tally(figure, points, height)
    return figure


def _draw_cell(axes: Axes, column: int, row: int, point: Point, *, small: bool) -> None:
    from matplotlib.patches import Rectangle

    finding, mark = point.deciding, MARKS[point.outcome]
    cell = Rectangle((column + 0.02, row + 0.03), 0.96, 0.94, facecolor=mark.tint, edgecolor="none")
    axes.add_patch(cell)
    emphasis = 2.0 if point.outcome != "pass" else 0.0
    if emphasis:
        cell.set(edgecolor=mark.ink, linewidth=1.2)
    size = 6.5 if small else 7.5
    sign = {"min": "≥", "max": "≤", None: ""}[finding.sense]
    limit = "" if finding.required is None else f"{sign} {finding.required:.4g}"
    write(axes, column + 0.08, row + 0.40, cd(finding.got), size=size + 3, bold=True)
    write(axes, column + 0.92, row + 0.38, mark.sign, size=size + 3.5, ink=mark.ink, bold=True,
          align="right")  # fmt: skip
    write(axes, column + 0.08, row + 0.66, limit, size=size, ink=QUIET)
    write(axes, column + 0.08, row + 0.88, margin(finding), size=size, ink=mark.ink,
          bold=point.outcome != "pass")  # fmt: skip


def _draw_empty(axes: Axes, columns: list[float], rows: list[float], points: list[Point]) -> None:
    """Leave places of the grid where nothing is required as a quiet ground."""
    from matplotlib.patches import Rectangle

    taken = {(point.h_deg, point.v_deg) for point in points}
    for column, h_deg in enumerate(columns):
        for row, v_deg in enumerate(rows):
            if (h_deg, v_deg) not in taken:
                ground = Rectangle((column + 0.02, row + 0.03), 0.96, 0.94, facecolor=GROUND)
                axes.add_patch(ground)


def _write_tally(figure: Figure, points: list[Point], height: float) -> None:
    width = figure.get_figwidth()
    at = _LEFT
    for outcome, mark in MARKS.items():
        count = sum(point.outcome == outcome for point in points)
        if count:
            write(figure, at / width, 0.2 / height, mark.sign, size=9, ink=mark.ink, bold=True)
            write(figure, (at + 0.16) / width, 0.2 / height, f"{mark.word}: {count}", size=8,
                  ink=INK)  # fmt: skip
            at += 1.3

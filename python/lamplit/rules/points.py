# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The test points of a rule, their names and minima, and what holds between them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import ROUND_FLOOR, Decimal
from itertools import pairwise
from typing import NamedTuple

from lamplit.rules.choices import chosen_name, chosen_number
from lamplit.rules.models import Distribution, Grid, Grouping


@dataclass(frozen=True)
class TestPoint:
    """A direction with a minimum."""

    #: Not a test, whatever its name begins with.
    __test__ = False

    #: "H-V", "5U-10L": L is to the left of who stands behind the lamp and looks along its beam
    #: (FMVSS 108, S14.2.1.4 (e)), and so has H > 0 here.
    name: str
    h_deg: float
    v_deg: float
    minimum_cd: float
    #: Which group it is summed in, from 0; None where there are none.
    group: int | None = None


class Cell(NamedTuple):
    """A rectangle between the lines of a grid, and the least that holds in it."""

    h_deg: tuple[float, float]
    v_deg: tuple[float, float]
    minimum_cd: float


class Segment(NamedTuple):
    """The line between two neighbouring points of a row or a column."""

    first: TestPoint
    second: TestPoint


def point_name(h_deg: float, v_deg: float) -> str:
    """Return the name of a direction, as the tables write it.

    >>> point_name(0.0, 0.0), point_name(10.0, -5.0)
    ('H-V', '5D-10L')
    """
    up = "H" if v_deg == 0.0 else f"{abs(v_deg):g}{'U' if v_deg > 0.0 else 'D'}"
    right = "V" if h_deg == 0.0 else f"{abs(h_deg):g}{'R' if h_deg < 0.0 else 'L'}"
    return f"{up}-{right}"


def grid_points(grid: Grid) -> Iterator[tuple[float, float, float]]:
    """Yield H, V and value of each entry of a grid, by rows."""
    for v, row in zip(grid.v_deg, grid.rows, strict=True):
        for h, value in zip(grid.h_deg, row, strict=True):
            if not isinstance(value, str):
                yield h, v, value


def rounded_down(value: Decimal, digits: int) -> Decimal:
    """Return ``value`` rounded down to so many significant digits.

    >>> float(rounded_down(Decimal("12.3456"), 3))
    12.3
    """
    if value == 0:
        return value
    return value.quantize(Decimal(1).scaleb(value.adjusted() - digits + 1), rounding=ROUND_FLOOR)


def _minimum(own: Distribution, grid: Grid, value: float, options: Mapping[str, str]) -> float:
    if grid.unit != "%" or own.minimum_cd is None:
        return value
    whole = Decimal(str(chosen_number(own.minimum_cd, options)))
    product = whole * Decimal(str(value)) / 100
    if own.significant_digits is not None:
        product = rounded_down(product, own.significant_digits)
    return float(product)


def _lowest(own: Distribution, options: Mapping[str, str]) -> float:
    return -180.0 if own.down_to_deg is None else -chosen_number(own.down_to_deg, options)


def required_points(
    own: Distribution,
    grids: Mapping[str, Grid],
    groupings: Mapping[str, Grouping],
    options: Mapping[str, str],
) -> tuple[TestPoint, ...]:
    """Return the points of a distribution, with their minima under the options chosen."""
    grid = grids[chosen_name(own.grid, options)]
    lowest = _lowest(own, options)
    groups: dict[str, int] = {}
    if own.groups is not None:
        members = groupings[own.groups].groups
        groups = {name: at for at, names in enumerate(members) for name in names}
    points: list[TestPoint] = []
    for h, v, value in grid_points(grid):
        below = v < lowest
        if below and own.below_that == "left-out":
            continue
        name = point_name(h, v)
        at_v = lowest if below else v
        minimum = _minimum(own, grid, value, options)
        points.append(TestPoint(name, h, at_v, minimum, groups.get(name)))
    return tuple(points)


def cells(
    own: Distribution, grids: Mapping[str, Grid], options: Mapping[str, str]
) -> Iterator[Cell]:
    """Yield the rectangles of the grid, each with the lowest minimum on the lines round it."""
    grid = grids[chosen_name(own.grid, options)]
    lowest = _lowest(own, options)
    value_at = {(h, v): value for h, v, value in grid_points(grid)}
    for (left, right), (top, bottom) in (
        (columns, rows) for rows in pairwise(grid.v_deg) for columns in pairwise(grid.h_deg)
    ):
        corners = [(h, v) for h in (left, right) for v in (bottom, top)]
        shown = [value_at[corner] for corner in corners if corner in value_at]
        if bottom >= lowest and shown:
            yield Cell((left, right), (bottom, top), _minimum(own, grid, min(shown), options))


def segments(points: tuple[TestPoint, ...]) -> Iterator[Segment]:
    """Yield the lines between neighbouring points on each horizontal and vertical line.

    Points that were moved up to a row of others are left out of it.
    """
    placed = [point for point in points if point.name == point_name(point.h_deg, point.v_deg)]
    rows: dict[float, list[TestPoint]] = {}
    columns: dict[float, list[TestPoint]] = {}
    for point in placed:
        rows.setdefault(point.v_deg, []).append(point)
        columns.setdefault(point.h_deg, []).append(point)
    for row in rows.values():
        yield from (Segment(*two) for two in pairwise(sorted(row, key=lambda own: own.h_deg)))
    for column in columns.values():
        yield from (Segment(*two) for two in pairwise(sorted(column, key=lambda own: own.v_deg)))

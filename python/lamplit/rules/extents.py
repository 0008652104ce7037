# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The ranges of directions in which a rule asks for something."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from lamplit.rules.choices import chosen_name, chosen_number
from lamplit.rules.models import Maximum, VisibilityField
from lamplit.rules.rule import Rule, Side


class Box(NamedTuple):
    """A range of H and V, in degrees."""

    left_deg: float
    right_deg: float
    bottom_deg: float
    top_deg: float


def outboard_sign(side: Side) -> float:
    """Return +1 where outboard is towards H > 0, -1 where it is towards H < 0.

    Seen from behind the car, its right-hand side is on the observer's right, towards H > 0.
    """
    return -1.0 if side == "left" else 1.0


def inside(box: Box, h_deg: float, v_deg: float) -> bool:
    """Return whether a direction lies in a range, its borders included."""
    return box.left_deg <= h_deg <= box.right_deg and box.bottom_deg <= v_deg <= box.top_deg


def mirrored(box: Box) -> Box:
    """Return the box with left and right exchanged."""
    return Box(-box.right_deg, -box.left_deg, box.bottom_deg, box.top_deg)


def maximum_boxes(own: Maximum, side: Side) -> tuple[Box, ...]:
    """Return where a maximum holds. Outboard of a lamp of either side is both sides."""
    box = Box(*own.h_deg, *own.v_deg)
    if own.toward == "as-written":
        return (box,)
    if own.toward == "both" or side == "either":
        return (box, mirrored(box))
    return (box,) if outboard_sign(side) > 0.0 else (mirrored(box),)


class VisibilityBoxes(NamedTuple):
    """The field of visibility, and whether it is less than the rule asks, for want of a side."""

    boxes: tuple[Box, ...]
    only_common: bool


def visibility_boxes(own: VisibilityField, rule: Rule) -> VisibilityBoxes:
    """Return the field for the side of the car; without a side, the part common to both."""

    def angle(value: object) -> float:
        return chosen_number(value, rule.options)  # pyright: ignore[reportArgumentType]

    inboard, outboard = angle(own.inboard_deg), angle(own.outboard_deg)
    up, down = angle(own.up_deg), angle(own.down_deg)
    below = inboard if own.inboard_below_deg is None else angle(own.inboard_below_deg)
    only_common = rule.side == "either" and not inboard == outboard == below
    if only_common:
        inboard = outboard = min(inboard, outboard)
        above_h = Box(-inboard, outboard, 0.0, up)
        below_h = Box(-min(below, inboard), min(below, outboard), -down, 0.0)
    else:
        above_h = Box(-inboard, outboard, 0.0, up)
        below_h = Box(-below, outboard, -down, 0.0)
    boxes = tuple(box for box in (above_h, below_h) if box.top_deg > box.bottom_deg)
    if outboard_sign(rule.side) < 0.0:
        boxes = tuple(mirrored(box) for box in boxes)
    return VisibilityBoxes(boxes, only_common)


def ranges_needed(rule: Rule) -> Iterator[Box]:
    """Yield every range that the grid has to cover."""
    entry = rule.entry
    for own in (own for own in entry.distribution if rule.holds(own.when)):
        if chosen_name(own.between, rule.options) != "no":
            grid = rule.rules.file.grids[chosen_name(own.grid, rule.options)]
            yield Box(grid.h_deg[0], grid.h_deg[-1], grid.v_deg[-1], grid.v_deg[0])
    for own in (own for own in entry.maximum if rule.holds(own.when)):
        if not own.optional and own.where == "everywhere":
            yield from maximum_boxes(own, rule.side)
    for own in (own for own in entry.zone if rule.holds(own.when)):
        h, v = zip(*own.polygon_deg, strict=True)
        yield Box(min(h), max(h), min(v), max(v))
    for own in (own for own in entry.field if rule.holds(own.when)):
        yield from visibility_boxes(own, rule).boxes
    for own in (own for own in entry.ratio if rule.holds(own.when)):
        if own.minimum is not None:
            yield Box(*own.h_deg, *own.v_deg)

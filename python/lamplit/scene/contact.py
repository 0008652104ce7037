# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Which bodies touch, overlap, or lie within one another.

Where two bounding boxes meet, points of one surface are held against the other body, and the other
way round. So a contact is never made up, and one smaller than the spacing of the points may be
missed: a `Contact` says how many points were looked at.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lamplit.scene.solids import Body

#: Surfaces closer than 1 µm touch.
TOUCHING_MM = 1e-3

_POINTS = 2000
_MOST_PAIRS = 2000


@dataclass(frozen=True)
class Contact:
    """How two bodies, by their places in the list, stand to each other.

    ``depth_mm``: how deep a point of one surface was found within the other body, about.
    ``points``: how many points of both surfaces were looked at.
    """

    first: int
    second: int
    kind: Literal["touch", "overlap", "first inside second", "second inside first"]
    depth_mm: float
    points: int


def find_contacts(bodies: Sequence[Body]) -> tuple[list[Contact], int]:
    """Return the contacts between ``bodies``, and how many near pairs were not looked at."""
    contacts: list[Contact] = []
    pairs = list(_near_pairs(bodies))
    for first, second in pairs[:_MOST_PAIRS]:
        if (contact := _contact(bodies, first, second)) is not None:
            contacts.append(contact)
    return contacts, max(len(pairs) - _MOST_PAIRS, 0)


def _near_pairs(bodies: Sequence[Body]) -> Iterator[tuple[int, int]]:
    """Yield the pairs whose bounding boxes come within 1 µm."""
    bounds = [body.bounds for body in bodies]
    low = np.array([lower for lower, _ in bounds]).reshape(-1, 3) - TOUCHING_MM
    high = np.array([upper for _, upper in bounds]).reshape(-1, 3) + TOUCHING_MM
    for first in range(len(bodies)):
        meets = ((low[first] <= high[first + 1 :]) & (low[first + 1 :] <= high[first])).all(axis=1)
        for second in np.flatnonzero(meets) + first + 1:
            yield first, int(second)


def _contact(bodies: Sequence[Body], first: int, second: int) -> Contact | None:
    one, two = bodies[first], bodies[second]
    low = np.maximum(one.bounds[0], two.bounds[0]) - TOUCHING_MM
    high = np.minimum(one.bounds[1], two.bounds[1]) + TOUCHING_MM
    of_one, of_two = _distances(one, two, low, high), _distances(two, one, low, high)
    everything = np.concatenate([of_one, of_two, _round_gaps(one, two)])
    if len(everything) == 0:
        return None
    # A body's sign is beyond doubt where the surface is farther than two surfaces that touch.
    one_in_two = two.solid and bool((of_one < -TOUCHING_MM).any())
    two_in_one = one.solid and bool((of_two < -TOUCHING_MM).any())
    sphere_in = one.solid and two.solid and bool((everything < -TOUCHING_MM).any())
    points = len(of_one) + len(of_two)
    if not (one_in_two or two_in_one or sphere_in):
        touching = bool((np.abs(everything) <= TOUCHING_MM).any())
        return Contact(first, second, "touch", 0.0, points) if touching else None
    kind: Literal["overlap", "first inside second", "second inside first"] = "overlap"
    if one_in_two and not two_in_one and _within(one, two) and (of_one <= TOUCHING_MM).all():
        kind = "first inside second"
    elif two_in_one and not one_in_two and _within(two, one) and (of_two <= TOUCHING_MM).all():
        kind = "second inside first"
    return Contact(first, second, kind, -float(everything.min()), points)


def _within(inner: Body, outer: Body) -> bool:
    """Return whether the box of ``inner`` lies within the box of ``outer``."""
    lower = (inner.bounds[0] >= outer.bounds[0] - TOUCHING_MM).all()
    return bool(lower and (inner.bounds[1] <= outer.bounds[1] + TOUCHING_MM).all())


def _distances(
    surface: Body, body: Body, low: NDArray[np.float64], high: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return how far points of ``surface`` in the common box are from ``body``."""
    points = surface.surface_points(low, high, _POINTS)
    found = body.distances(points) if len(points) else np.empty(0)
    return found if body.solid else np.abs(found)


def _round_gaps(one: Body, two: Body) -> NDArray[np.float64]:
    """Return the gap between a sphere and a sphere or a plane, which points alone may miss."""
    for ball, other in ((one.ball, two), (two.ball, one)):
        if ball is not None and (other.ball is not None or other.plane is not None):
            return other.distances(ball[0][None, :]) - ball[1]
    return np.empty(0)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`RuleSet` and `Rule`: one entry of a rule file, under the options that hold for a lamp."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import RuleError, nearest_name
from lamplit.rules.choices import chosen_name
from lamplit.rules.models import Entry, Reflex, RuleFile
from lamplit.rules.points import TestPoint, grid_points, required_points

Array = NDArray[np.float64]

Side = Literal["left", "right", "either"]


class GridNeed(NamedTuple):
    """What a grid has to cover so that a rule can be judged, and how fine its cells must be."""

    h_deg: tuple[float, float]
    v_deg: tuple[float, float]
    cell_deg: float


class ReflexAngles(NamedTuple):
    """What must be measured of a retro-reflector."""

    entrance_v_deg: float
    entrance_h_deg: float
    observation_deg: float


@dataclass(frozen=True)
class RuleSet:
    """A rule file that was read and found sound."""

    #: "un-r148", or the name of the file.
    name: str
    file: RuleFile

    @property
    def entries(self) -> tuple[str, ...]:
        """Return the names of the entries, as the file orders them."""
        return tuple(self.file.entries)

    def entry(self, name: str) -> Rule:
        """Return the rule ``name``, under the first choice of each option.

        Raises:
            RuleError: There is none; the message names the nearest.
        """
        if name not in self.file.entries:
            near = nearest_name(name, self.entries) or f"; it has {', '.join(self.entries)}"
            raise RuleError(f"{self.name} has no entry {name[:60]!r}{near}")
        first = {key: option.choices[0] for key, option in self.file.options.items()}
        return Rule(self, name, self.file.entries[name], first)


@dataclass(frozen=True)
class Rule:
    """One entry of a rule set, under options such as the number of lighted sections."""

    rules: RuleSet
    name: str
    entry: Entry
    #: The choice of each option.
    options: Mapping[str, str] = field(default_factory=dict[str, str])

    @property
    def id(self) -> str:
        """Return "un-r148/S1"."""
        return f"{self.rules.name}/{self.name}"

    @property
    def title(self) -> str:
        """Return what the rule is for, in words."""
        return self.entry.title

    @property
    def side(self) -> Side:
        """Return the side of the car that the lamp sits on, if it was said."""
        side = self.options.get("side")
        return "left" if side == "left" else "right" if side == "right" else "either"

    def under(self, **options: object) -> Rule:
        """Return this rule under other choices, such as ``sections=2`` or ``side="left"``.

        Raises:
            RuleError: The rule set has no such option or choice; the message names the nearest.
        """
        known = self.rules.file.options
        chosen = dict(self.options)
        for key, value in options.items():
            if key not in known:
                near = nearest_name(key, known) or f"; it has {', '.join(known) or 'none'}"
                raise RuleError(f"{self.rules.name} has no option {key[:60]!r}{near}")
            if str(value) not in known[key].choices:
                raise RuleError(
                    f"{key} = {str(value)[:60]!r} is no choice of {self.rules.name}; "
                    f"it has {', '.join(known[key].choices)}"
                )
            chosen[key] = str(value)
        return replace(self, options=chosen)

    def where_known(self, **options: object) -> Rule:
        """Return this rule under those of ``options`` that its set has and that are not None.

        For what a scene says of a function whatever its rule: ``sections``, ``assembly``, ``side``.

        Raises:
            RuleError: The set has such an option, and no such choice.
        """
        known = self.rules.file.options
        given = {key: value for key, value in options.items() if key in known and value is not None}
        return self.under(**given)

    def holds(self, when: Mapping[str, str]) -> bool:
        """Return whether a requirement with this ``when`` applies under the options chosen."""
        return all(self.options[key] == choice for key, choice in when.items())

    def points(self) -> tuple[TestPoint, ...]:
        """Return the test points that have a minimum, with what is required of them.

        Raises:
            RuleError: The rule gives no value for the options chosen.
        """
        grids = self.rules.file.grids
        groupings = self.rules.file.groupings
        return tuple(
            point
            for own in self.entry.distribution
            if self.holds(own.when)
            for point in required_points(own, grids, groupings, self.options)
        )

    def spots(self, *, disputed: bool = False) -> tuple[Array, Array]:
        """Return H and V, each (p,) in degrees, of the directions that must be measured.

        With ``disputed``, also eight directions round each, on the circle in which a point may be
        met when the result is disputed.

        Raises:
            RuleError: The rule gives no value for the options chosen, or knows no such circle.
        """
        directions = [(point.h_deg, point.v_deg) for point in self.points()]
        for own in self.entry.ratio:
            if own.grid is not None and self.holds(own.when):
                grid = self.rules.file.grids[chosen_name(own.grid, self.options)]
                directions += [(h, v) for h, v, _ in grid_points(grid)]
        if disputed:
            radius = self.tolerance_deg()
            circle = np.arange(8) * (np.pi / 4.0)
            directions += [
                (h + radius * float(np.cos(turn)), v + radius * float(np.sin(turn)))
                for h, v in list(directions)
                for turn in circle
            ]
        unique = list(dict.fromkeys((round(h, 6), round(v, 6)) for h, v in directions))
        both = np.array(unique, dtype=np.float64).reshape(-1, 2)
        return both[:, 0], both[:, 1]

    def tolerance_deg(self) -> float:
        """Return how far from a disputed point it may be met.

        Raises:
            RuleError: The rule set gives no such tolerance.
        """
        tolerance = self.rules.file.tolerance
        if tolerance is None:
            raise RuleError(f"{self.rules.name} gives no tolerance for disputed points")
        return tolerance.deg

    def field(self) -> GridNeed:
        """Return the range that the grid must cover, and the size of its cells.

        The range holds every maximum that is not optional, every zone and field of visibility, and
        the test points with what lies between them.

        Raises:
            RuleError: The rule gives no value for the options chosen.
        """
        from lamplit.rules.extents import ranges_needed

        spans = np.array(list(ranges_needed(self)), dtype=np.float64).reshape(-1, 4)
        if len(spans) == 0:
            return GridNeed((0.0, 0.0), (0.0, 0.0), self.rules.file.cell_deg)
        low, high = spans.min(axis=0), spans.max(axis=0)
        return GridNeed(
            (float(low[0]), float(high[1])),
            (float(low[2]), float(high[3])),
            self.rules.file.cell_deg,
        )

    def reflex(self) -> tuple[Reflex, ...]:
        """Return what is asked of a retro-reflector; empty for a lamp."""
        return tuple(self.entry.reflex)

    def reflex_angles(self) -> tuple[ReflexAngles, ...]:
        """Return the angles at which a retro-reflector must be measured."""
        return tuple(
            ReflexAngles(v, h, own.observation_deg)
            for own in self.entry.reflex
            for v, h in own.entrance_deg
        )

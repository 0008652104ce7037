# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Case`: a rule, what was observed of a lamp, and how the limits are to be read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from lamplit.errors import RuleError
from lamplit.photometry.observed import Observed
from lamplit.rules.models import Production
from lamplit.rules.reading import CellReadings, Reading, cell_readings, spot_readings
from lamplit.rules.rule import Rule


@dataclass(frozen=True, eq=False)
class Case:
    """One function of a lamp before one rule."""

    rule: Rule
    observed: Observed
    #: Other functions of the same lamp, by the name that the rule gives them.
    others: Mapping[str, Observed]
    #: Conformity of production: limits moved by what a lamp from the line may deviate.
    production: Production | None = None
    #: Whether a point may be met within the tolerance.
    disputed: bool = False

    @cached_property
    def cells(self) -> CellReadings:
        """Return the cells of the grid."""
        return cell_readings(self.observed)

    @cached_property
    def spots(self) -> tuple[Reading, ...]:
        """Return the readings at the spots."""
        return spot_readings(self.observed)

    def spots_of(self, observed: Observed) -> tuple[Reading, ...]:
        """Return the readings at the spots of this or another function."""
        return self.spots if observed is self.observed else spot_readings(observed)

    def least(self, minimum: float) -> float:
        """Return a minimum, as it holds for this case."""
        if self.production is None:
            return minimum
        return minimum * (1.0 - self.production.deviation_percent / 100.0)

    def least_in_field(self, minimum: float) -> float:
        """Return the minimum of a visibility field, which production has a table of its own for."""
        if self.production is not None:
            for written, instead in self.production.field_minima:
                if written == minimum:
                    return instead
        return self.least(minimum)

    def most(self, maximum: float) -> float:
        """Return a maximum, as it holds for this case."""
        if self.production is None:
            return maximum
        return maximum * (1.0 + self.production.deviation_percent / 100.0)


def production_of(rule: Rule) -> Production:
    """Return how far production may deviate.

    Raises:
        RuleError: The rule set does not say.
    """
    production = rule.rules.file.production
    if production is None:
        raise RuleError(
            f"{rule.rules.name} says nothing of conformity of production; judge without it"
        )
    return production

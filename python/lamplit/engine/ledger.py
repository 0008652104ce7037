# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Ledger`: where the weight of all walks went, so that none is lost unseen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from lamplit import _core


@dataclass(frozen=True)
class Ledger:
    """Shares of the weight that the walks from the eye start with; together they are 1.

    A walk's weight is what the eye makes of it, its wavelengths weighed by X + Y + Z.
    """

    #: Reached the background.
    escaped: float
    #: Stayed in bodies or on their surfaces, by the body's name.
    absorbed: Mapping[str, float]
    #: Was not followed further because of the depth limit.
    cut_by_depth: float
    #: Was lost at surfaces that do not enclose what they should.
    lost: float
    #: What choices at random took away more than they gave: zero but for noise.
    chance: float
    #: What is missing of 1: nothing but rounding.
    gap: float

    @staticmethod
    def of(outcome: _core.Render) -> Ledger | None:
        """Return the ledger of a render, or None of a method that keeps none."""
        shares = outcome.ledger()
        return None if shares is None else Ledger(**shares)

    def as_json(self) -> dict[str, Any]:
        """Return it as plain JSON values."""
        return asdict(self) | {"absorbed": dict(self.absorbed)}

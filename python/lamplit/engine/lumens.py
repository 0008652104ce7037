# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`LumenLedger`: where the lumens of a light group went."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class LumenLedger:
    """Where the luminous flux of a light group went, in lm, as it was walked.

    ``emitted`` is the sum of all others, and the gap is nothing but rounding. ``emitted`` differs
    from what the scene states by the noise of the walks.
    """

    emitted: float
    #: Left the scene.
    out: float
    #: Stayed in bodies or on their surfaces, by the body's name.
    absorbed: Mapping[str, float]
    #: Was not followed further because of the depth limit.
    cut_by_depth: float
    #: Was lost at surfaces that do not enclose what they should.
    lost: float
    #: What choices at random took away more than they gave: zero but for noise.
    chance: float
    #: What is missing: nothing but rounding.
    gap: float

    def as_json(self) -> dict[str, Any]:
        """Return it as plain JSON values."""
        return asdict(self) | {"absorbed": dict(self.absorbed)}

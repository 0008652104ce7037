# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From a scene to an image: the one room that knows the compiled core."""

from __future__ import annotations

from lamplit.engine.compare import Comparison, compare
from lamplit.engine.features import Features
from lamplit.engine.image import Image
from lamplit.engine.ledger import Ledger
from lamplit.engine.plan import FIRST_ROUND_SAMPLES, Plan, plan
from lamplit.engine.render import RenderInterrupted, render

__all__ = [
    "FIRST_ROUND_SAMPLES",
    "Comparison",
    "Features",
    "Image",
    "Ledger",
    "Plan",
    "RenderInterrupted",
    "compare",
    "plan",
    "render",
]

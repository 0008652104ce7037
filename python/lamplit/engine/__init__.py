# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From a scene to an image: the one room that knows the compiled core."""

from __future__ import annotations

from lamplit.engine.compare import Comparison, compare
from lamplit.engine.image import Image
from lamplit.engine.render import RenderInterrupted, render

__all__ = ["Comparison", "Image", "RenderInterrupted", "compare", "render"]

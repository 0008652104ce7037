# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What a picture of the surround may be: how large, and in which primaries."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from lamplit.errors import SceneError

#: The most pixels of a picture.
MOST_PIXELS: Final = 2**26

#: x, y of red, green, blue and white: Rec. ITU-R BT.709-6.
_REC709 = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)
_SAME = 0.005


def check_size(path: Path, height: int, width: int) -> None:
    """Refuse a picture without pixels, or with more than 2²⁶."""
    if height < 1 or width < 1:
        raise SceneError(f"a picture of {width} × {height} pixels has none", file=path)
    if height * width > MOST_PIXELS:
        raise SceneError(
            f"{width} × {height} pixels are more than {MOST_PIXELS}; make the picture smaller",
            file=path,
        )


def check_primaries(path: Path, primaries: Sequence[float]) -> None:
    """Refuse primaries and a white, eight numbers, other than those of Rec. 709."""
    given = np.array(primaries, dtype=np.float64)
    if given.shape != (8,) or not (np.abs(given - _REC709) <= _SAME).all():
        raise SceneError(
            "the picture's primaries are not those of Rec. 709 (sRGB); convert it to linear sRGB",
            file=path,
        )

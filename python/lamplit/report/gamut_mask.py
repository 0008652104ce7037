# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A picture of what a display cannot show."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from lamplit.colour.picture import Picture

_DIMMED = 0.45
_CYAN = (0.0, 0.85, 0.9)


def gamut_mask_picture(picture: Picture) -> NDArray[np.float64]:
    """Return display values (H, W, 3) in [0, 1]: cyan where the display has no such colour.

    The rest is the picture in dim grey. Cyan is far from every colour of a rear lamp.
    """
    grey = _DIMMED * picture.encoded.mean(axis=-1, keepdims=True)
    return np.where(picture.out_of_gamut[..., None], np.array(_CYAN), grey.repeat(3, axis=-1))

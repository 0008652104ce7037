# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Chromatic adaptation: what XYZ looks the same under another white."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.colour.tristimulus import xyz_of_xy

Adaptation = Literal["cat16", "bradford", "none"]

#: XYZ to sharpened cone responses. CAT16: C. Li et al., Color Res. Appl. 42 (2017) 703.
#: Bradford: ICC.1:2022, annex E.
_CONES = {
    "cat16": np.array(
        [
            [0.401288, 0.650173, -0.051461],
            [-0.250268, 1.204414, 0.045854],
            [-0.002079, 0.048952, 0.953127],
        ]
    ),
    "bradford": np.array(
        [
            [0.8951, 0.2664, -0.1614],
            [-0.7502, 1.7135, 0.0367],
            [0.0389, -0.0685, 1.0296],
        ]
    ),
}


def adaptation_matrix(
    from_white_xy: ArrayLike, to_white_xy: ArrayLike, *, method: Adaptation = "cat16"
) -> NDArray[np.float64]:
    """Return the 3×3 matrix that takes XYZ under one white to XYZ under another of the same Y.

    Full von Kries adaptation of the cone responses of ``method``; ``none`` is the identity.
    """
    if method == "none":
        return np.eye(3)
    cones = _CONES[method]
    gain = (cones @ xyz_of_xy(to_white_xy)) / (cones @ xyz_of_xy(from_white_xy))
    return np.linalg.inv(cones) @ (gain[:, None] * cones)

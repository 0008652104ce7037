# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Chromaticities from X, Y, Z, with their uncertainty."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class Chromaticities(NamedTuple):
    """The chromaticities of p directions."""

    #: (p, 2), NaN where no light came.
    xy: Array
    #: (p, 2, 2), the covariance of x and y. NaN where `is_known` is false.
    covariance: Array
    #: (p,), whether the light is known well enough for the covariance to mean something.
    is_known: NDArray[np.bool_]

    @property
    def standard_error(self) -> Array:
        """The standard errors of x and y, (p, 2); NaN where they are not known."""
        return np.sqrt(np.maximum(np.diagonal(self.covariance, axis1=-2, axis2=-1), 0.0))


def chromaticity_covariance(xyz: ArrayLike, covariance: ArrayLike) -> tuple[Array, Array]:
    """Return x, y (…, 2) and their covariance (…, 2, 2) from X, Y, Z (…, 3) and theirs.

    To first order (delta method): Σ_xy = J Σ_XYZ Jᵀ with J = (∂(x, y)/∂(X, Y, Z)), where
    ∂x/∂X = (1 − x)/S, ∂x/∂Y = ∂x/∂Z = −x/S, ∂y/∂Y = (1 − y)/S, ∂y/∂X = ∂y/∂Z = −y/S and
    S = X + Y + Z. NaN where S is not above zero: black has no chromaticity.
    """
    values, spread = np.asarray(xyz, np.float64), np.asarray(covariance, np.float64)
    total = values.sum(axis=-1)
    lit = total > 0.0
    safe = np.where(lit, total, 1.0)
    xy = np.where(lit[..., None], values[..., :2] / safe[..., None], np.nan)
    jacobian = (np.eye(3)[:2] - xy[..., :, None]) / safe[..., None, None]
    return xy, jacobian @ spread @ np.swapaxes(jacobian, -1, -2)

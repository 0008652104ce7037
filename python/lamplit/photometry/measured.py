# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From intensities measured over H and V to a `Photometry`, and from type to type."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from lamplit.photometry.angles import directions, file_horizontal_deg
from lamplit.photometry.distribution import Photometry


def from_hv(h_deg: ArrayLike, v_deg: ArrayLike, candela: ArrayLike) -> Photometry:
    """Return the type A distribution of intensities ``candela`` (v, h) in cd at H and V.

    ``h_deg`` (h,) and ``v_deg`` (v,) rise and are Lamplit's: H > 0 to the right of an observer
    before the lamp. The result has the H of IES files, which is the negative.

    Raises:
        ValueError: The shapes do not fit, or the angles do not rise.
    """
    h, v = np.asarray(h_deg, dtype=np.float64), np.asarray(v_deg, dtype=np.float64)
    table = np.asarray(candela, dtype=np.float64)
    if table.shape != (v.size, h.size) or h.size < 2 or v.size < 2:
        raise ValueError(f"{table.shape} intensities do not fit {v.size} V and {h.size} H")
    if (np.diff(h) <= 0.0).any() or (np.diff(v) <= 0.0).any():
        raise ValueError("H and V must rise")
    return Photometry("A", file_horizontal_deg(h[::-1]), v.copy(), table.T[::-1].copy(), None)


def resampled_c(
    photometry: Photometry, *, plane_step_deg: float = 5.0, gamma_step_deg: float = 1.0
) -> Photometry:
    """Return ``photometry`` on C-planes 0 to 360 and γ from 0 to 180, by interpolation.

    The axis is γ = 0, up is C = 0, and C = 90 is the right of an observer before the lamp. Each
    value is the bilinear interpolation of the given table at that direction. **Beyond the given
    angles it is 0**, and between a last direction inside and a first one outside readers of the
    result see a slope as wide as the steps. γ ends at 90 where nothing shines behind.

    Raises:
        ValueError: A step is no whole part of 90°.
    """
    for step in (plane_step_deg, gamma_step_deg):
        if not 0.0 < step <= 90.0 or abs(90.0 / step - round(90.0 / step)) > 1e-9:
            raise ValueError(f"a step of {step:g}° is no whole part of 90°")
    planes = np.linspace(0.0, 360.0, round(360.0 / plane_step_deg) + 1)
    gamma = np.linspace(0.0, 180.0, round(180.0 / gamma_step_deg) + 1)
    table = photometry.intensity_cd(directions("C", planes[:, None], gamma[None, :]))
    table[-1] = table[0]
    if not table[:, gamma > 90.0].any():
        gamma, table = gamma[gamma <= 90.0], table[:, gamma <= 90.0]
    return Photometry("C", planes, gamma, table, photometry.lamp_flux_lm)

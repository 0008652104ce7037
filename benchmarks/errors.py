# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How far a picture is from the converged one: in luminance, and in colour as the eye sees it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from lamplit.colour.difference import delta_e_2000

Array = NDArray[np.float64]

#: Share of the mean luminance that keeps dark pixels from counting without bound.
DARK_SHARE = 0.01


def dark_scale(reference: Array) -> Array:
    """Return what luminance differences are relative to, (H, W), of a picture (H, W, 3)."""
    luminance = reference[..., 1]
    return luminance + DARK_SHARE * luminance.mean()


def relative_mse(xyz: Array, reference: Array) -> float:
    """Return the mean over pixels of ((Y − Y₀) / (Y₀ + 1 % of the mean Y₀))² for (H, W, 3)."""
    difference = (xyz - reference)[..., 1]
    return float(((difference / dark_scale(reference)) ** 2).mean())


def mean_delta_e(xyz: Array, reference: Array, white_xyz: Array) -> float:
    """Return the mean CIEDE2000 over pixels under ``white_xyz`` (3,) in cd/m²."""
    return float(delta_e_2000(xyz, reference, white_xyz=white_xyz).mean())


def time_to_reach(times_s: list[float], errors: list[float], wanted: float) -> float:
    """Return the time at which a falling ladder of errors reaches ``wanted``, in log–log.

    Between its rungs by straight lines; beyond its ends by noise's own law, error ∝ 1/√time,
    which both relative standard deviation and small colour differences follow.
    """
    order = np.argsort(times_s)
    time: Array = np.log(np.asarray(times_s))[order]
    error: Array = np.log(np.asarray(errors))[order]
    falling = np.array([float(error[: at + 1].min()) for at in range(error.size)])
    goal = math.log(wanted)
    if goal >= falling[0]:
        return float(np.exp(time[0] - 2.0 * (goal - falling[0])))
    if goal <= falling[-1]:
        return float(np.exp(time[-1] + 2.0 * (falling[-1] - goal)))
    crossing: Array = np.interp([-goal], -falling, time)
    return math.exp(crossing[0])

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Colour difference: CIELAB and CIEDE2000."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

_EPSILON = (6.0 / 29.0) ** 3
_SLOPE = (29.0 / 6.0) ** 2 / 3.0


def xyz_to_lab(xyz: ArrayLike, *, white_xyz: ArrayLike) -> NDArray[np.float64]:
    """Return CIELAB L*, a*, b* (…, 3) of XYZ (…, 3) under ``white_xyz`` (3,), in the same unit.

    Source: ISO/CIE 11664-4:2019. The linear part goes on below zero, so that a colour outside a
    display's gamut has a place too.
    """
    ratio = np.asarray(xyz, dtype=np.float64) / np.asarray(white_xyz, dtype=np.float64)
    f = np.where(ratio > _EPSILON, np.cbrt(ratio), _SLOPE * ratio + 4.0 / 29.0)
    x, y, z = f[..., 0], f[..., 1], f[..., 2]
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=-1)


def delta_e_2000(
    xyz_1: ArrayLike, xyz_2: ArrayLike, *, white_xyz: ArrayLike
) -> NDArray[np.float64]:
    """Return CIEDE2000 (…) between XYZ (…, 3) and XYZ (…, 3) under ``white_xyz`` (3,)."""
    return delta_e_2000_lab(
        xyz_to_lab(xyz_1, white_xyz=white_xyz), xyz_to_lab(xyz_2, white_xyz=white_xyz)
    )


def delta_e_2000_lab(lab_1: ArrayLike, lab_2: ArrayLike) -> NDArray[np.float64]:
    """Return CIEDE2000 (…) between two arrays of CIELAB (…, 3), with k_L = k_C = k_H = 1.

    Source: G. Sharma, W. Wu, E. Dalal, "The CIEDE2000 color-difference formula: implementation
    notes, supplementary test data, and mathematical observations", Color Res. Appl. 30 (2005) 21,
    eqs. (2) to (22); ISO/CIE 11664-6:2022.
    """
    first, second = np.asarray(lab_1, dtype=np.float64), np.asarray(lab_2, dtype=np.float64)
    stretch = _a_stretch(first, second)
    chroma_1, hue_1 = _polar(first, stretch)
    chroma_2, hue_2 = _polar(second, stretch)
    grey = chroma_1 * chroma_2 == 0.0

    turn = hue_2 - hue_1
    turn = np.where(
        grey, 0.0, np.where(turn > 180, turn - 360, np.where(turn < -180, turn + 360, turn))
    )
    hue_sum = hue_1 + hue_2
    around = np.where(hue_sum < 360.0, hue_sum + 360.0, hue_sum - 360.0)
    wrapped = np.abs(hue_1 - hue_2) > 180.0
    hue = np.where(grey, hue_sum, np.where(wrapped, around, hue_sum) / 2.0)
    lightness = (first[..., 0] + second[..., 0]) / 2.0
    chroma = (chroma_1 + chroma_2) / 2.0

    away = (lightness - 50.0) ** 2
    lightness_part = (second[..., 0] - first[..., 0]) / (1.0 + 0.015 * away / np.sqrt(20.0 + away))
    chroma_part = (chroma_2 - chroma_1) / (1.0 + 0.045 * chroma)
    hue_difference = 2.0 * np.sqrt(chroma_1 * chroma_2) * np.sin(np.radians(turn) / 2.0)
    hue_part = hue_difference / (1.0 + 0.015 * chroma * _hue_weight(hue))
    return np.sqrt(
        lightness_part**2
        + chroma_part**2
        + hue_part**2
        + _rotation(chroma, hue) * chroma_part * hue_part
    )


def _a_stretch(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return 1 + G, eq. (4): a* counts for more near the neutral axis."""
    mean = (np.hypot(first[..., 1], first[..., 2]) + np.hypot(second[..., 1], second[..., 2])) / 2.0
    return 1.5 - 0.5 * _saturation(mean)


def _saturation(chroma: NDArray[np.float64]) -> NDArray[np.float64]:
    seventh = chroma**7
    return np.sqrt(seventh / (seventh + 25.0**7))


def _polar(
    lab: NDArray[np.float64], stretch: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return chroma C′ and hue h′ in degrees from 0 to 360, eqs. (6) and (7)."""
    a, b = stretch * lab[..., 1], lab[..., 2]
    return np.hypot(a, b), np.degrees(np.arctan2(b, a)) % 360.0


def _hue_weight(hue: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return T, eq. (15)."""
    return (
        1.0
        - 0.17 * np.cos(np.radians(hue - 30.0))
        + 0.24 * np.cos(np.radians(2.0 * hue))
        + 0.32 * np.cos(np.radians(3.0 * hue + 6.0))
        - 0.20 * np.cos(np.radians(4.0 * hue - 63.0))
    )


def _rotation(chroma: NDArray[np.float64], hue: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return R_T, eqs. (16), (17) and (21): chroma and hue lean on each other in the blue."""
    angle = 30.0 * np.exp(-(((hue - 275.0) / 25.0) ** 2))
    return -np.sin(np.radians(2.0 * angle)) * 2.0 * _saturation(chroma)

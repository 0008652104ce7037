# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Correlated colour temperature of whites."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.colour.observer import colour_matching_functions

#: The temperatures that are looked at, in K, and how many between them.
_RANGE_K, _STEPS = (1000.0, 100_000.0), 1200

#: Farther from the Planckian locus than this, a colour has no correlated temperature (CIE 015).
FARTHEST_DUV = 0.05

#: c₂ of Planck's law in nm K (CODATA 2018).
_C2_NM_K = 1.438776877e7


class ColourTemperature(NamedTuple):
    """CCT in K, and the distance from the Planckian locus: above it (greenish) positive."""

    kelvin: float
    duv: float


def colour_temperature(chromaticity: ArrayLike) -> ColourTemperature | None:
    """Return the correlated colour temperature of ``chromaticity`` (2,), CIE 1931 2°.

    It is that of the Planckian radiator whose (u, v) of CIE 1960 is nearest. None where that is
    farther than 0.05 away, or beyond 1000 K and 100 000 K: there the CCT says nothing.
    Source: CIE 015:2018, 9.5; sign of Duv by ANSI C78.377. The locus is that of ITS-90's c₂, each
    nm from 360 to 830.
    """
    x, y = np.asarray(chromaticity, dtype=np.float64)
    place = _uv(np.array([x, y, 1.0 - x - y]))
    mireds, locus = _planckian_locus()
    distances = np.hypot(*(locus - place).T)
    at = int(np.argmin(distances))
    if at in (0, len(mireds) - 1) or not np.isfinite(distances[at]):
        return None
    # Between neighbours the locus is straight to 1e-8: drop a perpendicular on both sides.
    feet = [_foot(place, locus[k], locus[k + 1]) for k in (at - 1, at)]
    nearest = int(np.argmin([distance for _, distance in feet]))
    share, distance = feet[nearest]
    if distance > FARTHEST_DUV:
        return None
    start = at - 1 + nearest
    mired = mireds[start] + share * (mireds[start + 1] - mireds[start])
    along = locus[start + 1] - locus[start]
    offset = place - locus[start]
    # Rising mireds go to the red; what lies to the left of that is above the locus.
    sign = np.sign(along[0] * offset[1] - along[1] * offset[0])
    return ColourTemperature(float(1e6 / mired), float(sign * distance))


def _foot(
    place: NDArray[np.float64], start: NDArray[np.float64], end: NDArray[np.float64]
) -> tuple[float, float]:
    """Return how far along a piece the point nearest to ``place`` lies, and how far it is."""
    along = end - start
    share = float(np.clip((place - start) @ along / (along @ along), 0.0, 1.0))
    return share, float(np.hypot(*(start + share * along - place)))


@lru_cache(maxsize=1)
def _planckian_locus() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return rising mireds (n,), and u and v of radiators of those temperatures, (n, 2)."""
    low, high = (1e6 / kelvin for kelvin in _RANGE_K[::-1])
    mireds = np.linspace(low, high, _STEPS)
    nm = np.arange(360.0, 830.5)
    with np.errstate(over="ignore"):
        power = nm**-5.0 / np.expm1(_C2_NM_K / nm * mireds[:, None] * 1e-6)
    xyz = power @ colour_matching_functions("cie-1931-2", nm)
    return mireds, _uv(xyz)


def _uv(xyz: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return u and v of CIE 1960, (…, 2)."""
    x, y, z = np.moveaxis(xyz, -1, 0)
    total = x + 15.0 * y + 3.0 * z
    return np.stack([4.0 * x / total, 6.0 * y / total], axis=-1)

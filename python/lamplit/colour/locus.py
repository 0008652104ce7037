# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The spectral locus, dominant wavelength and excitation purity."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.colour.observer import colour_matching_functions
from lamplit.colour.tristimulus import chromaticity_xy

#: Beyond these wavelengths the chromaticity of a spectral light stands still.
_LOCUS_NM = (390.0, 700.0)

#: Closer to the white than this, a chromaticity has no hue.
_ACHROMATIC = 1e-9


class DominantWavelength(NamedTuple):
    """Dominant wavelength in nm, and excitation purity from 0 (the white) to 1 (the locus).

    Purples have no dominant wavelength: theirs is the complementary one, with a minus sign.
    """

    wavelength_nm: float
    purity: float


def spectral_locus(
    observer: str = "cie-1931-2",
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return wavelengths in nm (n,) each nm from 390 to 700, and their chromaticities (n, 2).

    The straight line from the last point to the first is the purple line.
    """
    nm = np.arange(_LOCUS_NM[0], _LOCUS_NM[1] + 0.5)
    return nm, chromaticity_xy(colour_matching_functions(observer, nm))


def dominant_wavelength(
    chromaticity: ArrayLike,
    *,
    white_xy: ArrayLike = (1.0 / 3.0, 1.0 / 3.0),
    observer: str = "cie-1931-2",
) -> DominantWavelength:
    """Return the dominant wavelength and the excitation purity of ``chromaticity`` (2,).

    The half line from the white through the colour meets the spectral locus at the dominant
    wavelength, found between whole nm by a straight line. LED data sheets use the equal-energy
    white, which is the default.
    Source: CIE 015:2018, 9.4; CIE 127:2007, 7.2.3. NaN and 0 for the white itself.
    """
    white = np.asarray(white_xy, dtype=np.float64)
    offset = np.asarray(chromaticity, dtype=np.float64) - white
    if float(np.hypot(*offset)) < _ACHROMATIC:
        return DominantWavelength(float("nan"), 0.0)
    nm, locus = spectral_locus(observer)
    ahead = _crossing(white, offset, nm, locus)
    if ahead is not None:
        return DominantWavelength(ahead[0], 1.0 / ahead[1])
    behind = _crossing(white, -offset, nm, locus)
    ends = _crossing(white, offset, nm[[-1, 0]], locus[[-1, 0]])
    if behind is None or ends is None:
        raise ValueError(f"the white {white.tolist()} lies outside the spectral locus")
    return DominantWavelength(-behind[0], 1.0 / ends[1])


def _crossing(
    start: NDArray[np.float64],
    direction: NDArray[np.float64],
    nm: NDArray[np.float64],
    corners: NDArray[np.float64],
) -> tuple[float, float] | None:
    """Return where ``start + s·direction``, s > 0, first meets the open polygon, and that s."""
    edge = np.diff(corners, axis=0)
    to_edge = corners[:-1] - start
    denominator = _cross(direction, edge)
    parallel = denominator == 0.0
    safe = np.where(parallel, 1.0, denominator)
    along_ray = _cross(to_edge, edge) / safe
    along_edge = _cross(to_edge, direction) / safe
    hit = ~parallel & (along_ray > 0.0) & (along_edge >= 0.0) & (along_edge <= 1.0)
    if not hit.any():
        return None
    at = int(np.argmin(np.where(hit, along_ray, np.inf)))
    wavelength = nm[at] + along_edge[at] * (nm[at + 1] - nm[at])
    return float(wavelength), float(along_ray[at])


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]

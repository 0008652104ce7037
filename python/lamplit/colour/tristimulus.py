# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Tristimulus values of a spectrum, and what follows from them."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.colour.observer import colour_matching_functions
from lamplit.errors import SpectrumError
from lamplit.spectrum import SpectralDistribution

#: Maximum luminous efficacy of radiation in lm/W (CIE 015:2018).
K_M = 683.0

Normalisation = Literal["absolute", "relative"]


def tristimulus(
    spd: SpectralDistribution,
    *,
    observer: str = "cie-1931-2",
    reflectance: SpectralDistribution | None = None,
    normalisation: Normalisation = "absolute",
    range_nm: tuple[float, float] = (360.0, 830.0),
) -> NDArray[np.float64]:
    """Return XYZ (3,) of ``spd``, seen directly or off ``reflectance``.

    X = k Σ S(λ) R(λ) x̄(λ) Δλ, likewise Y and Z, with Δλ = 1 nm over ``range_nm``, ends included.
    ``absolute``: k = 683 lm/W, so a radiance in W·m⁻²·sr⁻¹·nm⁻¹ gives Y in cd/m². ``relative``:
    k = 100 / Σ S(λ) ȳ(λ) Δλ, so the source itself, or a perfect reflector, has Y = 100.
    Source: CIE 015:2018, eqs. (7.1) and (7.2).

    >>> tristimulus(SpectralDistribution.constant(1.0), normalisation="relative").round(2).tolist()
    [100.01, 100.0, 100.03]

    Raises:
        SpectrumError: A spectrum does not cover ``range_nm`` and does not say how to go on, or
            ``relative`` is asked of a source that gives no light.
    """
    nm, functions = _sampled(observer, range_nm)
    power = spd(nm)
    seen = power if reflectance is None else power * reflectance(nm)
    if normalisation == "absolute":
        return K_M * (seen @ functions)
    white = float(power @ functions[:, 1])
    if white <= 0.0:
        name = spd.label or "the source"
        raise SpectrumError(
            f"{name} gives no light that the eye sees, so nothing is relative to it"
        )
    return 100.0 / white * (seen @ functions)


def luminous_efficacy(spd: SpectralDistribution, *, observer: str = "cie-1931-2") -> float:
    """Return the luminous efficacy of radiation in lm/W, of the power from 360 to 830 nm.

    Raises:
        SpectrumError: ``spd`` does not cover that range, or gives no power in it.
    """
    nm, functions = _sampled(observer, (360.0, 830.0))
    power = spd(nm)
    total = float(power.sum())
    if total <= 0.0:
        raise SpectrumError(f"{spd.label or 'the source'} gives no power from 360 to 830 nm")
    return K_M * float(power @ functions[:, 1]) / total


def chromaticity_xy(xyz: ArrayLike) -> NDArray[np.float64]:
    """Return the chromaticity (…, 2) of XYZ (…, 3); NaN for black, which has none."""
    values = np.asarray(xyz, dtype=np.float64)
    total = values.sum(axis=-1, keepdims=True)
    black = total == 0.0
    return np.where(black, np.nan, values[..., :2] / np.where(black, 1.0, total))


def xyz_of_xy(chromaticity: ArrayLike, luminance: ArrayLike = 1.0) -> NDArray[np.float64]:
    """Return XYZ (…, 3) of a chromaticity (…, 2) with y > 0, at Y = ``luminance``."""
    xy = np.asarray(chromaticity, dtype=np.float64)
    x, y = xy[..., 0], xy[..., 1]
    scale = np.asarray(luminance, dtype=np.float64) / y
    return np.stack([x * scale, y * scale, (1.0 - x - y) * scale], axis=-1)


def _sampled(
    observer: str, range_nm: tuple[float, float]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    low, high = range_nm
    nm = low + np.arange(int(np.floor(high - low)) + 1, dtype=np.float64)
    return nm, colour_matching_functions(observer, nm)

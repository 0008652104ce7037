# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A photographic tone curve: five decades of light on a display, each colour with its own hue.

The curve is drawn after the characteristic curve of film, straight in the logarithm of the exposure
(F. Hurter, V. C. Driffield, "Photochemical Investigations and a New Method of Determination of the
Sensitiveness of Photographic Plates", J. Soc. Chem. Ind. 9, 1890), with middle tones that stay as
they are. The exposure is that of E. Reinhard, M. Stark, P. Shirley, J. Ferwerda, "Photographic Tone
Reproduction for Digital Images", SIGGRAPH 2002, eqs. (1) and (2).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.colour.display import Display
from lamplit.colour.gamut import oklab_to_rgb, rgb_to_oklab

#: Middle grey, as a share of white: up to here the curve leaves light as it is.
MIDDLE_GREY = 0.18
#: So many decades above white, every colour is white.
PALE_DECADES = 5.0
#: Pixels darker than this share of the mean say nothing about exposure; black has no logarithm.
_DARK = 1e-5


def tone_curve(light: ArrayLike, brightest: float) -> NDArray[np.float64]:
    """Return what a display shows, in [0, 1], for ``light`` m relative to white, of any shape.

    With g = 0.18 and u = (m - g)/(1 - g):

        f(m) = m                                below g,
        f(m) = g + (1 - g) ln(1 + s u)/s        up to the ``brightest`` M,
        f(m) = 1                                beyond.

    s > 0 follows from f(M) = 1. So the slope is 1 at g too; further up, equal ratios of light
    become equal steps. Where M ≤ 1, all fits the display, and the curve is f(m) = m.

    >>> tone_curve([0.0, 0.1, 1.0, 10.0, 1e5], brightest=1e5).round(3).tolist()
    [0.0, 0.1, 0.336, 0.474, 1.0]
    """
    m = np.maximum(np.asarray(light, dtype=np.float64), 0.0)
    rate = shoulder_rate(brightest)
    u = np.maximum(m - MIDDLE_GREY, 0.0) / (1.0 - MIDDLE_GREY)
    bent = u if rate == 0.0 else np.log1p(rate * u) / rate
    return np.minimum(np.where(m <= MIDDLE_GREY, m, MIDDLE_GREY + (1.0 - MIDDLE_GREY) * bent), 1.0)


def shoulder_rate(brightest: float) -> float:
    """Return s > 0 with ln(1 + s U) = s for U = (M - g)/(1 - g) > 1, and 0 for M ≤ 1."""
    reach = (brightest - MIDDLE_GREY) / (1.0 - MIDDLE_GREY)
    if reach <= 1.0:
        return 0.0
    # ln(1 + s U) - s rises from 0 at s = 0, has its top at 1 - 1/U, and falls through its root.
    low, high = 1.0 - 1.0 / reach, 1.0
    while math.log1p(high * reach) > high:
        high *= 2.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if math.log1p(middle * reach) > middle else (low, middle)
    return 0.5 * (low + high)


def photographic(linear: ArrayLike, brightest: float, display: Display) -> NDArray[np.float64]:
    """Return linear RGB (…, 3) of ``display``, relative to white, with the tone curve.

    `tone_curve` acts on the largest component m, and the other two go along: chromaticity stays.
    Above white, chroma then gives way by the share (log₁₀ m/5)², up to all of it five decades above
    white, as on film; else a saturated colour, dim on any display, would hide how bright it is. The
    largest component stays f(m), and Oklab's hue is kept exactly: a, b shrink together, and all of
    L, a, b scale with the cube root of light.
    """
    rgb = np.asarray(linear, dtype=np.float64)
    largest = np.maximum(rgb.max(axis=-1, keepdims=True), 0.0)
    shown = tone_curve(largest, brightest)
    toned = rgb * np.divide(shown, largest, out=np.ones_like(shown), where=largest > 0.0)
    bright = largest[..., 0] > 1.0
    decades = np.log10(largest[bright])
    pale = np.minimum(np.square(decades / PALE_DECADES), 1.0)
    lab = rgb_to_oklab(toned[bright], display) * (1.0 - pale)
    lab[:, :1] += pale * np.cbrt(shown[bright])
    paled = oklab_to_rgb(lab, display)
    toned[bright] = paled * (shown[bright] / paled.max(axis=-1, keepdims=True))
    return toned


def key_luminance(luminance: ArrayLike) -> float:
    """Return the geometric mean of the luminances that are not black; 0 where all are."""
    values = np.asarray(luminance, dtype=np.float64).ravel()
    lit = values[values > max(_DARK * float(values.mean()), 0.0)] if values.size else values
    return float(np.exp(np.log(lit).mean())) if lit.size else 0.0

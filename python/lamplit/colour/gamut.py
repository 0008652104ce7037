# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Gamut mapping that keeps the hue: chroma gives way until the display can show the colour."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.colour.adaptation import adaptation_matrix
from lamplit.colour.display import Display

#: Oklab: XYZ under D65 to cone responses, and their cube roots to L, a, b.
#: Source: B. Ottosson, "A perceptual color space for image processing" (2020).
_LMS = np.array(
    [
        [0.8189330101, 0.3618667424, -0.1288597137],
        [0.0329845436, 0.9293118715, 0.0361456387],
        [0.0482003018, 0.2643662691, 0.6338517070],
    ]
)
_LAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
_D65_XY = (0.3127, 0.3290)

#: A component further below 0 than this, with display white at 1, is outside the gamut. A 624 nm
#: LED is 0.00095 outside Rec. 2020, and the mapping moves it by a ΔE00 of 0.3, which nobody sees.
VISIBLE = 1e-3

_BISECTIONS = 24
#: Pixels at a time, so that their arrays stay in the cache: 1 Mpx takes 0.7 s, at 65 536 1.6 s.
_CHUNK = 1 << 14


def oklab_matrix(display: Display) -> NDArray[np.float64]:
    """Return the 3×3 matrix from the display's linear RGB to Oklab's cone responses.

    The display's white is adapted to D65, Oklab's own, and has responses (1, 1, 1) exactly, so
    that greys have no hue on any display.
    """
    to_d65 = adaptation_matrix(display.white_xy, _D65_XY)
    matrix = _LMS @ to_d65 @ display.rgb_to_xyz
    return matrix / matrix.sum(axis=1, keepdims=True)


def rgb_to_oklab(linear: ArrayLike, display: Display) -> NDArray[np.float64]:
    """Return Oklab L, a, b (…, 3) of linear RGB (…, 3); white has L = 1, a = b = 0."""
    rgb = np.asarray(linear, dtype=np.float64)
    return np.cbrt(rgb @ oklab_matrix(display).T) @ _LAB_BALANCED.T


def oklab_to_rgb(lab: ArrayLike, display: Display) -> NDArray[np.float64]:
    """Return linear RGB (…, 3) of Oklab L, a, b (…, 3): what `rgb_to_oklab` came from."""
    lms = (np.asarray(lab, dtype=np.float64) @ _FROM_LAB.T) ** 3
    return lms @ np.linalg.inv(oklab_matrix(display)).T


def outside_gamut(linear: ArrayLike) -> NDArray[np.bool_]:
    """Return where linear RGB (…, 3) has a chromaticity that the display lacks.

    A colour that is merely too bright for the display is not outside: its share is another
    number.
    """
    return np.asarray(linear, dtype=np.float64).min(axis=-1) < -VISIBLE


def map_to_gamut(
    linear: ArrayLike, display: Display
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return linear RGB (…, 3) in [0, 1] of ``display``, and where the colour was outside (…).

    Colours that the display has stay as they are. For all others Oklab's hue and lightness stay
    and chroma is reduced to the largest that the display has; what is lighter than white becomes
    white.
    """
    rgb = np.asarray(linear, dtype=np.float64)
    flat = rgb.reshape(-1, 3)
    mapped = np.minimum(np.maximum(flat, 0.0), 1.0)
    needy = np.flatnonzero((flat.min(axis=1) < 0.0) | (flat.max(axis=1) > 1.0))
    to_lms = oklab_matrix(display)
    from_lms = np.asarray(np.linalg.inv(to_lms), dtype=np.float64)
    for start in range(0, needy.size, _CHUNK):
        pixels = needy[start : start + _CHUNK]
        mapped[pixels] = _less_chroma(flat[pixels], to_lms, from_lms)
    return mapped.reshape(rgb.shape), outside_gamut(rgb)


def _less_chroma(
    rgb: NDArray[np.float64], to_lms: NDArray[np.float64], from_lms: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return ``rgb`` (n, 3) brought inside along its line of constant Oklab lightness and hue.

    On that line the cone responses are cubes of L + t d, with t = 1 the colour itself and t = 0
    the grey; so each of R, G, B is a cubic in t, and the largest t inside is found by bisection.
    """
    lab = np.cbrt(rgb @ to_lms.T) @ _LAB_BALANCED.T
    lightness = np.minimum(np.maximum(lab[:, :1], 0.0), 1.0)
    lab[:, 0] = 0.0
    d = lab @ _FROM_LAB.T
    cubic = [(d**3), 3.0 * lightness * d**2, 3.0 * lightness**2 * d]
    c3, c2, c1 = (np.ascontiguousarray((term @ from_lms.T).T) for term in cubic)
    c0 = lightness[:, 0] ** 3
    inside = np.zeros(len(rgb))
    value = np.empty_like(c1)
    for step in 0.5 ** np.arange(1, _BISECTIONS + 1):
        t = inside + step
        _cubic(t, (c0, c1, c2, c3), value)
        fits = (value.min(axis=0) >= 0.0) & (value.max(axis=0) <= 1.0)
        inside += step * fits
    _cubic(inside, (c0, c1, c2, c3), value)
    return np.minimum(np.maximum(value.T, 0.0), 1.0)


def _cubic(
    t: NDArray[np.float64], coefficients: Sequence[NDArray[np.float64]], value: NDArray[np.float64]
) -> None:
    """Write the three cubics (3, n) at ``t`` (n,) into ``value``."""
    c0, c1, c2, c3 = coefficients
    np.multiply(c3, t, out=value)
    for coefficient in (c2, c1):
        value += coefficient
        value *= t
    value += c0


def _balanced() -> NDArray[np.float64]:
    """Return Oklab's second matrix with rows that add up to exactly 1, 0 and 0."""
    balanced = _LAB.copy()
    balanced[:, 2] -= _LAB.sum(axis=1) - np.array([1.0, 0.0, 0.0])
    return balanced


_LAB_BALANCED = _balanced()
_FROM_LAB = np.asarray(np.linalg.inv(_LAB_BALANCED), dtype=np.float64)

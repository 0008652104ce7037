# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The eye's glare on a picture: every pixel's light spread as the eye spreads it.

After G. Spencer, P. Shirley, K. Zimmerman, D. P. Greenberg, "Physically-Based Glare Effects for
Digital Images", SIGGRAPH 1995, with the point spread of `Eye`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamplit.colour.eye import Eye

Array = NDArray[np.float64]

#: Within so many pixels of the point, scatter is integrated over so many places along a pixel's
#: side; further out it is nearly straight within a pixel (1/θ²: 0.5 % at most).
_NEAR, _PLACES = 6, 24
#: In the point's own pixel the places crowd towards the point, by this power of e: scatter changes
#: within 0.1°, however wide the pixel is.
_CROWDED = 8.0


@dataclass(frozen=True, eq=False)
class Glare:
    """A picture as the eye spreads it."""

    #: X, Y, Z in cd/m², (H, W, 3).
    xyz: Array
    eye: Eye
    #: The share of the picture's luminance that the eye spreads to places beyond its frame.
    left_frame_share: float


def with_glare(xyz: Array, eye: Eye, pitch: float) -> Glare:
    """Return XYZ (H, W, 3) in cd/m², all finite, with the glare of ``eye``.

    ``pitch`` is the tangent of the angle that a pixel in the middle spans. What the picture does
    not show sends no glare into it. All wavelengths spread alike, as the sources have it.

    No light is lost: sums over the pixels stay, but for what falls beyond the frame.
    """
    from scipy import fft

    rows, columns = xyz.shape[:2]
    size = (fft.next_fast_len(2 * rows - 1, real=True), fft.next_fast_len(2 * columns - 1))
    spread = np.zeros(size)
    quadrant = spread_weights(eye, rows, columns, pitch)
    spread[:rows, :columns] = quadrant
    spread[:-rows:-1, :columns] = quadrant[1:]
    spread[:rows, :-columns:-1] = quadrant[:, 1:]
    spread[:-rows:-1, :-columns:-1] = quadrant[1:, 1:]
    transfer = fft.rfft2(spread)
    seen = np.empty_like(xyz)
    for component in range(3):
        spectrum = fft.rfft2(xyz[..., component], size)
        spectrum *= transfer
        seen[..., component] = fft.irfft2(spectrum, size)[:rows, :columns]
    before, after = float(xyz[..., 1].sum()), float(seen[..., 1].sum())
    return Glare(seen, eye, 1.0 - after / before if before > 0.0 else 0.0)


def spread_weights(eye: Eye, rows: int, columns: int, pitch: float) -> Array:
    """Return the shares of a pixel's light that go to itself and to those below and right of it.

    The result is (rows, columns), its first entry the pixel itself. That lies in the middle of a
    picture in perspective, on the plane at distance 1 on which pixels are ``pitch`` wide. There a
    term f_β of the eye's image has a closed integral over a rectangle, the same as that of the
    solid angle it is seen under.
    """
    y, x = (pitch * np.arange(count, dtype=np.float64) for count in (rows, columns))
    scatter = pitch**2 * _scatter_per_area(eye, y, x)
    weights = scatter.copy()
    y, x = (np.append(at - 0.5 * pitch, at[-1] + 0.5 * pitch) for at in (y, x))
    for share, width in eye.image_terms:
        corners = _within(y[:, None], x[None, :], width)
        weights += share * np.diff(np.diff(corners, axis=0), axis=1)
    near = (min(rows, _NEAR), min(columns, _NEAR))
    (y, dy), (x, dx) = _places(near[0], pitch), _places(near[1], pitch)
    fine = (_scatter_per_area(eye, y, x) * dy[:, None] * dx[None, :]).reshape(
        near[0], _PLACES, near[1], _PLACES
    )
    weights[: near[0], : near[1]] += fine.sum(axis=(1, 3)) - scatter[: near[0], : near[1]]
    return weights


def field_deg2(rows: int, columns: int, pitch: float) -> float:
    """Return the solid angle of a picture, in square degrees."""
    quarter = 2.0 * math.pi * float(_within(0.5 * rows * pitch, 0.5 * columns * pitch, 1.0))
    return 4.0 * quarter * (180.0 / math.pi) ** 2


def _within(y: Array | float, x: Array | float, width: float) -> Array:
    """Return ∫∫ β/(2π (x² + y² + β²)^1.5) dx dy from 0 to ``x`` and ``y``."""
    reach = np.sqrt(np.square(x) + np.square(y) + width**2)
    return np.asarray(np.arctan(x * y / (width * reach)) / (2.0 * np.pi), dtype=np.float64)


def _scatter_per_area(eye: Eye, y: Array, x: Array) -> Array:
    """Return the scatter at the places ``y`` by ``x`` of the plane at distance 1, per its area."""
    square = np.square(y)[:, None] + np.square(x)[None, :]
    angles_deg = np.degrees(np.arctan(np.sqrt(square)))
    return eye.scatter_per_sr(angles_deg) / (1.0 + square) ** 1.5


def _places(pixels: int, pitch: float) -> tuple[Array, Array]:
    """Return places along the sides of pixels, from the point's on, and the lengths they stand for.

    Those of the point's own pixel lie on one side of it and stand for both.
    """
    steps = (np.arange(_PLACES, dtype=np.float64) + 0.5) / _PLACES
    even = np.arange(pixels, dtype=np.float64)[:, None] + steps - 0.5
    lengths = np.full_like(even, 1.0 / _PLACES)
    even[0] = 0.5 * np.expm1(_CROWDED * steps) / np.expm1(_CROWDED)
    lengths[0] = np.exp(_CROWDED * steps)
    lengths[0] /= lengths[0].sum()
    return pitch * even.ravel(), pitch * lengths.ravel()

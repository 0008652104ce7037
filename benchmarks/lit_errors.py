# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How far a picture of a lit lamp is from the converged one, where a few dots would be all of it.

The plain relative MSE of such a picture is a lottery: one pixel is nearly the whole sum. So it is
told four ways: of a tone curve, without the worst pixels, by counting dots, and by blocks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from errors import DARK_SHARE, Array, dark_scale

#: Share of the pixels that `trim` leaves out.
WORST_SHARE = 1e-3
#: A dot is a pixel that is so many times too bright or too dark.
DOT_RATIO = 10.0
#: Side of a block, in pixels.
BLOCK = 10


def tone(xyz: Array, reference: Array) -> float:
    """Return the relative MSE of T = Y/(Y + m), m being the reference's mean Y, for (H, W, 3).

    It is the mean of ((T − T₀)/(T₀ + 1 %))²: no pixel, however bright, counts as more than another.
    """
    mean = reference[..., 1].mean()
    shown, wanted = (one[..., 1] / (one[..., 1] + mean) for one in (xyz, reference))
    return float((((shown - wanted) / (wanted + DARK_SHARE)) ** 2).mean())


def trim(xyz: Array, reference: Array) -> float:
    """Return the relative MSE of luminance without the worst 0.1 % of the pixels of (H, W, 3)."""
    relative = (xyz - reference)[..., 1] / dark_scale(reference)
    squares = np.sort((relative**2).ravel())
    return float(squares[: squares.size - round(WORST_SHARE * squares.size)].mean())


def dots(xyz: Array, reference: Array) -> int:
    """Return how many pixels of (H, W, 3) are off by more than ten times, 1 % of the mean aside."""
    ratio = (xyz[..., 1] + dark_scale(reference) - reference[..., 1]) / dark_scale(reference)
    return int(((ratio > DOT_RATIO) | (ratio < 1.0 / DOT_RATIO)).sum())


def halved(xyz: Array) -> Array:
    """Return pictures (..., H, W, 3) as half as many pixels each way see them, box filter."""
    return 0.25 * (
        xyz[..., ::2, ::2, :]
        + xyz[..., 1::2, ::2, :]
        + xyz[..., ::2, 1::2, :]
        + xyz[..., 1::2, 1::2, :]
    )


def blocks(xyz: Array) -> Array:
    """Return the mean luminance of blocks, (..., H/10, W/10), of pictures (..., H, W, 3)."""
    luminance = xyz[..., 1]
    *more, height, width = luminance.shape
    rows, columns = height // BLOCK, width // BLOCK
    cut = luminance[..., : rows * BLOCK, : columns * BLOCK]
    return cut.reshape(*more, rows, BLOCK, columns, BLOCK).mean(axis=(-3, -1))


@dataclass(frozen=True)
class Agreement:
    """How independent pictures agree with the reference, in standard errors of both."""

    #: Mean luminance over the reference's, less 1, its standard error, and their ratio.
    flux: float
    flux_sigma: float
    #: Root mean square and largest z over blocks brighter than the reference's mean.
    rms_z: float
    largest_z: float
    #: What ``rms_z`` would be if all were right: that of Student's t of as many pictures.
    expected_rms_z: float

    @property
    def flux_z(self) -> float:
        """The difference in flux in σ."""
        return self.flux / self.flux_sigma


def agreement(pictures: Array, reference: Array, reference_parts: Array | None) -> Agreement:
    """Return how ``pictures`` (n, H, W, 3) agree with ``reference`` (H, W, 3).

    ``reference_parts`` (k, H, W, 3) are independent pictures of equal weight that tell the
    reference's own σ; None where it is none of its own, as when it is known exactly.
    """
    own = blocks(pictures)
    wanted, wanted_var = blocks(reference), np.zeros_like(blocks(reference))
    flux_var = 0.0
    if reference_parts is not None:
        parts = blocks(reference_parts)
        wanted_var = parts.var(axis=0, ddof=1) / len(parts)
        flux_var = float(parts.mean(axis=(1, 2)).var(ddof=1) / len(parts))
    sigma = np.sqrt(own.var(axis=0, ddof=1) / len(own) + wanted_var)
    bright = wanted > wanted.mean()
    z = ((own.mean(axis=0) - wanted) / sigma)[bright]
    each = own.mean(axis=(1, 2))
    flux_sigma = np.sqrt(each.var(ddof=1) / len(own) + flux_var)
    freedom = len(own) - 1
    expected = np.sqrt(freedom / (freedom - 2)) if freedom > 2 else np.inf
    return Agreement(
        flux=float(each.mean() / wanted.mean() - 1.0),
        flux_sigma=float(flux_sigma / wanted.mean()),
        rms_z=float(np.sqrt((z**2).mean())),
        largest_z=float(np.abs(z).max()),
        expected_rms_z=float(expected),
    )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How far a picture of a lit lamp is from the converged one, where a few dots would be all of it.

The plain relative MSE of such a picture is a lottery: one pixel is nearly the whole sum. So it is
told four ways: through a tone curve, without the worst pixels, by counting dots, and by blocks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from errors import Array, dark_scale

#: The usual ε of relative MSE, which keeps what is dark from counting without bound.
_EPSILON = 0.01
#: Share of the pixels that `trim` leaves out.
WORST_SHARE = 1e-3
#: A dot is a pixel that is so many times too bright or too dark.
DOT_RATIO = 10.0
#: Side of a block, in pixels.
BLOCK = 10


def toned(xyz: Array, mean: float) -> Array:
    """Return T = Y/(Y + m) of pictures (..., H, W, 3), for a ``mean`` m in cd/m²."""
    return xyz[..., 1] / (xyz[..., 1] + mean)


def tone(xyz: Array, reference: Array) -> float:
    """Return the relative MSE of T, m being the reference's mean Y, of pictures (H, W, 3).

    It is the mean of (T − T₀)²/(T₀² + ε): no pixel, however bright, is most of the sum.
    """
    mean = float(reference[..., 1].mean())
    wanted = toned(reference, mean)
    return float(((toned(xyz, mean) - wanted) ** 2 / (wanted**2 + _EPSILON)).mean())


def tone_variance(pictures: Array) -> float:
    """Return the mean over pixels of the relative variance of T of independent ``pictures``."""
    mean = pictures.mean(axis=0)
    tones = toned(pictures, float(mean[..., 1].mean()))
    return float(
        (tones.var(axis=0, ddof=1) / (toned(mean, mean[..., 1].mean()) ** 2 + _EPSILON)).mean()
    )


def trim(xyz: Array, reference: Array) -> float:
    """Return the relative MSE of luminance without the worst 0.1 % of the pixels of (H, W, 3).

    With y = Y/m, m being the reference's mean Y, it is the mean of (y − y₀)²/(y₀² + ε) over the
    rest.
    """
    shown, wanted = (one[..., 1] / reference[..., 1].mean() for one in (xyz, reference))
    squares = np.sort(((shown - wanted) ** 2 / (wanted**2 + _EPSILON)).ravel())
    return float(squares[: squares.size - round(WORST_SHARE * squares.size)].mean())


def dots(xyz: Array, reference: Array) -> int:
    """Return how many pixels are off by more than ten times, but for 1 % of the mean Y."""
    ratio = (xyz - reference)[..., 1] / dark_scale(reference) + 1.0
    return int(((ratio > DOT_RATIO) | (ratio < 1.0 / DOT_RATIO)).sum())


def halved(xyz: Array) -> Array:
    """Return pictures (..., H, W, 3) as half as many pixels each way see them: means of four."""
    rows = xyz[..., ::2, :, :] + xyz[..., 1::2, :, :]
    return 0.25 * (rows[..., ::2, :] + rows[..., 1::2, :])


def blocks(xyz: Array) -> Array:
    """Return the mean luminance (..., H/10, W/10) of the blocks of pictures (..., H, W, 3)."""
    luminance = xyz[..., 1]
    *more, height, width = luminance.shape
    rows, columns = height // BLOCK, width // BLOCK
    cut = luminance[..., : rows * BLOCK, : columns * BLOCK]
    return cut.reshape(*more, rows, BLOCK, columns, BLOCK).mean(axis=(-3, -1))


@dataclass(frozen=True, eq=False)
class Estimate:
    """Blocks (h, w) and mean luminance with their variances, and of how many pictures at least."""

    blocks: Array
    blocks_variance: Array
    flux: float
    flux_variance: float
    pictures: int

    @classmethod
    def of(cls, pictures: Array) -> Estimate:
        """Return the estimate by independent ``pictures`` (n, H, W, 3) of equal weight."""
        own = blocks(pictures)
        flux = pictures[..., 1].mean(axis=(1, 2))
        count = len(pictures)
        return cls(
            own.mean(axis=0),
            own.var(axis=0, ddof=1) / count,
            float(flux.mean()),
            float(flux.var(ddof=1) / count),
            count,
        )

    @classmethod
    def weighted(cls, parts: list[tuple[float, Estimate]]) -> Estimate:
        """Return the mean of independent estimates with weights whose sum is 1."""
        return cls(
            sum((w * one.blocks for w, one in parts), np.zeros(())),
            sum((w**2 * one.blocks_variance for w, one in parts), np.zeros(())),
            sum(w * one.flux for w, one in parts),
            sum(w**2 * one.flux_variance for w, one in parts),
            min(one.pictures for _, one in parts),
        )

    def against(self, other: Estimate) -> dict[str, float]:
        """Return how this agrees with an independent one, in standard errors of both.

        ``flux`` is the relative difference in mean luminance, ``flux_sigma`` its σ, ``rms_z`` and
        ``largest_z`` are over blocks brighter than the mean, ``expected_rms_z`` is what right
        pictures would have, by Student's t of so few of them (no more than four: infinite).
        """
        bright = other.blocks > other.blocks.mean()
        sigma = np.sqrt(self.blocks_variance + other.blocks_variance)[bright]
        z = (self.blocks - other.blocks)[bright] / np.maximum(sigma, np.finfo(float).tiny)
        flux_sigma = (self.flux_variance + other.flux_variance) ** 0.5
        freedom = min(self.pictures, other.pictures) - 1
        return {
            "flux": self.flux / other.flux - 1.0,
            "flux_sigma": flux_sigma / other.flux,
            "flux_z": (self.flux - other.flux) / flux_sigma,
            "rms_z": float(np.sqrt((z**2).mean())),
            "largest_z": float(np.abs(z).max()),
            "expected_rms_z": (freedom / (freedom - 2)) ** 0.5 if freedom > 2 else float("inf"),
        }

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Spreading`: over which pixels of a receiver's picture its looks are spread."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Map = NDArray[np.float32]

#: σ of the blurs of what was met, in shares of the picture's longer side.
_BLURS = (0.04, 0.012, 0.003)
#: This share of the looks is spread in all ways alike: what nobody has met yet can be anywhere.
_PRIOR = 0.4
_STEPS = 30


class Met(NamedTuple):
    """What looks met, pixel by pixel: how many looks, and by light group Σ Y and Σ Y²."""

    #: (rows, columns), then (g, rows, columns) twice.
    looks: Map
    first: Map
    second: Map

    @staticmethod
    def nothing(groups: int, shape: tuple[int, ...]) -> Met:
        """Return that of no looks."""
        empty = np.zeros((groups, *shape), np.float32)
        return Met(np.zeros(shape, np.float32), empty, empty)

    def with_looks(self, counts: NDArray[np.uint32], mean: Array, error: Array) -> Met:
        """Add looks with their mean Y (g, rows, columns) and its standard error."""
        n = counts.astype(np.float64)
        spread = np.where(counts > 1, error, 0.0) ** 2 * n * (n - 1.0)
        squares = self.second + spread + n * mean**2
        sums = (self.looks + n, self.first + n * mean, squares)
        return Met(*(own.astype(np.float32) for own in sums))

    def __add__(self, other: object) -> Met:
        """Return both together."""
        if not isinstance(other, Met):
            return NotImplemented
        return Met(*(one + own for one, own in zip(self, other, strict=True)))


@dataclass(frozen=True, eq=False)
class Spreading:
    """A mixture of ways to spread looks: evenly, and after the noise that was met.

    Noise is blurred as well, widely where little is known: glints that nobody has met yet lie
    beside those that were. How much of each way is right, the last round tells: looks spread as
    the rounds before it taught met noise that these had not seen.
    """

    met: Met
    #: (s, rows, columns), each a sum of one; the first is even.
    ways: Array
    #: (s,), a sum of one.
    mixture: Array

    @staticmethod
    def even(groups: int, shape: tuple[int, int]) -> Spreading:
        """Return that of nothing known."""
        ways = np.full((1, *shape), 1.0 / (shape[0] * shape[1]))
        return Spreading(Met.nothing(groups, shape), ways, np.ones(1))

    @property
    def density(self) -> Array:
        """Return the share of each pixel in all looks, (rows, columns)."""
        return np.einsum("s,src->rc", self.mixture, self.ways)

    def taught_by(self, more: Met, areas_m2: Array, cd: Array, share: Array) -> Spreading:
        """Return what is known after another round.

        ``cd`` (g,) are the groups' intensities by which noise counts; ``share`` the looks that each
        pixel had in a repetition.
        """
        met = self.met + more
        power, spread = _noise(met, cd)
        if not power.any():
            return Spreading(met, self.ways, self.mixture)
        size, even = max(areas_m2.shape), self.ways[0]
        count = met.looks.astype(np.float64)
        maps = [_root(power, count, blur * size) for blur in _BLURS]
        # Where a pixel has several looks, only what differs within it is noise.
        maps.append(_root(spread, count, _BLURS[-1] * size))
        weighted = [areas_m2 * own for own in maps]
        ways = [own / own.sum() if own.any() else even for own in weighted]
        mixture = np.full(1 + len(ways), 1.0 / (1 + len(ways)))
        if len(self.ways) == len(mixture):
            own_power, own_spread = _noise(more, cd)
            noise = np.where(share < 1.0, own_power, own_spread) * areas_m2**2
            mixture = self._fitted(noise) if noise.any() else self.mixture
        return Spreading(met, np.stack([even, *ways]), mixture)

    def _fitted(self, noise: Array) -> Array:
        """Return the mixture of the ways so far that would have been best for new ``noise``.

        ``noise`` are the pixels' sums of squares over looks spread by `density`. Another density
        q would have had the variance Σ noise/(density · q); each step raises the ways that lower
        it most, and keeps the sum.
        """
        at = np.flatnonzero(noise)
        ways = self.ways.reshape(len(self.ways), -1)[:, at]
        weight = noise.ravel()[at] / self.density.ravel()[at]
        mixture = self.mixture
        for _ in range(_STEPS):
            gain = ways @ (weight / (mixture @ ways) ** 2)
            mixture = mixture * np.sqrt(gain)
            mixture = mixture / mixture.sum()
        usual = np.full(len(mixture), _PRIOR / len(mixture))
        return (1.0 - _PRIOR) * mixture + usual


def _noise(met: Met, cd: Array) -> tuple[Array, Array]:
    """Return each pixel's sum of squares, and of squares off its mean, relative to ``cd``."""
    power, spread = np.zeros(met.looks.shape), np.zeros(met.looks.shape)
    count = np.maximum(met.looks.astype(np.float64), 1.0)
    for first, second, own in zip(met.first, met.second, cd.tolist(), strict=True):
        if own > 0.0:
            power += second / own**2
            spread += np.maximum(second - first.astype(np.float64) ** 2 / count, 0.0) / own**2
    return power, spread


def _root(sums: Array, count: Array, sigma: float) -> Array:
    """Return the root of the mean over a neighbourhood."""
    from scipy.ndimage import gaussian_filter

    looks = np.maximum(gaussian_filter(count, sigma), 1e-9)
    return np.sqrt(np.maximum(gaussian_filter(sums, sigma), 0.0) / looks)

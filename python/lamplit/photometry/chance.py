# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What independent batches of random walks say of a light, also when few walks met it.

The mean over b batches has the covariance s²/b of their spread. Of n hits of one weight w that is
n w with a variance of n w²: variance/mean tells the weight, mean²/variance the number of hits. A
standard error from few hits is itself a guess, and mostly too small: nobody has met the strong ones
yet. So where hits are few σ is let out, until 2 σ reach up to where a Poisson count no longer lets
us see so few: its upper 97.7 % bound, which for a normal distribution *is* 2 σ. That adds one to
two hits to σ, 1.88 where there is none: a tenth of σ at 100 hits, a hundredth at 10 000. They weigh
as much as the light's own, or as hits elsewhere if these are stronger.

Source: N. Gehrels, *Astrophysical Journal* 303 (1986) 336, eq. (9), good to 1 % of the exact bound.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

#: The bound is that of so many standard errors of a normal distribution.
_SIGMAS = 2.0


def upper_hits(hits: ArrayLike) -> Array:
    """Return the upper 97.7 % bound of a Poisson mean of which ``hits`` were counted.

    >>> upper_hits([0.0, 1.0, 100.0]).round(1).tolist()
    [3.8, 5.7, 122.1]
    """
    more = np.asarray(hits, dtype=np.float64) + 1.0
    root = 1.0 - 1.0 / (9.0 * more) + _SIGMAS / (3.0 * np.sqrt(more))
    return np.asarray(more * root**3, dtype=np.float64)


def covariance_of_mean(batches: Array) -> Array:
    """Return the covariance (…, 3, 3) of the mean over the first axis of (b, …, 3)."""
    off = batches - batches.mean(axis=0)
    count = batches.shape[0]
    return np.einsum("b...i,b...j->...ij", off, off) / (count * (count - 1))


def variance_of_mean(batches: Array) -> Array:
    """Return the variance (…) of the mean over the first axis of (b, …)."""
    return np.asarray(batches.var(axis=0, ddof=1) / batches.shape[0], dtype=np.float64)


def let_out(mean: ArrayLike, variance: ArrayLike, hit: ArrayLike) -> Array:
    """Return the variance (…) that is an upper bound when hits are few.

    ``mean`` (…) is of what cannot be below zero, ``variance`` (…) that of the mean, and ``hit`` (…)
    what one hit elsewhere adds to such a mean. A light that does not scatter keeps the variance 0.

    >>> let_out([0.0, 1.0, 100.0], [0.0, 1.0, 100.0], 1.0).round(2).tolist()
    [3.54, 5.47, 121.93]
    """
    value, spread = np.asarray(mean, np.float64), np.asarray(variance, np.float64)
    own = np.divide(spread, value, out=np.zeros_like(value), where=value > 0.0)
    weight = np.maximum(own, hit)
    scatters = ((spread > 0.0) | (value <= 0.0)) & (weight > 0.0)
    hits = np.where(scatters, value, 0.0) / np.where(scatters, weight, 1.0)
    further = (upper_hits(hits) - hits) / _SIGMAS - np.sqrt(hits)
    bound = np.sqrt(spread) + further * weight
    return np.where(scatters, bound**2, spread)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Are two renderers' pictures of one scene the same, as far as their noise lets one see?

Both are rendered several times with independent seeds. Each picture is cut into blocks of pixels,
whose means are near to Gaussian; the spread of a block's mean over the seeds gives its error,
whatever the sampler. Each block's X, Y and Z, and those of the whole picture, are put to Welch's
t-test, and its p-value is told as the equivalent |z|. With m tests in all, one may exceed what
belongs to 1 − (1 − α)^(1/m) (Šidák), so that equal renderers fail with a probability of α together.
"""

from __future__ import annotations

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray
from scipy import stats

Array = NDArray[np.float64]

_NORMAL = NormalDist()

ALPHA = 0.01
#: Share of the value that single precision and tables of 1 nm may differ by; counted as equal.
ROUNDING = 1e-4


@dataclass(frozen=True)
class Comparison:
    """What the tests say, and how sharp they were."""

    #: The largest |z| of all tests and the largest that Šidák allows.
    largest_z: float
    threshold: float
    tests: int
    #: Mean luminance in cd/m² of the picture, theirs and mine, and the error of the difference.
    theirs_cd_m2: float
    mine_cd_m2: float
    sigma_cd_m2: float
    #: A common factor off by this would be seen with a probability of 95 %.
    detectable: float
    #: The same for one block alone: the median over blocks, in luminance.
    detectable_in_block: float
    #: The largest difference of a block's luminance relative to the picture's mean.
    largest_difference: float

    @property
    def agree(self) -> bool:
        """Whether no test rejects."""
        return self.largest_z <= self.threshold


def block_means(xyz: Array, side: int) -> Array:
    """Return the means (blocks, 3) of squares of ``side`` pixels of a picture (H, W, 3)."""
    height, width = xyz.shape[0] // side, xyz.shape[1] // side
    whole = xyz[: height * side, : width * side]
    return whole.reshape(height, side, width, side, 3).mean(axis=(1, 3)).reshape(-1, 3)


def compare(mine: list[Array], theirs: list[Array], *, side: int, allowance: float) -> Comparison:
    """Compare pictures (H, W, 3) of independent seeds.

    ``allowance`` is a relative difference that is counted as none: what the two models are known
    to differ by.
    """
    samples = [_with_whole(pictures, side) for pictures in (mine, theirs)]
    means = [values.mean(axis=0) for values in samples]
    variances = [values.var(axis=0, ddof=1) / len(values) for values in samples]
    freedoms = [len(values) - 1 for values in samples]
    difference = means[0] - means[1]
    slack = (ROUNDING + allowance) * means[1]
    excess = np.maximum(np.abs(difference) - slack, 0.0)
    z = _equivalent_z(excess, variances, freedoms)
    threshold = -_NORMAL.inv_cdf(0.5 * (1.0 - (1.0 - ALPHA) ** (1.0 / z.size)))
    sigma = np.sqrt(variances[0] + variances[1])
    power = threshold + _NORMAL.inv_cdf(0.95)
    luminance, error = means[1][:, 1], sigma[:, 1]
    relative = np.divide(error, luminance, out=np.zeros_like(error), where=luminance > 0)
    return Comparison(
        largest_z=float(z.max()),
        threshold=threshold,
        tests=z.size,
        theirs_cd_m2=float(luminance[-1]),
        mine_cd_m2=float(means[0][-1, 1]),
        sigma_cd_m2=float(error[-1]),
        detectable=power * float(relative[-1]) + ROUNDING + allowance,
        detectable_in_block=power * float(np.median(relative[:-1])) + ROUNDING + allowance,
        largest_difference=float(np.abs(difference[:-1, 1]).max() / luminance[-1]),
    )


def _with_whole(pictures: list[Array], side: int) -> Array:
    """Return (seeds, blocks + 1, 3): the blocks' means, and the whole picture's at last."""
    blocks = np.stack([block_means(xyz, side) for xyz in pictures])
    return np.concatenate([blocks, blocks.mean(axis=1, keepdims=True)], axis=1)


def _equivalent_z(excess: Array, variances: list[Array], freedoms: list[int]) -> Array:
    """Return |z| of the p-values of Welch's test; infinite where unequal values have no spread."""
    total = variances[0] + variances[1]
    parts = variances[0] ** 2 / freedoms[0] + variances[1] ** 2 / freedoms[1]
    still = total <= 0.0
    freedom = np.divide(total**2, parts, out=np.full_like(total, np.inf), where=~still)
    t = np.divide(excess, np.sqrt(total), out=np.zeros_like(total), where=~still)
    z = stats.norm.isf(stats.t.sf(t, np.minimum(freedom, 1e6)))
    return np.where(still, np.where(excess > 0.0, np.inf, 0.0), z)

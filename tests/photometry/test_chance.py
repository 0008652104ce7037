# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Few hits: how often 2 σ hold, and how often a verdict is wrong, over many drawn measurements."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.stats import chi2, norm

from lamplit.photometry.chance import (
    covariance_of_mean,
    let_out,
    upper_hits,
    variance_of_mean,
)
from lamplit.photometry.chromaticity import chromaticity_covariance

BATCHES, LAMPS = 32, 20_000
#: Draws the sums of n hits of mean weight 1, n (…).
Weights = Callable[[np.random.Generator, np.ndarray], np.ndarray]


def alike(_random: np.random.Generator, hits: np.ndarray) -> np.ndarray:
    """All hits weigh the same."""
    return hits.astype(np.float64)


def exponential(random: np.random.Generator, hits: np.ndarray) -> np.ndarray:
    """Weights from nought to many times the mean."""
    return np.where(hits > 0, random.gamma(np.maximum(hits, 1)), 0.0)


def a_tenth_strong(random: np.random.Generator, hits: np.ndarray) -> np.ndarray:
    """A tenth of the hits weighs ten times as much as the others, 10/1.9."""
    strong = random.binomial(hits, 0.1)
    return (hits + 9.0 * strong) / 1.9


#: The size-weighted mean weight Σw²/Σw of each law, by hand.
LAWS: list[tuple[Weights, float]] = [
    (alike, 1.0),
    (exponential, 2.0),
    (a_tenth_strong, (0.9 + 0.1 * 100.0) / 1.9**2),
]


def drawn(expected_hits: float, weights: Weights, seed: int) -> np.ndarray:
    """Return b batches of many measurements of the intensity ``expected_hits``, (b, lamps)."""
    random = np.random.default_rng(seed)
    return weights(random, random.poisson(expected_hits / BATCHES, (BATCHES, LAMPS))) * BATCHES


def test_the_bound_is_that_of_a_poisson_count() -> None:
    """Exactly: half the χ² quantile of 2 (n + 1) degrees of freedom (F. Garwood, 1936)."""
    hits = np.array([0.0, 1.0, 2.0, 5.0, 10.0, 30.0, 100.0, 1000.0])
    exact = 0.5 * chi2.ppf(norm.cdf(2.0), 2.0 * (hits + 1.0))
    np.testing.assert_allclose(upper_hits(hits), exact, rtol=0.01)


@pytest.mark.parametrize(("weights", "hit"), LAWS)
@pytest.mark.parametrize("hits", [0.3, 1.0, 2.0, 3.0, 4.0, 6.0, 9.0, 14.0, 20.0, 30.0, 60.0, 300.0])
def test_2_sigma_hold_the_truth_on_either_side_however_few_hits_there_are(
    hits: float, weights: Weights, hit: float
) -> None:
    batches = drawn(hits, weights, seed=round(10 * hits))
    mean, variance = batches.mean(axis=0), variance_of_mean(batches)
    sigma = np.sqrt(let_out(mean, variance, hit))
    # A normal distribution leaves 2.3 % beyond 2 σ on each side. Where one hit in ten has half of
    # the light, a few per cent of the measurements have met too few of these to tell.
    most = 0.05 if weights is a_tenth_strong else 0.028
    assert np.mean(mean + 2.0 * sigma < hits) <= most, "false fail below a minimum"
    assert np.mean(mean - 2.0 * sigma > hits) <= 0.025, "false pass above a minimum"


@pytest.mark.parametrize("weights", [law for law, _ in LAWS])
def test_the_spread_of_batches_alone_would_not_do(weights: Weights) -> None:
    """The test above can fail: with a few hits σ as it stands fails good lamps far too often."""
    batches = drawn(4.0, weights, seed=5)
    mean, sigma = batches.mean(axis=0), np.sqrt(variance_of_mean(batches))
    assert np.mean(mean + 2.0 * sigma < 4.0) > 0.08


def test_many_hits_leave_sigma_as_it_is() -> None:
    batches = drawn(1e6, alike, seed=6)
    variance = variance_of_mean(batches)
    np.testing.assert_allclose(let_out(batches.mean(axis=0), variance, 1.0), variance, rtol=0.005)
    assert let_out(5.0, 0.0, 0.0) == 0.0


@pytest.mark.parametrize("hits", [10.0, 20.0, 30.0, 40.0, 80.0])
def test_a_colour_that_is_known_is_seldom_told_from_its_true_one(hits: float) -> None:
    """Hits of two colours by halves: how often x is more than 2 σ from the truth, where known."""
    random = np.random.default_rng(round(hits))
    first, second = np.array([0.5, 0.2, 0.01]), np.array([0.4, 0.4, 0.0])
    lamps = 4000
    count = random.poisson(0.5 * hits / BATCHES, (2, BATCHES, lamps, 1))
    batches = (count[0] * first + count[1] * second) * BATCHES
    mean, covariance = batches.mean(axis=0), covariance_of_mean(batches)
    bound = let_out(mean[:, 1], covariance[:, 1, 1], 0.333)
    covariance *= (bound / np.maximum(covariance[:, 1, 1], 1e-12))[:, None, None]
    known = mean[:, 1] > 5.0 * np.sqrt(bound)
    both = first + second
    xy, spread = chromaticity_covariance(mean, covariance)
    off = np.abs(xy[known, 0] - both[0] / both.sum()) > 2.0 * np.sqrt(spread[known, 0, 0])
    assert np.count_nonzero(off) / lamps <= 0.05
    if hits >= 80.0:
        assert known.mean() > 0.9

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`EyeReading`: what walks from the eyes of receivers saw of a lamp's light."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamplit.photometry.chance import covariance_of_mean, let_out, variance_of_mean

Array = NDArray[np.float64]

#: With fewer looks from a spot, on average, where light is seen is not known well enough yet.
_FEWEST_LOOKS = 1 << 14


@dataclass(frozen=True, eq=False)
class EyeReading:
    """Luminous intensities at p spots from the eye, in ``b`` independent repetitions."""

    #: (b, g, p, 3), X, Y, Z of each light group; Y in cd.
    xyz: Array
    #: (p,), looks at the lamp from each spot; 0 where there was no time for any.
    looks: NDArray[np.int64]

    @property
    def is_enough(self) -> bool:
        """Whether the looks are so many that they tell more than walks from the light.

        By their number alone: whoever chose by what was seen would be biased.
        """
        return bool(self.looks.mean() >= _FEWEST_LOOKS)

    @property
    def sees(self) -> Array:
        """1 where anything was seen of a group from a spot, else 0, (g, p)."""
        return np.asarray(self.xyz[..., 1].any(axis=0), dtype=np.float64)

    def observed(self, weights: Array) -> tuple[Array, Array]:
        """Return X, Y, Z (p, 3) of the groups by their ``weights``, and the covariance (p, 3, 3).

        It is let out where looks that met light were few (`lamplit.photometry.chance`): a hit may
        be as strong as those of the spot that has the strongest, look for look.
        """
        xyz = np.einsum("g,bgpi->bpi", weights, self.xyz)
        covariance = covariance_of_mean(xyz)
        looks = np.maximum(self.looks, 1.0)
        for group, weight in enumerate(weights):
            own = self.xyz[:, group]
            mean, spread = own[..., 1].mean(axis=0), variance_of_mean(own[..., 1])
            of_hits = np.divide(spread * looks, mean, out=np.zeros_like(mean), where=mean > 0)
            bound = let_out(mean, spread, of_hits.max(initial=0.0) / looks)
            growth = np.divide(bound - spread, spread, out=np.zeros_like(spread), where=spread > 0)
            covariance += weight**2 * growth[:, None, None] * covariance_of_mean(own)
        return xyz.mean(axis=0), covariance

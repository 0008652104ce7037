# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`EyeSpot`: the looks of one receiver at the lamp, put where its picture is noisy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamplit import _core
from lamplit.engine.receiver_view import ReceiverView
from lamplit.engine.spreading import Met, Spreading

Array = NDArray[np.float64]

#: A round of n looks has the weight n²: the later ones know better where to look.
_WEIGHT_POWER = 2.0

#: Renders a view with so many samples in each pixel and a seed; None where Ctrl-C came.
Look = Callable[[ReceiverView, NDArray[np.uint32], int], "_core.Render | None"]


class _Sums(NamedTuple):
    """All that the rounds so far left; one assignment adds a round."""

    #: (b, g, 3): the sum of the rounds' readings times their weights, and that of the weights.
    xyz: Array
    weight: float
    rounds: int
    #: Looks of all repetitions.
    looks: int
    spreading: Spreading


class EyeSpot:
    """The sums of one receiver's looks, in ``b`` repetitions that share what they learn.

    A round spreads looks over the pixels as all earlier rounds teach. Given those rounds its
    repetitions are independent, and their means are right whatever was learned. The reading of a
    repetition is the mean over its rounds by fixed weights.
    """

    def __init__(
        self, key: tuple[int, int], batches: int, groups: int, shape: tuple[int, int]
    ) -> None:
        """Start without a look.

        ``key`` is what seeds are made of, the measurement's and the receiver's number; ``shape``
        are the rows and columns of its pictures.
        """
        self._key, self._batches = key, batches
        spreading = Spreading.even(groups, shape)
        self._sums = _Sums(np.zeros((batches, groups, 3)), 0.0, 0, 0, spreading)

    @property
    def rounds(self) -> int:
        """How many rounds are done."""
        return self._sums.rounds

    @property
    def looks(self) -> int:
        """How many looks are done, over all repetitions."""
        return self._sums.looks

    @property
    def xyz(self) -> Array:
        """Return X, Y and Z of the intensity in cd, (b, g, 3); zero without a round."""
        return self._sums.xyz / (self._sums.weight or 1.0)

    def round(self, looks: int, views: Sequence[ReceiverView], look: Look) -> bool:
        """Take about so many looks more; return whether Ctrl-C left the round undone.

        ``views`` are the views of the repetitions, or one for all.
        """
        before = self._sums
        share = before.spreading.density * (looks / self._batches)
        rng = np.random.default_rng((*self._key, before.rounds))
        seeds = rng.integers(1 << 62, size=self._batches)
        xyz, met = np.zeros_like(before.xyz), Met.nothing(before.xyz.shape[1], share.shape)
        for batch in range(self._batches):
            view = views[batch % len(views)]
            # One look in several repetitions counts as many times as it was unlikely.
            counts = np.floor(share + rng.random(share.shape)).astype(np.uint32)
            outcome = look(view, counts, int(seeds[batch]))
            if outcome is None:
                return True
            layers, errors = _layers(outcome, before.xyz.shape[1])
            scale = view.areas_m2 / np.minimum(share, 1.0)
            xyz[batch] = np.einsum("rc,grci->gi", scale, layers)
            met = met.with_looks(counts, layers[..., 1], errors[..., 1])
        weight = float(looks) ** _WEIGHT_POWER
        xyz = before.xyz + weight * xyz
        weight += before.weight
        cd = xyz[..., 1].mean(axis=0) / weight
        spreading = before.spreading.taught_by(met, views[0].areas_m2, cd, share)
        done = before.looks + round(float(met.looks.sum()))
        self._sums = _Sums(xyz, weight, before.rounds + 1, done, spreading)
        return False


def _layers(outcome: _core.Render, groups: int) -> tuple[Array, Array]:
    """Return X, Y, Z of the light groups and their standard errors, (g, rows, columns, 3)."""
    if groups == 1:
        return outcome.xyz()[None], outcome.xyz_standard_error()[None]
    return outcome.layers(), outcome.layers_standard_error()

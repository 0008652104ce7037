# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Error against time: one program, one seed, pictures of growing length.

A `Climber` renders on until a given time is used up; it is asked for longer and longer times in
turn with other programs, so that whatever else the machine does slows all of them. Only tracing
counts: loading, building trees and compiling kernels are told apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from comparison_scenes import picture
from errors import Array
from peers.mitsuba_process import Mitsuba

import lamplit as ll
from lamplit.scene.camera import MOST_SAMPLES


@dataclass(frozen=True, eq=False)
class Rung:
    """A picture (H, W, 3) in cd/m², its samples per pixel, and the seconds that it took."""

    xyz: Array
    samples: int
    seconds: float


class Climber(Protocol):
    """One program with one seed."""

    def climb(self, until_s: float) -> Rung:
        """Return a picture that took about ``until_s`` seconds."""
        ...


class LamplitClimber:
    """Lamplit renders every picture anew: its samples are laid out for their number."""

    def __init__(self, scene: ll.Scene, seed: int) -> None:
        self._scene = picture(scene, seed=seed)
        self._seconds_per_sample: float | None = None

    def climb(self, until_s: float) -> Rung:
        """Return a picture of as many samples as the time allows, allotted to pixels by noise."""
        count = 1
        if self._seconds_per_sample is not None:
            count = max(1, min(int(until_s / self._seconds_per_sample), MOST_SAMPLES))
        image = ll.render(self._scene, method="path", samples=count, adaptive=True)
        seconds = float(image.statistics["trace_s"])
        self._seconds_per_sample = seconds / count
        return Rung(image.xyz, count, seconds)


class MitsubaClimber:
    """Mitsuba adds pass after pass with seeds of their own: its samples are independent."""

    #: Samples per pixel of a pass: few while the ladder is low, enough to fill LLVM's kernels.
    _SHORT, _LONG = 4, 16
    _SHORT_UNTIL_S = 1.0

    def __init__(self, peer: Mitsuba, seed: int) -> None:
        self._peer = peer
        self._seed = seed * 100_000
        self._sum: Array | None = None
        self._samples = 0
        self._seconds = 0.0
        #: Mean luminance of each pass, and its samples, for the cross-check.
        self.passes: list[tuple[float, int]] = []

    def climb(self, until_s: float) -> Rung:
        """Return the mean of all passes so far, after as many more as the time allows."""
        while self._sum is None or self._seconds < until_s:
            count = self._SHORT if self._seconds < self._SHORT_UNTIL_S else self._LONG
            self._seed += 1
            done = self._peer.render(count, self._seed)
            self._sum = done.xyz * count + (0.0 if self._sum is None else self._sum)
            self._samples += count
            self._seconds += done.seconds
            self.passes.append((float(done.xyz[..., 1].mean()), count))
        return Rung(self._sum / self._samples, self._samples, self._seconds)

    @staticmethod
    def warm(peer: Mitsuba) -> None:
        """Let ``peer`` compile its kernels for passes of both lengths."""
        for count in (MitsubaClimber._SHORT, MitsubaClimber._LONG):
            peer.render(count, 0)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""One program on one lit lamp: pictures of so many core seconds, loading not counted.

A core second is one of the processor's time, over all threads, so that what else the machine does
counts little. Lamplit is told how long to trace; Mitsuba adds passes of its own seeds.
"""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from comparison_scenes import picture
from errors import Array
from peers.mitsuba_process import Mitsuba

import lamplit as ll
from lamplit.engine.assembly import assemble
from lamplit.engine.carrier import SpectralCarrier

MITSUBA = "Mitsuba"
_CORES = os.cpu_count() or 1


@dataclass(frozen=True, eq=False)
class Shot:
    """A picture (H, W, 3) in cd/m², its samples per pixel, and the core seconds that it took."""

    xyz: Array
    samples: int
    core_s: float


class Runner(Protocol):
    """One program with one scene."""

    def shots(self, core_s: Sequence[float], seed: int) -> list[Shot]:
        """Return pictures of about these core seconds, rising; seeds are independent."""
        ...


class Lamplit:
    """A method of Lamplit; every picture is rendered anew, as users ask for it."""

    def __init__(self, scene: ll.Scene, method: str) -> None:
        self._scene, self._method = scene, method
        carrier = SpectralCarrier(scene.image.wavelength_range_nm, scene.image.observer)
        for _ in range(2):  # the first also reads the meshes
            start = time.process_time()
            assemble(scene, carrier)
            self._loading_s = time.process_time() - start

    def shots(self, core_s: Sequence[float], seed: int) -> list[Shot]:
        """Return one picture for each of the times, all with ``seed``."""
        scene, taken = picture(self._scene, seed=seed), list[Shot]()
        for wanted in core_s:
            start = time.process_time()
            image = ll.render(scene, method=self._method, time_s=wanted / _CORES)
            spent = time.process_time() - start - self._loading_s
            taken.append(Shot(image.xyz, image.samples, spent))
        return taken


class MitsubaVariant:
    """A variant of Mitsuba; a longer picture holds the shorter ones of its seed."""

    #: Samples per pixel of a pass: few while the picture is young.
    _SHORT, _LONG = 4, 16
    _SHORT_UNTIL_S = 2.0

    def __init__(self, peer: Mitsuba) -> None:
        self._peer = peer
        for samples in (self._SHORT, self._LONG):  # compiles its kernels
            peer.render(samples, 0)
        start = peer.render(self._LONG, 1)
        self.samples_per_core_s = self._LONG / start.core_s

    def shots(self, core_s: Sequence[float], seed: int) -> list[Shot]:
        """Return the mean of all passes at each of the times."""
        taken: list[Shot] = []
        total, samples, spent = None, 0, 0.0
        own_seed = seed * 100_000
        for wanted in core_s:
            while total is None or spent < wanted:
                count = self._SHORT if spent < self._SHORT_UNTIL_S else self._LONG
                own_seed += 1
                done = self._peer.render(count, own_seed)
                total = done.xyz * count + (0.0 if total is None else total)
                samples, spent = samples + count, spent + done.core_s
            taken.append(Shot(total / samples, samples, spent))
        return taken

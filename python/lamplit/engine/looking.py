# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Looking`: a lamp's intensities at spots, read by walks from the eye of each receiver."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from lamplit import _core
from lamplit.engine.eye_reading import EyeReading
from lamplit.engine.eye_spot import EyeSpot
from lamplit.engine.receiver_view import (
    WIDEST_LENS_DEG,
    ReceiverView,
    corners_of,
    receiver_view,
)
from lamplit.engine.receivers import Goniometer
from lamplit.errors import SceneError
from lamplit.scene import Scene

Array = NDArray[np.float64]

#: Independent repetitions of every reading: their spread is the standard error.
REPETITIONS = 16
#: Pixels on the longer side of a receiver's picture; fewer where many pictures fill the memory.
_PIXELS, _FEWEST_PIXELS = 256, 48
_MOST_SUMS = 1 << 27
#: Looks of a receiver's first round at most: it knows nothing. Each further one doubles them.
_FIRST_ROUND = 1 << 14
#: Every receiver gets this share of an even part; what is left goes where it is needed most.
_EVEN_SHARE = 0.25
#: Below this share of the brightest reading, less certainty is needed in proportion.
_DIM = 1e-3
#: Both ways on at the first smooth surface, and by chance below this share: docs/transport.md.
_SPLIT_DEPTH, _ROULETTE_BELOW = 1, 0.05


def check_visible(scene: Scene) -> None:
    """Check that an eye can see all light of the lamp in ``scene``.

    Raises:
        SceneError: Rays of a file start in no surface that an eye could see, or an endless plane
            reaches beyond what it sees.
    """
    if scene.ray_files:
        raise SceneError(
            "the rays of a file are followed forward only: no eye sees them, and so there is "
            "nothing to cross-check; leave --cross-check out",
            file=scene.path,
            where="ray_files",
        )
    left_out = {*(scene.measure.leave_out if scene.measure else ())}
    for at, thing in enumerate(scene.objects):
        if thing.kind == "plane" and thing.name not in left_out:
            raise SceneError(
                f"no eye sees the endless plane {thing.name!r} whole, and so there is nothing to "
                "cross-check; name it in measure.leave_out, or leave --cross-check out",
                file=scene.path,
                where=f"objects[{at}]",
            )


def eye_method(scene: Scene) -> _core.PathMethod:
    """Return how walks from the eye of a receiver are spent in ``scene``."""
    return _core.PathMethod(
        max_depth=scene.path_settings.max_depth,
        split_depth=_SPLIT_DEPTH,
        roulette_below=_ROULETTE_BELOW,
    )


class Looking:
    """A reading in the making, in rounds: each spot's looks go where its picture is noisy."""

    def __init__(
        self,
        world: _core.Scene,
        goniometer: Goniometer,
        method: _core.PathMethod,
        *,
        groups: int,
        seed: int,
        threads: int | None = None,
        spots: Sequence[int] | NDArray[np.intp] | None = None,
    ) -> None:
        """Prepare to look from ``spots``, numbers of the goniometer's; None: all.

        Raises:
            LamplitError: There are endless planes alone, or the lamp reaches up to a receiver.
        """
        self._world, self._gonio, self._method = world, goniometer, method
        self._threads = threads or 0
        numbers = range(goniometer.spot_h_deg.size) if spots is None else spots
        self._directions = goniometer.directions()[list(numbers)]
        self._corners = corners_of(world)
        sums = max(1, len(self._directions) * (2 * groups + 1))
        pixels = int(np.clip((_MOST_SUMS / sums) ** 0.5, _FEWEST_PIXELS, _PIXELS))
        self._views = [self._view(direction, pixels) for direction in self._directions]
        self._wide = goniometer.receiver_deg > WIDEST_LENS_DEG
        self._spots = [
            EyeSpot((seed, int(number)), REPETITIONS, groups, view.areas_m2.shape)
            for number, view in zip(numbers, self._views, strict=True)
        ]
        self._seed, self._groups = seed, groups
        #: Looks per second of the last round, looks that progress was told of, and who is told.
        self._rate: float | None = None
        self._told = 0
        self._tell: Callable[[int], object] = lambda _done: None

    @property
    def looks(self) -> int:
        """Looks so far, of all spots."""
        return sum(spot.looks for spot in self._spots)

    def reading(self) -> EyeReading:
        """Return what was seen so far."""
        xyz = np.stack([spot.xyz for spot in self._spots], axis=2)
        return EyeReading(xyz, np.array([spot.looks for spot in self._spots]))

    def needs(self) -> Array:
        """Return how uncertain each spot is, (p,): σ/I, less for what is dim; infinite unlooked.

        Where nothing was seen yet, it falls with the root of the looks.
        """
        reading = self.reading()
        xyz, covariance = reading.observed(np.ones(self._groups))
        mean, sigma = xyz[:, 1], np.sqrt(covariance[:, 1, 1])
        least = _DIM * float(mean.max(initial=0.0))
        unseen: Array = np.sqrt(_FIRST_ROUND / np.maximum(reading.looks, 1.0))
        share = np.divide(sigma, mean + least, out=unseen, where=np.greater(mean, 0.0))
        return np.where(reading.looks > 0, share, np.inf)

    def until(
        self,
        looks: int | None,
        *,
        error: float = 0.0,
        deadline: float | None = None,
        progress: Callable[[int], object] | None = None,
    ) -> bool:
        """Look until all spots together have ``looks``; return whether Ctrl-C ended it.

        It ends before that where all spots that see light are certain to the relative error
        ``error``, or when `time.perf_counter` reaches ``deadline``. ``looks`` of None is no end.
        ``progress`` is told the looks done. What is done is kept, but for the round that was
        interrupted.
        """
        self._tell = progress or (lambda _done: None)
        try:
            while (task := self._next(looks, error, deadline)) is not None:
                at, more = task
                started = time.perf_counter()
                self._told = self.looks
                if self._spots[at].round(more, self._views_of(at), self._look):
                    return True
                self._rate = more / max(time.perf_counter() - started, 1e-9)
        except KeyboardInterrupt:
            return True
        return False

    def _next(
        self, looks: int | None, error: float, deadline: float | None
    ) -> tuple[int, int] | None:
        """Return which spot has its turn, and how many looks it takes; None where all is done."""
        count = len(self._spots)
        left = 1 << 62 if looks is None else looks - self.looks
        if deadline is not None:
            seconds = deadline - time.perf_counter()
            usual = _FIRST_ROUND if seconds > 0.0 else 0.0
            left = min(left, int(usual if self._rate is None else seconds * self._rate))
        if count == 0 or left < REPETITIONS:
            return None
        needs, reading = self.needs(), self.reading()
        done, is_seen = reading.looks, reading.sees.any(axis=0)
        if is_seen.any() and (needs[is_seen | (done == 0)] <= error).all():
            return None
        even = 4 * _FIRST_ROUND if looks is None else _EVEN_SHARE * looks / count
        behind = np.isfinite(needs).all() & (done < 0.9 * even)
        at = int(np.argmax(behind) if behind.any() else np.argmax(needs))
        first = int(np.clip(even, REPETITIONS, _FIRST_ROUND))
        return at, min(max(first, int(done[at])), left)

    def _look(
        self, view: ReceiverView, counts: NDArray[np.uint32], seed: int
    ) -> _core.Render | None:
        """Look at the lamp from ``view``; None where Ctrl-C came."""
        view.take(self._world)
        rows, columns = counts.shape
        before = self._told
        self._told += int(counts.sum())
        outcome = self._world.render(
            columns,
            rows,
            1,
            self._method,
            counts=counts.ravel().tolist(),
            filter="box",
            seed=seed,
            layers=self._groups > 1,
            threads=self._threads,
            progress=lambda done, _total: self._tell(before + done),
        )
        return None if outcome.interrupted else outcome

    def _views_of(self, at: int) -> list[ReceiverView]:
        """Return the views of a spot's next round: of a wide receiver, pinholes by chance."""
        view = self._views[at]
        if not self._wide:
            return [view]
        rng = np.random.default_rng((self._seed, at, self._spots[at].rounds, 1))
        shape = view.areas_m2.shape
        return [self._view(self._directions[at], shape, rng.random(2)) for _ in range(REPETITIONS)]

    def _view(
        self, direction: Array, pixels: int | tuple[int, int], place: Array | None = None
    ) -> ReceiverView:
        return receiver_view(self._gonio, direction, self._corners, pixels, place)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Run`: a measurement in the making, in rounds."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lamplit import _core
from lamplit.engine.looking import Looking
from lamplit.engine.lumens import LumenLedger
from lamplit.engine.measurement import Measurement
from lamplit.engine.receivers import Goniometer

Array = NDArray[np.float64]
#: Called with the paths done and to do, a few times a second. Where an eye reads too, half of each
#: is a path from the light, half a look from the eye.
ProgressCallback = Callable[[int, int], object]

#: Paths where nothing says how many.
USUAL_PATHS = 1 << 20

#: Paths of each batch in the first round of an open run, and at most in all.
FIRST_ROUND = 1 << 11
MOST_IN_BATCH = 2**32 - 1


class MeasureInterrupted(KeyboardInterrupt):
    """Ctrl-C during a measurement; ``measurement`` holds what was done."""

    def __init__(self, measurement: Measurement) -> None:
        super().__init__(f"stopped with {measurement.paths} paths")
        self.measurement = measurement


@dataclass(eq=False)
class Run:
    """One measurement in the making: a photometer, and how far it is to go on."""

    meter: _core.Photometer
    goniometer: Goniometer
    #: What a `Measurement` says of what was measured.
    about: Mapping[str, Any]
    threads: int
    #: What reads the spots by the eye: one look for each path of light.
    looking: Looking | None = None
    started: float = field(default_factory=time.perf_counter)

    def until(
        self,
        paths: int | None,
        error: float | None,
        time_s: float | None,
        enough: Callable[[Measurement], bool] | None,
        progress: ProgressCallback | None,
    ) -> Measurement:
        """Walk until something says that it is enough; see `measure`.

        Raises:
            MeasureInterrupted: Ctrl-C; its ``measurement`` has the paths that were done.
        """
        is_open = error is not None or enough is not None
        most = paths or (MOST_IN_BATCH * _core.BATCHES if is_open or time_s else USUAL_PATHS)
        most = min(math.ceil(most / _core.BATCHES), MOST_IN_BATCH)
        wanted = min(FIRST_ROUND, most) if is_open else most
        while True:
            before = self.meter.paths_per_batch
            share = 1.0 if self.looking is None else 0.5
            left = None if time_s is None else share * (time_s - self._elapsed_s)
            interrupted = self.walk(wanted - before, left, progress, most)
            done = self.meter.paths_per_batch
            if not interrupted:
                # What is left of the time after the last walk is the eye's.
                is_last = time_s is not None and paths is None and (not is_open or done < wanted)
                interrupted = self._look(error, time_s, progress, most, is_open_ended=is_last)
            is_late = time_s is not None and self._elapsed_s >= time_s
            is_over = done >= most or done < wanted or interrupted or is_late
            if is_over and not is_open:
                return self.result(complete=not interrupted, interrupted=interrupted)
            result = self.result(complete=False, interrupted=interrupted)
            reached = _reached(result, error, enough)
            if reached or is_over:
                return replace(result, complete=reached and not interrupted)
            wanted = min(most, self._next(done, result, error))

    @property
    def _elapsed_s(self) -> float:
        return time.perf_counter() - self.started

    def _look(
        self,
        error: float | None,
        time_s: float | None,
        progress: ProgressCallback | None,
        most: int,
        *,
        is_open_ended: bool,
    ) -> bool:
        """Let the eye look once for each path done, or for the time left; return if interrupted."""
        if self.looking is None:
            return False
        done = self.meter.paths_per_batch * _core.BATCHES
        return self.looking.until(
            None if is_open_ended else done,
            error=error or 0.0,
            deadline=None if time_s is None else self.started + time_s,
            progress=lambda looks: self._tell(progress, done, looks, done, most),
        )

    def _tell(
        self, progress: ProgressCallback | None, paths: int, looks: int, total: int, most: int
    ) -> None:
        """Tell how much is done of ``total`` paths, or of the ``most`` of every batch."""
        if progress is not None:
            shown = paths if self.looking is None else (paths + min(looks, paths)) // 2
            progress(shown, total if most == MOST_IN_BATCH else most * _core.BATCHES)

    def _next(self, done: int, result: Measurement, error: float | None) -> int:
        """Return how many paths of each batch are wanted: twice as many, or as the error says."""
        if error is None or not math.isfinite(result.relative_error):
            return 2 * done
        needed = done * (result.relative_error / error) ** 2
        return math.ceil(min(max(1.05 * needed, 1.1 * done), 4.0 * done))

    def walk(
        self, more: int, time_s: float | None, progress: ProgressCallback | None, most: int
    ) -> bool:
        """Walk ``more`` paths of every batch, or until the time is up; return whether interrupted.

        ``most`` is how many paths of each batch the progress is told of.
        """
        before = self.meter.paths_per_batch * _core.BATCHES

        looks = 0 if self.looking is None else self.looking.looks

        def tell(done: int, total: int) -> None:
            self._tell(progress, before + done, looks, before + total, most)

        if time_s is not None and time_s <= 0.0:
            return False
        return self.meter.walk(more, time_budget_s=time_s, threads=self.threads, progress=tell)

    def result(self, *, complete: bool, interrupted: bool = False) -> Measurement:
        """Return what was caught so far.

        Raises:
            MeasureInterrupted: It was interrupted; the measurement is in it.
        """
        meter, gonio = self.meter, self.goniometer
        rows, columns = gonio.cell_sr.shape
        cells = meter.cells()
        batches, groups = cells.shape[:2]
        grid = cells.reshape(batches, groups, rows, columns, 3) / gonio.cell_sr[..., None]
        plane = None
        if gonio.plane is not None:
            shape = (batches, groups, gonio.plane.rows, gonio.plane.columns, 3)
            plane = meter.map().reshape(shape) / gonio.plane.pixel_m2
        spectra = None
        if gonio.cell_bands:
            bands = meter.cell_bands()
            spectra = bands.reshape(groups, rows, columns, -1) / gonio.cell_sr[..., None]
        entries = {name: meter.ledger(at) for at, name in enumerate(self.about["groups"])}
        found = {name: LumenLedger(**own) for name, own in entries.items() if own is not None}
        measurement = Measurement(
            **self.about,
            emitted_xyz=meter.emitted(),
            out_xyz=meter.out()[:, :, 0],
            spot_xyz=meter.spots() / gonio.spot_sr,
            grid_xyz=grid,
            plane_xyz=plane,
            spot_spectra_by_batch=meter.spot_bands() / gonio.spot_sr,
            out_spectra_by_batch=meter.out_bands()[:, :, 0],
            grid_spectra=spectra,
            band_centres_nm=self._centres(gonio.spot_bands),
            grid_band_centres_nm=self._centres(gonio.cell_bands),
            paths=meter.paths_per_batch * _core.BATCHES,
            ledgers=found,
            statistics=meter.statistics(),
            eye=None if self.looking is None else self.looking.reading(),
            elapsed_s=time.perf_counter() - self.started,
            complete=complete,
            interrupted=interrupted,
            version=_core.__version__,
        )
        if interrupted:
            raise MeasureInterrupted(measurement)
        return measurement

    def _centres(self, per_lane: int) -> Array:
        low, high = self.about["scene"].image.wavelength_range_nm
        count = per_lane * _core.LANES
        return low + (high - low) * (np.arange(count) + 0.5) / max(count, 1)


def _reached(
    result: Measurement, error: float | None, enough: Callable[[Measurement], bool] | None
) -> bool:
    is_enough = enough is None or enough(result)
    return is_enough and (error is None or result.relative_error <= error)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`measure`: how many candela, where, and in what colour."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit import _core
from lamplit.engine.assembly import assemble
from lamplit.engine.carrier import SpectralCarrier
from lamplit.engine.light_sources import Laboratory, Light
from lamplit.engine.lumens import LumenLedger
from lamplit.engine.measurement import Measurement
from lamplit.engine.receivers import (
    Goniometer,
    Plane,
    checked_edges,
    checked_spots,
    measure_settings,
)
from lamplit.engine.seen_light import check_range
from lamplit.errors import LamplitError, SceneError
from lamplit.scene import Scene
from lamplit.scene.lighting import BLACK
from lamplit.scene.shining import light_groups

Array = NDArray[np.float64]
#: Called with the paths done and to do, a few times a second.
ProgressCallback = Callable[[int, int], object]

#: Paths where nothing says how many.
USUAL_PATHS = 1 << 20

#: Paths of each batch in the first round of an open run, and at most in all.
_FIRST_ROUND = 1 << 11
_MOST_IN_BATCH = 2**32 - 1

#: Finest bands of a spot, per lane: 5 nm over 380–780 nm. Cells of a grid have one band a lane.
_SPOT_BANDS = 5

#: How light walks are spent: both ways on at the first smooth surface, and by chance below this
#: share. docs/transport.md has what was measured.
_SPLIT_DEPTH, _ROULETTE_BELOW = 1, 0.25


class MeasureInterrupted(KeyboardInterrupt):
    """Ctrl-C during a measurement; ``measurement`` holds what was done."""

    def __init__(self, measurement: Measurement) -> None:
        super().__init__(f"stopped with {measurement.paths} paths")
        self.measurement = measurement


def measure(
    scene: Scene,
    *,
    spots: ArrayLike | None = None,
    grid: tuple[ArrayLike, ArrayLike] | None = None,
    distance_m: float | None = None,
    receiver_deg: float | None = None,
    plane: Plane | None = None,
    light: Light | None = None,
    paths: int | None = None,
    error: float | None = None,
    time_s: float | None = None,
    until: Callable[[Measurement], bool] | None = None,
    spectra: bool = False,
    seed: int | None = None,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> Measurement:
    """Walk light from the lamp's sources and return its luminous intensity over directions.

    ``spots`` (n, 2) are H and V in degrees of round receivers, ``grid`` the borders of cells along
    H and V (None: each degree over ±90°), ``plane`` a rectangle to light. ``distance_m`` and
    ``receiver_deg`` stand in for those of [measure]; an infinite distance is the far field.
    ``light`` is walked instead of what shines in the scene. ``spectra`` keeps the spectrum of each
    cell of the grid.

    ``error`` is the `Measurement.relative_error` to go down to, ``time_s`` the seconds to walk for,
    and ``until`` is asked after every round whether that is enough; with any of them, ``paths`` is
    the most. ``threads`` of None takes one per core: the result does not depend on it.

    Raises:
        LamplitError: The lamp has no axis or no light, the receiver stands in the lamp, or an
            argument cannot be used.
        MeasureInterrupted: Ctrl-C; its ``measurement`` has the paths that were done.
    """
    _check(paths=paths, error=error, time_s=time_s)
    if receiver_deg is not None and not 0.0 < receiver_deg <= 180.0:
        raise LamplitError(
            f"a receiver subtends more than 0° and at most 180°, not {receiver_deg:g}°"
        )
    if distance_m is not None and not distance_m > 0.0:
        raise LamplitError(f"a receiver's distance is above 0 m, not {distance_m:g} m")
    settings = measure_settings(scene)
    dark = in_laboratory(scene)
    carrier = SpectralCarrier(scene.image.wavelength_range_nm, scene.image.observer)
    check_range(dark, carrier)
    world = assemble(dark, carrier)
    h, v = checked_spots(spots)
    h_edges, v_edges = checked_edges(grid)
    distance = settings.distance_m if distance_m is None else distance_m
    cuts = [cut for cut in range(1, _SPOT_BANDS + 1) if carrier.phases % cut == 0]
    goniometer = Goniometer(
        axis=settings.axis,
        up=settings.up,
        centre_mm=settings.centre_mm or _middle(world, scene),
        distance_m=None if distance is None or math.isinf(distance) else distance,
        receiver_deg=settings.receiver_deg if receiver_deg is None else receiver_deg,
        spot_h_deg=h,
        spot_v_deg=v,
        h_edges_deg=h_edges,
        v_edges_deg=v_edges,
        plane=plane,
        spot_bands=max(cuts),
        cell_bands=1 if spectra else 0,
    )
    method = _core.PathMethod(
        max_depth=scene.path_settings.max_depth,
        split_depth=_SPLIT_DEPTH,
        roulette_below=_ROULETTE_BELOW,
    )
    seed = scene.image.seed if seed is None else seed
    laboratory = Laboratory(
        world=world,
        scene=dark,
        carrier=carrier,
        goniometer=goniometer,
        method=method,
        seed=seed,
    )
    try:
        meter = laboratory.photometer(light)
    except ValueError as fault:
        raise _told(str(fault), scene, goniometer, light) from fault
    groups = light_groups(dark) if light is None else (light.group,)
    about = {"goniometer": goniometer, "groups": groups, "scene": scene, "light": light}
    run = _Run(meter, goniometer, about | {"seed": seed, "threads": threads}, threads or 0)
    return run.until(paths, error, time_s, until, progress)


def _check(*, paths: int | None, error: float | None, time_s: float | None) -> None:
    if paths is not None and paths < 1:
        raise LamplitError(f"a measurement takes 1 path or more, not {paths}")
    if error is not None and not 0.0 < error <= 1.0:
        raise LamplitError(
            f"a target error is a share above 0 and at most 1, such as 0.01, not {error:g}"
        )
    if time_s is not None and not (math.isfinite(time_s) and time_s > 0.0):
        raise LamplitError(f"a time budget is a number of seconds above 0, not {time_s:g}")


def in_laboratory(scene: Scene) -> Scene:
    """Return the scene without what belongs to the picture: a dark room, and the lamp alone."""
    left_out = {*(scene.measure.leave_out if scene.measure else ())}
    objects = tuple(thing for thing in scene.objects if thing.name not in left_out)
    if not objects:
        raise SceneError("nothing is left to measure", file=scene.path, where="measure.leave_out")
    tables: dict[str, Any] = {"background": BLACK, "ambient": None, "lights": ()}
    return scene.changed(**tables, **({"objects": objects} if left_out else {}))


def _middle(world: _core.Scene, scene: Scene) -> tuple[float, float, float]:
    bounds = world.bounds_mm
    if bounds is None:
        raise SceneError(
            "only endless planes are left; give the reference centre",
            file=scene.path,
            where="measure.centre_mm",
        )
    x, y, z = (0.5 * np.add(*bounds)).tolist()
    return x, y, z


@dataclass(eq=False)
class _Run:
    """One measurement in the making."""

    meter: _core.Photometer
    goniometer: Goniometer
    #: What a `Measurement` says of what was measured.
    about: Mapping[str, Any]
    threads: int
    started: float = field(default_factory=time.perf_counter)

    def until(
        self,
        paths: int | None,
        error: float | None,
        time_s: float | None,
        enough: Callable[[Measurement], bool] | None,
        progress: ProgressCallback | None,
    ) -> Measurement:
        is_open = error is not None or enough is not None
        most = paths or (_MOST_IN_BATCH * _core.BATCHES if is_open or time_s else USUAL_PATHS)
        most = min(math.ceil(most / _core.BATCHES), _MOST_IN_BATCH)
        wanted = min(_FIRST_ROUND, most) if is_open else most
        while True:
            left = None if time_s is None else time_s - (time.perf_counter() - self.started)
            before = self.meter.paths_per_batch
            interrupted = self._walk(wanted - before, left, progress, most)
            done = self.meter.paths_per_batch
            is_over = done >= most or done < wanted or interrupted
            if is_over and not is_open:
                return self._result(complete=not interrupted, interrupted=interrupted)
            result = self._result(complete=False, interrupted=interrupted)
            reached = _reached(result, error, enough)
            if reached or is_over:
                return replace(result, complete=reached and not interrupted)
            wanted = min(most, self._next(done, result, error))

    def _next(self, done: int, result: Measurement, error: float | None) -> int:
        """Return how many paths of each batch are wanted: twice as many, or as the error says."""
        if error is None or not math.isfinite(result.relative_error):
            return 2 * done
        needed = done * (result.relative_error / error) ** 2
        return math.ceil(min(max(1.05 * needed, 1.1 * done), 4.0 * done))

    def _walk(
        self, more: int, time_s: float | None, progress: ProgressCallback | None, most: int
    ) -> bool:
        before = self.meter.paths_per_batch * _core.BATCHES

        def tell(done: int, total: int) -> None:
            if progress is not None:
                is_open = most == _MOST_IN_BATCH
                progress(before + done, before + total if is_open else most * _core.BATCHES)

        if time_s is not None and time_s <= 0.0:
            return False
        return self.meter.walk(more, time_budget_s=time_s, threads=self.threads, progress=tell)

    def _result(self, *, complete: bool, interrupted: bool) -> Measurement:
        meter, gonio = self.meter, self.goniometer
        rows, columns = gonio.v_edges_deg.size - 1, gonio.h_edges_deg.size - 1
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
            spot_spectra=meter.spot_bands() / gonio.spot_sr,
            out_spectra=meter.out_bands()[:, 0],
            grid_spectra=spectra,
            band_centres_nm=self._centres(gonio.spot_bands),
            grid_band_centres_nm=self._centres(gonio.cell_bands),
            paths=meter.paths_per_batch * _core.BATCHES,
            ledgers=found,
            statistics=meter.statistics(),
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


def _told(fault: str, scene: Scene, gonio: Goniometer, light: Light | None) -> SceneError:
    """Return the core's refusal as one that says what to do."""
    if "visible flux" in fault:
        what = "the given light has no visible flux" if light else "no object has visible flux"
        advice = "" if light else "; give one an emission with flux_lm"
        return SceneError(f"nothing can be measured: {what}{advice}", file=scene.path)
    if "the receivers stand" in fault and gonio.distance_m is not None:
        rounded = re.sub(r"\d+\.\d+", lambda number: f"{float(number[0]):.4g}", fault)
        return SceneError(
            f"{rounded}; take a larger distance_m, or name objects that are not the lamp's in "
            "measure.leave_out",
            file=scene.path,
            where="measure.distance_m",
        )
    return SceneError(fault, file=scene.path)

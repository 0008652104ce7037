# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`measure_reflector`: what a retro-reflector sends back, direction by direction of the light."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from lamplit import _core
from lamplit.engine.assembly import assemble
from lamplit.engine.carrier import SpectralCarrier
from lamplit.engine.light_sources import BeamLight, Laboratory
from lamplit.engine.measure import check_budget, in_laboratory, light_method, middle_of, refused
from lamplit.engine.measurement import Measurement
from lamplit.engine.measuring_run import (
    FIRST_ROUND,
    MOST_IN_BATCH,
    USUAL_PATHS,
    ProgressCallback,
    Run,
)
from lamplit.engine.receivers import Goniometer, measure_settings
from lamplit.errors import LamplitError
from lamplit.photometry.reflex import ReflexReading
from lamplit.scene import Scene
from lamplit.scene.measuring import REFLEX_DEG

_MCD_PER_CD = 1e3
#: With a target that light which never comes cannot reach, paths of each direction at most.
_MOST_OPEN = 1 << 26

#: Entrance angle V, entrance angle H and observation angle in degrees.
Angles = tuple[float, float, float]


@dataclass(frozen=True, eq=False, kw_only=True)
class ReflexMeasurement:
    """What came back of light from each entrance direction, at the observation angles there."""

    #: One for each entrance direction, in a beam of 1 lx: candela there are cd/lx.
    parts: tuple[Measurement, ...]
    #: V, H and the observation angle of each spot of each part, in degrees.
    angles: tuple[tuple[Angles, ...], ...]
    source_deg: float
    receiver_deg: float
    elapsed_s: float = 0.0
    complete: bool = True
    interrupted: bool = False

    @property
    def readings(self) -> tuple[ReflexReading, ...]:
        """The coefficients of luminous intensity with their standard errors, in mcd/lx.

        Where no light came, the coefficient is 0 and its standard error an upper bound.
        """
        found: list[ReflexReading] = []
        for part, angles in zip(self.parts, self.angles, strict=True):
            seen = part.observed()
            values = _MCD_PER_CD * np.stack([seen.spot_cd, seen.spot_standard_error_cd], axis=-1)
            found += [
                ReflexReading(*own, *value)
                for own, value in zip(angles, values.tolist(), strict=True)
            ]
        return tuple(found)

    @property
    def paths(self) -> int:
        """Paths walked, over all entrance directions."""
        return sum(part.paths for part in self.parts)

    @property
    def scene(self) -> Scene:
        """The scene as it was measured."""
        return self.parts[0].scene

    @property
    def relative_error(self) -> float:
        """The largest relative standard error of all readings; infinite where one has no light."""
        return max(
            own.standard_error_mcd_per_lx / own.cil_mcd_per_lx
            if own.cil_mcd_per_lx > 0.0
            else math.inf
            for own in self.readings
        )


class ReflexInterrupted(KeyboardInterrupt):
    """Ctrl-C during a measurement; ``measurement`` holds what was done."""

    def __init__(self, measurement: ReflexMeasurement) -> None:
        super().__init__(f"stopped with {measurement.paths} paths")
        self.measurement = measurement


def measure_reflector(
    scene: Scene,
    angles: Sequence[Angles],
    *,
    source_deg: float = REFLEX_DEG,
    receiver_deg: float = REFLEX_DEG,
    paths: int | None = None,
    error: float | None = None,
    time_s: float | None = None,
    until: Callable[[ReflexMeasurement], bool] | None = None,
    seed: int | None = None,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> ReflexMeasurement:
    """Walk light of illuminant A onto a retro-reflector and return what comes back.

    ``angles`` are triples of entrance angle V, entrance angle H and observation angle in degrees,
    such as ``rule.reflex_angles()``. Light comes from (H, V) about the axis of the scene's
    [measure], from a disc of the full angle ``source_deg``; receivers of the full angle
    ``receiver_deg`` stand at (H, V + observation angle). That is the system of CIE 54.2 with
    β₁ = V, β₂ = H and no rotation. Both are in the far field; what shines in the scene is dark.

    ``paths`` are those of each entrance direction. ``error`` is the relative standard error that
    all readings go down to, ``time_s`` the seconds to walk for, ``until`` is asked after every
    round whether that is enough; with any of them, ``paths`` is the most (2²⁶ if neither it nor a
    time is given).

    Raises:
        LamplitError: The scene has no axis, or an argument cannot be used.
        ReflexInterrupted: Ctrl-C; its ``measurement`` has the paths that were done.
    """
    check_budget(paths=paths, error=error, time_s=time_s)
    by_entrance = _by_entrance(angles)
    for name, value in (("source", source_deg), ("receiver", receiver_deg)):
        if not 0.0 < value <= 10.0:
            raise LamplitError(f"a {name} subtends more than 0° and at most 10°, not {value:g}°")
    settings = measure_settings(scene)
    dark = in_laboratory(scene)
    carrier = SpectralCarrier(scene.image.wavelength_range_nm, scene.image.observer)
    world = assemble(dark, carrier)
    centre = settings.centre_mm or middle_of(world, scene)
    seed = scene.image.seed if seed is None else seed
    runs: list[Run] = []
    for (v, h), own in by_entrance.items():
        gonio = Goniometer(
            axis=settings.axis,
            up=settings.up,
            centre_mm=centre,
            distance_m=None,
            receiver_deg=receiver_deg,
            spot_h_deg=np.full(len(own), h),
            spot_v_deg=np.array([v + observation for _, _, observation in own]),
            h_edges_deg=np.empty(0),
            v_edges_deg=np.empty(0),
            spot_bands=1,
        )
        light = BeamLight(h_deg=h, v_deg=v, angular_radius_deg=0.5 * source_deg)
        laboratory = Laboratory(
            world=world,
            scene=dark,
            carrier=carrier,
            goniometer=gonio,
            method=light_method(scene),
            seed=seed,
        )
        try:
            meter = laboratory.photometer(light)
        except ValueError as fault:
            raise refused(str(fault), scene, gonio, light) from fault
        about = {"goniometer": gonio, "groups": (light.group,), "scene": scene, "light": light}
        runs.append(Run(meter, gonio, about | {"seed": seed, "threads": threads}, threads or 0))
    rounds = _Rounds(tuple(runs), by_entrance, source_deg, receiver_deg, progress)
    return rounds.until(paths, error, time_s, until)


def _by_entrance(angles: Sequence[Angles]) -> dict[tuple[float, float], tuple[Angles, ...]]:
    """Return the angles by entrance direction, each once, in their order.

    Raises:
        LamplitError: There are none, or a direction is none before the reflector.
    """
    found: dict[tuple[float, float], list[Angles]] = {}
    for v, h, observation in angles:
        sound = all(math.isfinite(value) for value in (v, h, observation))
        if not (sound and abs(v) < 90.0 and abs(h) < 90.0 and 0.0 <= observation <= 90.0 - v):
            raise LamplitError(
                f"entrance angles lie within ±90°, and the observation angle leads from there to "
                f"V = 90° at most, not V {v:g}°, H {h:g}°, observation {observation:g}°"
            )
        own = found.setdefault((float(v), float(h)), [])
        if (triple := (float(v), float(h), float(observation))) not in own:
            own.append(triple)
    if not found:
        raise LamplitError("nothing is to be measured: there are no entrance angles")
    return {entrance: tuple(own) for entrance, own in found.items()}


@dataclass(eq=False)
class _Rounds:
    """All entrance directions in turn, a little further in each round."""

    runs: tuple[Run, ...]
    by_entrance: Mapping[tuple[float, float], tuple[Angles, ...]]
    source_deg: float
    receiver_deg: float
    progress: ProgressCallback | None
    started: float = field(default_factory=time.perf_counter)

    def until(
        self,
        paths: int | None,
        error: float | None,
        time_s: float | None,
        enough: Callable[[ReflexMeasurement], bool] | None,
    ) -> ReflexMeasurement:
        has_aim = error is not None or enough is not None
        usual = MOST_IN_BATCH * _core.BATCHES if time_s else _MOST_OPEN if has_aim else USUAL_PATHS
        most = min(math.ceil((paths or usual) / _core.BATCHES), MOST_IN_BATCH)
        wanted = min(FIRST_ROUND, most)
        while True:
            in_time, interrupted = self._walk(wanted, most, time_s)
            found = self._found(interrupted=interrupted)
            if interrupted:
                raise ReflexInterrupted(replace(found, complete=False))
            reached = (enough is None or enough(found)) and (
                error is None or found.relative_error <= error
            )
            if has_aim and reached:
                return found
            if wanted >= most or not in_time:
                return replace(found, complete=not has_aim)
            wanted = min(2 * wanted, most)

    def _walk(self, wanted: int, most: int, time_s: float | None) -> tuple[bool, bool]:
        """Bring all to ``wanted`` paths of a batch; return whether in time, and whether stopped."""
        for at, run in enumerate(self.runs):
            left = None
            if time_s is not None:
                left = (time_s - (time.perf_counter() - self.started)) / (len(self.runs) - at)
            before = run.meter.paths_per_batch
            if run.walk(wanted - before, left, self._told(at), most):
                return False, True
        return all(run.meter.paths_per_batch >= wanted for run in self.runs), False

    def _told(self, at: int) -> ProgressCallback | None:
        """Return a callback that adds what the other directions have walked."""
        tell = self.progress
        if tell is None:
            return None
        others = sum(
            run.meter.paths_per_batch * _core.BATCHES
            for number, run in enumerate(self.runs)
            if number != at
        )
        return lambda done, total: tell(others + done, len(self.runs) * total)

    def _found(self, *, interrupted: bool) -> ReflexMeasurement:
        return ReflexMeasurement(
            parts=tuple(run.result(complete=True, interrupted=False) for run in self.runs),
            angles=tuple(self.by_entrance.values()),
            source_deg=self.source_deg,
            receiver_deg=self.receiver_deg,
            elapsed_s=time.perf_counter() - self.started,
            interrupted=interrupted,
        )

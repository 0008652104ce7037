# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`measure`: how many candela, where, and in what colour."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lamplit import _core
from lamplit.engine.assembly import assemble
from lamplit.engine.carrier import SpectralCarrier
from lamplit.engine.light_sources import Laboratory, Light
from lamplit.engine.looking import Looking, check_visible, eye_method
from lamplit.engine.measurement import Measurement
from lamplit.engine.measuring_run import ProgressCallback, Run
from lamplit.engine.receiver_view import WIDEST_LENS_DEG
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

#: Finest bands of a spot, per lane: 5 nm over 380–780 nm. Cells of a grid have one band a lane.
_SPOT_BANDS = 5

#: How light walks are spent: both ways on at the first smooth surface, and by chance below this
#: share. docs/transport.md has what was measured.
_SPLIT_DEPTH, _ROULETTE_BELOW = 1, 0.25


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
    eye: bool = True,
    seed: int | None = None,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> Measurement:
    """Walk light from the lamp's sources and return its luminous intensity over directions.

    Spots are read both ways: from the light, and by as many looks from the ``eye`` of the receiver
    as there are paths of light, which is far more certain where a receiver is small.
    `Measurement.observed` tells what the eye reads; `Measurement.cross_check` compares. The eye
    reads nothing with ``eye`` of False, of receivers beyond 2°, of ``light``, ray files and endless
    planes, and where the lamp reaches up to a receiver.

    ``spots`` (n, 2) are H and V in degrees of round receivers, ``grid`` the borders of cells along
    H and V (None: each degree over ±90°), ``plane`` a rectangle to light. ``distance_m`` and
    ``receiver_deg`` stand in for those of [measure]; an infinite distance is the far field.
    ``light`` is walked instead of what shines in the scene. ``spectra`` keeps the spectrum of each
    cell of the grid.

    ``error`` is the `Measurement.relative_error` to go down to, ``time_s`` the seconds to walk for
    (half of them from the light, where an eye reads too),
    and ``until`` is asked after every round whether that is enough; with any of them, ``paths`` is
    the most. ``threads`` of None takes one per core: the result does not depend on it.

    Raises:
        LamplitError: The lamp has no axis or no light, the receiver stands in the lamp, or an
            argument cannot be used.
        MeasureInterrupted: Ctrl-C; its ``measurement`` has the paths that were done.
    """
    check_budget(paths=paths, error=error, time_s=time_s)
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
        centre_mm=settings.centre_mm or middle_of(world, scene),
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
    method = light_method(scene)
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
        raise refused(str(fault), scene, goniometer, light) from fault
    groups = light_groups(dark) if light is None else (light.group,)
    about = {"goniometer": goniometer, "groups": groups, "scene": scene, "light": light}
    looking = _looking(laboratory, light, groups, threads) if eye else None
    about |= {"seed": seed, "threads": threads}
    run = Run(meter, goniometer, about, threads or 0, looking)
    return run.until(paths, error, time_s, until, progress)


def _looking(
    laboratory: Laboratory, light: Light | None, groups: tuple[str, ...], threads: int | None
) -> Looking | None:
    """Return what reads the spots by the eye; None where it cannot see all their light."""
    gonio, scene = laboratory.goniometer, laboratory.scene
    is_lens = gonio.spot_h_deg.size > 0 and gonio.receiver_deg <= WIDEST_LENS_DEG
    if light is not None or not is_lens:
        return None
    try:
        check_visible(scene)
        return Looking(
            laboratory.world,
            gonio,
            eye_method(scene),
            groups=len(groups),
            seed=laboratory.seed,
            threads=threads,
        )
    except LamplitError:
        return None


def light_method(scene: Scene) -> _core.PathMethod:
    """Return how walks from lights are spent in ``scene``."""
    return _core.PathMethod(
        max_depth=scene.path_settings.max_depth,
        split_depth=_SPLIT_DEPTH,
        roulette_below=_ROULETTE_BELOW,
    )


def check_budget(*, paths: int | None, error: float | None, time_s: float | None) -> None:
    """Check how long is to be walked.

    Raises:
        LamplitError: That is nothing, or no number.
    """
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


def middle_of(world: _core.Scene, scene: Scene) -> tuple[float, float, float]:
    """Return the middle of the box round all objects, in mm.

    Raises:
        SceneError: There are endless planes alone.
    """
    bounds = world.bounds_mm
    if bounds is None:
        raise SceneError(
            "only endless planes are left; give the reference centre",
            file=scene.path,
            where="measure.centre_mm",
        )
    x, y, z = (0.5 * np.add(*bounds)).tolist()
    return x, y, z


def refused(fault: str, scene: Scene, gonio: Goniometer, light: Light | None) -> SceneError:
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

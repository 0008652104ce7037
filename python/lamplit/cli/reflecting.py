# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The retro-reflectors of a scene, measured one after the other."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lamplit.cli.functions import AskedReflector
    from lamplit.cli.measuring_options import Budget
    from lamplit.engine.reflectors import ReflexMeasurement
    from lamplit.report.photometry.results import ReflectorResults
    from lamplit.scene import Scene


def measured_reflectors(
    scene: Scene,
    reflectors: Sequence[AskedReflector],
    budget: Budget,
    *,
    production: bool,
    threads: int | None,
) -> tuple[list[ReflectorResults], list[ReflexMeasurement]]:
    """Return what is shown and what was measured of each reflector; a signal leaves the rest out.

    The paths of ``budget`` are those of each entrance direction.

    Raises:
        LamplitError: The scene cannot be measured, or a rule cannot be judged.
    """
    from lamplit import engine
    from lamplit.report.photometry.progress import MeasuringProgress
    from lamplit.report.photometry.reflected import reflector_results

    shown: list[ReflectorResults] = []
    found: list[ReflexMeasurement] = []
    for one in reflectors:
        until = _until(one, production=production) if budget.until_decided else None
        with MeasuringProgress(f"Measuring {one.name}", time_s=budget.time_s) as progress:
            try:
                measured = engine.measure_reflector(
                    scene,
                    one.angles,
                    source_deg=one.source_deg,
                    receiver_deg=one.receiver_deg,
                    paths=budget.paths,
                    error=budget.error,
                    time_s=budget.time_s,
                    threads=threads,
                    until=until,
                    progress=progress,
                )
            except engine.ReflexInterrupted as stopped:
                measured = stopped.measurement
        if measured.paths > 0:
            shown.append(reflector_results(one.name, measured, one.rule, production=production))
            found.append(measured)
        if measured.interrupted:
            break
    return shown, found


def _until(one: AskedReflector, *, production: bool) -> Callable[[ReflexMeasurement], bool]:
    """Return what asks whether all is decided that can be."""
    from lamplit.report.photometry.reflected import reflector_results

    def is_decided(so_far: ReflexMeasurement) -> bool:
        verdict = reflector_results(one.name, so_far, one.rule, production=production).verdict
        return verdict is None or verdict.paths_factor is None

    return is_decided

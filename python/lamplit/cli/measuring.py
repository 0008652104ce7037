# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What `measure` and `report` share: the run itself."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import typer

from lamplit.errors import LamplitError

if TYPE_CHECKING:
    from lamplit.cli.functions import Asked, AskedReflector
    from lamplit.cli.measuring_options import Budget, Wanted
    from lamplit.cli.stopping import Stop
    from lamplit.engine.measurement import Measurement
    from lamplit.report.photometry.progress import MeasuringProgress
    from lamplit.report.photometry.results import Results
    from lamplit.scene import Scene


class Measured(NamedTuple):
    """What is shown, what was measured of the lit lamp, if it was, and what stopped it."""

    results: Results
    measurement: Measurement | None
    stop: Stop
    #: Whether a signal ended it.
    interrupted: bool


def measured(wanted: Wanted, budget: Budget, *, threads: int | None = None) -> Measured:
    """Measure what is ``wanted``: the lit functions, then each retro-reflector.

    Raises:
        LamplitError: The scene, a rule or an option cannot be used.
        typer.Exit: A signal stopped it before anything was done.
    """
    from lamplit.cli.functions import asked_functions, asked_reflectors
    from lamplit.cli.reflecting import measured_reflectors
    from lamplit.cli.stopping import stop_signals
    from lamplit.report.photometry.measured import results_of
    from lamplit.report.photometry.reflected import with_reflectors

    scene = wanted.load()
    functions = asked_functions(scene, rules=wanted.rules)
    reflectors = asked_reflectors(scene, rules=wanted.rules)
    _check(budget, [*functions, *reflectors])
    if budget.time_s is not None:
        share = budget.time_s / (bool(functions) + len(reflectors))
        budget = replace(budget, time_s=share)
    results, measurement, interrupted = None, None, False
    with stop_signals() as stop:
        if functions:
            measurement = _lit(scene, functions, wanted, budget, threads)
            if measurement.paths > 0:
                results = results_of(measurement, functions, production=wanted.production)
                notices = (*results.notices, *_dark(measurement, functions))
                results = replace(results, notices=notices)
            interrupted = measurement.interrupted
        if reflectors and not interrupted:
            shown, found = measured_reflectors(
                scene, reflectors, budget, production=wanted.production, threads=threads
            )
            if found:
                results = with_reflectors(results, shown, found)
            interrupted = len(found) < len(reflectors) or found[-1].interrupted
    if results is None:
        print("stopped before the first path was done; nothing is written", file=sys.stderr)
        raise typer.Exit(stop.exit_code)
    if interrupted:
        results = replace(results, complete=False)
    return Measured(results, measurement, stop, interrupted)


def _lit(
    scene: Scene,
    functions: Sequence[Asked],
    wanted: Wanted,
    budget: Budget,
    threads: int | None,
) -> Measurement:
    """Measure the lit functions; what is done when a signal ends it."""
    from lamplit import engine
    from lamplit.cli.functions import directions
    from lamplit.report.photometry.progress import MeasuringProgress

    distance_m, receiver_deg = wanted.distance_m, wanted.checked_receiver_deg
    spots, grid = directions(functions)
    progress = MeasuringProgress(
        "Measuring", time_s=budget.time_s, paths=budget.most_paths, error=budget.error
    )
    rounds = _Rounds(functions, budget, progress, production=wanted.production)
    with progress:
        try:
            measurement = engine.measure(
                scene,
                spots=spots,
                grid=grid,
                distance_m=distance_m,
                receiver_deg=receiver_deg,
                paths=budget.most_paths,
                error=budget.error,
                time_s=budget.time_s,
                threads=threads,
                until=rounds.are_enough,
                progress=progress,
            )
        except engine.MeasureInterrupted as stopped:
            return stopped.measurement
    return measurement if rounds.have_an_aim else replace(measurement, complete=True)


def _dark(measurement: Measurement, functions: Sequence[Asked]) -> list[str]:
    """Return a notice for each function whose light groups give no light at all."""
    emitted = dict(zip(measurement.groups, measurement.emitted_xyz[:, 1].tolist(), strict=True))
    return [
        f"{one.name}: none of its light groups ({', '.join(one.light)}) gives any light"
        for one in functions
        if one.light and not any(weight * emitted[name] for name, weight in one.light.items())
    ]


class _Rounds:
    """What is asked between the rounds of a measurement: are the paths so far enough?"""

    def __init__(
        self,
        functions: Sequence[Asked],
        budget: Budget,
        progress: MeasuringProgress,
        *,
        production: bool,
    ) -> None:
        self._functions, self._budget, self._production = functions, budget, production
        self._progress = progress

    @property
    def have_an_aim(self) -> bool:
        """Whether something else than paths or time says when it is enough."""
        return self._budget.error is not None or self._budget.until_decided

    def are_enough(self, so_far: Measurement) -> bool:
        """Tell how certain it is so far, and return whether all is decided that can be."""
        from lamplit.report.photometry.measured import judged_functions

        self._progress.note(so_far.relative_error)
        if not self._budget.until_decided:
            return self._budget.error is not None
        judged = judged_functions(so_far, self._functions, production=self._production)
        verdicts = [one.verdict for one in judged if one.verdict is not None]
        return all(verdict.paths_factor is None for verdict in verdicts)


def _check(budget: Budget, asked: Sequence[Asked | AskedReflector]) -> None:
    """Refuse to go on until what has no rule is decided.

    Raises:
        LamplitError: No function has a rule.
    """
    if budget.until_decided and all(one.rule is None for one in asked):
        raise LamplitError(
            "no function has a rule that could be decided; name one with --rule",
            where="--until-decided",
        )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What `measure` and `report` share: options, the run itself, and what is printed of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lamplit.errors import LamplitError

if TYPE_CHECKING:
    from rich.console import Console

    from lamplit.cli.functions import Asked
    from lamplit.cli.stopping import Stop
    from lamplit.engine.measurement import Measurement
    from lamplit.report.photometry.results import Results
    from lamplit.scene import Scene

RuleOption = Annotated[
    list[str] | None,
    typer.Option(
        "--rule",
        metavar="[FUNCTION=]RULE",
        help="What the lamp, or one function of it, has to meet, such as un-r148/S1 or "
        "un-r148/S2?period=night, instead of the scene's; may be repeated.",
    ),
]
PathsOption = Annotated[
    int | None, typer.Option("--paths", min=1, help="Paths of light to walk, at most.")
]
ErrorOption = Annotated[
    float | None,
    typer.Option(
        "--error",
        metavar="SHARE",
        help="Walk until the relative standard error at the bright test points is this: 0.01 is "
        "1 %.",
    ),
]
TimeOption = Annotated[
    float | None, typer.Option("--time", metavar="SECONDS", help="Walk for so long, at most.")
]
UntilDecidedOption = Annotated[
    bool,
    typer.Option(
        "--until-decided",
        help="Walk until no limit lies within 2 sigma of what was measured; --time or --paths "
        "sets an end.",
    ),
]
DistanceOption = Annotated[
    float | None,
    typer.Option(
        "--distance", metavar="M", help="Distance of the receiver, instead of the scene's."
    ),
]
ReceiverOption = Annotated[
    float | None,
    typer.Option(
        "--receiver",
        metavar="DEG",
        help="Full angle that the receiver subtends, 1/6 to 1, instead of the scene's.",
    ),
]
ProductionOption = Annotated[
    bool,
    typer.Option(
        "--production", help="Judge as a lamp from the line: limits of conformity of production."
    ),
]


@dataclass(frozen=True)
class Budget:
    """How long to walk."""

    paths: int | None = None
    error: float | None = None
    time_s: float | None = None
    until_decided: bool = False


@dataclass(frozen=True)
class Wanted:
    """What is to be measured."""

    place: Path
    rules: Sequence[str] = ()
    distance_m: float | None = None
    receiver_deg: float | None = None
    production: bool = False
    seed: int | None = None
    assignments: Sequence[str] = ()

    def load(self) -> Scene:
        """Return the scene with what the options change in it.

        Raises:
            LamplitError: The scene or an option cannot be used.
        """
        from lamplit.cli.overrides import overrides, scene_file
        from lamplit.scene import load_scene

        changed = overrides(assignments=self.assignments, seed=self.seed)
        own = {"measure.distance_m": self.distance_m, "measure.receiver_deg": self.receiver_deg}
        changed |= {key: value for key, value in own.items() if value is not None}
        return load_scene(scene_file(self.place), overrides=changed)


def measured(
    wanted: Wanted, budget: Budget, *, threads: int | None = None, cross_check: bool = False
) -> tuple[Results, Stop]:
    """Measure what is ``wanted``, and return it with the signal that stopped it, if one did.

    Raises:
        LamplitError: The scene, a rule or an option cannot be used.
        typer.Exit: A signal stopped it before anything was done.
    """
    from lamplit import engine
    from lamplit.cli.functions import asked_functions, directions
    from lamplit.cli.stopping import stop_signals
    from lamplit.report.photometry.measured import results_of
    from lamplit.report.photometry.progress import MeasuringProgress

    scene = wanted.load()
    functions = asked_functions(scene, rules=wanted.rules)
    _check(budget, functions)
    spots, grid = directions(functions)
    progress = MeasuringProgress("Measuring", time_s=budget.time_s)
    decide = _decider(functions, production=wanted.production) if budget.until_decided else None

    def until(so_far: Measurement) -> bool:
        progress.note(so_far.relative_error)
        return decide is not None and decide(so_far)

    with stop_signals() as stop, progress:
        measurement = engine.measure(
            scene,
            spots=spots,
            grid=grid,
            paths=budget.paths,
            error=budget.error,
            time_s=budget.time_s,
            threads=threads,
            until=until,
            progress=progress,
        )
    results = results_of(measurement, functions, production=wanted.production)
    return results, stop


def _check(budget: Budget, functions: Sequence[Asked]) -> None:
    """Refuse to go on until what has no rule is decided.

    Raises:
        LamplitError: No function has a rule.
    """
    if budget.until_decided and all(one.rule is None for one in functions):
        raise LamplitError(
            "no function has a rule that could be decided; name one with --rule",
            where="--until-decided",
        )


def _decider(
    functions: Sequence[Asked], *, production: bool
) -> Callable[[Measurement], bool]:
    """Return what says whether more paths would decide nothing."""
    from lamplit.report.photometry.measured import judged_functions

    def decided(so_far: Measurement) -> bool:
        judged = judged_functions(so_far, functions, production=production)
        verdicts = [one.verdict for one in judged if one.verdict is not None]
        return all(verdict.paths_factor is None for verdict in verdicts)

    return decided


def print_verdicts(console: Console, results: Results) -> None:
    """Print the table of each function, and below all of them the verdicts."""
    from rich.markup import escape
    from rich.text import Text

    from lamplit.report.photometry.style import MARKS
    from lamplit.report.photometry.table import STYLES, findings_table, in_words, spots_table

    for one in results.functions:
        console.print(f"\n[bold]{escape(one.name)}[/bold]", end="")
        if one.verdict is None:
            console.print(": no rule, nothing is judged\n")
            console.print(spots_table(one.observed))
            continue
        chosen = "" if not one.verdict.production else ", conformity of production"
        console.print(f": {escape(one.verdict.title)}, {escape(one.verdict.rule)}{chosen}\n")
        console.print(findings_table(one))
    console.print()
    for one in results.functions:
        if one.verdict is not None:
            mark = MARKS[one.verdict.outcome]
            word = Text(f"{mark.sign} {mark.word:10}", style=STYLES[one.verdict.outcome])
            console.print(word, Text(f"{one.name}: {in_words(one.verdict)}"))
    notices = [note for one in results.functions if one.verdict for note in one.verdict.notices]
    for notice in dict.fromkeys([*results.notices, *notices]):
        console.print(f"[cyan]notice: {escape(notice)}[/cyan]")

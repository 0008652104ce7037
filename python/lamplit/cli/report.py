# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit report``: one HTML file that says whether a lamp passes, and what that stands on."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lamplit.cli.measuring import (
    Budget,
    DistanceOption,
    ErrorOption,
    PathsOption,
    ProductionOption,
    ReceiverOption,
    RuleOption,
    TimeOption,
    UntilDecidedOption,
)
from lamplit.cli.options import SeedOption, SetOption, ThreadsOption
from lamplit.cli.overrides import command_line
from lamplit.errors import LamplitError, OutputError

if TYPE_CHECKING:
    from lamplit.report.photometry.results import Results


def report(
    place: Annotated[
        Path,
        typer.Argument(
            metavar="SCENE_OR_DIR",
            help="The scene's TOML file or its folder, or a folder that `lamplit measure` wrote.",
        ),
    ],
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="FILE", help="The page, a .html file.")
    ],
    picture: Annotated[
        list[Path] | None,
        typer.Option(
            "--picture",
            metavar="FILE",
            help="A PNG or JPEG to show, named by its file; may be repeated. Without it, those of "
            "`lamplit render` and `lamplit mix` that lie in DIR.",
        ),
    ] = None,
    rule: RuleOption = None,
    paths: PathsOption = None,
    error: ErrorOption = None,
    time: TimeOption = None,
    until_decided: UntilDecidedOption = False,
    distance: DistanceOption = None,
    receiver: ReceiverOption = None,
    production: ProductionOption = False,
    seed: SeedOption = None,
    threads: ThreadsOption = None,
    set_: SetOption = None,
) -> None:
    """Write FILE: verdicts first, then pictures, test points, plots, spectra, energy, provenance.

    The file holds all it shows and asks nothing of a network. From a scene it measures first, with
    the options of `lamplit measure`; from a folder it takes what is there.
    """
    from lamplit.report.atomic import prepare_output, write_bytes
    from lamplit.report.photometry.kept import MEASUREMENT_FILE
    from lamplit.report.photometry.page import pictures_in, read_picture, render_page
    from lamplit.report.progress import Progress

    if output.suffix.lower() not in (".html", ".htm"):
        raise OutputError("a report is a .html file; name one with -o", file=output)
    prepare_output(output.parent, (output.name,))
    shown = [read_picture(path) for path in picture or ()]
    budget = Budget(paths, error, time, until_decided)
    stop = None
    if place.is_dir() and (place / MEASUREMENT_FILE).exists():
        options = (rule, distance, receiver, seed, threads, set_, production or None)
        _refuse(budget, given=any(value is not None for value in options))
        results = _kept(place)
        shown = shown or pictures_in(place)
    else:
        from lamplit.cli.measuring import Wanted, measured

        wanted = Wanted(place, rule or (), distance, receiver, production, seed, set_ or ())
        found = measured(wanted, budget, threads=threads)
        results, stop = found.results, found.stop
        results = replace(results, command=command_line(sys.argv))
    with Progress("Drawing") as progress:
        page = render_page(results, shown, progress)
    write_bytes(output, page.encode())
    _tell(results, output)
    if stop is not None and stop.signal_number is not None:
        raise typer.Exit(stop.exit_code)


def _kept(place: Path) -> Results:
    from lamplit.report.photometry.kept import read_results

    return read_results(place)


def _refuse(budget: Budget, *, given: bool) -> None:
    """Refuse options that a folder which is measured already cannot follow.

    Raises:
        LamplitError: There are any.
    """
    if given or budget != Budget():
        raise LamplitError(
            "the folder is measured already, and only -o and --picture apply; name its scene to "
            "measure anew"
        )


def _tell(results: Results, output: Path) -> None:
    from lamplit.cli.verdicts import print_verdicts

    print_verdicts(results)
    print(f"\nOpen {output}")

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit report``: one HTML file that says whether a lamp passes, and what that stands on."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lamplit.cli.measuring_options import MeasuringOptions
from lamplit.cli.option_groups import grouped
from lamplit.cli.overrides import command_line
from lamplit.errors import LamplitError, OutputError

if TYPE_CHECKING:
    from lamplit.report.photometry.results import Results


@grouped
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
    options: MeasuringOptions,
    picture: Annotated[
        list[Path] | None,
        typer.Option(
            "--picture",
            metavar="FILE",
            help="A PNG or JPEG to show, named by its file; may be repeated. Without it, those of "
            "`lamplit render` and `lamplit mix` that lie in DIR.",
        ),
    ] = None,
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
    stop = None
    if place.is_dir() and (place / MEASUREMENT_FILE).exists():
        _refuse(options)
        results = _kept(place)
        shown = shown or pictures_in(place)
    else:
        from lamplit.cli.measuring import measured

        found = measured(options.wanted(place), options.budget, threads=options.threads)
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


def _refuse(options: MeasuringOptions) -> None:
    """Refuse options that a folder which is measured already cannot follow.

    Raises:
        LamplitError: There are any.
    """
    if options != MeasuringOptions():
        raise LamplitError(
            "the folder is measured already, and only -o and --picture apply; name its scene to "
            "measure anew"
        )


def _tell(results: Results, output: Path) -> None:
    from lamplit.cli.verdicts import print_verdicts

    print_verdicts(results)
    print(f"\nOpen {output}")

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit measure``: candela, colour and verdict of a lamp, in files and in a table."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lamplit.cli.measuring import measured
from lamplit.cli.measuring_options import MeasuringOptions
from lamplit.cli.option_groups import grouped
from lamplit.cli.options import OutputOption, SceneArgument
from lamplit.cli.overrides import command_line
from lamplit.cli.verdicts import print_verdicts

if TYPE_CHECKING:
    from lamplit.report.photometry.results import Results


@grouped
def measure(
    scene: SceneArgument,
    output: OutputOption,
    options: MeasuringOptions,
    cross_check: Annotated[
        bool,
        typer.Option(
            "--cross-check",
            help="Also show the test points by walks from the light and from the receiver, "
            "beside each other, and keep them.",
        ),
    ] = False,
) -> None:
    """Measure the lamp in SCENE: candela and colour per direction, and whether it passes.

    Writes tables (CSV), IES and EULUMDAT files, plots and measurement.json into DIR, and prints
    the test points and the verdict. Ctrl-C keeps the paths that are done. Exit code 0: it was
    measured, whatever the verdict; measurement.json has the verdict as "outcome".
    """
    from lamplit.cli.cross_checking import cross_checked
    from lamplit.report.atomic import prepare_output
    from lamplit.report.photometry.files import write_measurement
    from lamplit.report.photometry.kept import MEASUREMENT_FILE
    from lamplit.report.progress import Progress

    wanted = options.wanted(scene, cross_check=cross_check)
    prepare_output(output, (MEASUREMENT_FILE,))
    found = measured(wanted, options.budget, threads=options.threads)
    results = replace(found.results, command=command_line(sys.argv))
    with Progress("Drawing") as progress:
        files = write_measurement(results, output, progress)
    _tell(output, results, files)
    if found.interrupted:
        raise typer.Exit(found.stop.exit_code)
    if cross_check:
        if found.measurement is None:
            print("\nno function is lit, and so there is nothing to cross-check")
        else:
            cross_checked(found.measurement, output)


def _tell(output: Path, results: Results, files: dict[str, str]) -> None:
    from lamplit.cli.closing import show_table

    print_verdicts(results)
    numbers = {
        "paths": f"{results.paths / 1e6:.4g} million in {results.elapsed_s:.1f} s, "
        f"{results.paths / max(results.elapsed_s, 1e-9) / 1e6:.3g} million/s"
    }
    if "test points" in results.geometry:
        numbers["test points"] = results.geometry["test points"]
    if results.energy is not None:
        energy = results.energy
        numbers["flux"] = (
            f"{energy.total_lm:.4g} lm emitted, {energy.out_lm:.4g} lm "
            f"({100 * energy.efficiency:.3g} %) leave the lamp"
        )
    heading = results.scene or "Lamp"
    console = show_table(heading, numbers, output, files)
    console.print(f"\n[dim]lamplit report {output} -o FILE.html makes one page of it[/dim]")
    if not results.complete:
        console.print(
            "\n[yellow]stopped before all was done; what is done is in the files[/yellow]"
        )

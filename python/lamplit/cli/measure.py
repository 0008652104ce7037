# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit measure``: candela, colour and verdict of a lamp, in files and in a table."""

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
    Wanted,
    measured,
)
from lamplit.cli.options import OutputOption, SceneArgument, SeedOption, SetOption, ThreadsOption
from lamplit.cli.overrides import command_line
from lamplit.cli.verdicts import print_verdicts

if TYPE_CHECKING:
    from lamplit.engine.measurement import Measurement
    from lamplit.report.photometry.results import Results


def measure(
    scene: SceneArgument,
    output: OutputOption,
    rule: RuleOption = None,
    paths: PathsOption = None,
    error: ErrorOption = None,
    time: TimeOption = None,
    until_decided: UntilDecidedOption = False,
    cross_check: Annotated[
        bool,
        typer.Option(
            "--cross-check",
            help="Also show the test points by walks from the light and from the receiver, "
            "beside each other.",
        ),
    ] = False,
    distance: DistanceOption = None,
    receiver: ReceiverOption = None,
    production: ProductionOption = False,
    seed: SeedOption = None,
    threads: ThreadsOption = None,
    set_: SetOption = None,
) -> None:
    """Measure the lamp in SCENE: candela and colour per direction, and whether it passes.

    Writes tables (CSV), IES and EULUMDAT files, plots and measurement.json into DIR, and prints
    the test points and the verdict. Ctrl-C keeps the paths that are done. Exit code 0: it was
    measured, whatever the verdict; measurement.json has the verdict as "outcome".
    """
    from lamplit.report.atomic import prepare_output
    from lamplit.report.photometry.files import write_measurement
    from lamplit.report.photometry.kept import MEASUREMENT_FILE

    wanted = Wanted(scene, rule or (), distance, receiver, production, seed, set_ or ())
    prepare_output(output, (MEASUREMENT_FILE,))
    budget = Budget(paths, error, time, until_decided)
    found = measured(wanted, budget, threads=threads)
    results = replace(found.results, command=command_line(sys.argv))
    files = write_measurement(results, output)
    _tell(output, results, files)
    if found.interrupted:
        raise typer.Exit(found.stop.exit_code)
    if cross_check:
        if found.measurement is None:
            print("\nno function is lit, and so there is nothing to cross-check")
        else:
            _compare(found.measurement)


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


def _compare(measurement: Measurement) -> None:
    """Print the test points by both ways: walked from the light, and from the eye."""
    from rich.console import Console
    from rich.table import Table

    from lamplit.report.photometry.style import cd
    from lamplit.report.photometry.table import angle

    console = Console(highlight=False, soft_wrap=True)
    console.print("\n[bold]Cross-check[/bold], all light: from the light, and from the receiver\n")
    both = measurement.cross_check()
    table = Table(box=None, header_style="bold", pad_edge=False)
    for heading in (
        "H °",
        "V °",
        "cd from the light",
        "2 σ",
        "cd from the receiver",
        "2 σ",
        "apart",
    ):
        table.add_column(heading, justify="right", no_wrap=True)
    for at, apart in enumerate(both.sigmas):
        table.add_row(
            angle(float(both.spot_h_deg[at])),
            angle(float(both.spot_v_deg[at])),
            cd(float(both.light_cd[at])),
            f"± {2.0 * both.light_standard_error_cd[at]:.2g}",
            cd(float(both.eye_cd[at])),
            f"± {2.0 * both.eye_standard_error_cd[at]:.2g}",
            f"{abs(apart):.1f} σ",
        )
    console.print(table)

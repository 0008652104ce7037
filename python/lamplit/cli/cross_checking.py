# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`lamplit measure --cross-check`: the test points by both ways, beside each other."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from lamplit.engine.cross_check import CrossCheck
    from lamplit.engine.measurement import Measurement

_HEADINGS = ("H °", "V °", "cd from the light", "2 σ", "cd from the receiver", "2 σ", "apart")


def cross_checked(measurement: Measurement, directory: Path) -> None:
    """Print and write the test points by walks from the light and from the receiver.

    Where the measurement had no time for looks from the receiver, they are taken now.

    Raises:
        typer.Exit: A signal stopped it.
    """
    from lamplit.cli.stopping import stop_signals
    from lamplit.report.atomic import write_bytes
    from lamplit.report.photometry.csv_files import CROSS_CHECK_FILE, cross_check_csv
    from lamplit.report.progress import Progress

    with stop_signals() as stop, Progress("Cross-check") as progress:
        try:
            both = measurement.cross_check(progress=progress)
        except KeyboardInterrupt:
            print("stopped in the cross-check; the measurement is in the files", file=sys.stderr)
            raise typer.Exit(stop.exit_code) from None
    write_bytes(directory / CROSS_CHECK_FILE, cross_check_csv(both))
    _show(both)
    print(f"\nboth are in {directory / CROSS_CHECK_FILE}")


def _show(both: CrossCheck) -> None:
    from rich.console import Console
    from rich.table import Table

    from lamplit.report.photometry.style import cd, spread
    from lamplit.report.photometry.table import angle

    console = Console(highlight=False, soft_wrap=True)
    console.print("\n[bold]Cross-check[/bold], all light: from the light, and from the receiver\n")
    table = Table(box=None, header_style="bold", pad_edge=False)
    for heading in _HEADINGS:
        table.add_column(heading, justify="right", no_wrap=True)
    for at, apart in enumerate(both.sigmas):
        table.add_row(
            angle(float(both.spot_h_deg[at])),
            angle(float(both.spot_v_deg[at])),
            cd(float(both.light_cd[at])),
            spread(2.0 * float(both.light_standard_error_cd[at])),
            cd(float(both.eye_cd[at])),
            spread(2.0 * float(both.eye_standard_error_cd[at])) if both.eye_cd[at] else "none seen",
            f"{abs(apart):.1f} σ",
        )
    console.print(table)
    far = int(both.is_apart.sum())
    console.print(
        "\nboth ways agree within what chance explains"
        if far == 0
        else f"\n[red]{far} of {len(both.sigmas)} points differ by more than chance explains: "
        "smooth normals on a coarse mesh do that, or light that one way seldom finds[/red]"
    )

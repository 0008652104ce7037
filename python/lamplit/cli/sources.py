# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit sources``: the light sources of the library."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lamplit.cli.listing import print_listing
from lamplit.errors import LamplitError

if TYPE_CHECKING:
    from lamplit.sources import Bulb

_TITLES = ("name", "x", "y", "λd nm", "lm/W")


def sources(
    name: Annotated[
        str | None, typer.Argument(help="A source or a bulb; without one, all are listed.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option("--plot", help="Draw the source's spectrum into this file.")
    ] = None,
) -> None:
    """Light sources by name, with their colour, references and licence."""
    from rich.console import Console

    from lamplit.sources import bulb, bulb_names, source, source_names

    if name is None and plot is not None:
        raise LamplitError("--plot draws one source; name it: lamplit sources NAME --plot FILE")
    console = Console()
    if name is None:
        print_listing(console, _TITLES, [_listed(each) for each in source_names()])
        console.print(
            "x, y: CIE 1931 2°, 360-830 nm.  λd: dominant wavelength against equal-energy white.\n"
            "lm/W: luminous efficacy of radiation.  lamplit sources NAME tells more of one.\n"
            "Bulbs, for emission = { source = .., bulb = NAME }: "
            + ", ".join(f"{each} {bulb(each).flux_lm:g} lm" for each in bulb_names())
        )
        return
    if name in bulb_names():
        console.print(_bulb_details(bulb(name)))
        return
    entry = source(name)
    console.print(_details(entry.name))
    if plot is not None:
        from lamplit.report.source_plot import plot_source

        plot_source(entry, plot)
        console.print(f"open {plot}", highlight=False)


def _listed(name: str) -> tuple[list[str], list[str]]:
    from lamplit.sources import source

    entry = source(name)
    return [name, *_numbers(name)], [entry.description, f"{entry.reference}. {entry.licence}"]


def _bulb_details(entry: Bulb) -> object:
    rows = (
        ("Name", entry.name),
        ("Bulb", entry.description),
        ("Luminous flux", f"{entry.flux_lm:g} lm ± {100 * entry.tolerance:g} %"),
        ("Test voltage", f"{entry.test_voltage_v:g} V"),
        ("Reference", f"{entry.reference} (V read, V2 read where it is cited, M from memory)"),
        ("In a scene", f'emission = {{ source = "A", bulb = "{entry.name}" }}'),
    )
    return _table(rows)


def _details(name: str) -> object:
    from lamplit.sources import source

    entry = source(name)
    x, y, dominant, efficacy = _numbers(name)
    rows = (
        ("Name", entry.name),
        ("Description", entry.description),
        ("x, y (CIE 1931)", f"{x}, {y}"),
        ("Dominant wavelength", f"{dominant} nm"),
        ("Luminous efficacy", f"{efficacy} lm/W of radiation, 360-830 nm"),
        ("Reference", entry.reference),
        ("Licence", entry.licence),
    )
    return _table(rows)


def _table(rows: Iterable[tuple[str, str]]) -> object:
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, show_header=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column()
    for label, value in rows:
        table.add_row(label, Text(value))
    return table


def _numbers(name: str) -> tuple[str, str, str, str]:
    """Return x, y, dominant wavelength and efficacy as text; a dash where light is white."""
    from lamplit.colour.locus import dominant_wavelength
    from lamplit.colour.tristimulus import chromaticity_xy, luminous_efficacy, tristimulus
    from lamplit.sources import source

    spd = source(name).distribution()
    xy = chromaticity_xy(tristimulus(spd, normalisation="relative"))
    dominant, purity = dominant_wavelength(xy)
    hue = f"{dominant:.1f}" if purity > 0.5 else "-"
    return f"{xy[0]:.4f}", f"{xy[1]:.4f}", hue, f"{luminous_efficacy(spd):.0f}"

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit materials``: what the library holds, with numbers, references and licence."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lamplit.cli.listing import print_listing
from lamplit.errors import LamplitError

if TYPE_CHECKING:
    from rich.table import Table

    from lamplit.materials import Material

_TITLES = ("name", "kind", "n_d", "V_d", "R0 %", "T or R %", "x", "y")

#: The thickness at which a plate's numbers are given: a usual lamp lens.
_LENS_MM = 2.5


def materials(
    name: Annotated[
        str | None, typer.Argument(metavar="[NAME]", help="One material, with its references.")
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            "--plot", metavar="FILE", help="Draw t(λ) or the reflectance (png, svg, pdf)."
        ),
    ] = None,
    thicknesses_mm: Annotated[
        str, typer.Option("--thicknesses-mm", metavar="LIST", help="Plates to draw, by commas.")
    ] = "1,2,3,5,10",
) -> None:
    """List the library's materials; with a name, tell all about one, and draw it."""
    from rich.console import Console

    from lamplit.materials import material, material_names

    console = Console(highlight=False)
    if name is None:
        if plot is not None:
            raise LamplitError("--plot draws one material: lamplit materials NAME --plot FILE")
        print_listing(console, _TITLES, [_listed(each) for each in material_names()])
        console.print(
            "T or R, xy: plate of 2.5 mm, or one surface, under illuminant A, CIE 1931 2°"
        )
        return
    chosen = material(name)
    if plot is not None:
        _draw(chosen, name, plot, thicknesses_mm)
    console.print(_card(name, chosen))
    if plot is not None:
        console.print(f"drawn: {plot}", soft_wrap=True, markup=False)


def _listed(name: str) -> tuple[list[str], list[str]]:
    from lamplit.materials import material

    entry = material(name)
    below = [entry.description, *entry.references, f"Licence: {entry.licence}"]
    return [name, entry.kind, *_numbers(entry)], below


def _numbers(entry: Material) -> tuple[str, str, str, str, str, str]:
    """Return n_d, V_d, R0, luminous T or R, x and y as the table prints them."""
    from lamplit.colour.tristimulus import chromaticity_xy
    from lamplit.materials import Checker, Dielectric, Glossy
    from lamplit.materials.appearance import (
        VISIBLE_NM,
        plate_transmittance,
        seen_xyz,
        surface_reflectance,
    )
    from lamplit.materials.optics import LINE_D_NM, abbe_number, normal_reflectance

    n_d = v_d = "-"
    r_0 = f"{100 * float(surface_reflectance(entry, LINE_D_NM)):.2f}"
    if isinstance(entry, (Dielectric, Glossy)):
        index = float(entry.index(LINE_D_NM))
        abbe = abbe_number(entry.index)
        n_d, v_d = f"{index:.4f}", f"{abbe:.1f}" if abbe < 1e6 else "-"
        r_0 = f"{100 * float(normal_reflectance(index)):.2f}"
    elif isinstance(entry, Checker):
        r_0 = "-"
    seen = (
        plate_transmittance(entry, VISIBLE_NM, _LENS_MM)
        if isinstance(entry, Dielectric)
        else surface_reflectance(entry, VISIBLE_NM)
    )
    xyz = seen_xyz(seen, "A")
    x, y = chromaticity_xy(xyz)
    return n_d, v_d, r_0, f"{xyz[1]:.1f}", f"{x:.3f}", f"{y:.3f}"


def _card(name: str, entry: Material) -> Table:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    from lamplit.materials import Dielectric

    n_d, v_d, r_0, seen, x, y = _numbers(entry)
    where = f"a plate of {_LENS_MM} mm lets" if isinstance(entry, Dielectric) else "it gives back"
    rows = [
        ("kind", entry.kind),
        ("what", entry.description),
        ("n_d, V_d", f"{n_d}, {v_d}"),
        ("R0", f"{r_0} % of one face at normal incidence, 587.56 nm"),
        ("under A", f"{where} {seen} %, xy {x}, {y} (CIE 1931 2°)"),
        *(("reference", reference) for reference in entry.references),
        ("licence", entry.licence),
    ]
    table = Table(title=name, title_justify="left", box=box.SIMPLE, show_header=False)
    table.add_column(no_wrap=True, style="dim")
    table.add_column(overflow="fold")
    for key, value in rows:
        if not value.startswith("-"):
            table.add_row(key, Text(value))
    return table


def _draw(entry: Material, name: str, path: Path, thicknesses_mm: str) -> None:
    from lamplit.materials import Dielectric
    from lamplit.materials.plot import plot_reflectance, plot_transmittance

    if not isinstance(entry, Dielectric):
        plot_reflectance(entry, path, name=name)
        return
    try:
        listed = [float(word) for word in thicknesses_mm.split(",")]
    except ValueError:
        raise LamplitError(
            f"--thicknesses-mm {thicknesses_mm!r} is not a list of numbers such as 1,2.5,4"
        ) from None
    plot_transmittance(entry, path, listed, name=name)

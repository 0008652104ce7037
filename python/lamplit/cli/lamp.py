# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit lamp``: write a parametric example lamp, or show which there are."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lamplit.errors import LamplitError


def lamp(
    name: Annotated[
        str | None, typer.Argument(metavar="[NAME]", help="Which lamp; without it, list them.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="DIR", help="Where the files go.")
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="A parameter; may be repeated."),
    ] = None,
    show: Annotated[
        bool, typer.Option("--list", help="Show the lamp's parameters with their defaults.")
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Replace files that were changed or are not ours.")
    ] = False,
) -> None:
    """Write a lamp's meshes and scene file to start from."""
    from lamplit.lamps import write_lamp

    if name is None:
        if output is not None or settings:
            raise LamplitError("which lamp? lamplit lamp NAME -o DIR")
        _list_lamps()
    elif show:
        _list_parameters(name)
    elif output is None:
        raise LamplitError(f"where to? lamplit lamp {name} -o DIR (or --list for its parameters)")
    else:
        path = write_lamp(name, output, _parsed(settings or []), force=force)
        typer.echo(f"written: {path}\nnext:    lamplit render {path} -o {output / 'pictures'}")


def _parsed(settings: list[str]) -> dict[str, str]:
    parameters: dict[str, str] = {}
    for setting in settings:
        key, equals, value = setting.partition("=")
        if not (key.strip() and equals):
            raise LamplitError(f"--set {setting}: a parameter is given as key=value")
        parameters[key.strip()] = value.strip()
    return parameters


def _list_lamps() -> None:
    from lamplit.lamps import lamp_description, lamp_names

    for each in lamp_names():
        typer.echo(f"{each:10} {lamp_description(each)}")
    typer.echo("\nlamplit lamp NAME --list shows the parameters; -o DIR writes the lamp")


def _list_parameters(name: str) -> None:
    from rich.console import Console
    from rich.table import Table

    from lamplit.lamps import lamp_description, lamp_parameters

    table = Table("parameter", "default", "limits", "meaning", title_justify="left")
    table.title = f"{name}: {lamp_description(name)}"
    for parameter in lamp_parameters(name):
        default = parameter.default
        shown = str(default).lower() if isinstance(default, bool) else f"{default}"
        table.add_row(parameter.name, shown, parameter.limits, parameter.description)
    Console(highlight=False).print(table)

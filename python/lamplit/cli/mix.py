# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit mix``: one render's light groups, each turned up or down, without tracing again."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from lamplit.cli.option_groups import grouped
from lamplit.cli.overrides import command_line
from lamplit.cli.viewing import ViewOptions
from lamplit.errors import LamplitError

#: Where the mixture goes below the folder of the render unless another place is named.
_FOLDER = "mix"


@grouped
def mix(
    view: ViewOptions,
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Where `lamplit render --layers` wrote to.")
    ],
    set_: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="GROUP=WEIGHT",
            help="Times what a light group counts: 0 is off, 1 as rendered; may be repeated. "
            "Groups that are not named count once.",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="OUT", help="Where the results go; else DIR/mix."),
    ] = None,
) -> None:
    """Weigh and add the light groups of the render in DIR: picture.png, picture.exr, summary.json.

    Nothing is traced. The standard errors of the sum are upper bounds: the weighted sums of those
    of the groups.
    """
    from lamplit import __version__
    from lamplit.cli.closing import picture_rows, show_table
    from lamplit.report import mixture as report
    from lamplit.report.atomic import prepare_output
    from lamplit.report.layers import LAYERS_FILE, read_layers

    weights = _weights(set_ or ())
    layers = read_layers(folder / LAYERS_FILE, changed=view.overrides())
    mixed = report.mix(layers, weights)
    target = folder / _FOLDER if output is None else output
    if target.resolve() == folder.resolve():
        raise LamplitError("the render itself lies there; choose another place", where="-o")
    files = report.mixture_files(layers.view.settings)
    prepare_output(target, files)
    command = command_line(sys.argv)
    numbers = report.write_mixture(mixed, target, command=command, version=__version__)
    rows = picture_rows(numbers)
    bound = numbers["luminance_cd_m2"]["mean_standard_error_bound"]
    if bound is not None:
        rows["luminance, mean"] += f", standard error {bound:.2g} at most"
    heading = " + ".join(f"{weight:g} × {group}" for group, weight in mixed.weights.items())
    show_table(heading, rows, target, files)


def _weights(assignments: Sequence[str]) -> dict[str, float]:
    found: dict[str, float] = {}
    for text in assignments:
        name, equals, value = (part.strip() for part in text.partition("="))
        try:
            weight = float(value)
        except ValueError:
            weight = math.nan
        if not (name and equals and math.isfinite(weight)):
            raise LamplitError(
                f"{text!r} is no weight; write group=number, such as filament=0.5", where="--set"
            )
        if name in found:
            raise LamplitError(f"{name!r} is given two weights", where="--set")
        found[name] = weight
    return found

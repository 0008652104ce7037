# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit develop``: another picture of what was rendered, without rendering again."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from lamplit.cli.option_groups import grouped
from lamplit.cli.options import Bits, BitsOption, GamutMaskOption
from lamplit.cli.overrides import command_line
from lamplit.cli.viewing import ViewOptions
from lamplit.errors import LamplitError

#: Where the pictures go, beside the one that is developed, unless another place is named.
_FOLDER = "developed"


@grouped
def develop(
    view: ViewOptions,
    picture: Annotated[
        Path,
        typer.Argument(
            metavar="PICTURE", help="A picture.exr of render or mix, or the folder it lies in."
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="DIR", help="Where the results go; else developed/."
        ),
    ] = None,
    gamut_mask: GamutMaskOption = False,
    bits: BitsOption = Bits.eight,
) -> None:
    """Develop PICTURE again: picture.png, what else is asked for, and develop.json.

    Exposure, tone, display, false colours and glare are those of the scene unless they are named.
    PICTURE stays as it is: glare is laid on a copy.
    """
    from lamplit import __version__
    from lamplit.cli.closing import picture_rows, show_table
    from lamplit.report import redevelop as report
    from lamplit.report.atomic import prepare_output

    file = picture / "picture.exr" if picture.is_dir() else picture
    kept = report.read_picture(file, view.overrides())
    target = file.parent / _FOLDER if output is None else output
    if target.resolve() == file.parent.resolve():
        raise LamplitError("the picture itself lies there; choose another place", where="-o")
    files = report.developed_files(kept.view.settings, gamut_mask=gamut_mask)
    prepare_output(target, files)
    numbers = report.write_developed(
        kept,
        target,
        command=command_line(sys.argv),
        version=__version__,
        bits=16 if bits is Bits.sixteen else 8,
        gamut_mask=gamut_mask,
    )
    show_table(str(file), picture_rows(numbers), target, files)

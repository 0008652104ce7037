# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The last words of a command: a short table, and the files to open."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from lamplit.engine.image import Image


def show_results(
    image: Image, numbers: Mapping[str, str], directory: Path, files: Mapping[str, str]
) -> None:
    """Print ``numbers`` about ``image``, and ``files`` in ``directory`` with what is in each."""
    from rich.console import Console
    from rich.markup import escape

    from lamplit.report.losses import Losses

    console = Console(highlight=False, soft_wrap=True)
    console.print(f"\n[bold]{escape(_heading(image))}[/bold]")
    for title, lines in (("", numbers), (f"Files in {directory}", files)):
        if title:
            console.print(f"\n{escape(title)}")
        width = max(map(len, lines), default=0) + 3
        for name, text in lines.items():
            console.print(f"  {escape(name.ljust(width))}[dim]{escape(text)}[/dim]")
    for warning in Losses.of(image).warnings():
        console.print(f"\n[yellow]warning: {escape(warning)}[/yellow]")
    if not image.complete:
        console.print(
            f"\n[yellow]stopped with {image.samples} of {image.samples_asked} samples per pixel; "
            "what is done is in the files[/yellow]"
        )


def end_if_refused(*images: Image, allow_lost: bool) -> None:
    """End the run with one line of error if one of ``images`` is not to be trusted.

    Raises:
        typer.Exit: With code 1.
    """
    from lamplit.report.losses import Losses

    for image in images:
        if fault := Losses.of(image).fault(allow_lost=allow_lost):
            print(f"error: the picture is written, but {fault}", file=sys.stderr)
            raise typer.Exit(1)


def _heading(image: Image) -> str:
    samples = f"{image.samples} sample" + ("s" if image.samples != 1 else "")
    return (
        f"{image.scene.name or 'Scene'}: {image.width} × {image.height}, {samples} per pixel, "
        f"{image.elapsed_s:.1f} s"
    )

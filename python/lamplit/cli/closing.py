# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The last words of a command: a short table, and the files to open."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from rich.console import Console

    from lamplit.engine.image import Image


def picture_rows(numbers: Mapping[str, Any]) -> dict[str, str]:
    """Return what the summary of a picture says of it, for `show_table`."""
    luminance, display = numbers["luminance_cd_m2"], numbers["display"]
    xy, shares = numbers["chromaticity_xy_of_mean"], luminance["percentiles"]
    spread = " | ".join(f"{shares[share]:.4g}" for share in ("5", "50", "95") if share in shares)
    mean, error = luminance["mean"], luminance.get("mean_standard_error")
    rows = {
        "luminance, mean": f"{mean:.4g}{'' if error is None else f' ± {error:.2g}'} cd/m²",
        "luminance, 5 | 50 | 95 %": f"{spread} cd/m²",
        "chromaticity of the mean": "none: black" if xy is None else f"{xy[0]:.4f}, {xy[1]:.4f}",
        "shown as white": _exposure(display),
        f"outside {display['label']}": f"{100 * display['out_of_gamut_share']:.1f} % of the pixels",
        "brighter than white": f"{100 * display['over_white_share']:.1f} % of the pixels",
    }
    glare = numbers.get("glare")
    if glare is not None:
        rows["glare"] = (
            f"an eye of {glare['age']:g} years, pupil {glare['pupil_mm']:.2g} mm: "
            f"{100 * glare['left_frame_share']:.2g} % of the light goes beyond the picture"
        )
    return rows


def show_results(
    image: Image, numbers: Mapping[str, str], directory: Path, files: Mapping[str, str]
) -> None:
    """Print ``numbers`` about ``image``, and ``files`` in ``directory`` with what is in each."""
    from rich.markup import escape

    from lamplit.report.losses import Losses

    console = show_table(_heading(image), numbers, directory, files)
    for notice in image.notices:
        console.print(f"\n[cyan]notice: {escape(notice)}[/cyan]")
    for warning in Losses.of(image).warnings():
        console.print(f"\n[yellow]warning: {escape(warning)}[/yellow]")
    if not image.complete:
        console.print(
            f"\n[yellow]stopped with {image.samples} of {image.samples_asked} samples per pixel; "
            "what is done is in the files[/yellow]"
        )


def show_table(
    heading: str, numbers: Mapping[str, str], directory: Path, files: Mapping[str, str]
) -> Console:
    """Print ``heading``, ``numbers``, and ``files`` in ``directory`` with what is in each."""
    from rich.console import Console
    from rich.markup import escape

    console = Console(highlight=False, soft_wrap=True)
    console.print(f"\n[bold]{escape(heading)}[/bold]")
    for title, lines in (("", numbers), (f"Files in {directory}", files)):
        if title:
            console.print(f"\n{escape(title)}")
        width = max(map(len, lines), default=0) + 3
        for name, text in lines.items():
            console.print(f"  {escape(name.ljust(width))}[dim]{escape(text)}[/dim]")
    return console


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
    counts = image.samples_per_pixel
    fewest, most = int(counts.min()), int(counts.max())
    spread = f" ({fewest} to {most})" if fewest < most else ""
    return (
        f"{image.scene.name or 'Scene'}: {image.width} × {image.height}, "
        f"{samples} per pixel{spread}, {image.elapsed_s:.1f} s"
    )


def _exposure(display: Mapping[str, Any]) -> str:
    white, brightest = (display[f"{name}_luminance_cd_m2"] for name in ("white", "brightest"))
    reach = "" if brightest is None else f", tone curve up to {brightest:.4g} cd/m² of white"
    return f"{white:.4g} cd/m²{reach}"

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit compare``: one scene in RGB and in spectra, and how far they are apart."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lamplit.cli.option_groups import grouped
from lamplit.cli.overrides import command_line
from lamplit.cli.scene_run import SceneRun
from lamplit.cli.stopping import stop_signals
from lamplit.cli.viewing import ExposureOptions
from lamplit.errors import LamplitError

if TYPE_CHECKING:
    from lamplit.engine.image import Image
    from lamplit.report.difference import Difference


@grouped
def compare(
    run: SceneRun,
    view: ExposureOptions,
    mark: Annotated[
        list[str] | None,
        typer.Option(
            "--mark",
            metavar="X,Y",
            help="A pixel to look at, from the top left; may be repeated, five fit the page. "
            "Without it, the places that differ most.",
        ),
    ] = None,
) -> None:
    """Render SCENE in RGB and in spectra, and lay the two side by side on one page.

    Both by the method hall, whatever the scene says, unless --method asks for another. Ctrl-C
    keeps what is done of the picture that is being made. Exit code 1: the files are written, but
    the pictures are not to be trusted, since too many rays were lost.
    """
    from lamplit import engine
    from lamplit.cli.closing import end_if_refused
    from lamplit.report.atomic import prepare_output
    from lamplit.report.comparison import COMPARISON_FILES, write_comparison
    from lamplit.report.difference import check_marks
    from lamplit.report.progress import Progress

    marks = None if mark is None else _places(mark)
    scene = run.load(view.overrides())
    check_marks(marks or (), width=scene.image.width, height=scene.image.height)
    prepare_output(run.output, COMPARISON_FILES)
    with stop_signals() as stop, Progress("Comparing") as progress:
        try:
            pair = engine.compare(
                scene,
                method=run.method_name or "hall",
                samples=run.samples,
                threads=run.threads,
                progress=progress,
            )
        except engine.RenderInterrupted as stopped:
            stop.end_if_empty(stopped.image)
            _keep(run.output, stopped.image)
            raise typer.Exit(stop.exit_code) from None
    command = command_line(sys.argv)
    spectral, rgb = (replace(image, command=command) for image in (pair.spectral, pair.rgb))
    difference = write_comparison(spectral, rgb, run.output, marks=marks)
    _tell(run.output, spectral, difference)
    end_if_refused(spectral, rgb, allow_lost=run.allow_lost)


def _keep(output: Path, image: Image) -> None:
    """Write the picture that was being made when the comparison was stopped."""
    from lamplit.cli.closing import show_results
    from lamplit.report.comparison import COMPARISON_FILES, write_half

    names = write_half(replace(image, command=command_line(sys.argv)), output)
    show_results(image, {}, output, {name: COMPARISON_FILES[name] for name in names})


def _places(marks: Sequence[str]) -> list[tuple[int, int]]:
    places: list[tuple[int, int]] = []
    for text in marks:
        match = re.fullmatch(r"\s*(\d{1,6})\s*,\s*(\d{1,6})\s*", text)
        if match is None:
            raise LamplitError(
                f"{text!r} is no pixel; write column,row, such as 320,200", where="--mark"
            )
        places.append((int(match[1]), int(match[2])))
    return places


def _tell(output: Path, image: Image, difference: Difference) -> None:
    from lamplit.cli.closing import show_results
    from lamplit.report.comparison import COMPARISON_FILES

    shares = [100 * view.picture.gamut_share for view in (difference.rgb, difference.spectral)]
    rows = {
        "ΔE00, mean": f"{difference.mean:.2f}",
        "ΔE00, 95 % of the pixels below": f"{difference.percentile_95:.2f}",
        "ΔE00, largest": f"{difference.largest:.2f}",
        f"outside {difference.spectral.display_label}": (
            f"RGB {shares[0]:.1f} %, spectral {shares[1]:.1f} % of the pixels"
        ),
    }
    show_results(image, rows, output, COMPARISON_FILES)

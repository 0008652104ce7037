# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit render``: the picture of a scene, in files that say how they came about."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lamplit.cli.options import (
    AllowLostOption,
    Bits,
    BitsOption,
    DisplayOption,
    Method,
    MethodOption,
    OutputOption,
    SamplesOption,
    SceneArgument,
    SeedOption,
    SetOption,
    SizeOption,
    ThreadsOption,
)
from lamplit.cli.overrides import command_line, overrides, scene_file
from lamplit.cli.stopping import stop_signals

if TYPE_CHECKING:
    from lamplit.engine.image import Image


def render(
    scene: SceneArgument,
    output: OutputOption,
    method: MethodOption = Method.hall,
    samples: SamplesOption = None,
    seed: SeedOption = None,
    size: SizeOption = None,
    threads: ThreadsOption = None,
    set_: SetOption = None,
    display: DisplayOption = None,
    bits: BitsOption = Bits.eight,
    spectral: Annotated[
        bool, typer.Option("--spectral", help="Keep the spectrum of each pixel in the EXR.")
    ] = False,
    gamut_mask: Annotated[
        bool, typer.Option("--gamut-mask", help="Also draw which pixels the display cannot show.")
    ] = False,
    allow_lost: AllowLostOption = False,
) -> None:
    """Render SCENE: picture.png for the display, picture.exr with exact values, summary.json.

    Ctrl-C keeps the samples that are done. Exit code 1: the files are written, but the picture is
    not to be trusted, since too many rays were lost.
    """
    from lamplit import engine
    from lamplit.cli.closing import end_if_refused
    from lamplit.report.atomic import prepare_output
    from lamplit.report.develop import check_display
    from lamplit.report.picture_files import picture_files, write_picture
    from lamplit.report.progress import Progress
    from lamplit.scene import load_scene

    changed = overrides(
        assignments=set_ or (), samples=samples, seed=seed, size=size, display=display
    )
    loaded = load_scene(scene_file(scene), overrides=changed)
    check_display(loaded)
    contents = picture_files(gamut_mask=gamut_mask)
    prepare_output(output, contents)
    with stop_signals() as stop, Progress("Rendering") as progress:
        try:
            image = engine.render(
                loaded,
                method=method.value,
                threads=threads,
                spectral_bands=spectral,
                progress=progress,
            )
        except engine.RenderInterrupted as stopped:
            image = stopped.image
    stop.end_if_empty(image)
    image = replace(image, command=command_line(sys.argv))
    numbers = write_picture(
        image,
        output,
        bits=16 if bits is Bits.sixteen else 8,
        spectral=spectral,
        gamut_mask=gamut_mask,
    )
    _tell(output, image, numbers, contents)
    stop.end_if_interrupted(image)
    end_if_refused(image, allow_lost=allow_lost)


def _tell(output: Path, image: Image, numbers: dict[str, Any], contents: dict[str, str]) -> None:
    from lamplit.cli.closing import show_results

    luminance, display = numbers["luminance_cd_m2"], numbers["display"]
    xy, shares = numbers["chromaticity_xy_of_mean"], luminance["percentiles"]
    spread = " | ".join(f"{shares[share]:.4g}" for share in ("5", "50", "95") if share in shares)
    mean, error = luminance["mean"], luminance["mean_standard_error"]
    rows = {
        "luminance, mean": f"{mean:.4g}{'' if error is None else f' ± {error:.2g}'} cd/m²",
        "luminance, 5 | 50 | 95 %": f"{spread} cd/m²",
        "chromaticity of the mean": "none: black" if xy is None else f"{xy[0]:.4f}, {xy[1]:.4f}",
        f"outside {display['label']}": f"{100 * display['out_of_gamut_share']:.1f} % of the pixels",
        "brighter than white": f"{100 * display['over_white_share']:.1f} % of the pixels",
    }
    show_results(image, rows, output, contents)

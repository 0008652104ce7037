# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit render``: the picture of a scene, in files that say how they came about."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lamplit.cli.option_groups import grouped
from lamplit.cli.options import Bits, BitsOption, GamutMaskOption
from lamplit.cli.overrides import command_line
from lamplit.cli.scene_run import SceneRun
from lamplit.cli.stopping import stop_signals
from lamplit.cli.viewing import ViewOptions
from lamplit.cli.views import Round, render_round
from lamplit.cli.watching import watched

if TYPE_CHECKING:
    from pathlib import Path

    from lamplit.engine import Ledger
    from lamplit.engine.image import Image

#: How many bodies the line about the ledger names.
_NAMED_BODIES = 4


@grouped
def render(
    run: SceneRun,
    view: ViewOptions,
    error: Annotated[
        float | None,
        typer.Option(
            "--error",
            metavar="SHARE",
            help="Sample until the relative error, root mean square over the pixels, is this: "
            "0.01 is 1 %.",
        ),
    ] = None,
    time: Annotated[
        float | None,
        typer.Option("--time", metavar="SECONDS", help="Sample for so long, at most."),
    ] = None,
    adaptive: Annotated[
        bool | None,
        typer.Option(
            "--adaptive/--uniform",
            help="Allot samples to pixels by their noise, or give all the same. "
            "With --error or --time adaptive, else uniform.",
        ),
    ] = None,
    turntable: Annotated[
        int | None,
        typer.Option(
            "--turntable",
            metavar="N",
            help="N pictures from round the lamp, and an animation: the eye moves to its right "
            "about the camera's target and up.",
        ),
    ] = None,
    sweep: Annotated[
        float | None,
        typer.Option(
            "--sweep",
            metavar="DEG",
            help="The turntable's angle, the camera in its middle: 90, or 360 for a full circle.",
        ),
    ] = None,
    eyes: Annotated[
        str | None,
        typer.Option(
            "--eyes",
            metavar="FILE",
            help="A picture from each eye point of a CSV or TOML file, and an animation; "
            "scene takes the scene's own [[eyes]].",
        ),
    ] = None,
    layers: Annotated[
        bool, typer.Option("--layers", help="Also write each light group by itself, for mix.")
    ] = False,
    features: Annotated[
        bool,
        typer.Option("--features", help="Keep depth, normal, body, albedo in the EXR."),
    ] = False,
    spectral: Annotated[
        bool, typer.Option("--spectral", help="Keep the spectrum of each pixel in the EXR.")
    ] = False,
    gamut_mask: GamutMaskOption = False,
    bits: BitsOption = Bits.eight,
    max_memory: Annotated[
        float | None,
        typer.Option(
            "--max-memory", metavar="GIB", help="Refuse what takes more; else what is free."
        ),
    ] = None,
) -> None:
    """Render SCENE: picture.png for the display, picture.exr with exact values, summary.json.

    With --error or --time, --samples is the most that a pixel takes on average. Meanwhile
    preview.png shows the picture so far. Ctrl-C keeps the samples that are done. With --turntable
    or --eyes there is a frame from each place, all under one white, and animation.png; --time is
    then for all frames together, and Ctrl-C keeps the frames that are done. Exit code 1: the files
    are written, but the picture is not to be trusted, since too many rays were lost.
    """
    from lamplit import engine
    from lamplit.cli.closing import end_if_refused
    from lamplit.report.atomic import prepare_output
    from lamplit.report.picture_files import picture_files, write_picture
    from lamplit.report.preview import PREVIEW_FILE, PreviewFile
    from lamplit.report.progress import Progress
    from lamplit.scene.memory import MOST_BANDS, check_memory, memory_estimate
    from lamplit.scene.shining import light_groups

    places = Round(turntable, sweep, eyes)
    scene = run.load(view.overrides())
    asked: dict[str, Any] = {
        "method": run.method_name,
        "samples": run.samples,
        "error": error,
        "time_s": time,
        "adaptive": adaptive,
    }
    depth = 16 if bits is Bits.sixteen else 8
    if places.is_asked:
        places.refuse(
            {
                "--layers": layers,
                "--features": features,
                "--spectral": spectral,
                "--gamut-mask": gamut_mask,
                "--false-colour": view.false_colour,
                "--glare": view.glare,
            }
        )
        check_memory(memory_estimate(scene), None if max_memory is None else max_memory * 2**30)
        render_round(run, scene, places.places(scene), asked, bits=depth)
        return
    asked["layers"] = layers
    settled = engine.plan(scene, **asked)
    estimate = memory_estimate(
        scene, bands=MOST_BANDS if spectral else 0, layers=len(light_groups(scene)) if layers else 0
    )
    check_memory(estimate, None if max_memory is None else max_memory * 2**30)
    contents = picture_files(scene.display, layers=layers, gamut_mask=gamut_mask)
    prepare_output(run.output, [*contents, PREVIEW_FILE])
    pixels = scene.image.width * scene.image.height
    progress = Progress(
        "Rendering",
        pixels=pixels,
        time_s=time,
        first_round=engine.FIRST_ROUND_SAMPLES * pixels if settled.adaptive else 0,
        error=settled.error,
    )
    with PreviewFile(run.output) as preview:
        with stop_signals() as stop, progress:
            try:
                image = engine.render(
                    scene,
                    **asked,
                    threads=run.threads,
                    spectral_bands=spectral,
                    features=features,
                    progress=progress,
                    preview=watched(progress, preview),
                )
            except engine.RenderInterrupted as stopped:
                image = stopped.image
        stop.end_if_empty(image)
        image = replace(image, command=command_line(sys.argv))
        numbers = write_picture(
            image, run.output, bits=depth, spectral=spectral, gamut_mask=gamut_mask
        )
    contents = picture_files(scene.display, layers=bool(image.layers), gamut_mask=gamut_mask)
    _tell(run.output, image, numbers, contents)
    stop.end_if_interrupted(image)
    end_if_refused(image, allow_lost=run.allow_lost)


def _tell(output: Path, image: Image, numbers: dict[str, Any], contents: dict[str, str]) -> None:
    from lamplit.cli.closing import picture_rows, show_results

    rows = picture_rows(numbers)
    reached, speed = numbers["relative_error_rms"], numbers["speed"]
    if reached is not None:
        asked = "" if image.error_asked is None else f", {100 * image.error_asked:g} % was asked"
        rows["relative error, rms"] = f"{100 * reached:.2g} %{asked}"
    if speed["rays_per_s"]:
        millions = [speed[name] / 1e6 for name in ("rays_per_s", "paths_per_s")]
        rows["speed"] = f"{millions[0]:.3g} million rays/s, {millions[1]:.3g} million paths/s"
    if (found := _found_line(image.statistics.get("found_cd_m2", {}))) is not None:
        rows["how light was found"] = found
    if image.ledger is not None:
        rows["where the walks ended"] = _ledger_line(image.ledger)
    show_results(image, rows, output, contents)


def _found_line(found: dict[str, float]) -> str | None:
    """Return the shares of the luminance by how they were found; None where one way found all."""
    words = {
        "specular": "in mirrors and through glass",
        "scattered": "scattered",
        "landed": "where light landed",
    }
    total = sum(found.values())
    if len(found) < 2 or total <= 0.0:
        return None
    return ", ".join(f"{words[how]} {100 * part / total:.3g} %" for how, part in found.items())


def _ledger_line(ledger: Ledger) -> str:
    """Return the largest entries of ``ledger``, in percent of all that set out."""
    bodies = sorted(ledger.absorbed.items(), key=lambda entry: -entry[1])
    kept = [entry for entry in bodies if entry[1] >= 5e-4]
    named, others = kept[:_NAMED_BODIES], kept[_NAMED_BODIES:]
    if len(others) == 1:
        named, others = kept, []
    entries = [("background", ledger.escaped), *named]
    if others:
        entries.append((f"{len(others)} others", sum(share for _, share in others)))
    rest = {"depth limit": ledger.cut_by_depth, "lost": ledger.lost}
    entries += [(name, share) for name, share in rest.items() if share > 0.0]
    return ", ".join(f"{name} {100 * share:.2g} %" for name, share in entries)

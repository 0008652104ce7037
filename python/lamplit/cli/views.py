# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit render --turntable`` and ``--eyes``: one picture after the other, and an animation."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import typer

from lamplit.cli.overrides import command_line
from lamplit.cli.scene_run import SceneRun
from lamplit.errors import LamplitError

if TYPE_CHECKING:
    from lamplit.engine import Views
    from lamplit.report.view_progress import ViewsProgress
    from lamplit.scene import Scene

#: What stands for the scene's own list in place of a file.
_OF_SCENE = "scene"


@dataclass(frozen=True)
class Round:
    """From where a lamp is to be seen."""

    turntable: int | None
    sweep_deg: float | None
    eyes: str | None

    @property
    def is_asked(self) -> bool:
        """Whether there is to be more than the one picture.

        Raises:
            LamplitError: The options contradict each other.
        """
        if self.sweep_deg is not None and self.turntable is None:
            raise LamplitError("a sweep is that of a --turntable", where="--sweep")
        if self.turntable is not None and self.eyes is not None:
            raise LamplitError("choose either --turntable or --eyes", where="--eyes")
        return self.turntable is not None or self.eyes is not None

    def refuse(self, kept: Mapping[str, bool]) -> None:
        """Refuse what is kept of a single picture only: names of options, and whether asked for.

        Raises:
            LamplitError: One is.
        """
        for name, is_asked in kept.items():
            if is_asked:
                raise LamplitError("this is for a single picture; leave it out", where=name)

    def places(self, scene: Scene) -> dict[str, Any]:
        """Return the places as `lamplit.engine.plan_views` takes them.

        Raises:
            LamplitError: The file of eye points cannot be used, or the scene has none.
        """
        from lamplit.scene.eye_files import read_eyes
        from lamplit.scene.eyes import USUAL_SWEEP_DEG

        if self.eyes is None:
            sweep = USUAL_SWEEP_DEG if self.sweep_deg is None else self.sweep_deg
            return {"turntable": self.turntable, "sweep_deg": sweep}
        if self.eyes != _OF_SCENE:
            return {"eyes": read_eyes(Path(self.eyes))}
        if not scene.eyes:
            raise LamplitError(
                "the scene has no [[eyes]]; write some, or name a file with --eyes",
                file=scene.path,
            )
        return {"eyes": list(scene.eyes)}


def render_round(
    run: SceneRun,
    scene: Scene,
    places: Mapping[str, Any],
    asked: Mapping[str, Any],
    *,
    bits: Literal[8, 16],
) -> None:
    """Render ``scene`` from ``places``, as ``asked`` of each picture, and write the files.

    Raises:
        LamplitError: Something cannot be used or written.
        typer.Exit: A signal stopped it, or a picture is not to be trusted.
    """
    from lamplit import engine
    from lamplit.cli.stopping import stop_signals
    from lamplit.cli.watching import watched
    from lamplit.report.losses import Losses
    from lamplit.report.preview import PreviewFile
    from lamplit.report.view_files import ViewWriter

    views = engine.plan_views(scene, **places, **asked)
    progress = _progress(scene, views)
    command = command_line(sys.argv)
    warnings: list[str] = []
    faults: list[str] = []
    interrupted = False
    with (
        ViewWriter(run.output, count=len(views), circle=views.circle, bits=bits) as writer,
        PreviewFile(run.output) as preview,
    ):
        images = views.images(
            threads=run.threads, progress=progress.frame, preview=watched(progress, preview)
        )
        with stop_signals() as stop, progress:
            try:
                for image in images:
                    writer.add(replace(image, command=command))
                    losses, frame = Losses.of(image), f"frame {len(writer)}"
                    warnings += [f"{frame}: {warning}" for warning in losses.warnings()]
                    fault = losses.fault(allow_lost=run.allow_lost)
                    faults += [] if fault is None else [f"{frame}: {fault}"]
            except KeyboardInterrupt:
                interrupted = True
        if len(writer) == 0:
            print("stopped before the first frame was done; nothing is written", file=sys.stderr)
            raise typer.Exit(stop.exit_code)
        numbers = writer.finish()
    _tell(run.output, numbers, warnings)
    if interrupted:
        raise typer.Exit(stop.exit_code)
    if faults:
        print(f"error: the frames are written, but {faults[0]}", file=sys.stderr)
        raise typer.Exit(1)


def _progress(scene: Scene, views: Views) -> ViewsProgress:
    from lamplit.engine import FIRST_ROUND_SAMPLES
    from lamplit.report.view_progress import ViewsProgress

    pixels = scene.image.width * scene.image.height
    time_s, settled = views.settled.time_s, views.settled
    return ViewsProgress(
        "Rendering",
        count=len(views),
        pixels=pixels,
        time_s=None if time_s is None else time_s * len(views),
        first_round=FIRST_ROUND_SAMPLES * pixels if settled.adaptive else 0,
        error=settled.error,
    )


def _tell(output: Path, numbers: Mapping[str, Any], warnings: Sequence[str]) -> None:
    from rich.markup import escape

    from lamplit.cli.closing import show_table
    from lamplit.report.view_files import view_files

    frames: list[Mapping[str, Any]] = numbers["frames"]
    first, done, asked = frames[0], len(frames), numbers["frames_asked"]
    heading = (
        f"{numbers['scene'] or 'Scene'}: {done} frame{'s' if done > 1 else ''} of "
        f"{first['width']} × {first['height']}, {numbers['elapsed_s']:.1f} s"
    )
    console = show_table(heading, _rows(numbers, frames), output, view_files(done))
    for notice in first["notices"]:
        console.print(f"\n[cyan]notice: {escape(notice)}[/cyan]")
    for warning in warnings:
        console.print(f"\n[yellow]warning: {escape(warning)}[/yellow]")
    if done < asked:
        console.print(
            f"\n[yellow]stopped with {done} of {asked} frames; they are in the files[/yellow]"
        )


def _rows(numbers: Mapping[str, Any], frames: Sequence[Mapping[str, Any]]) -> dict[str, str]:
    means = [frame["luminance_cd_m2"]["mean"] for frame in frames]
    dark, bright = means.index(min(means)), means.index(max(means))
    errors = [frame["relative_error_rms"] for frame in frames]
    samples = [frame["samples"] for frame in frames]
    spread = (
        f"{min(samples)}" if min(samples) == max(samples) else f"{min(samples)} to {max(samples)}"
    )
    rows = {
        "samples per pixel": spread,
        "luminance, mean": f"{means[dark]:.4g} (frame {dark + 1}) to {means[bright]:.4g} "
        f"(frame {bright + 1}) cd/m²",
        "shown as white": f"{numbers['white_luminance_cd_m2']:.4g} cd/m² in all frames",
    }
    if None not in errors:
        rows["relative error, rms"] = f"{100 * min(errors):.2g} to {100 * max(errors):.2g} %"
    return rows

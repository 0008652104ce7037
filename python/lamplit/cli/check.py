# SPDX-License-Identifier: Apache-2.0 OR MIT
"""``lamplit check``: is this scene sound?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from lamplit.cli.options import SceneArgument, SetOption
from lamplit.cli.overrides import overrides, scene_file
from lamplit.printable import printable

if TYPE_CHECKING:
    from lamplit.scene import Report, Scene

_STYLES = {"error": "bold red", "warning": "yellow", "notice": "cyan"}


def check(scene: SceneArgument, set_: SetOption = None) -> None:
    """Check SCENE: meshes, normals, touching and overlapping bodies, spectra, memory.

    Exit code 0: sound; 1: it cannot be rendered as it stands; 2: it cannot be read.
    """
    from lamplit.scene import check_scene, load_scene

    loaded = load_scene(scene_file(scene), overrides=overrides(assignments=set_ or ()))
    report = check_scene(loaded)
    _tell(loaded, report)
    if not report.sound:
        raise typer.Exit(1)


def _tell(scene: Scene, report: Report) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console(highlight=False, soft_wrap=True)
    objects = Table(box=None, header_style="bold", pad_edge=False)
    for heading in ("object", "kind", "material", "triangles", "closed"):
        objects.add_column(heading, justify="right" if heading == "triangles" else "left")
    for thing in scene.objects_as_read:
        mesh = thing.mesh
        count, closed = (
            ("", "")
            if mesh is None
            else (
                f"{len(mesh.triangles):,}".replace(",", " "),
                "yes" if mesh.closed else f"no, {mesh.open_edges} open edges",
            )
        )
        objects.add_row(
            Text(printable(thing.name)),
            thing.kind,
            Text(printable(thing.material_name)),
            count,
            closed,
        )
    console.print(objects)
    console.print()
    for finding in report.findings:
        level = Text(f"{finding.level:8}", style=_STYLES[finding.level])
        console.print(level, Text(printable(f"{finding.subject}: {finding.message}")))
    memory = report.memory
    console.print(
        f"memory   about {memory.total_bytes / 2**20:.0f} MiB: meshes "
        f"{memory.meshes_bytes / 2**20:.1f}, tracer {memory.tracer_bytes / 2**20:.1f}, "
        f"picture {memory.film_bytes / 2**20:.1f}, program {memory.base_bytes / 2**20:.0f}"
    )
    counts = [sum(f.level == level for f in report.findings) for level in _STYLES]
    verdict = "sound" if report.sound else "not sound"
    tally = ", ".join(
        f"{count} {level}{'' if count == 1 else 's'}"
        for level, count in zip(_STYLES, counts, strict=True)
    )
    console.print(Text(verdict, style="bold green" if report.sound else "bold red"), f"({tally})")

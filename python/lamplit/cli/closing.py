# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The last words of a command: a short table, and the files to open."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lamplit.engine.image import Image


def show_results(
    image: Image, numbers: Mapping[str, str], directory: Path, files: Mapping[str, str]
) -> None:
    """Print ``numbers`` about ``image``, and ``files`` in ``directory`` with what is in each."""
    from rich.console import Console
    from rich.markup import escape

    console = Console(highlight=False, soft_wrap=True)
    console.print(f"\n[bold]{escape(_heading(image))}[/bold]")
    for title, lines in (("", numbers), (f"Files in {directory}", files)):
        if title:
            console.print(f"\n{escape(title)}")
        width = max(map(len, lines), default=0) + 3
        for name, text in lines.items():
            console.print(f"  {escape(name.ljust(width))}[dim]{escape(text)}[/dim]")
    for warning in warnings(image.statistics):
        console.print(f"\n[yellow]warning: {escape(warning)}[/yellow]")
    if not image.complete:
        console.print(
            f"\n[yellow]stopped with {image.samples} of {image.samples_asked} samples per pixel; "
            "what is done is in the files[/yellow]"
        )


def warnings(statistics: Mapping[str, Any]) -> list[str]:
    """Return what a user must know of a render that went wrong in places."""
    found: list[str] = []
    dropped = statistics.get("dropped_samples", 0)
    if dropped:
        found.append(f"{dropped} samples were not finite and were dropped; please report it")
    lost = {body: count for body, count in statistics.get("lost_rays", {}).items() if count}
    if lost:
        bodies = ", ".join(f"{count} in {body}" for body, count in lost.items())
        found.append(f"rays were lost ({bodies}); lamplit check finds open or overlapping bodies")
    return found


def _heading(image: Image) -> str:
    samples = f"{image.samples} sample" + ("s" if image.samples != 1 else "")
    return (
        f"{image.scene.name or 'Scene'}: {image.width} × {image.height}, {samples} per pixel, "
        f"{image.elapsed_s:.1f} s"
    )

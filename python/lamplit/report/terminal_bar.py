# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The bar of a terminal, with a line of details below it."""

from __future__ import annotations

from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from rich.progress import Progress as Bar


def terminal_bar(stream: TextIO) -> Bar:
    """Return a bar on ``stream`` whose tasks have the fields ``left`` and ``detail``."""
    from collections.abc import Iterable

    from rich.console import Console, RenderableType
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn
    from rich.progress import Progress as Bar
    from rich.text import Text

    class _BarAndDetails(Bar):
        def get_renderables(self) -> Iterable[RenderableType]:
            yield self.make_tasks_table(self.tasks)
            for task in self.tasks:
                yield Text(f"  {task.fields['detail']}", style="dim")

    return _BarAndDetails(
        TextColumn("{task.description}"),
        BarColumn(bar_width=None, complete_style="red", finished_style="bright_red"),
        TaskProgressColumn(),
        TextColumn("{task.fields[left]}"),
        console=Console(file=stream),
        auto_refresh=False,
        expand=True,
    )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How the library's contents are listed: a line of numbers, and below it where they come from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

#: Spaces before the text below a line of numbers.
_INDENT = 4


def print_listing(
    console: Console,
    titles: Sequence[str],
    entries: Sequence[tuple[Sequence[str], Sequence[str]]],
) -> None:
    """Print ``entries``, each a row of cells under ``titles`` and paragraphs of text below it.

    The first two columns are set to the left, the numbers after them to the right.
    """
    from rich.padding import Padding
    from rich.text import Text

    widths = [
        max(len(title), *(len(cells[at]) for cells, _ in entries))
        for at, title in enumerate(titles)
    ]

    def line(cells: Sequence[str]) -> str:
        set_out = [
            cell.ljust(width) if at < 2 else cell.rjust(width)
            for at, (cell, width) in enumerate(zip(cells, widths, strict=True))
        ]
        return "  ".join(set_out)

    console.print(Text(line(titles), style="bold"))
    for cells, paragraphs in entries:
        console.print(Text(line(cells)), soft_wrap=True)
        for paragraph in filter(None, paragraphs):
            console.print(Padding(Text(paragraph, style="dim"), (0, 0, 0, _INDENT)))

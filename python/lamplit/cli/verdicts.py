# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What is printed of a measurement: a table of each function and reflector, then the verdicts."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lamplit.report.photometry.results import Results

#: In a log, a table of findings has this width at least: narrower ones break every line of it.
_TABLE_WIDTH = 120


def print_verdicts(results: Results) -> None:
    """Print the table of each function, and below all of them the verdicts."""
    from rich.console import Console
    from rich.text import Text

    from lamplit.cli.closing import shown
    from lamplit.printable import printable
    from lamplit.report.photometry.reflected import reflector_table
    from lamplit.report.photometry.style import MARKS
    from lamplit.report.photometry.table import STYLES, findings_table, in_words, spots_table

    console = Console(highlight=False, soft_wrap=True)
    if not console.is_terminal:
        console.width = max(console.width, _TABLE_WIDTH)
    for one in results.functions:
        console.print(f"\n[bold]{shown(one.name)}[/bold]", end="")
        if one.verdict is None:
            console.print(": no rule, nothing is judged\n")
            console.print(spots_table(one.observed))
            continue
        chosen = "" if not one.verdict.production else ", conformity of production"
        console.print(f": {shown(one.verdict.title)}, {shown(one.verdict.rule)}{chosen}\n")
        console.print(findings_table(one, width=console.width))
    for one in results.reflectors:
        rule = "no rule, nothing is judged"
        if one.verdict is not None:
            chosen = "" if not one.verdict.production else ", conformity of production"
            rule = f"{shown(one.verdict.title)}, {shown(one.verdict.rule)}{chosen}"
        console.print(f"\n[bold]{shown(one.name)}[/bold]: {rule}\n")
        console.print(reflector_table(one))
    console.print()
    for name, verdict in results.verdicts():
        mark = MARKS[verdict.outcome]
        word = Text(f"{mark.sign} {mark.word:10}", style=STYLES[verdict.outcome])
        console.print(word, Text(printable(f"{name}: {in_words(verdict)}")))
    notices = [note for _, verdict in results.verdicts() for note in verdict.notices]
    for notice in dict.fromkeys([*results.notices, *notices]):
        console.print(f"[cyan]notice: {shown(notice)}[/cyan]")

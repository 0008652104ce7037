# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The parts of a page that are generated, between two comments that name them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

_SECTION = re.compile(
    r"(?P<begin><!-- generated: (?P<name>[\w-]+) -->\n).*?(?P<end><!-- end of generated -->)",
    re.DOTALL,
)


def refreshed(page: Path, sections: Mapping[str, str]) -> str:
    """Return the text of ``page`` with each of ``sections`` in its place.

    Raises:
        ValueError: The page lacks a place for a section, or has one that nothing fills.
    """
    text = page.read_text(encoding="utf-8")
    places = [match["name"] for match in _SECTION.finditer(text)]
    if sorted(places) != sorted(sections):
        raise ValueError(f"{page}: has places for {places} and gets {list(sections)}")
    return _SECTION.sub(
        lambda match: f"{match['begin']}\n{sections[match['name']]}\n\n{match['end']}", text
    )


def table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table; columns whose cells are all numbers stand to the right."""
    cells = [[_cell(text) for text in row] for row in rows]
    numeric = [
        all(re.fullmatch(r"[-–\d.,≥≤ %]*", row[at]) for row in cells) for at in range(len(headings))
    ]
    rule = ["---:" if right else "---" for right in numeric]
    return "\n".join(f"| {' | '.join(row)} |" for row in [list(headings), rule, *cells])


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")

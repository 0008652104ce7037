# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Makes what is generated in docs/ again: ``make docs``.

``python docs/make.py --tables`` leaves the pictures and the numbers that need a render as they
are; ``--check`` writes nothing and fails if a table or the API page is out of date.
"""

from __future__ import annotations

import sys
from pathlib import Path

from builders.api_page import api_page
from builders.library_tables import lamp_sections, material_sections
from builders.scene_tables import scene_sections
from builders.sections import refreshed

DOCS = Path(__file__).parent


def main(arguments: list[str]) -> int:
    """Run with the words of the command line; return the exit code."""
    pages = _quick_pages()
    if "--check" in arguments:
        stale = [path for path, text in pages.items() if path.read_text(encoding="utf-8") != text]
        for path in stale:
            print(f"{path} is out of date: make docs", file=sys.stderr)
        return 1 if stale else 0
    if "--tables" not in arguments:
        pages |= _rendered_pages()
    for path, text in pages.items():
        path.write_text(text, encoding="utf-8")
        print(f"written: {path}")
    return 0


def _quick_pages() -> dict[Path, str]:
    """Return the pages whose generated parts need no render."""
    return {
        DOCS / "api.md": api_page(),
        DOCS / "scene.md": refreshed(DOCS / "scene.md", scene_sections()),
        DOCS / "materials.md": refreshed(DOCS / "materials.md", material_sections()),
        DOCS / "lamps.md": refreshed(DOCS / "lamps.md", lamp_sections()),
    }


def _rendered_pages() -> dict[Path, str]:
    """Draw all pictures, and return the page whose numbers are measured on renders."""
    from builders.failures import compared, failures_table, pairs_table
    from builders.metamers import write_metamers
    from builders.pictures import draw_pictures

    images = DOCS / "images"
    images.mkdir(exist_ok=True)
    write_metamers(DOCS / "scenes")
    outcomes = compared(DOCS / "scenes")
    draw_pictures(images, outcomes)
    page = DOCS / "rgb-against-spectral.md"
    sections = {"patches": failures_table(outcomes), "pairs": pairs_table(outcomes)}
    return {page: refreshed(page, sections)}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What the pages say is so: generated tables are fresh, links lead somewhere, commands exist."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from lamplit.cli import main
from lamplit.cli.commands import COMMANDS

ROOT = Path(__file__).parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")])
FENCED = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")


def anchors(page: Path) -> set[str]:
    """Return the names that a heading of the page can be linked by, as GitHub makes them."""
    headings = re.findall(r"^#+ (.+)$", FENCED.sub("", page.read_text("utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def broken_links(page: Path) -> Iterator[str]:
    for target in LINK.findall(FENCED.sub("", page.read_text("utf-8"))):
        if re.match(r"[a-z]+:", target):
            continue
        file, _, anchor = target.partition("#")
        place = (page.parent / file).resolve() if file else page
        if not place.exists() or (anchor and anchor not in anchors(place)):
            yield target


def commands_of(text: str) -> Iterator[list[str]]:
    """Yield the words of each `lamplit` command line: in shell blocks, and between backticks."""
    lines = [
        line for kind, block in FENCED.findall(text) if kind == "sh" for line in block.splitlines()
    ]
    lines += re.findall(r"`([^`\n]+)`", FENCED.sub("", text))
    for line in lines:
        if re.match(r"lamplit (-|[a-z]+( |$))", line):
            yield shlex.split(line, comments=True)[1:]


def faults_of(words: list[str], capsys: pytest.CaptureFixture[str]) -> Iterator[str]:
    """Yield what the help of the command does not know of its words."""
    name = "" if words[0].startswith("-") else words[0]
    if name and name not in COMMANDS:
        yield f"no command {name}"
        return
    capsys.readouterr()
    assert main([*([name] if name else []), "--help"]) == 0
    known = set(re.findall(r"(?<![\w-])--?[a-z][\w-]*", capsys.readouterr().out))
    for word in words:
        option = word.strip("[]").partition("=")[0]
        if option.startswith("-") and option not in known:
            yield f"{name} has no {option}"


def test_generated_tables_are_fresh() -> None:
    """``make docs`` makes them again."""
    made = subprocess.run(
        [sys.executable, str(ROOT / "docs" / "make.py"), "--check"],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert made.returncode == 0, made.stderr


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_within_the_project_leads_somewhere(page: Path) -> None:
    assert list(broken_links(page)) == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_command_line_is_one_that_the_program_knows(
    page: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    commands = list(commands_of(page.read_text("utf-8")))
    assert commands or page.name != "README.md"
    assert [fault for words in commands for fault in faults_of(words, capsys)] == []


def test_a_missing_page_option_or_anchor_is_found(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "page.md"
    page.write_text("# One\n[a](#one) [b](#two) [c](gone.md) [d](https://example.org/gone.md)\n")
    assert list(broken_links(page)) == ["#two", "gone.md"]
    text = "```sh\nlamplit render a -o b --sampels 4  # c\nlamplit rendr a\n```\n`lamplit = 1`"
    faults = [fault for words in commands_of(text) for fault in faults_of(words, capsys)]
    assert faults == ["render has no --sampels", "no command rendr"]

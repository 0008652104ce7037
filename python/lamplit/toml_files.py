# SPDX-License-Identifier: Apache-2.0 OR MIT
"""TOML files of a stranger: read with bounds on their size and depth, faults in one line."""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

from lamplit.errors import LamplitError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

_MOST_BYTES = 8 * 2**20
#: Levels of tables and lists that are read.
DEEPEST = 16
#: Begun at the start of a word only, these look at each character a bounded number of times.
_LONG_CHAIN = re.compile(rf"(?<![\w\"'-])(?:[\w\"'-]+[ \t]*\.[ \t]*){{{4 * DEEPEST}}}")
_OPEN_BRACKETS = re.compile(rf"(?:[\[{{][ \t\r\n]*){{{4 * DEEPEST}}}")


def read_toml(file: Path, *, noun: str, error: type[LamplitError]) -> dict[str, Any]:
    """Return the tables of the TOML file ``file``; ``noun`` says what it should be.

    Raises:
        LamplitError: Of the kind ``error``: the file cannot be read, is too large or too deep, or
            is not sound TOML; with the line where there is one.
    """
    try:
        written = _read(file, noun, error)
    except RecursionError:
        raise _too_deep(file, noun, error) from None
    check_depth(written, file, noun=noun, error=error)
    return written


def _read(file: Path, noun: str, error: type[LamplitError]) -> dict[str, Any]:
    try:
        if not file.is_file():
            raise error(
                "this is not a file" if file.exists() else "this file does not exist", file=file
            )
        size = file.stat().st_size
        if size > _MOST_BYTES:
            raise error(
                f"a {noun} file of {size} bytes is too large; keep tables of measured values in "
                "files of their own",
                file=file,
            )
        text = file.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise error(f"this is not UTF-8 text: {fault.reason}", file=file) from fault
    except (OSError, ValueError) as fault:
        raise error(f"the file cannot be read: {fault}", file=file) from fault
    if "\0" in text:
        raise error("this is not a text file", file=file)
    if _LONG_CHAIN.search(text) or _OPEN_BRACKETS.search(text):
        raise _too_deep(file, noun, error)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as fault:
        raise _toml_fault(fault, file, error) from fault
    except ValueError as fault:
        raise error(f"a value cannot be read: {str(fault).partition(';')[0]}", file=file) from fault


def _toml_fault(fault: Exception, file: Path, error: type[LamplitError]) -> LamplitError:
    found = re.search(r"\(at line (\d+), column (\d+)\)", str(fault))
    message = re.sub(r" \(at [^)]*\)", "", str(fault))[:200]
    where = f"line {found[1]}, column {found[2]}" if found else "last line"
    return error(f"this is not sound TOML: {message}", file=file, where=where)


def _too_deep(file: Path | None, noun: str, error: type[LamplitError]) -> LamplitError:
    return error(f"the {noun} is nested too deep; {DEEPEST} levels are read at most", file=file)


def check_depth(
    written: Mapping[str, object], file: Path | None, *, noun: str, error: type[LamplitError]
) -> None:
    """Refuse tables that are nested deeper than `DEEPEST`.

    Raises:
        LamplitError: Of the kind ``error``.
    """
    level: list[object] = [written]
    for _ in range(DEEPEST):
        level = [
            child
            for value in level
            for child in (
                cast("Mapping[str, object]", value).values()
                if isinstance(value, Mapping)
                else cast("list[object]", value)
            )
            if isinstance(child, (Mapping, list, tuple))
        ]
        if not level:
            return
    raise _too_deep(file, noun, error)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Eye points from a file: ``[[eyes]]`` in TOML, or a table of numbers."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated

from pydantic import Field, ValidationError

from lamplit.errors import SceneError
from lamplit.scene.eyes import MOST_FRAMES, Eye
from lamplit.scene.fields import Table
from lamplit.table_faults import table_fault
from lamplit.toml_files import read_toml

_MOST_BYTES = 2**20
_SEPARATOR = re.compile(r"\s*[;,\t]\s*|\s+")
_DECIMAL_COMMA = re.compile(r"(?<=\d),(?=\d)")
_NUMBER_LIKE = re.compile(r"[-+.\d]|nan\b|inf\b", re.IGNORECASE)


class _EyeFile(Table):
    eyes: Annotated[tuple[Eye, ...], Field(strict=False, max_length=MOST_FRAMES)] = Field(
        description="the places, in their order"
    )


def read_eyes(path: Path) -> list[Eye]:
    """Return the eye points in ``path``: TOML with ``[[eyes]]`` if it ends so, else a table.

    A row of the table has x, y and z of the eye in mm, and on request x, y and z of what is in the
    middle of its picture. Columns part at commas, semicolons, tabs or blanks; a decimal
    comma is understood where semicolons, tabs or blanks part them. ``#`` starts a comment, and one
    header line may come first.

    Raises:
        SceneError: The file cannot be read as that or holds no eye; the message names the line.
    """
    eyes = _from_toml(path) if path.suffix.lower() == ".toml" else _from_table(path)
    if not eyes:
        raise SceneError("there is no eye point in this file; one is the least", file=path)
    return eyes


def _from_toml(path: Path) -> list[Eye]:
    written = read_toml(path, noun="eye point", error=SceneError)
    try:
        return list(_EyeFile.model_validate(written).eyes)
    except ValidationError as fault:
        message, where = table_fault(fault, written, _EyeFile.model_json_schema())
        raise SceneError(message, file=path, where=where or None) from None


def _from_table(path: Path) -> list[Eye]:
    eyes: list[Eye] = []
    header_allowed = True
    for number, line in enumerate(_text(path).splitlines(), start=1):
        row = line.partition("#")[0].strip()
        if not row:
            continue
        if header_allowed and not _NUMBER_LIKE.match(row):
            header_allowed = False
            continue
        header_allowed = False
        try:
            eyes.append(_eye(row))
        except ValueError as fault:
            raise SceneError(_reason(fault), file=path, where=f"line {number}") from fault
        if len(eyes) > MOST_FRAMES:
            raise SceneError(
                f"these are more than {MOST_FRAMES} eye points", file=path, where=f"line {number}"
            )
    return eyes


def _eye(row: str) -> Eye:
    if _SEPARATOR.search(row.replace(",", "")) and "," not in _DECIMAL_COMMA.sub("", row):
        row = _DECIMAL_COMMA.sub(".", row)
    columns = [column.strip("\"' ") for column in _SEPARATOR.split(row)]
    if len(columns) not in (3, 6):
        raise ValueError(
            "x, y and z of the eye in mm are expected, and x, y and z of its target if it has one "
            f"of its own; here are {len(columns)} columns"
        )
    numbers = [_number(column) for column in columns]
    return Eye.model_validate(
        {"position_mm": tuple(numbers[:3]), "target_mm": tuple(numbers[3:]) or None}
    )


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{text[:40]!r} is not a number") from None


def _reason(fault: ValueError) -> str:
    if isinstance(fault, ValidationError):
        first = fault.errors()[0]
        return f"{first['input']:g} is no coordinate in mm"
    return str(fault)


def _text(path: Path) -> str:
    try:
        if not path.is_file():
            raise SceneError(
                "this is not a file" if path.exists() else "this file does not exist", file=path
            )
        if path.stat().st_size > _MOST_BYTES:
            raise SceneError("a list of eye points is not as large as this file", file=path)
        return path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise SceneError("this is no UTF-8 text; save the list as CSV", file=path) from fault
    except (OSError, ValueError) as fault:
        raise SceneError(f"the file cannot be read: {fault}", file=path) from fault

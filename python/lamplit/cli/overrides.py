# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Options that stand in for values of the scene file."""

from __future__ import annotations

import re
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from lamplit.cli.options import Method
from lamplit.errors import LamplitError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

_KEY = re.compile(r"^[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+|\[\d+\])*$")
_SIZE = re.compile(r"^(\d{1,6})[xX×](\d{1,6})$")


def overrides(
    *,
    assignments: Sequence[str] = (),
    method: Method | None = None,
    samples: int | None = None,
    seed: int | None = None,
    size: str | None = None,
) -> dict[str, Any]:
    """Return ``{"image.samples": 4, ...}`` for `lamplit.scene.load_scene`.

    ``assignments`` are ``key.path=value`` with the value in TOML; a bare word is a string.

    >>> overrides(assignments=["camera.field_of_view_deg=30.0", "image.filter=box"], size="64x40")
    {'camera.field_of_view_deg': 30.0, 'image.filter': 'box', 'image.width': 64, 'image.height': 40}

    Raises:
        LamplitError: An assignment or the size cannot be read.
    """
    found = dict(_assignment(text) for text in assignments)
    if size is not None:
        match = _SIZE.match(size)
        if match is None:
            raise LamplitError(
                f"{size!r} is no size; write width x height, such as 640x400", where="--size"
            )
        found |= {"image.width": int(match[1]), "image.height": int(match[2])}
    named = {
        "image.method": None if method is None else method.value,
        "image.samples": samples,
        "image.seed": seed,
    }
    return found | {key: value for key, value in named.items() if value is not None}


def command_line(arguments: Sequence[str]) -> str:
    """Return the command that a user would type to run ``arguments`` (``sys.argv``) again."""
    return shlex.join(["lamplit", *arguments[1:]])


def _assignment(text: str) -> tuple[str, Any]:
    key, equals, value = text.partition("=")
    key, value = key.strip(), value.strip()
    if not equals or not value or _KEY.match(key) is None:
        raise LamplitError(
            f"{text!r} is no assignment; write key.path=value, such as image.samples=16",
            where="--set",
        )
    try:
        table = tomllib.loads(f"value = {value}")
        if set(table) == {"value"}:
            return key, table["value"]
    except (tomllib.TOMLDecodeError, RecursionError):
        if re.fullmatch(r"[\w.+/ -]+", value):
            return key, value
    raise LamplitError(
        f"{value[:40]!r} is no TOML value; put text in quotes, such as --set 'name=\"my lamp\"'",
        where=f"--set {key}",
    )


def scene_file(path: Path) -> Path:
    """Return ``path``, or the ``scene.toml`` in it when it is a folder."""
    return path / "scene.toml" if path.is_dir() else path

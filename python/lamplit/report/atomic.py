# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What results are written with: whole files, JSON, and a place that is proved writable."""

from __future__ import annotations

import json
import os
import secrets
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from lamplit.atomic import refusal, replacing, write_bytes
from lamplit.errors import OutputError

__all__ = ["prepare_output", "replacing", "write_bytes", "write_json"]


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """Write ``content`` as indented JSON with strict numbers (no NaN), whole or not at all."""
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
    write_bytes(path, (text + "\n").encode())


def prepare_output(directory: Path, names: Iterable[str] = ()) -> None:
    """Make ``directory`` and prove, before any work is done, that ``names`` can be written in it.

    Raises:
        OutputError: The directory cannot be made or written, or a name is taken by a directory.
    """
    probe = directory / f".lamplit.{secrets.token_hex(4)}.part"
    try:
        directory.mkdir(parents=True, exist_ok=True)
        try:
            with probe.open("xb") as file:
                file.write(b"\0" * 4096)
                file.flush()
                os.fsync(file.fileno())
        finally:
            with suppress(OSError):
                probe.unlink()
    except OSError as fault:
        raise refusal(directory, fault) from fault
    for name in names:
        if (directory / name).is_dir():
            raise OutputError(
                "a directory stands where a result must go; move it, or choose another -o",
                file=directory / name,
            )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Files that are either whole or not there: temporary file, fsync, rename."""

from __future__ import annotations

import json
import os
import secrets
from collections.abc import Generator, Iterable, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from lamplit.errors import OutputError


@contextmanager
def replacing(path: Path) -> Generator[Path]:
    """Give a new file beside ``path`` to write to; it takes the place of ``path`` at the end.

    Whatever goes wrong, an older file at ``path`` stays as it was and nothing half-written is
    left behind. The new file is on the disk (fsync) before it takes the name.

    Raises:
        OutputError: The file cannot be made, written, or renamed.
    """
    partial = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    try:
        os.close(os.open(partial, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
        yield partial
        _flush(partial)
        partial.replace(path)
        with suppress(OSError):
            _flush(path.parent)
    except OSError as fault:
        raise _refusal(path, fault) from fault
    finally:
        with suppress(OSError):
            partial.unlink()


def write_bytes(path: Path, content: bytes) -> None:
    """Write ``content`` to ``path``, whole or not at all."""
    with replacing(path) as partial:
        partial.write_bytes(content)


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
        raise _refusal(directory, fault) from fault
    for name in names:
        if (directory / name).is_dir():
            raise OutputError(
                "a directory stands where a result must go; move it, or choose another -o",
                file=directory / name,
            )


def _flush(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _refusal(path: Path, fault: OSError) -> OutputError:
    reason = (fault.strerror or str(fault)).lower()
    return OutputError(f"cannot be written ({reason}); free it, or choose another -o", file=path)

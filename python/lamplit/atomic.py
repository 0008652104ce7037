# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Files that are either whole or not there: temporary file, fsync, rename."""

from __future__ import annotations

import os
import secrets
from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path

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
        raise refusal(path, fault) from fault
    finally:
        with suppress(OSError):
            partial.unlink()


def write_bytes(path: Path, content: bytes) -> None:
    """Write ``content`` to ``path``, whole or not at all."""
    with replacing(path) as partial:
        partial.write_bytes(content)


def _flush(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def refusal(path: Path, fault: OSError) -> OutputError:
    """Return what to say where ``path`` cannot be written."""
    reason = (fault.strerror or str(fault)).lower()
    return OutputError(f"cannot be written ({reason}); free it, or choose another -o", file=path)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A binary file whose every read is held against the bytes that are there."""

from __future__ import annotations

import struct
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO, Final

import numpy as np
from numpy.typing import NDArray

from lamplit.photometry.text import PhotometryError

#: More rays than this are refused: 100 million take 7 GB.
MOST_RAYS: Final = 100_000_000


class BinaryFile:
    """A file open for reading, which knows how much of it is left."""

    def __init__(self, path: Path, stream: BinaryIO, size: int) -> None:
        self.path = path
        self.size = size
        self._stream = stream
        self.at = 0

    @property
    def left(self) -> int:
        """Bytes that have not been read."""
        return self.size - self.at

    def fault(self, message: str, at: int | None = None) -> PhotometryError:
        """Return an error at a byte of the file; by default at the next one."""
        return PhotometryError(
            message, file=self.path, where=f"byte {self.at if at is None else at}"
        )

    def take(self, count: int, what: str) -> bytes:
        """Return the next ``count`` bytes.

        Raises:
            PhotometryError: Fewer are there; nothing of that size is made before it is known.
        """
        if count > self.left:
            raise self.fault(
                f"the file ends too early: {count} bytes are due for {what}, and {self.left} are "
                "there; get the file anew"
            )
        content = self._stream.read(count)
        if len(content) != count:
            raise self.fault(f"the file shrank while {what} was read; try again")
        self.at += count
        return content

    def unpack(self, layout: str, what: str) -> tuple[Any, ...]:
        """Return the next values, little-endian and without gaps, by a layout of `struct`."""
        return struct.unpack(f"<{layout}", self.take(struct.calcsize(f"<{layout}"), what))

    def rows(self, count: int, columns: int) -> NDArray[np.float32]:
        """Return the rest of the file as ``count`` rows of float32, (count, columns).

        Raises:
            PhotometryError: There are no rows, too many, or not as many bytes as they take.
        """
        if count == 0:
            raise self.fault("the header promises no rays, so nothing shines; get another file")
        due = 4 * columns * count
        if due != self.left:
            raise self.fault(
                f"the header promises {count} rays of {4 * columns} bytes, which take {due}, and "
                f"{self.left} bytes are there; get the file anew"
            )
        if count > MOST_RAYS:
            raise self.fault(
                f"{count} rays are too many; {MOST_RAYS} is the limit. Export fewer: a million "
                "serve most lamps"
            )
        values = np.frombuffer(self.take(due, "the rays"), dtype="<f4")
        return values.reshape(count, columns)


@contextmanager
def opened(path: Path) -> Generator[BinaryFile]:
    """Give the regular file ``path``; faults of the disk become a PhotometryError."""
    try:
        if not path.is_file():
            raise PhotometryError("there is no such file; check the name", file=path)
        with path.open("rb") as stream:
            yield BinaryFile(path, stream, path.stat().st_size)
    except OSError as fault:
        raise PhotometryError(f"cannot be read: {fault.strerror}", file=path) from fault

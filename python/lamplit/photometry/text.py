# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Photometric files as lines, words and numbers that know where they stand."""

from __future__ import annotations

import math
import re
from array import array
from bisect import bisect_right
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import LamplitError

#: Larger files are refused before they are read.
MAX_BYTES: Final = 64 * 2**20

#: More angles, planes or lamps than this are no count.
MOST_ANGLES: Final = 1_000_000

#: No luminaire reaches it, in candela; what does is a damaged number.
_MOST_CANDELA = 1e15

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)


class PhotometryError(LamplitError):
    """A photometric file cannot be used."""


def read_lines(path: Path) -> list[str]:
    """Return the lines of a text file, without their ends; line n of the file is item n − 1.

    Both formats are ASCII by their standards; names in UTF-8 or in Western European code pages are
    met all the same, and only numbers matter here. A Ctrl-Z at the end, as DOS wrote it, is
    dropped.

    Raises:
        PhotometryError: The file cannot be read, is too large, or is not text of one byte a letter.
    """
    try:
        if not path.is_file():
            raise PhotometryError("there is no such file; check the name", file=path)
        size = path.stat().st_size
        if size > MAX_BYTES:
            raise PhotometryError(
                f"{size / 2**20:.0f} MB is too large for a photometric file; "
                f"{MAX_BYTES // 2**20} MB is the limit",
                file=path,
            )
        with path.open("rb") as stream:
            content = stream.read(size)
    except OSError as fault:
        raise PhotometryError(f"cannot be read: {fault.strerror}", file=path) from fault
    if b"\0" in content or content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise PhotometryError(
            "this is no plain text (it may be UTF-16); save it as ASCII or UTF-8", file=path
        )
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("latin-1")
    return text.rstrip("\x1a\r\n\t ").replace("\r\n", "\n").replace("\r", "\n").split("\n")


def number_of(word: str) -> float:
    """Return a finite number as the formats write it; ValueError for ``nan``, ``1_0`` and the like.

    >>> number_of("1.5e2")
    150.0
    """
    if _NUMBER.fullmatch(word) is None or not math.isfinite(number := float(word)):
        raise ValueError(f"{word[:40]!r} is not a number")
    return number


class Numbers:
    """The numbers of some lines of a file, in their order; blanks and commas part them.

    ``lines`` are pairs of a line's number, from 1, and its text.

    Raises:
        PhotometryError: A word is not a finite number.
    """

    def __init__(self, file: Path, lines: Iterator[tuple[int, str]]) -> None:
        self.file = file
        self._values = array("d")
        self._starts: list[int] = []
        self._line_numbers: list[int] = []
        self._at = 0
        for number, line in lines:
            if words := line.replace(",", " ").split():
                self._starts.append(len(self._values))
                self._line_numbers.append(number)
                try:
                    self._values.extend(map(number_of, words))
                except ValueError as fault:
                    raise self.fault(f"{fault}; mend that value", number) from fault

    def fault(self, message: str, line: int | None = None) -> PhotometryError:
        """Return an error at ``line``, or at that of the number taken last."""
        if line is None:
            line = self.line_of(max(0, self._at - 1))
        return PhotometryError(message, file=self.file, where=f"line {line}" if line else None)

    def line_of(self, index: int) -> int:
        """Return the line of a number by its index; 0 if there are no numbers."""
        at = bisect_right(self._starts, index) - 1
        return self._line_numbers[at] if at >= 0 else 0

    @property
    def left(self) -> int:
        """How many numbers have not been taken."""
        return len(self._values) - self._at

    def take(self, count: int, what: str) -> NDArray[np.float64]:
        """Return the next ``count`` numbers.

        Raises:
            PhotometryError: The file has fewer; nothing of that size is made before it is known.
        """
        if count > self.left:
            taken, self._at = self._at, len(self._values)
            raise self.fault(
                f"the file ends too early: {count} numbers are due for {what}, and "
                f"{len(self._values) - taken} are there; get the file anew or mend its counts"
            )
        self._at += count
        return np.array(self._values[self._at - count : self._at], dtype=np.float64)

    def one(self, what: str) -> float:
        """Return the next number."""
        return float(self.take(1, what)[0])

    def count(self, what: str, *, least: int) -> int:
        """Return the next number, a whole one from ``least`` to ``MOST_ANGLES``."""
        number = self.one(what)
        if number != int(number) or not least <= number <= MOST_ANGLES:
            raise self.fault(
                f"{what} must be a whole number from {least} to {MOST_ANGLES}, not {number:g}"
            )
        return int(number)

    def angles(self, count: int, what: str, low: float, high: float) -> NDArray[np.float64]:
        """Return the next ``count`` numbers as angles in degrees that rise within the bounds."""
        start = self._at
        angles = self.take(count, what)
        if (np.diff(angles) <= 0.0).any():
            at = int(np.argmax(np.diff(angles) <= 0.0))
            raise self.fault(
                f"{what} must rise, and {angles[at + 1]:g}° follows {angles[at]:g}°; "
                "sort them, or mend the counts in the header",
                self.line_of(start + at + 1),
            )
        if angles[0] < low or angles[-1] > high:
            at = 0 if angles[0] < low else count - 1
            raise self.fault(
                f"{what} lie between {low:g}° and {high:g}° here, and {angles[at]:g}° does not",
                self.line_of(start + at),
            )
        return angles

    def candela(self, planes: int, angles: int, scale: float) -> NDArray[np.float64]:
        """Return the last numbers, (planes, angles), times ``scale``, as intensities in cd."""
        start, due = self._at, planes * angles
        values = self.take(due, f"{planes} × {angles} intensities")
        with np.errstate(over="ignore", invalid="ignore"):
            values *= scale
        wrong = (values < 0.0) | ~(values <= _MOST_CANDELA)
        if wrong.any():
            at = int(np.argmax(wrong))
            raise self.fault(
                f"an intensity of {values[at]:g} cd cannot be; mend that value",
                self.line_of(start + at),
            )
        if self.left:
            raise self.fault(
                f"{self.left} numbers follow the {planes} × {angles} intensities that the header "
                "promises; mend its counts",
                self.line_of(self._at),
            )
        if not values.any():
            raise self.fault("every intensity is 0, so nothing shines; get another file")
        return values.reshape(planes, angles)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Measured spectra from files: two-column text, and IES TM-27 (``.spdx``)."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple
from xml.parsers import expat

import numpy as np

from lamplit.errors import SpectrumError

#: Larger files are refused before they are read.
MAX_BYTES = 64 * 2**20

#: A step this many times the usual one, and this wide, is a hole in the measurement.
_GAP_FACTOR = 4.0
_GAP_NM = 20.0

_SEPARATOR = re.compile(r"\s*[;,\t]\s*|\s+")
_NUMBER_LIKE = re.compile(r"[-+.\d]|nan\b|inf\b", re.IGNORECASE)
_DECIMAL_COMMA = re.compile(r"(?<=\d),(?=\d)")


class Table(NamedTuple):
    """Wavelengths in nm and a value for each."""

    wavelengths_nm: tuple[float, ...]
    values: tuple[float, ...]


def check_table(table: Table, *, gaps_allowed: bool, file: Path | None = None) -> None:
    """Refuse a table that no measurement would give.

    Raises:
        SpectrumError: Too few points, wavelengths that do not rise, that are not in nm, or that
            leave a hole (when ``gaps_allowed`` is false), or a number that is not finite.
    """
    nm, values = np.array(table.wavelengths_nm), np.array(table.values)
    if nm.size == 0 and values.size == 0:
        raise SpectrumError("the spectrum is empty; give at least two points", file=file)
    if nm.size != values.size or nm.size < 2:
        raise SpectrumError(
            f"as many values as wavelengths are expected, two at least; here are {nm.size} "
            f"wavelengths and {values.size} values",
            file=file,
        )
    if not (np.isfinite(nm).all() and np.isfinite(values).all()):
        raise SpectrumError("a number is not finite; mend or remove that point", file=file)
    steps = np.diff(nm)
    if (steps <= 0).any():
        at = int(np.argmax(steps <= 0))
        raise SpectrumError(
            f"wavelengths must rise, and {nm[at + 1]:g} nm follows {nm[at]:g} nm; "
            "sort the table and remove repeated points",
            file=file,
        )
    if nm[0] <= 0 or nm[-1] < 100:
        raise SpectrumError(
            f"wavelengths are in nm, and {nm[0]:g} to {nm[-1]:g} cannot be; "
            "a table in micrometres needs its wavelengths times 1000",
            file=file,
        )
    hole = steps > max(_GAP_NM, _GAP_FACTOR * float(np.median(steps)))
    if hole.any() and not gaps_allowed:
        at = int(np.argmax(hole))
        raise SpectrumError(
            f"nothing is given between {nm[at]:g} and {nm[at + 1]:g} nm; add the missing points, "
            'or accept the gap by stating interpolation = "linear" or "cubic"',
            file=file,
        )


def read_csv(path: Path) -> Table:
    """Return the table of a text file with two columns, wavelength in nm and value.

    Columns part at commas, semicolons, tabs or blanks; a decimal comma is understood where
    semicolons, tabs or blanks part the columns. ``#`` starts a comment, and one header line may
    come before the numbers.

    Raises:
        SpectrumError: A line is not two finite numbers, wavelengths do not rise, or the file is
            too large, not text, or cannot be read. The message names the file and the line.
    """
    try:
        text = _read(path).decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise SpectrumError("this is no UTF-8 text; save the table as CSV", file=path) from fault
    wavelengths: list[float] = []
    values: list[float] = []
    header_allowed = True
    for number, line in enumerate(text.splitlines(), start=1):
        row = line.partition("#")[0].strip()
        if not row:
            continue
        try:
            nm, value = _two_numbers(row)
        except ValueError as fault:
            if header_allowed and not _NUMBER_LIKE.match(row):
                header_allowed = False
                continue
            raise SpectrumError(str(fault), file=path, where=f"line {number}") from fault
        header_allowed = False
        if wavelengths and nm <= wavelengths[-1]:
            raise SpectrumError(
                f"wavelengths must rise, and {nm:g} nm follows {wavelengths[-1]:g} nm; "
                "sort the table and remove repeated rows",
                file=path,
                where=f"line {number}",
            )
        wavelengths.append(nm)
        values.append(value)
    if len(wavelengths) < 2:
        raise SpectrumError(
            f"two rows of 'wavelength nm, value' are the least, and here are {len(wavelengths)}",
            file=path,
        )
    return Table(tuple(wavelengths), tuple(values))


def read_spdx(path: Path) -> Table:
    """Return the table of an IES TM-27 file.

    Document type declarations are refused, and with them every entity, so that a file can neither
    name another nor grow. Source: ANSI/IES TM-27-14, "IES Standard Format for the Electronic
    Transfer of Spectral Data".

    Raises:
        SpectrumError: The XML is broken or has a DTD, or is no TM-27 document, or a value is not a
            finite number. The message names the file and the line.
    """
    reader = _SpdxReader(path)
    content = _read(path)
    try:
        reader.parser.Parse(content, True)
    except expat.ExpatError as fault:
        raise SpectrumError(
            f"the XML is broken: {expat.ErrorString(fault.code)}",
            file=path,
            where=f"line {fault.lineno}",
        ) from fault
    except (LookupError, ValueError) as fault:
        raise SpectrumError(f"the XML is broken: {fault}", file=path, where="line 1") from fault
    if not reader.seen_root or len(reader.wavelengths) < 2:
        raise SpectrumError(
            "this is no IES TM-27 file: an IESTM2714 element with SpectralData is expected",
            file=path,
        )
    rows = sorted(zip(reader.wavelengths, reader.values, strict=True))
    return Table(tuple(nm for nm, _ in rows), tuple(value for _, value in rows))


class _SpdxReader:
    """Collects the SpectralData of a TM-27 document from expat's events."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.wavelengths: list[float] = []
        self.values: list[float] = []
        self.seen_root = False
        self._text: list[str] | None = None
        self.parser = expat.ParserCreate()
        self.parser.StartDoctypeDeclHandler = self._refuse_dtd
        self.parser.StartElementHandler = self._start
        self.parser.CharacterDataHandler = self._characters
        self.parser.EndElementHandler = self._end

    def _fault(self, message: str) -> SpectrumError:
        line = f"line {self.parser.CurrentLineNumber}"
        return SpectrumError(message, file=self.path, where=line)

    def _refuse_dtd(self, *_: object) -> None:
        raise self._fault("a document type declaration is not accepted; remove the <!DOCTYPE ...>")

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        local = name.rpartition(":")[2]
        self.seen_root = self.seen_root or local == "IESTM2714"
        if local != "SpectralData":
            return
        self.wavelengths.append(self._number(attributes.get("wavelength", "")))
        self._text = []

    def _characters(self, text: str) -> None:
        if self._text is not None:
            self._text.append(text)

    def _end(self, name: str) -> None:
        if self._text is not None and name.rpartition(":")[2] == "SpectralData":
            self.values.append(self._number("".join(self._text)))
            self._text = None

    def _number(self, text: str) -> float:
        try:
            return _finite(text)
        except ValueError as fault:
            raise self._fault(f"SpectralData: {fault}") from fault


def _read(path: Path) -> bytes:
    try:
        size = path.stat().st_size
        if size > MAX_BYTES:
            raise SpectrumError(
                f"{size / 2**20:.0f} MB is too large for a spectrum; "
                f"{MAX_BYTES // 2**20} MB is the limit",
                file=path,
            )
        with path.open("rb") as stream:
            return stream.read(MAX_BYTES)
    except OSError as fault:
        raise SpectrumError(f"cannot be read: {fault.strerror}", file=path) from fault


def _two_numbers(row: str) -> tuple[float, float]:
    if _SEPARATOR.search(row.replace(",", "")) and not _DECIMAL_COMMA.sub("", row).count(","):
        row = _DECIMAL_COMMA.sub(".", row)
    columns = [column.strip("\"' ") for column in _SEPARATOR.split(row)]
    if len(columns) != 2:
        raise ValueError(
            f"two columns are expected, wavelength nm and value, and here are {len(columns)}"
        )
    return _finite(columns[0]), _finite(columns[1])


def _finite(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        raise ValueError(f"{text[:40]!r} is not a number") from None
    if not np.isfinite(number):
        raise ValueError(f"{text.strip()[:40]!r} is not a finite number")
    return number

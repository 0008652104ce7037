# SPDX-License-Identifier: Apache-2.0 OR MIT
"""IES TM-25 ray files (``.tm25ray``), version 2013.

Little-endian. Of the standard itself (IES TM-25-13) only the clause numbers were at hand; the
layout was read in open programs and in notes on makers' files, and was checked as marked:

    byte     what                                                            seen in
    0        "TM25"; int32: version 2013, creation method                    C R P N
    12       float32: total luminous flux lm, total radiant flux W           C R P N
             (NaN or 0: not known)
    20       uint64: number of rays                                          C R P N
    28       28 letters: date and time; int32: where rays start              C R P
    60       int32: spectral data: 0 none, 1 one wavelength, 2 one per ray,  C R P N
             3 one table, 4 a table for each ray
    64       float32: that wavelength, shortest, longest, nm                 C R P N
    76       int32: spectral tables, columns added, bytes of text added      C R P
    88       reserved, to 256                                                C R P
    256      int32, eight flags: position, direction, radiant flux,          C R P N
             wavelength, luminous flux, Stokes, tristimulus, spectrum index
    288      nine texts of 1000 UTF-32 letters: name, maker, ...             C R P N
    36288    each table: int32 k, k times (float32 nm, float32 weight);      C R P N
             all tables filled up to a multiple of 32 bytes
    then     names of added columns, 512 bytes each; the added text          P, and R in letters
    then     rays of float32: x y z (mm), cosines, then what the flags name  C R P N
             in this order: radiant flux, wavelength, luminous flux, S1 S2 S3
             and x y z of the polarisation ellipse, X Z, spectrum index
             (from 1), added columns

C: TM25RaySetTools by J. Muschaweck (C++, Unlicense). R: IESTM25RayFiles by L. Boxler (C#,
Unlicense). P: a Python reader of the same layout. N: notes of the tm25ray project on four files of
ams OSRAM with 0.1 to 20 million rays. **They differ in one place**: where the Stokes flag is set,
older readings (R, early C) have three columns, later ones (C, P, N) six; the bytes there decide.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamplit.photometry.rays.binary import BinaryFile, opened
from lamplit.photometry.rays.ray_set import (
    FluxQuantity,
    RayFaults,
    RaySet,
    SpectralTable,
    checked_directions,
    checked_flux,
    checked_positions,
    checked_wavelengths,
)

VERSION: Final = 2013
TEXTS: Final = 9
TEXT_BYTES: Final = 4000
COLUMN_NAME_BYTES: Final = 512
HEADER: Final = "2i2fQ28s2i3f3i168x"
_FLAGS = (
    *("position", "direction", "radiant flux", "wavelength"),
    *("luminous flux", "Stokes", "tristimulus", "spectrum index"),
)


class _Header(NamedTuple):
    version: int
    creation_method: int
    luminous_flux_lm: float
    radiant_flux_w: float
    rays: int
    created: bytes
    start_position: int
    spectral_data: int
    wavelength_nm: float
    shortest_nm: float
    longest_nm: float
    tables: int
    added_columns: int
    added_text_bytes: int


def read_tm25(path: Path) -> RaySet:
    """Return the rays of an IES TM-25 file; its lengths are mm.

    The flux is luminous where the file has it, unless each ray has a wavelength or a spectrum of
    its own; it is radiant otherwise. Polarisation, X and Z, and added columns are passed over.

    Raises:
        PhotometryError: The file is none, is damaged, or holds a ray that cannot be.
    """
    with opened(path) as file:
        if (magic := file.take(4, "the mark TM25")) != b"TM25":
            raise file.fault(f"a TM-25 file begins with 'TM25', and this one with {magic!r}", 0)
        header = _read_header(file)
        flags = _read_flags(file, header)
        name = _text(file.take(TEXT_BYTES, "the name of the source"))
        file.take(TEXT_BYTES * (TEXTS - 1), "the descriptions")
        tables = _read_tables(file, header.tables)
        if header.added_columns * COLUMN_NAME_BYTES > file.left:
            raise file.fault(
                f"{header.added_columns} names of added columns are due, and {file.left} bytes are "
                "there; get the file anew"
            )
        file.take(header.added_columns * COLUMN_NAME_BYTES, "the names of added columns")
        file.take(header.added_text_bytes, "the added text")
        begins = file.at
        columns = _columns(file, header, flags)
        rows = file.rows(header.rays, columns.total)
    faults = RayFaults(path, lambda ray: begins + 4 * columns.total * ray)
    return _ray_set(
        header=header,
        flags=flags,
        columns=columns,
        rows=rows,
        tables=tables,
        name=name,
        faults=faults,
    )


def _read_header(file: BinaryFile) -> _Header:
    header = _Header(*file.unpack(HEADER, "the header"))
    if header.version != VERSION:
        raise file.fault(
            f"version {header.version} of TM-25 is not known; export the file as {VERSION}", 4
        )
    for at, flux in ((12, header.luminous_flux_lm), (16, header.radiant_flux_w)):
        if flux < 0.0 or math.isinf(flux):
            raise file.fault(f"a total flux of {flux:g} cannot be; get the file anew", at)
    if not 0 <= header.spectral_data <= 4:
        raise file.fault(
            f"the kind of spectral data is 0 to 4, not {header.spectral_data}; get the file anew",
            60,
        )
    for at, count, what in (
        (76, header.tables, "spectral tables"),
        (80, header.added_columns, "added columns"),
        (84, header.added_text_bytes, "bytes of added text"),
    ):
        if count < 0:
            raise file.fault(f"there are {count} {what}, which cannot be; get the file anew", at)
    return header


def _read_flags(file: BinaryFile, header: _Header) -> dict[str, bool]:
    begins = file.at
    values = file.unpack("8i", "the flags")
    for at, (name, value) in enumerate(zip(_FLAGS, values, strict=True)):
        if value not in (0, 1):
            raise file.fault(f"the flag of {name} is 0 or 1, not {value}", begins + 4 * at)
    flags = {name: value == 1 for name, value in zip(_FLAGS, values, strict=True)}
    needs = {
        "position": True,
        "direction": True,
        "wavelength": header.spectral_data == 2,
        "spectrum index": header.spectral_data == 4,
    }
    for name, needed in needs.items():
        if needed and not flags[name]:
            raise file.fault(
                f"the rays have no {name}, which they need here; export them with it",
                begins + 4 * _FLAGS.index(name),
            )
    if not (flags["radiant flux"] or flags["luminous flux"]):
        raise file.fault(
            "the rays have no flux, radiant or luminous; export them with it", begins + 8
        )
    if header.spectral_data in (3, 4) and header.tables == 0:
        raise file.fault(
            f"spectral data of the kind {header.spectral_data} need a table, and there is none", 76
        )
    return flags


def _read_tables(file: BinaryFile, count: int) -> tuple[SpectralTable, ...]:
    if 12 * count > file.left:
        raise file.fault(
            f"{count} spectral tables are due, and {file.left} bytes are there; get the file anew"
        )
    tables: list[SpectralTable] = []
    begins = file.at
    for number in range(1, count + 1):
        at = file.at
        (points,) = file.unpack("i", f"spectral table {number}")
        if points < 1:
            raise file.fault(f"spectral table {number} has {points} points; get the file anew", at)
        pairs = np.frombuffer(file.take(8 * points, f"spectral table {number}"), dtype="<f4")
        nm, weights = pairs.astype(np.float64).reshape(points, 2).T
        if not (np.isfinite(pairs).all() and (nm > 0.0).all() and (np.diff(nm) > 0.0).all()):
            raise file.fault(f"the wavelengths of spectral table {number} must rise above 0", at)
        if (weights < 0.0).any() or not weights.any():
            raise file.fault(
                f"the weights of spectral table {number} must be 0 or more, and not all 0", at
            )
        tables.append(SpectralTable(nm, weights))
    file.take(-(file.at - begins) % 32, "the end of the spectral tables")
    return tuple(tables)


class _Columns(NamedTuple):
    """Where in a ray each quantity stands; -1 where it does not."""

    radiant: int
    wavelength: int
    luminous: int
    spectrum: int
    total: int


def _columns(file: BinaryFile, header: _Header, flags: dict[str, bool]) -> _Columns:
    total = 6
    places: dict[str, int] = {}
    for name in ("radiant flux", "wavelength", "luminous flux"):
        places[name] = total if flags[name] else -1
        total += flags[name]
    after = 2 * flags["tristimulus"] + flags["spectrum index"]
    stokes = 6 * flags["Stokes"]
    if stokes and file.left == 4 * header.rays * (total + 3 + after + header.added_columns):
        stokes = 3
    total += stokes + after
    index = total - 1 if flags["spectrum index"] else -1
    return _Columns(
        places["radiant flux"],
        places["wavelength"],
        places["luminous flux"],
        index,
        total + header.added_columns,
    )


def _ray_set(
    *,
    header: _Header,
    flags: dict[str, bool],
    columns: _Columns,
    rows: NDArray[np.float32],
    tables: tuple[SpectralTable, ...],
    name: str,
    faults: RayFaults,
) -> RaySet:
    own_spectra = header.spectral_data in (2, 4)
    luminous = flags["luminous flux"] and not (own_spectra and flags["radiant flux"])
    quantity: FluxQuantity = "luminous" if luminous else "radiant"
    flux = rows[:, columns.luminous if luminous else columns.radiant].astype(np.float64)
    wavelengths = None
    if header.spectral_data == 2:
        nm = rows[:, columns.wavelength].astype(np.float64)
        wavelengths = checked_wavelengths(nm, "nm", faults)
    elif header.spectral_data == 1:
        nm = np.full(len(rows), header.wavelength_nm)
        wavelengths = checked_wavelengths(nm, "nm", faults)
    return RaySet(
        checked_positions(rows[:, :3].astype(np.float64), 1.0, faults),
        checked_directions(rows[:, 3:6].astype(np.float64), faults),
        checked_flux(flux, faults),
        quantity,
        wavelengths,
        tables if header.spectral_data in (3, 4) else (),
        _indices(rows[:, columns.spectrum], len(tables), faults) if columns.spectrum >= 0 else None,
        header.luminous_flux_lm if header.luminous_flux_lm > 0.0 else None,
        header.radiant_flux_w if header.radiant_flux_w > 0.0 else None,
        1.0,
        name,
    )


def _indices(column: NDArray[np.float32], tables: int, faults: RayFaults) -> NDArray[np.intp]:
    numbers = column.astype(np.float64)
    known = (numbers >= 1.0) & (numbers <= tables) & (numbers == np.floor(numbers))
    faults.refuse_where(
        ~known,
        f"the spectrum {{value}} is none of the {tables} tables of the file; get the file anew",
        numbers,
    )
    return numbers.astype(np.intp) - 1


def _text(content: bytes) -> str:
    return content.decode("utf-32-le", "replace").partition("\0")[0].strip()

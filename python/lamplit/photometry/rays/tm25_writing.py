# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Writing IES TM-25 ray files; `lamplit.photometry.rays.tm25` has the layout."""

from __future__ import annotations

import math
import struct
from pathlib import Path
from typing import Literal

import numpy as np

from lamplit.atomic import replacing
from lamplit.photometry.rays.ray_set import RaySet
from lamplit.photometry.rays.tm25 import HEADER, TEXT_BYTES, TEXTS, VERSION
from lamplit.photometry.text import PhotometryError

_CREATION = {"simulation": 0, "measurement": 1}
_LETTERS = TEXT_BYTES // 4 - 1

#: Rays that are turned into bytes at a time.
_BLOCK = 2**18


def write_tm25(
    path: Path,
    rays: RaySet,
    *,
    creation: Literal["simulation", "measurement"] = "simulation",
    created: str = "",
) -> None:
    """Write ``rays`` as an IES TM-25 file, whole or not at all.

    The total is their sum. ``created`` is a date and time of ISO 8601, at most 28 letters.

    Raises:
        OutputError: The file cannot be written.
        PhotometryError: Luminous rays have wavelengths, which the format does not allow.
    """
    radiant = rays.quantity == "radiant"
    kind = _spectral_data(rays)
    if kind in (2, 4) and not radiant:
        raise PhotometryError("rays with spectra of their own need a flux in W", file=path)
    nan = math.nan
    nm = rays.wavelengths_nm
    ends = (nan, nan) if nm is None else (float(nm.min()), float(nm.max()))
    if rays.spectra:
        ends = (
            min(float(table.wavelengths_nm[0]) for table in rays.spectra),
            max(float(table.wavelengths_nm[-1]) for table in rays.spectra),
        )
    head = struct.pack(
        f"<4s{HEADER}",
        b"TM25",
        VERSION,
        _CREATION[creation],
        nan if radiant else rays.total_flux,
        rays.total_flux if radiant else nan,
        rays.count,
        created.encode("ascii", "replace"),
        0,
        kind,
        nan,
        *ends,
        len(rays.spectra),
        0,
        0,
    )
    flags = struct.pack("<8i", 1, 1, radiant, kind == 2, not radiant, 0, 0, kind == 4)
    name = rays.description[:_LETTERS].encode("utf-32-le")
    with replacing(path) as partial, partial.open("wb") as stream:
        stream.write(head + flags + name.ljust(TEXT_BYTES * TEXTS, b"\0") + _tables(rays))
        for first in range(0, rays.count, _BLOCK):
            stream.write(_block(rays, slice(first, first + _BLOCK)))


def _spectral_data(rays: RaySet) -> int:
    if rays.wavelengths_nm is not None:
        return 2
    if rays.spectrum_index is not None:
        return 4
    return 3 if rays.spectra else 0


def _tables(rays: RaySet) -> bytes:
    content = b"".join(
        struct.pack("<i", len(table.weights))
        + np.column_stack([table.wavelengths_nm, table.weights]).astype("<f4").tobytes()
        for table in rays.spectra
    )
    return content + bytes(-len(content) % 32)


def _block(rays: RaySet, which: slice) -> bytes:
    columns = [rays.positions_mm[which], rays.directions[which], rays.flux[which, None]]
    if rays.wavelengths_nm is not None:
        columns.append(rays.wavelengths_nm[which, None])
    elif rays.spectrum_index is not None:
        columns.append(rays.spectrum_index[which, None].astype(np.float64) + 1.0)
    return np.concatenate(columns, axis=1).astype("<f4").tobytes()

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Zemax OpticStudio's binary source files (``.dat`` and ``.sdf``).

Little-endian: a header of 208 bytes, then rays of float32.

    byte   what
    0      int32: 1010 (older: 8675309); uint32: number of rays
    8      100 letters: description
    108    float32: SourceFlux, RaySetFlux, Wavelength (µm, 0 for a mixture),
           inclination from and to, azimuth from and to (degrees)
    136    int32: unit of length: 0 m, 1 in, 2 cm, 3 ft, 4 mm
    140    float32: place, rotation, scale (three each), four not used
    192    int32: ray format (0 flux, 2 flux and wavelength), flux type (0 W, 1 lm), two reserved
    208    rays: x y z, direction cosines l m n, flux; with format 2 a wavelength in µm

OpticStudio uses of the header the number of rays, the unit, the ray format and the flux type only;
so does Lamplit: place, rotation and the header's wavelength are passed over.

Source: the vendor's article on converting such files to text, and its help on source files, for the
fields up to ``RaySetFlux`` and both identifiers; TM25RaySetTools by J. Muschaweck (C++, Unlicense),
which quotes the help of OpticStudio 19.4, p. 657, for the rest; pyspeos by Ansys (Python, MIT)
writes the same 208 bytes and µm.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from lamplit.photometry.rays.binary import BinaryFile, opened
from lamplit.photometry.rays.ray_set import (
    RayFaults,
    RaySet,
    checked_directions,
    checked_flux,
    checked_positions,
    checked_wavelengths,
)

_HEADER: Final = "iI100s7fi13f4i"
_HEADER_BYTES: Final = 208
_IDENTIFIERS: Final = (1010, 8675309)
#: Millimetres in the units of the header.
_UNITS_MM: Final = (1000.0, 25.4, 10.0, 304.8, 1.0)


class _Header(NamedTuple):
    rays: int
    description: str
    ray_set_flux: float
    unit_mm: float
    spectral: bool
    luminous: bool


def read_zemax(path: Path) -> RaySet:
    """Return the rays of a binary source file of Zemax OpticStudio.

    Raises:
        PhotometryError: The file is none, is text, is damaged, or holds a ray that cannot be.
    """
    with opened(path) as file:
        header = _read_header(file)
        columns = 8 if header.spectral else 7
        rows = file.rows(header.rays, columns)
    faults = RayFaults(path, lambda ray: _HEADER_BYTES + 4 * columns * ray)
    wavelengths = None
    if header.spectral:
        nm = 1000.0 * rows[:, 7].astype(np.float64)
        wavelengths = checked_wavelengths(nm, "µm", faults)
    stated = header.ray_set_flux if header.ray_set_flux > 0.0 else None
    return RaySet(
        checked_positions(rows[:, :3].astype(np.float64), header.unit_mm, faults),
        checked_directions(rows[:, 3:6].astype(np.float64), faults),
        checked_flux(rows[:, 6].astype(np.float64), faults),
        "luminous" if header.luminous else "radiant",
        wavelengths,
        stated_flux_lm=stated if header.luminous else None,
        stated_flux_w=None if header.luminous else stated,
        unit_mm=header.unit_mm,
        description=header.description,
    )


def _read_header(file: BinaryFile) -> _Header:
    first = file.take(min(4, file.left), "the identifier")
    if int.from_bytes(first, "little") not in _IDENTIFIERS:
        if first and all(byte in b"0123456789 \t\r\n" for byte in first):
            raise file.fault(
                "this is a source file in text, and binary ones are read; save it as binary", 0
            )
        raise file.fault(
            f"a binary source file of Zemax begins with {_IDENTIFIERS[0]}, and this one with "
            f"{int.from_bytes(first, 'little')}; check the format",
            0,
        )
    rays, description, *numbers = file.unpack(_HEADER[1:], "the header")
    unit, ray_format, flux_type = numbers[7], numbers[21], numbers[22]
    if not 0 <= unit < len(_UNITS_MM):
        raise file.fault(
            f"the unit of length is 0 (m), 1 (in), 2 (cm), 3 (ft) or 4 (mm), not {unit}", 136
        )
    if ray_format not in (0, 2):
        raise file.fault(
            f"the ray format is 0 (flux) or 2 (flux and wavelength), not {ray_format}", 192
        )
    if flux_type not in (0, 1):
        raise file.fault(f"the flux type is 0 (W) or 1 (lm), not {flux_type}", 196)
    if ray_format == 2 and flux_type == 1:
        raise file.fault("rays with wavelengths have their flux in W, and lm is stated", 196)
    told = bytes(description).partition(b"\0")[0].decode("latin-1").strip()
    return _Header(rays, told, numbers[1], _UNITS_MM[unit], ray_format == 2, flux_type == 1)

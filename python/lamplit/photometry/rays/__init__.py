# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Ray files: the light of a source as rays, each with its start, direction and flux."""

from __future__ import annotations

from pathlib import Path

from lamplit.photometry.rays.ray_set import FluxQuantity, RaySet, SpectralTable
from lamplit.photometry.rays.tm25 import read_tm25
from lamplit.photometry.rays.tm25_writing import write_tm25
from lamplit.photometry.rays.zemax import read_zemax
from lamplit.photometry.text import PhotometryError

__all__ = [
    "RAY_FORMATS",
    "FluxQuantity",
    "RaySet",
    "SpectralTable",
    "read_rays",
    "read_tm25",
    "read_zemax",
    "write_tm25",
]

#: The reader for each suffix.
_READERS = {".tm25ray": read_tm25, ".dat": read_zemax, ".sdf": read_zemax}

RAY_FORMATS = tuple(_READERS)


def read_rays(path: Path) -> RaySet:
    """Return the rays of an IES TM-25 (``.tm25ray``) or Zemax binary (``.dat``, ``.sdf``) file.

    Raises:
        PhotometryError: The suffix is another, or the file is not what its suffix says; the message
            names the file, the byte or the ray, and what to do.
    """
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise PhotometryError(
            f"the suffix {path.suffix!r} is none of {', '.join(RAY_FORMATS)}; ask the maker of the "
            "source for its TM-25 file, or name the file by its format",
            file=path,
        )
    return reader(path)

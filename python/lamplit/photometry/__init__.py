# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Luminous intensity distributions from files: IES LM-63 and EULUMDAT."""

from __future__ import annotations

from pathlib import Path

from lamplit.photometry.distribution import PhotometricType, Photometry, PolarTable
from lamplit.photometry.ies import read_ies
from lamplit.photometry.ldt import read_ldt
from lamplit.photometry.text import PhotometryError

__all__ = [
    "FORMATS",
    "PhotometricType",
    "Photometry",
    "PhotometryError",
    "PolarTable",
    "read_photometry",
]

#: The reader for each suffix.
_READERS = {".ies": read_ies, ".ldt": read_ldt}

FORMATS = tuple(_READERS)


def read_photometry(path: Path) -> Photometry:
    """Return the intensities of an IES LM-63 (``.ies``) or EULUMDAT (``.ldt``) file.

    Raises:
        PhotometryError: The suffix is another, or the file is not what its suffix says; the message
            names the file, the line where there is one, and what to do.
    """
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise PhotometryError(
            f"the suffix {path.suffix!r} is none of {', '.join(FORMATS)}; "
            "name the file by its format",
            file=path,
        )
    return reader(path)

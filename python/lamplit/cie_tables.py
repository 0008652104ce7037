# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The CIE's published tables: observers and illuminants, from CSV files in the package.

The numbers are colour-science's (BSD-3-Clause; its notice stands in THIRD_PARTY.md), written by
``tools/make_cie_tables.py``: reading them takes milliseconds, importing that library a second.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

_FOLDER = Path(__file__).parent / "cie"


@dataclass(frozen=True, eq=False)
class CieTable:
    """Wavelengths in nm (n,), rising, and the values (n,) of each column by its name."""

    wavelengths_nm: NDArray[np.float64]
    columns: Mapping[str, NDArray[np.float64]]


@cache
def cie_table(name: str) -> CieTable:
    """Return the table ``name``: an observer such as ``cie-1931-2``, ``daylights`` or ``lamps``.

    >>> float(cie_table("daylights").columns["D65"][52])  # at 560 nm
    100.0
    """
    text = (_FOLDER / f"{name}.csv").read_text(encoding="utf-8")
    head, *rows = (line.split(",") for line in text.splitlines() if not line.startswith("#"))
    numbers = np.array([[float(word) for word in row] for row in rows])
    numbers.flags.writeable = False
    nm, *columns = numbers.T
    return CieTable(nm, dict(zip(head[1:], columns, strict=True)))

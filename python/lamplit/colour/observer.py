# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The CIE's standard observers: colour-matching functions x̄, ȳ, z̄."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.cie_tables import cie_table
from lamplit.errors import LamplitError, nearest_name

#: The observers by name: CIE 1931 2°, CIE 1964 10°, CIE 2015 2° (cone-fundamental based).
OBSERVERS = ("cie-1931-2", "cie-1964-10", "cie-2015-2")


def colour_matching_functions(observer: str, wavelengths_nm: ArrayLike) -> NDArray[np.float64]:
    """Return x̄, ȳ, z̄ of ``observer`` at ``wavelengths_nm`` (n,), as an array (n, 3).

    Between the CIE's values, given each nm, straight lines; zero outside the tables (360–830 nm,
    for 2015 390–830 nm), where the CIE gives none and the eye sees next to nothing.
    Source: CIE 018:2019 and ISO/CIE 11664-1:2019; CIE 170-2:2015.

    Raises:
        LamplitError: There is no such observer.
    """
    if observer not in OBSERVERS:
        raise LamplitError(
            f"there is no observer {observer!r}{nearest_name(observer, OBSERVERS)}; "
            f"choose one of {', '.join(OBSERVERS)}"
        )
    table = cie_table(observer)
    nm = np.asarray(wavelengths_nm, dtype=np.float64)
    functions = [
        np.interp(nm, table.wavelengths_nm, values, left=0.0, right=0.0)
        for values in table.columns.values()
    ]
    return np.stack(functions, axis=-1)

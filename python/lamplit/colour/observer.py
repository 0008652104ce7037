# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The CIE's standard observers: colour-matching functions x̄, ȳ, z̄."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.errors import LamplitError, nearest_name

#: The observers by name: CIE 1931 2°, CIE 1964 10°, CIE 2015 2° (cone-fundamental based).
OBSERVERS = ("cie-1931-2", "cie-1964-10", "cie-2015-2")

_TITLES = {
    "cie-1931-2": "CIE 1931 2 Degree Standard Observer",
    "cie-1964-10": "CIE 1964 10 Degree Standard Observer",
    "cie-2015-2": "CIE 2015 2 Degree Standard Observer",
}


def colour_matching_functions(observer: str, wavelengths_nm: ArrayLike) -> NDArray[np.float64]:
    """Return x̄, ȳ, z̄ of ``observer`` at ``wavelengths_nm`` (n,), as an array (n, 3).

    Between the CIE's values, given each nm, straight lines; zero outside the tables (360–830 nm,
    for 2015 390–830 nm), where the CIE gives none and the eye sees next to nothing.
    Source: CIE 018:2019 and ISO/CIE 11664-1:2019; CIE 170-2:2015.

    Raises:
        LamplitError: There is no such observer.
    """
    nm = np.asarray(wavelengths_nm, dtype=np.float64)
    table_nm, table = _table(observer)
    columns = [np.interp(nm, table_nm, table[:, i], left=0.0, right=0.0) for i in range(3)]
    return np.stack(columns, axis=-1)


@cache
def _table(observer: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    if observer not in OBSERVERS:
        raise LamplitError(
            f"there is no observer {observer!r}{nearest_name(observer, OBSERVERS)}; "
            f"choose one of {', '.join(OBSERVERS)}"
        )
    import colour

    functions = colour.MSDS_CMFS[_TITLES[observer]]
    return (
        np.asarray(functions.wavelengths, dtype=np.float64),
        np.asarray(functions.values, dtype=np.float64),
    )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From linear RGB to smooth spectra, for pictures whose spectra nobody measured.

What comes of it is *derived from RGB*: it has the right colour under D65, and one of endlessly many
spectra of that colour. The idea is I. Mallett and C. Yuksel's, "Spectral Primary Decomposition for
Rendering with sRGB Reflectance", EGSR 2019; the numbers are this project's own, of
``tools/make_uplift_basis.py``.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

_FILE = Path(__file__).parent / "uplift-d65.csv"


def basis(wavelengths_nm: ArrayLike) -> NDArray[np.float64]:
    """Return the spectra B_r, B_g, B_b at ``wavelengths_nm`` (n,), as an array (n, 3).

    r B_r + g B_g + b B_b is the spectral reflectance, or the factor on a source S, for linear RGB
    with the primaries of sRGB (Rec. ITU-R BT.709). The three are nowhere negative and sum to 1 at
    each wavelength, so RGB in [0, 1] gives values in [0, 1], and grey is flat. Of all such spectra
    with the right colours they have the least squared slope. Under D65, summed over the middles of
    the nanometres from 380 to 780 nm, they give back XYZ to 1e-6 of white (over whole nanometres,
    to 1e-4); (1, 1, 1) is the white of S itself.

    Nodes stand 5 nm apart, joined by straight lines. Below 380 and above 780 nm the values at the
    ends go on.

    >>> basis([450.0, 550.0, 650.0]).round(2).tolist()
    [[0.02, 0.0, 0.98], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]
    """
    nodes_nm, values = _table()
    nm = np.asarray(wavelengths_nm, dtype=np.float64)
    red, green = (np.interp(nm, nodes_nm, values[:, column]) for column in (0, 1))
    # Where two of them are at 0 and 1, rounding must not take the third below zero.
    return np.stack([red, green, np.maximum(0.0, 1.0 - red - green)], axis=-1)


@cache
def _table() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the nodes in nm (81,) and the values there (81, 3)."""
    lines = _FILE.read_text(encoding="utf-8").splitlines()
    rows = [line.split(",") for line in lines if line[:1].isdigit()]
    numbers = np.array([[float(word) for word in row] for row in rows])
    numbers.flags.writeable = False
    return numbers[:, 0], numbers[:, 1:]

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Two reflectances of one colour under D65, for docs/scenes/metamers.toml."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lamplit.colour.observer import colour_matching_functions
from lamplit.sources import source
from lamplit.spectrum import Array

_NM = np.arange(380.0, 781.0, 10.0)


def write_metamers(folder: Path) -> None:
    """Write metamer-a.csv, a brown paint, and metamer-b.csv, which is it and a metameric black.

    A metameric black is a function that eq. (1) takes to X = Y = Z = 0 under D65: what is left of
    any function after its projection on the three weightings S x̄, S ȳ, S z̄. Here it is what is left
    of S x̄ under illuminant A, which X under A answers most. Source: G. Wyszecki, Farbe 2 (1953) 39.
    """
    daylight, tungsten = (_weightings(name) for name in ("D65", "A"))
    red = tungsten[:, 0]
    black = red - daylight @ np.linalg.lstsq(daylight, red)[0]
    paint = 0.20 + 0.30 / (1.0 + np.exp(-(_NM - 575.0) / 32.0))
    other = paint + 0.15 * black / np.abs(black).max()
    for letter, values in (("a", paint), ("b", other)):
        _write(folder / f"metamer-{letter}.csv", values)


def _weightings(name: str) -> Array:
    """Return S x̄, S ȳ, S z̄, (n, 3), as they weigh values that straight lines join."""
    between = np.arange(380.5, 780.0, 1.0)
    joined = np.stack([np.interp(between, _NM, unit) for unit in np.eye(len(_NM))])
    functions = colour_matching_functions("cie-1931-2", between)
    return joined @ (source(name).distribution()(between)[:, None] * functions)


def _write(path: Path, values: Array) -> None:
    head = "# SPDX-License-Identifier: Apache-2.0 OR MIT\n# made by docs/make.py\n"
    rows = "".join(f"{nm:g}, {value:.7f}\n" for nm, value in zip(_NM, values, strict=True))
    path.write_text(f"{head}wavelength_nm, reflectance\n{rows}", encoding="utf-8")

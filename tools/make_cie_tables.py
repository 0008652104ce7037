# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Write the CIE's tables, as colour-science has them, to python/lamplit/cie/.

Run it when colour-science corrects a value: ``.venv/bin/python tools/make_cie_tables.py``. Each
file is CSV with wavelengths in nm in its first column; `lamplit.cie_tables` reads them, so that a
render need not import colour-science, which takes a second.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TypeAlias

import colour
import numpy as np
from numpy.typing import NDArray

Table: TypeAlias = NDArray[np.float64]

FOLDER = Path(__file__).resolve().parents[1] / "python" / "lamplit" / "cie"

OBSERVERS = {
    "cie-1931-2": ("CIE 1931 2 Degree Standard Observer", "CIE 018:2019, ISO/CIE 11664-1:2019"),
    "cie-1964-10": ("CIE 1964 10 Degree Standard Observer", "CIE 018:2019, ISO/CIE 11664-1:2019"),
    "cie-2015-2": ("CIE 2015 2 Degree Standard Observer", "CIE 170-2:2015"),
}
ILLUMINANTS = {
    "daylights": [f"D{temperature}" for temperature in (50, 55, 65, 75)],
    "lamps": [
        *(f"FL{number}" for number in range(1, 13)),
        *(f"FL3.{number}" for number in range(1, 16)),
        *(f"HP{number}" for number in range(1, 6)),
        *(f"LED-{name}" for name in ("B1", "B2", "B3", "B4", "B5", "BH1", "RGB1", "V1", "V2")),
    ],
}


def tables() -> Iterator[tuple[str, str]]:
    """Yield the name of each file and its text."""
    for name, (title, source) in OBSERVERS.items():
        functions = colour.MSDS_CMFS[title]
        values: Table = functions.values
        what = f"{title}: colour-matching functions. {source}"
        yield f"{name}.csv", _text(what, functions.wavelengths, ["x", "y", "z"], values)
    for name, members in ILLUMINANTS.items():
        spectra = [colour.SDS_ILLUMINANTS[member] for member in members]
        (nm,) = {tuple(spectrum.wavelengths) for spectrum in spectra}
        values = np.stack([spectrum.values for spectrum in spectra], axis=1)
        what = "CIE illuminants: relative spectral power. CIE 015:2018"
        yield f"{name}.csv", _text(what, np.array(nm), members, values)


def _text(what: str, wavelengths_nm: Table, names: list[str], values: Table) -> str:
    rows = np.column_stack([wavelengths_nm, values]).tolist()
    return "\n".join(
        [
            f"# {what}.",
            f"# Numbers of colour-science {colour.__version__}, BSD-3-Clause: see THIRD_PARTY.md.",
            ",".join(["wavelength_nm", *names]),
            *(",".join(map(repr, row)) for row in rows),
            "",
        ]
    )


def main() -> None:
    """Write every table."""
    FOLDER.mkdir(exist_ok=True)
    for name, text in tables():
        (FOLDER / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()

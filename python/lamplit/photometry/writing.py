# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Writing distributions: IES LM-63-2019 of types A, B and C, and EULUMDAT of type C.

Both files are text of one byte a letter with CR LF, written whole or not at all, in absolute
photometry unless the distribution knows the flux of its lamps. Intensities have six significant
digits.

Source: ANSI/IESNA LM-63-2002 for the layout; what 2019 changed, from programs that read it: the
first line ``IES:LM-63-2019``, and after the ballast factor the kind of file, which is 1.00010 for a
computed one (from memory: readers pass over it, and do not agree on its digits). EULUMDAT: A. W.
Stockmar, "EULUMDAT/2", CIBSE National Lighting Conference 1998.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lamplit.atomic import write_bytes
from lamplit.photometry.distribution import Photometry, PolarTable
from lamplit.photometry.measured import resampled_c
from lamplit.photometry.text import PhotometryError

#: Letters in a line of an IES file and of a name in an EULUMDAT file.
_IES_LETTERS: Final = 78
_LDT_LETTERS: Final = 78

_IES_TYPES: Final = {"C": 1, "B": 2, "A": 3}
_SIMULATED: Final = "1.00010"
_DIRECT_RATIOS: Final = 10


@dataclass(frozen=True, kw_only=True)
class FileLabels:
    """What a photometric file says of itself; letters beyond ASCII become question marks."""

    luminaire: str = ""
    manufacturer: str = ""
    catalogue_number: str = ""
    lamp: str = ""
    report: str = ""
    laboratory: str = "computed by Lamplit"
    #: ISO 8601.
    date: str = ""
    #: Further keywords of an IES file, such as ``{"OTHER": "seed 1"}``.
    others: Mapping[str, str] = field(default_factory=dict[str, str])


def write_ies(
    path: Path,
    photometry: Photometry,
    labels: FileLabels = FileLabels(),
    *,
    opening_m: tuple[float, float, float] = (0.0, 0.0, 0.0),
    input_watts: float = 0.0,
) -> None:
    """Write ``photometry`` as an IES LM-63-2019 file of its own type.

    ``opening_m`` are width, length and height of the luminous opening; 0 is a point. Grids of types
    A and B are written as they are, though the standard's go from −90 or 0 to 90.

    Raises:
        PhotometryError: A reader would see another distribution: an intensity is no number of 0 or
            more, or angles of type A or B begin at 0, which means that they are mirrored.
        OutputError: The file cannot be written.
    """
    _check_intensities(path, photometry)
    if photometry.photometric_type != "C":
        for name, angles in (("H", photometry.horizontal_deg), ("V", photometry.vertical_deg)):
            if angles[0] == 0.0:
                raise PhotometryError(
                    f"{name} begins at 0°, and readers would mirror it; give both sides", file=path
                )
    flux = photometry.lamp_flux_lm
    head = (1, -1 if flux is None else _number(flux), 1)
    counts = (photometry.vertical_deg.size, photometry.horizontal_deg.size)
    kind = _IES_TYPES[photometry.photometric_type]
    lines = [
        "IES:LM-63-2019",
        *_keywords(labels),
        "TILT=NONE",
        " ".join(map(str, (*head, *counts, kind, 2, *map(_number, opening_m)))),
        f"1 {_SIMULATED} {_number(input_watts)}",
        *_rows(map(_angle, photometry.vertical_deg)),
        *_rows(map(_angle, photometry.horizontal_deg)),
    ]
    for row in photometry.candela:
        lines += _rows(map(_number, row))
    _write(path, lines)


def write_ldt(
    path: Path,
    photometry: Photometry,
    labels: FileLabels = FileLabels(),
    *,
    plane_step_deg: float = 5.0,
    gamma_step_deg: float = 1.0,
    opening_mm: tuple[float, float, float] = (0.0, 0.0, 0.0),
    input_watts: float = 0.0,
) -> None:
    """Write ``photometry`` as an EULUMDAT file; types A and B are interpolated (`resampled_c`).

    ``opening_mm`` are length, width and height; 0 is a point. A distribution of type C is written
    on its own planes and angles. The ten direct ratios, which are for rooms, are 0.

    Raises:
        PhotometryError: No light: the format counts per 1000 lm. Or an intensity is no number of 0
            or more.
        OutputError: The file cannot be written.
    """
    _check_intensities(path, photometry)
    if photometry.photometric_type != "C":
        photometry = resampled_c(
            photometry, plane_step_deg=plane_step_deg, gamma_step_deg=gamma_step_deg
        )
    own_flux = photometry.flux_lm()
    if not own_flux > 0.0:
        raise PhotometryError(
            "there is no light, and EULUMDAT counts intensities per 1000 lm; no file is written",
            file=path,
        )
    lamps = photometry.lamp_flux_lm
    flux = float(_number(own_flux if lamps is None else lamps))
    planes, gamma = photometry.horizontal_deg[:-1], photometry.vertical_deg
    length, width, height = map(_number, opening_mm)
    downward = 100.0 * _downward_flux(photometry) / own_flux
    output = 100.0 if lamps is None else 100.0 * own_flux / lamps
    name = _plain(labels.luminaire)[:_LDT_LETTERS]
    lines = [
        _plain(labels.manufacturer or labels.laboratory)[:_LDT_LETTERS],
        *("3", "0", str(planes.size), _step(np.append(planes, 360.0))),
        *(str(gamma.size), _step(gamma)),
        *(_plain(labels.report)[:_LDT_LETTERS], name),
        *(_plain(labels.catalogue_number)[:_LDT_LETTERS], _plain(path.name)[:_LDT_LETTERS]),
        _plain(f"{labels.date} {labels.laboratory}")[:_LDT_LETTERS],
        *(length, width, height, length, width, height, height, height, height),
        *(_number(downward), _number(output), "1", "0", "1"),
        *("-1" if lamps is None else "1", _plain(labels.lamp)[:_LDT_LETTERS], _number(flux)),
        *("0", "0", _number(input_watts), *["0"] * _DIRECT_RATIOS),
        *map(_angle, planes),
        *map(_angle, gamma),
        *(_number(value) for row in photometry.candela[:-1] for value in row * (1000.0 / flux)),
    ]
    _write(path, lines)


def _keywords(labels: FileLabels) -> Iterator[str]:
    standard = {
        "TEST": labels.report,
        "TESTLAB": labels.laboratory,
        "ISSUEDATE": labels.date,
        "MANUFAC": labels.manufacturer,
        "LUMCAT": labels.catalogue_number,
        "LUMINAIRE": labels.luminaire,
        "LAMP": labels.lamp,
    }
    for keyword, text in {**standard, **labels.others}.items():
        width = _IES_LETTERS - len(keyword) - 8
        first, *more = textwrap.wrap(_plain(text), width) or ["none"]
        yield f"[{keyword}] {first}"
        yield from (f"[MORE] {part}" for part in more)


def _check_intensities(path: Path, photometry: Photometry) -> None:
    table = photometry.candela
    if not (np.isfinite(table).all() and (table >= 0.0).all()):
        at = np.argwhere(~(np.isfinite(table) & (table >= 0.0)))[0]
        raise PhotometryError(
            f"the intensity at {photometry.horizontal_deg[at[0]]:g}°, "
            f"{photometry.vertical_deg[at[1]]:g}° is {table[tuple(at)]:g} cd, "
            "and a file holds numbers of 0 or more",
            file=path,
        )


def _downward_flux(photometry: Photometry) -> float:
    """Return the flux in lm towards γ from 0 to 90, exact for the bilinear table."""
    table = photometry.polar
    low = table.polar_deg <= 90.0
    polar, candela = table.polar_deg[low], table.candela[:, low]
    if polar.size < table.polar_deg.size and polar[-1] < 90.0:
        after = table.polar_deg[polar.size]
        share = (90.0 - polar[-1]) / (after - polar[-1])
        edge = (1.0 - share) * candela[:, -1] + share * table.candela[:, polar.size]
        polar, candela = np.append(polar, 90.0), np.column_stack([candela, edge])
    if polar.size < 2:
        return 0.0
    return PolarTable(table.azimuths_deg, polar, candela, table.frame).flux_lm()


def _step(angles: NDArray[np.float64]) -> str:
    """Return the common distance of ``angles``, 0 where there is none."""
    steps = np.diff(angles)
    return _angle(float(steps[0])) if np.ptp(steps) < 1e-6 else "0"


def _number(value: float) -> str:
    """Return six significant digits without an exponent.

    >>> _number(1234567.0), _number(0.000012345678)
    ('1234570', '0.0000123457')
    """
    rounded = float(f"{value:.6g}")
    return np.format_float_positional(rounded, trim="-")


def _angle(degrees: float) -> str:
    return np.format_float_positional(round(float(degrees), 6) + 0.0, trim="-")


def _plain(text: str) -> str:
    return " ".join(text.split()).encode("ascii", "replace").decode("ascii")


def _rows(words: Iterable[str]) -> list[str]:
    """Return ``words`` in lines that are short enough for every reader."""
    return textwrap.wrap(" ".join(words), _IES_LETTERS, break_long_words=False)


def _write(path: Path, lines: Iterable[str]) -> None:
    write_bytes(path, ("\r\n".join(lines) + "\r\n").encode("ascii"))

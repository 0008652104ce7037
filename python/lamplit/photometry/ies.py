# SPDX-License-Identifier: Apache-2.0 OR MIT
"""IES LM-63: the editions of 1986, 1991, 1995, 2002 and 2019, photometric types A, B and C.

Source: ANSI/IESNA LM-63-2002, "Standard File Format for the Electronic Transfer of Photometric
Data", and how earlier and later editions differ from it: the number after the ballast
factor, the ballast-lamp photometric factor, multiplies intensities up to 1995. It is unused in 2002
and tells how the file came about in 2019.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamplit.photometry.distribution import PhotometricType, Photometry, full_turn, mirrored
from lamplit.photometry.text import Numbers, PhotometryError, read_lines

_TILT = re.compile(r"\s*TILT\s*=\s*(.*?)\s*", re.IGNORECASE)
_EDITION = re.compile(r"\s*IES(?:NA)?\s*:?\s*LM-63-(\d{4}|\d{2})\b", re.IGNORECASE)

_TYPES: Final[dict[int, PhotometricType]] = {1: "C", 2: "B", 3: "A"}

#: How far the angles of a type reach: horizontal, then vertical.
_RANGES: Final[dict[PhotometricType, tuple[tuple[float, float], tuple[float, float]]]] = {
    "C": ((0.0, 360.0), (0.0, 180.0)),
    "B": ((-90.0, 90.0), (-180.0, 180.0)),
    "A": ((-180.0, 180.0), (-90.0, 90.0)),
}

_Grid = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]


class _Header(NamedTuple):
    """What the numbers before the angles say."""

    verticals: int
    horizontals: int
    photometric_type: PhotometricType
    #: What a number of the table is multiplied by to be in cd.
    scale: float
    lamp_flux_lm: float | None


def read_ies(path: Path) -> Photometry:
    """Return the distribution of an IES LM-63 file.

    Symmetries are written out. Type C by its horizontal angles: see `full_turn`. Types A and B:
    angles from 0 on are mirrored about 0, horizontally and vertically. Grids may be narrower than
    the standard's; beyond them is dark. Factors for a tilted lamp (TILT=INCLUDE) are read over: the
    lamp stands as it was measured.

    Raises:
        PhotometryError: The file is none, is damaged, or needs another file for its tilt.
    """
    lines = read_lines(path)
    tilt_at, tilt = _find_tilt(path, lines)
    following = enumerate(lines[tilt_at:], start=tilt_at + 1)
    numbers = Numbers(path, following)
    if tilt == "INCLUDE":
        _pass_over_tilt(numbers)
    header = _read_header(numbers, multiplies=_edition(lines) < 2002)
    horizontal_range, vertical_range = _RANGES[header.photometric_type]
    vertical = numbers.angles(header.verticals, "vertical angles", *vertical_range)
    horizontal = numbers.angles(header.horizontals, "horizontal angles", *horizontal_range)
    horizontals_end = numbers.fault("").where
    candela = numbers.candela(header.horizontals, header.verticals, header.scale)
    try:
        grid = _written_out(header.photometric_type, horizontal, vertical, candela)
    except ValueError as fault:
        raise PhotometryError(str(fault), file=path, where=horizontals_end) from fault
    return Photometry(header.photometric_type, *grid, header.lamp_flux_lm)


def _find_tilt(path: Path, lines: list[str]) -> tuple[int, str]:
    """Return the number of the TILT line and what it says, NONE or INCLUDE."""
    for number, line in enumerate(lines, start=1):
        if (match := _TILT.fullmatch(line)) is not None:
            tilt = match[1].upper()
            if tilt in ("NONE", "INCLUDE"):
                return number, tilt
            raise PhotometryError(
                f"TILT={match[1][:40]} is not understood, and a second file is not read; write "
                "TILT=NONE if the lamp gives the same light at any tilt",
                file=path,
                where=f"line {number}",
            )
    raise PhotometryError(
        "there is no line with TILT=, so this is no IES LM-63 file, or it is cut off", file=path
    )


def _edition(lines: list[str]) -> int:
    """Return the year that the first line names; 1986, which had no such line, if it names none.

    The edition of 1991 writes ``IESNA91`` and is read like its neighbours.
    """
    if (match := _EDITION.match(lines[0])) is None:
        return 1986
    year = int(match[1])
    return year if year >= 100 else year + (1900 if year >= 86 else 2000)


def _pass_over_tilt(numbers: Numbers) -> None:
    """Take the lamp's position and its factors by tilt, and hold them against the standard."""
    position = numbers.one("the lamp's position of TILT=INCLUDE")
    if position not in (1.0, 2.0, 3.0):
        raise numbers.fault(f"the lamp's position after TILT is 1, 2 or 3, not {position:g}")
    count = numbers.count("the number of tilt angles", least=1)
    numbers.angles(count, "tilt angles", 0.0, 180.0)
    if (numbers.take(count, "the factors by tilt") < 0.0).any():
        raise numbers.fault("a factor by tilt is below 0; mend it, or write TILT=NONE")


def _read_header(numbers: Numbers, *, multiplies: bool) -> _Header:
    """Take the thirteen numbers; ``multiplies``: the one after the ballast factor multiplies."""
    lamps = numbers.count("the number of lamps", least=1)
    lumens = numbers.one("the lumens per lamp")
    if lumens <= 0.0 and lumens != -1.0:
        raise numbers.fault(
            f"the lumens per lamp are {lumens:g}; give the lamp's flux, or -1 for absolute "
            "photometry"
        )
    multiplier = _factor(numbers, "the candela multiplier")
    verticals = numbers.count("the number of vertical angles", least=2)
    horizontals = numbers.count("the number of horizontal angles", least=1)
    kind = numbers.one("the photometric type")
    if kind not in _TYPES:
        raise numbers.fault(f"the photometric type is 1 (C), 2 (B) or 3 (A), not {kind:g}")
    unit = numbers.one("the unit of length")
    if unit not in (1.0, 2.0):
        raise numbers.fault(f"the unit of length is 1 (feet) or 2 (metres), not {unit:g}")
    numbers.take(3, "width, length and height")
    ballast = _factor(numbers, "the ballast factor")
    scale = multiplier * ballast
    if multiplies:
        scale *= _factor(numbers, "the ballast-lamp photometric factor")
    else:
        numbers.one("the number after the ballast factor")
    numbers.one("the input watts")
    flux = None if lumens == -1.0 else lamps * lumens
    return _Header(verticals, horizontals, _TYPES[int(kind)], scale, flux)


def _factor(numbers: Numbers, what: str) -> float:
    factor = numbers.one(what)
    if factor <= 0.0:
        raise numbers.fault(f"{what} is {factor:g}, which leaves no light; it is usually 1")
    return factor


def _written_out(
    kind: PhotometricType,
    horizontal: NDArray[np.float64],
    vertical: NDArray[np.float64],
    candela: NDArray[np.float64],
) -> _Grid:
    """Return the grid (h,), (v,), (h, v) with its symmetries written out.

    Raises:
        ValueError: The horizontal angles are none of the format.
    """
    if kind == "C":
        planes, rows = full_turn(horizontal, candela)
        return planes, vertical, rows
    if horizontal.size < 2:
        raise ValueError(
            f"one horizontal angle is no distribution of type {kind}; two at least are expected"
        )
    if horizontal[0] == 0.0:
        horizontal, candela = mirrored(horizontal, candela, 0.0)
    if vertical[0] == 0.0:
        vertical, columns = mirrored(vertical, candela.T, 0.0)
        candela = columns.T
    return horizontal, vertical, candela

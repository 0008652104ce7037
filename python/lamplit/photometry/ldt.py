# SPDX-License-Identifier: Apache-2.0 OR MIT
"""EULUMDAT (``.ldt``): C-planes with a line for each number, in cd per 1000 lm.

Source: A. W. Stockmar, "EULUMDAT/2 – Extended Version of a Well Established Luminaire Data Format",
CIBSE National Lighting Conference 1998.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamplit.photometry.distribution import Photometry, full_turn
from lamplit.photometry.text import MOST_ANGLES, Numbers, PhotometryError, number_of, read_lines

#: Lines by what they hold, from 1.
_SYMMETRY, _PLANES, _ANGLES, _CONVERSION, _SETS = 3, 4, 6, 24, 26

_LINES_OF_A_SET = 6
_DIRECT_RATIOS = 10

_PER_LUMEN = 1e-3


class _Symmetry(NamedTuple):
    """Which planes a file gives: how many parts of a turn they must fit, and their ends."""

    parts: int
    first_deg: float
    last_deg: float


#: Isym 2, 3 and 4; 0 gives every plane and 1 the first only.
_MIRRORED = {
    2: _Symmetry(2, 0.0, 180.0),
    3: _Symmetry(4, -90.0, 90.0),
    4: _Symmetry(4, 0.0, 90.0),
}


def read_ldt(path: Path) -> Photometry:
    """Return the distribution of an EULUMDAT file, type C, with its symmetry written out.

    The intensities, per 1000 lm, are for the flux of the first set of lamps and are multiplied by
    the file's conversion factor. A negative number of lamps (absolute photometry) makes no
    difference: the flux is then the luminaire's.

    Raises:
        PhotometryError: The file is none or is damaged.
    """
    lines = _Lines(path)
    symmetry = lines.count(_SYMMETRY, "the symmetry indicator", least=0, most=4)
    planes = lines.count(_PLANES, "the number of C-planes", least=1)
    angles = lines.count(_ANGLES, "the number of intensities in a C-plane", least=2)
    conversion = lines.positive(_CONVERSION, "the conversion factor", "it is usually 1")
    sets = lines.count(_SETS, "the number of lamp sets", least=1)
    flux_lm = lines.positive(_SETS + 3, "the lamps' flux in lm", "give it")
    before = _SETS + _LINES_OF_A_SET * sets + _DIRECT_RATIOS
    numbers = lines.numbers_after(before)
    listed = numbers.angles(planes, "C-planes", 0.0, 360.0)
    try:
        given = _given_planes(symmetry, listed)
    except ValueError as fault:
        raise numbers.fault(str(fault)) from fault
    gamma = numbers.angles(angles, "γ angles", 0.0, 180.0)
    candela = numbers.candela(given.size, angles, conversion * flux_lm * _PER_LUMEN)
    all_planes, rows = full_turn(given, candela)
    return Photometry("C", all_planes, gamma, rows, flux_lm)


def _given_planes(symmetry: int, listed: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the planes whose intensities stand in the file; ValueError if they do not fit Isym."""
    count = listed.size
    if symmetry == 1:
        return np.zeros(1)
    if symmetry == 0:
        if listed[0] != 0.0 or listed[-1] <= 180.0:
            raise ValueError(
                f"symmetry indicator 0 needs C-planes all around from 0°, and these go from "
                f"{listed[0]:g}° to {listed[-1]:g}°; mend the indicator or the planes"
            )
        return listed
    parts, first, last = _MIRRORED[symmetry]
    stored = listed[: count // parts + 1]
    if symmetry == 3:
        stored = np.concatenate([listed[3 * count // 4 :] - 360.0, stored])
    if count % parts or stored[0] != first or stored[-1] != last:
        raise ValueError(
            f"symmetry indicator {symmetry} needs a multiple of {parts} C-planes with {last:g}° "
            f"in its place, and here are {count}; mend the indicator or the planes"
        )
    return stored


class _Lines:
    """The lines of a file by their numbers, from 1."""

    def __init__(self, path: Path) -> None:
        self.file = path
        self._lines = read_lines(path)

    def positive(self, line: int, what: str, advice: str) -> float:
        number = self._number(line, what)
        if number <= 0.0:
            raise self._fault(f"{what} must be above 0, not {number:g}; {advice}", line)
        return number

    def count(self, line: int, what: str, *, least: int, most: int = MOST_ANGLES) -> int:
        number = self._number(line, what)
        if number != int(number) or not least <= number <= most:
            raise self._fault(
                f"{what} must be a whole number from {least} to {most}, not {number:g}; "
                "mend it, and see that no line before it is missing",
                line,
            )
        return int(number)

    def numbers_after(self, line: int) -> Numbers:
        """Return the numbers of all lines after ``line``."""
        if line >= len(self._lines):
            raise self._fault(
                f"the file ends before its C-planes, which are due after line {line}; "
                "get the file anew",
                len(self._lines),
            )
        following = enumerate(self._lines[line:], start=line + 1)
        # One number stands in a line, so a comma is a decimal one.
        return Numbers(self.file, ((at, text.replace(",", ".")) for at, text in following))

    def _number(self, line: int, what: str) -> float:
        if line > len(self._lines):
            raise self._fault(
                f"the file ends before line {line} with {what}; get the file anew",
                len(self._lines),
            )
        text = self._lines[line - 1].strip().replace(",", ".")
        try:
            return number_of(text)
        except ValueError as fault:
            raise self._fault(f"{what} is due here, and {fault}", line) from fault

    def _fault(self, message: str, line: int) -> PhotometryError:
        return PhotometryError(message, file=self.file, where=f"line {line}")

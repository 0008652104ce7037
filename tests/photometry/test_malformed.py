# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Damaged and lying photometric files are refused in one line that names file and place, fast."""

from __future__ import annotations

import os
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import pytest

from lamplit.errors import LamplitError
from lamplit.photometry import PhotometryError, read_photometry
from lamplit.photometry.text import MAX_BYTES

Write = Callable[[str, "str | bytes"], Path]

IES = """\
IESNA:LM-63-2002
[TEST] none
TILT=NONE
1 1000 1 3 3 1 2 0.1 0.1 0
1 1 60
0 45 90
0 45 90
30 20 10
30 20 10
30 20 10
"""

LDT = "\n".join(
    [
        *("Nobody", "3", "4", "8", "45", "3", "45", "report", "lamp", "1", "lamp.ldt", "2026"),
        *("100", "100", "10", "90", "90", "0", "0", "0", "0", "100", "80", "1.0", "0", "1"),
        *("1", "LED", "2000", "3000", "80", "20", *["0.5"] * 10),
        *("0", "45", "90", "135", "180", "225", "270", "315"),
        *("0", "45", "90", *["30", "20", "10"] * 3, ""),
    ]
)

#: What is replaced in the sound IES file, by what, and what the message says.
IES_FAULTS = {
    "no TILT line": ("TILT=NONE\n", "", "no line with TILT="),
    "tilt of another file": ("TILT=NONE", "TILT=other.tlt", "line 3: TILT=other.tlt"),
    "tilt factors cut off": ("TILT=NONE\n", "TILT=INCLUDE\n1\n900\n0 90\n", "ends too early"),
    "tilt angles fall": ("TILT=NONE", "TILT=INCLUDE\n1\n2\n90 0\n1 1", "line 6: tilt angles"),
    "tilt position": ("TILT=NONE", "TILT=INCLUDE\n9\n2\n0 90\n1 1", "line 4: the lamp's position"),
    "negative tilt factor": ("TILT=NONE", "TILT=INCLUDE\n1\n2\n0 90\n1 -1", "line 7: a factor"),
    "more angles than numbers": ("1 3 3 1", "1 30 3 1", "ends too early: 30 numbers"),
    "fewer angles than numbers": ("1 3 3 1", "1 3 2 1", "line [79]: "),
    "numbers left over": ("30 20 10\n30", "30 20 10\n5 30", "line 10: 1 numbers follow"),
    "a million angles": ("1 3 3 1", "1 1000000 1000000 1", "ends too early"),
    "a count beyond belief": ("1 3 3 1", "1 1e300 3 1", "line 4: .* not 1e.300"),
    "half an angle": ("1 3 3 1", "1 2.5 3 1", "line 4: .* not 2.5"),
    "one vertical angle": ("1 3 3 1", "1 1 9 1", "line 4: the number of vertical"),
    "no horizontal angles": ("1 3 3 1", "1 3 0 1", "line 4: the number of horizontal"),
    "negative count": ("1 3 3 1", "1 3 -3 1", "line 4: .* not -3"),
    "no lamps": ("1 1000 1", "0 1000 1", "line 4: the number of lamps"),
    "lamps without flux": ("1 1000 1", "1 0 1", "line 4: the lumens per lamp are 0"),
    "negative flux": ("1 1000 1", "1 -5 1", "line 4: the lumens per lamp are -5"),
    "multiplier 0": ("1 1000 1", "1 1000 0", "line 4: the candela multiplier is 0"),
    "negative multiplier": ("1 1000 1", "1 1000 -1", "line 4: the candela multiplier is -1"),
    "multiplier that overflows": ("1 1000 1", "1 1000 1e308", "line 8: an intensity"),
    "ballast factor 0": ("1 1 60", "0 1 60", "line 5: the ballast factor is 0"),
    "photometric type 4": ("3 3 1 2", "3 3 4 2", "line 4: the photometric type"),
    "unit of length 3": ("3 3 1 2", "3 3 1 3", "line 4: the unit of length"),
    "vertical angles fall": ("0 45 90\n0", "0 90 45\n0", "line 6: vertical angles must rise"),
    "vertical angle twice": ("0 45 90\n0", "0 45 45\n0", "line 6: vertical .* 45° follows 45°"),
    "horizontal angles fall": ("90\n0 45 90", "90\n0 90 45", "line 7: horizontal angles"),
    "vertical angle past 180": ("0 45 90\n0", "0 45 190\n0", "line 6: .* 190° does not"),
    "planes of no symmetry": ("90\n0 45 90", "90\n0 45 100", "line 7: planes from 0° to 100°"),
    "planes from 10": ("90\n0 45 90", "90\n10 45 90", "line 7: planes from 10° to 90°"),
    "negative horizontal": ("90\n0 45 90", "90\n-45 0 45", "line 7: .* -45° does not"),
    "angle that is no number": ("0 45 90\n0", "0 forty 90\n0", "line 6: 'forty' is not a number"),
    "negative candela": ("30 20 10\n30 20", "30 20 10\n30 -2", "line 9: an intensity of -2 cd"),
    "candela NaN": ("30 20 10\n30 20", "30 20 10\n30 nan", "line 9: 'nan' is not a number"),
    "candela infinite": ("30 20 10\n30 20", "30 20 10\n30 inf", "line 9: 'inf' is not a number"),
    "candela overflows": ("30 20 10\n30 20", "30 20 10\n30 1e999", "line 9: '1e999'"),
    "candela of another script": ("30 20 10\n30", "30 20 10\n٣0", "line 9: '٣0' is not"),
    "candela with underscore": ("30 20 10\n30", "30 20 10\n3_0", "line 9: '3_0' is not"),
    "candela in hexadecimal": ("30 20 10\n30", "30 20 10\n0x1", "line 9: '0x1' is not"),
    "table cut off": ("30 20 10\n30 20 10\n30 20 10\n", "30 20 10\n30 2", "line 9: the file ends"),
    "header cut off": ("1 3 3 1 2 0.1 0.1 0\n1 1 60", "1 3", "line [4-9]: "),
    "all dark": ("30 20 10\n30 20 10\n30 20 10", "0 0 0\n0 0 0\n0 0 0", "nothing shines"),
    "one horizontal angle of type A": (
        "3 3 1 2 0.1 0.1 0\n1 1 60\n0 45 90\n0 45 90\n30 20 10\n30 20 10\n",
        "3 1 3 2 0.1 0.1 0\n1 1 60\n0 45 90\n0\n",
        "line 7: one horizontal angle",
    ),
}

LDT_FAULTS = {
    "symmetry 5": ("Nobody\n3\n4", "Nobody\n3\n5", "line 3: the symmetry indicator"),
    "symmetry that is a word": ("Nobody\n3\n4", "Nobody\n3\nfour", "line 3: .* 'four' is not"),
    "a line is missing": ("Nobody\n3\n", "Nobody\n", "line 3: "),
    "no planes": ("\n8\n45\n3", "\n0\n45\n3", "line 4: the number of C-planes"),
    "more planes than lines": ("\n8\n45\n3", "\n800\n45\n3", "ends too early: 800 numbers"),
    "planes beyond belief": ("\n8\n45\n3", "\n1e12\n45\n3", "line 4: .* not 1e.12"),
    "planes that fit no quarter": ("\n8\n45\n3", "\n7\n45\n3", "line 49: symmetry indicator 4"),
    "one angle": ("\n8\n45\n3", "\n8\n45\n1", "line 6: the number of intensities"),
    "more angles than lines": ("\n8\n45\n3", "\n8\n45\n30", "ends too early: 30 numbers"),
    "fewer angles than lines": ("\n8\n45\n3", "\n8\n45\n2", "numbers follow the 3 × 2"),
    "conversion factor 0": ("\n1.0\n0\n1\n1", "\n0\n0\n1\n1", "line 24: the conversion factor"),
    "conversion factor NaN": ("\n1.0\n0\n1\n1", "\nnan\n0\n1\n1", "line 24: .* 'nan'"),
    "no lamps": ("\n1.0\n0\n1\n1", "\n1.0\n0\n0\n1", "line 26: the number of lamp sets"),
    "lamps beyond the file": ("\n1.0\n0\n1\n1", "\n1.0\n0\n9999\n1", "due after line 60030"),
    "no flux": ("LED\n2000", "LED\n0", "line 29: the lamps' flux in lm must be above 0"),
    "flux that is a word": ("LED\n2000", "LED\nplenty", "line 29: .* 'plenty' is not"),
    "planes fall": ("\n0\n45\n90\n135", "\n0\n90\n45\n135", "line 45: C-planes must rise"),
    "planes past a turn": ("\n270\n315", "\n270\n400", "line 50: .* 400° does not"),
    "symmetry and planes differ": ("\n90\n135\n180", "\n91\n135\n180", "line 50: symmetry .* 4"),
    "half a turn without symmetry": (
        "Nobody\n3\n4\n8\n45",
        "Nobody\n3\n0\n5\n45",
        "line 47: symmetry indicator 0 needs",
    ),
    "gamma falls": ("315\n0\n45\n90", "315\n0\n90\n45", "line 53: γ angles must rise"),
    "gamma past 180": ("315\n0\n45\n90", "315\n0\n45\n181", "line 53: .* 181° does not"),
    "negative intensity": ("315\n0\n45\n90\n30", "315\n0\n45\n90\n-30", "line 54: an intensity"),
    "intensity NaN": ("315\n0\n45\n90\n30", "315\n0\n45\n90\nnan", "line 54: 'nan'"),
    "table cut off": ("30\n20\n10\n30\n20\n10\n30\n20\n10\n", "30\n20\n10\n3", "ends too early"),
    "header cut off": (LDT[40:], "", "line 11: the file ends before line 24"),
    "all dark": ("30\n20\n10\n" * 3, "0\n0\n0\n" * 3, "nothing shines"),
}

#: Whole files, by name.
CONTENTS = {
    "empty.ies": (b"", "no line with TILT="),
    "empty.ldt": (b"", "line 3|before line 3"),
    "utf-16.ies": (IES.encode("utf-16"), "no plain text"),
    "utf-16-without-mark.ldt": (LDT.encode("utf-16-le"), "no plain text"),
    "picture.ies": (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + bytes(range(256)), "no plain text"),
    "noise.ldt": (bytes(range(1, 256)) * 40, "line 3|before line 3"),
    "ldt-named.ies": (LDT.encode(), "no line with TILT="),
    "ies-named.ldt": (IES.encode(), "line 3: the symmetry indicator is due"),
    "only-tilt.ies": (b"TILT=NONE", "ends too early"),
    "ten-million-letters.ies": (b"TILT=NONE\n" + b"1" * 10_000_000, "is not a number"),
    "only-numbers.ies": (b"TILT=NONE\n" + b"1 " * 500_000, "line 2: "),
    "only-lines.ldt": (b"1\n" * 500_000, "line 4|line 6|C-planes"),
}


def refused(path: Path, says: str) -> None:
    """Check that the file is refused within a second, in one line that names it."""
    start = time.perf_counter()
    with pytest.raises(PhotometryError, match=says) as fault:
        read_photometry(path)
    assert time.perf_counter() - start < 1.0
    told = str(fault.value)
    assert isinstance(fault.value, LamplitError)
    assert told.startswith(str(path)) and "\n" not in told and len(told) < 400 + len(str(path))


def test_the_sound_files_are_sound(written: Write) -> None:
    for name, text in (("a.ies", IES), ("a.ldt", LDT)):
        photometry = read_photometry(written(name, text))
        assert photometry.horizontal_deg.tolist() == [0, 45, 90, 135, 180, 225, 270, 315, 360]
        assert photometry.vertical_deg.tolist() == [0, 45, 90]


@pytest.mark.parametrize("name", IES_FAULTS)
def test_a_damaged_ies_file_is_refused_with_its_place(written: Write, name: str) -> None:
    piece, by, says = IES_FAULTS[name]
    assert piece in IES
    refused(written("lamp.ies", IES.replace(piece, by, 1)), says)


@pytest.mark.parametrize("name", LDT_FAULTS)
def test_a_damaged_eulumdat_file_is_refused_with_its_place(written: Write, name: str) -> None:
    piece, by, says = LDT_FAULTS[name]
    assert piece in LDT
    refused(written("lamp.ldt", LDT.replace(piece, by, 1)), says)


@pytest.mark.parametrize("name", CONTENTS)
def test_what_is_no_such_file_at_all_is_refused(written: Write, name: str) -> None:
    content, says = CONTENTS[name]
    refused(written(name, content), says)


def test_every_way_to_cut_a_file_off_is_refused_or_harmless(written: Write) -> None:
    """Only the last digits of the last number may go unnoticed."""
    for name, text in (("a.ies", IES), ("a.ldt", LDT)):
        for end in range(len(text.rstrip()) - 1):
            with pytest.raises(PhotometryError):
                read_photometry(written(name, text[:end]))


def test_counts_are_held_against_the_file_before_memory_is_taken(written: Write) -> None:
    path = written("a.ies", IES.replace("1 3 3 1", "1 999999 999999 1"))
    tracemalloc.start()
    try:
        with pytest.raises(PhotometryError):
            read_photometry(path)
        assert tracemalloc.get_traced_memory()[1] < 2**20
    finally:
        tracemalloc.stop()


def test_a_missing_file_a_folder_a_pipe_and_a_giant_are_named(tmp_path: Path) -> None:
    (tmp_path / "folder.ies").mkdir()
    os.mkfifo(tmp_path / "pipe.ies")
    with (tmp_path / "giant.ldt").open("wb") as stream:
        stream.truncate(MAX_BYTES + 1)
    refused(tmp_path / "missing.ies", "no such file")
    refused(tmp_path / "folder.ies", "no such file")
    refused(tmp_path / "pipe.ies", "no such file")
    refused(tmp_path / "giant.ldt", "too large")

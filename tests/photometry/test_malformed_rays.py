# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Damaged and lying ray files are refused in one line that names file, byte and ray, fast."""

from __future__ import annotations

import os
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lamplit.photometry.rays import read_rays
from lamplit.photometry.text import PhotometryError

Write = Callable[[str, "str | bytes"], Path]
Bytes = Callable[..., bytes]

NAN, INF = float("nan"), float("inf")
SOUND = (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0)


def ray(**changed: float) -> tuple[float, ...]:
    """Return a sound ray with some of its numbers changed."""
    numbers = dict(zip(("x", "y", "z", "l", "m", "n", "flux"), SOUND, strict=True))
    return tuple({**numbers, **changed}.values())


#: Rays, and what the message says; the ray begins at the format's first byte + 28 · its number.
BAD_RAYS = {
    "start NaN": ([SOUND, ray(y=NAN)], r"ray 2 of 2, byte {}: the start \(0, nan, 0\)", 1),
    "start infinite": ([ray(z=-INF)], r"ray 1 of 1, byte {}: the start", 0),
    "direction NaN": ([ray(l=NAN)], r"ray 1 of 1, byte {}: the direction \(nan, 0, 1\)", 0),
    "direction zero": ([SOUND, SOUND, ray(n=0.0)], r"ray 3 of 3, byte {}: .* no length", 2),
    "direction long": (
        [SOUND, ray(n=1.5), ray(n=1.001), SOUND],
        r"ray 2 of 4, byte {}: .* length 1.5 instead of 1; .* \(1 other rays",
        1,
    ),
    "direction overflows": ([ray(n=3e38)], r"ray 1 of 1, byte {}: .* length 3e\+38", 0),
    "direction in degrees": ([ray(l=90.0)], r"length 90.0056 instead", 0),
    "flux negative": ([SOUND, ray(flux=-1e-6)], r"ray 2 of 2, byte {}: the flux -1e-06", 1),
    "flux NaN": ([ray(flux=NAN)], r"ray 1 of 1, byte {}: the flux nan", 0),
    "flux infinite": ([ray(flux=INF)], r"ray 1 of 1, byte {}: the flux inf", 0),
    "no flux at all": ([ray(flux=0.0)] * 2, r"the flux of all 2 rays is 0", 0),
    "no rays": ([], r"promises no rays", 0),
}

#: What is changed in a sound TM-25 file, and what the message says.
TM25_FAULTS: dict[str, tuple[dict[str, Any], str]] = {
    "another mark": ({"magic": b"TM26"}, "byte 0: a TM-25 file begins with 'TM25'"),
    "another version": ({"version": 2020}, "byte 4: version 2020"),
    "negative lumens": ({"lumens": -1.0}, "byte 12: a total flux of -1"),
    "infinite watts": ({"watts": INF}, "byte 16: a total flux of inf"),
    "kind of spectrum": ({"kind": 5}, "byte 60: .* 0 to 4, not 5"),
    "negative tables": ({"table_count": -1}, "byte 76: there are -1 spectral"),
    "negative columns": ({"added_count": -2}, "byte 80: there are -2 added"),
    "negative text": ({"text_bytes": -32}, "byte 84: there are -32 bytes"),
    "more tables than file": ({"table_count": 2**31 - 1}, "byte 36288: 2147483647 spectral"),
    "more columns than file": ({"added_count": 2**31 - 1}, "byte 36288: 2147483647 names"),
    "more text than file": ({"text_bytes": 2**31 - 32}, "byte 36288: the file ends too early"),
    "more rays than file": ({"count": 2**63}, "promises 9223372036854775808 rays of 28 bytes"),
    "one ray too few": ({"count": 4}, "promises 4 rays of 28 bytes, which take 112, and 84"),
    "one ray too many": ({"count": 2}, "promises 2 rays of 28 bytes, which take 56, and 84"),
    "no position": ({"flags": (0, 1, 1, 0, 0, 0, 0, 0)}, "byte 256: the rays have no position"),
    "no direction": ({"flags": (1, 0, 1, 0, 0, 0, 0, 0)}, "byte 260: the rays have no direction"),
    "no flux": ({"flags": (1, 1, 0, 0, 0, 0, 0, 0)}, "byte 264: the rays have no flux"),
    "flag of two": ({"flags": (1, 1, 1, 0, 2, 0, 0, 0)}, "byte 272: the flag of luminous flux"),
    "no wavelengths": ({"kind": 2}, "byte 268: the rays have no wavelength"),
    "no spectrum index": (
        {"kind": 4, "tables": [[(600.0, 1.0)]]},
        "byte 284: the rays have no spectrum index",
    ),
    "no table": ({"kind": 3}, "byte 76: spectral data of the kind 3 need a table"),
    "table without points": ({"kind": 3, "tables": [[]]}, "byte 36288: spectral table 1 has 0"),
    "table that falls": (
        {"kind": 3, "tables": [[(600.0, 1.0), (590.0, 1.0)]]},
        "byte 36288: the wavelengths of spectral table 1",
    ),
    "table below zero": (
        {"kind": 3, "tables": [[(600.0, 1.0), (610.0, 1.0)], [(600.0, -1.0), (610.0, 2.0)]]},
        "byte 36308: the weights of spectral table 2",
    ),
    "table NaN": ({"kind": 3, "tables": [[(NAN, 1.0)]]}, "wavelengths of spectral table 1"),
    "table dark": ({"kind": 3, "tables": [[(600.0, 0.0)]]}, "weights of spectral table 1"),
    "one wavelength NaN": ({"kind": 1}, "the wavelength nan nm is no light's"),
    "wavelength in metres": (
        {"rays": [(*SOUND, 6.2e-7)], "kind": 2, "flags": (1, 1, 1, 1, 0, 0, 0, 0)},
        "ray 1 of 1, byte 36288: the wavelength 6.2e-07 nm is no light's; .* in nm",
    ),
    "unknown table": (
        {
            "rays": [(*SOUND, 3.0)],
            "kind": 4,
            "tables": [[(600.0, 1.0)]],
            "flags": (1, 1, 1, 0, 0, 0, 0, 1),
        },
        "ray 1 of 1, byte 36320: the spectrum 3 is none of the 1 tables",
    ),
    "filling left out": (
        {"kind": 3, "tables": [[(600.0, 1.0)]], "padding": 0},
        "byte 36320: .* take 84, and 64",
    ),
}

ZEMAX_FAULTS: dict[str, tuple[dict[str, Any], str]] = {
    "another identifier": ({"identifier": 2002}, "byte 0: .* begins with 1010, .* with 2002"),
    "more rays than file": ({"count": 2**32 - 1}, "promises 4294967295 rays of 28 bytes"),
    "one ray too many": ({"count": 2}, "byte 208: .* take 56, and 84"),
    "unit": ({"unit": 5}, r"byte 136: the unit of length is 0 \(m\)"),
    "negative unit": ({"unit": -1}, "byte 136: the unit of length"),
    "ray format": ({"ray_format": 1}, "byte 192: the ray format"),
    "flux type": ({"flux_type": 2}, "byte 196: the flux type"),
    "spectral lumens": ({"ray_format": 2}, "byte 196: .* lm is stated"),
    "spectral without wavelengths": (
        {"ray_format": 2, "flux_type": 0},
        "promises 3 rays of 32 bytes, which take 96, and 84",
    ),
    "wavelength in nm": (
        {"rays": [(*SOUND, 624.0)], "ray_format": 2, "flux_type": 0},
        "ray 1 of 1, byte 208: the wavelength 624000 nm is no light's; .* in µm",
    ),
}


def refused(path: Path, says: str) -> None:
    """Check that the file is refused within a second, in one line that names it."""
    start = time.perf_counter()
    with pytest.raises(PhotometryError, match=says) as fault:
        read_rays(path)
    assert time.perf_counter() - start < 1.0
    told = str(fault.value)
    assert told.startswith(str(path)) and "\n" not in told and len(told) < 400 + len(str(path))


@pytest.mark.parametrize("name", BAD_RAYS)
def test_a_ray_that_cannot_be_is_named_with_its_byte(
    written: Write, tm25: Bytes, zemax: Bytes, name: str
) -> None:
    rays, says, at = BAD_RAYS[name]
    refused(written("a.tm25ray", tm25(rays)), says.format(36288 + 28 * at))
    refused(written("a.dat", zemax(rays)), says.format(208 + 28 * at))


@pytest.mark.parametrize("name", TM25_FAULTS)
def test_a_damaged_tm25_file_is_refused_with_its_place(
    written: Write, tm25: Bytes, name: str
) -> None:
    changed, says = TM25_FAULTS[name]
    refused(written("a.tm25ray", tm25(**changed)), says)


@pytest.mark.parametrize("name", ZEMAX_FAULTS)
def test_a_damaged_zemax_file_is_refused_with_its_place(
    written: Write, zemax: Bytes, name: str
) -> None:
    changed, says = ZEMAX_FAULTS[name]
    refused(written("a.sdf", zemax(**changed)), says)


def test_every_way_to_cut_a_file_off_is_refused(written: Write, tm25: Bytes, zemax: Bytes) -> None:
    table = tm25(kind=3, tables=[[(600.0, 1.0), (700.0, 1.0)]])
    ends = [*range(0, 300, 7), 4288, 36287, *range(36288, len(table))]
    for end in ends:
        with pytest.raises(PhotometryError):
            read_rays(written("a.tm25ray", table[:end]))
    whole = zemax()
    for end in range(len(whole)):
        with pytest.raises(PhotometryError):
            read_rays(written("a.dat", whole[:end]))


def test_counts_are_held_against_the_file_before_memory_is_taken(
    written: Write, tm25: Bytes, zemax: Bytes
) -> None:
    lying = [
        written("a.tm25ray", tm25(count=10**9)),
        written("b.tm25ray", tm25(text_bytes=2**30)),
        written("c.tm25ray", tm25(table_count=10**9, kind=3)),
        written("d.dat", zemax(count=10**9)),
    ]
    tracemalloc.start()
    try:
        for path in lying:
            with pytest.raises(PhotometryError):
                read_rays(path)
        assert tracemalloc.get_traced_memory()[1] < 2**20
    finally:
        tracemalloc.stop()


def test_more_rays_than_anybody_needs_are_refused(tmp_path: Path, zemax: Bytes) -> None:
    """A file with holes that is as long as its header says."""
    count = 100_000_001
    path = tmp_path / "a.dat"
    with path.open("wb") as stream:
        stream.write(zemax([], count=count))
        stream.truncate(208 + 28 * count)
    refused(path, "100000001 rays are too many")


def test_what_is_no_ray_file_at_all_is_refused(written: Write, tm25: Bytes, tmp_path: Path) -> None:
    refused(written("a.dat", "2 4\n0 0 0 0 0 1 1\n"), "byte 0: this is a source file in text")
    refused(written("b.dat", b""), "byte 0: a binary source file")
    refused(written("c.tm25ray", b""), "byte 0: the file ends too early")
    refused(written("d.sdf", tm25()), "byte 0: a binary source file of Zemax begins")
    refused(written("e.ray", tm25()), "the suffix '.ray' is none of .tm25ray, .dat, .sdf")
    (tmp_path / "folder.dat").mkdir()
    os.mkfifo(tmp_path / "pipe.dat")
    for name in ("missing.tm25ray", "folder.dat", "pipe.dat"):
        refused(tmp_path / name, "no such file")

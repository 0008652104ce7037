# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Writes small IES, EULUMDAT and ray files, apart from the code that reads and writes them."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

#: Intensity (…) in cd of unit vectors (…, 3) in the luminaire's frame.
Law = Callable[[np.ndarray], np.ndarray]


def direction(kind: str, horizontal_deg: np.ndarray, vertical_deg: np.ndarray) -> np.ndarray:
    """Return unit vectors by turning the axis step by step, as a goniometer of the type does."""
    h, v = np.broadcast_arrays(np.radians(horizontal_deg), np.radians(vertical_deg))
    zero = np.zeros_like(h)
    if kind == "C":
        # Lower a vertical from nadir towards +y, then turn about nadir from +y to +x.
        tilted = np.stack([zero, np.sin(v), np.cos(v)], axis=-1)
        x = tilted[..., 1] * np.sin(h)
        return np.stack([x, tilted[..., 1] * np.cos(h), tilted[..., 2]], axis=-1)
    if kind == "A":
        # Raise the axis by V, then turn about the upright axis, away from +x.
        raised = np.stack([zero, np.sin(v), np.cos(v)], axis=-1)
        x = -raised[..., 2] * np.sin(h)
        return np.stack([x, raised[..., 1], raised[..., 2] * np.cos(h)], axis=-1)
    # Swing the axis by H away from +x, then raise it about the level axis by V.
    swung = np.stack([-np.sin(h), zero, np.cos(h)], axis=-1)
    y = swung[..., 2] * np.sin(v)
    return np.stack([swung[..., 0], y, swung[..., 2] * np.cos(v)], axis=-1)


def ies_text(
    kind: str,
    horizontal: list[float],
    vertical: list[float],
    law: Law,
    *,
    first_line: str = "IESNA:LM-63-2002",
    tilt: str = "TILT=NONE",
    lamps: str = "1 1000",
    multiplier: float = 1.0,
    factors: str = "1 1 60",
) -> str:
    """Return an IES file; the numbers of the table are those of ``law`` over ``multiplier``."""
    h, v = np.array(horizontal), np.array(vertical)
    table = law(direction(kind, h[:, None], v[None, :])) / multiplier
    number = {"C": 1, "B": 2, "A": 3}[kind]
    return "\n".join(
        [
            first_line,
            "[TEST] a test",
            "[MANUFAC] nobody",
            tilt,
            f"{lamps} {multiplier!r} {v.size} {h.size} {number} 2 0.1 0.1 0",
            factors,
            " ".join(map(repr, v.tolist())),
            " ".join(map(repr, h.tolist())),
            *(" ".join(map(repr, row)) for row in table.tolist()),
            "",
        ]
    )


#: The planes whose intensities stand in a file, by Isym, for planes all around.
STORED: dict[int, Callable[[np.ndarray], np.ndarray]] = {
    0: lambda planes: planes,
    1: lambda planes: planes[:1],
    2: lambda planes: planes[planes <= 180.0],
    3: lambda planes: np.concatenate([planes[planes >= 270.0], planes[planes <= 90.0]]),
    4: lambda planes: planes[planes <= 90.0],
}


def ldt_text(
    symmetry: int,
    planes: list[float],
    gamma: list[float],
    law: Law,
    *,
    flux_lm: float = 2000.0,
    lamps: int = 1,
    conversion: float = 1.0,
) -> str:
    """Return an EULUMDAT file with one set of lamps; each line of the 26 is at its place."""
    c, g = np.array(planes), np.array(gamma)
    cd = law(direction("C", STORED[symmetry](c)[:, None], g[None, :]))
    table = cd / (flux_lm / 1000.0) / conversion
    head = [
        *("Nobody", "3", str(symmetry), str(c.size), "0", str(g.size), "0", "report", "lamp"),
        *("1", "lamp.ldt", "2026", "100", "100", "10", "90", "90", "0", "0", "0", "0"),
        *("100", "80", repr(conversion), "0", "1"),
        *(str(lamps), "LED", repr(flux_lm), "3000", "80", "20"),
        *["0.5"] * 10,
    ]
    assert len(head) == 26 + 6 + 10
    return "\r\n".join([*head, *map(repr, [*c.tolist(), *g.tolist(), *table.ravel().tolist()]), ""])


NAN = float("nan")

#: x, y, z, direction cosines, flux.
RAYS = (
    (1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 0.5),
    (-1.0, 0.25, 0.0, 0.6, 0.0, 0.8, 1.5),
    (0.0, 0.0, -4.0, 0.0, -1.0, 0.0, 2.0),
)


def tm25_bytes(
    rays: Sequence[Sequence[float]] = RAYS,
    *,
    magic: bytes = b"TM25",
    version: int = 2013,
    lumens: float = NAN,
    watts: float = 4.0,
    count: int | None = None,
    kind: int = 0,
    wavelength: float = NAN,
    flags: Sequence[int] = (1, 1, 1, 0, 0, 0, 0, 0),
    tables: Sequence[Sequence[tuple[float, float]]] = (),
    table_count: int | None = None,
    added: Sequence[str] = (),
    added_count: int | None = None,
    text: bytes = b"",
    text_bytes: int | None = None,
    padding: int | None = None,
) -> bytes:
    """Return a TM-25 file; what is not given is sound."""
    content = magic
    content += struct.pack("<i", version)
    content += struct.pack("<i", 0)  # creation method
    content += struct.pack("<f", lumens)
    content += struct.pack("<f", watts)
    content += struct.pack("<Q", len(rays) if count is None else count)
    content += b"2026-01-02T03:04:05+01:00".ljust(28, b"\0")
    content += struct.pack("<i", 0)  # start position
    content += struct.pack("<i", kind)
    content += struct.pack("<f", wavelength)
    content += struct.pack("<f", NAN) + struct.pack("<f", NAN)  # shortest, longest
    content += struct.pack("<i", len(tables) if table_count is None else table_count)
    content += struct.pack("<i", len(added) if added_count is None else added_count)
    content += struct.pack("<i", len(text) if text_bytes is None else text_bytes)
    content += bytes(168)
    assert len(content) == 256
    for flag in flags:
        content += struct.pack("<i", flag)
    assert len(content) == 288
    content += "Red LED λ".encode("utf-32-le").ljust(4000, b"\0") + bytes(8 * 4000)
    assert len(content) == 36288
    spectra = b""
    for table in tables:
        spectra += struct.pack("<i", len(table))
        for nm, weight in table:
            spectra += struct.pack("<f", nm) + struct.pack("<f", weight)
    spectra += bytes((32 - len(spectra) % 32) % 32 if padding is None else padding)
    content += spectra
    for name in added:
        content += name.encode("utf-32-le").ljust(512, b"\0")
    content += text
    for ray in rays:
        for number in ray:
            content += struct.pack("<f", number)
    return content


def zemax_bytes(
    rays: Sequence[Sequence[float]] = RAYS,
    *,
    identifier: int = 1010,
    count: int | None = None,
    ray_set_flux: float = 4.0,
    wavelength: float = 0.55,
    unit: int = 4,
    ray_format: int = 0,
    flux_type: int = 1,
) -> bytes:
    """Return a binary source file of Zemax; what is not given is sound."""
    content = struct.pack("<i", identifier)
    content += struct.pack("<I", len(rays) if count is None else count)
    content += b"Amber LED".ljust(100, b"\0")
    content += struct.pack("<f", 9.0)  # SourceFlux
    content += struct.pack("<f", ray_set_flux)
    content += struct.pack("<f", wavelength)
    content += struct.pack("<f", 0.0) + struct.pack("<f", 180.0)  # inclination
    content += struct.pack("<f", 0.0) + struct.pack("<f", 360.0)  # azimuth
    assert len(content) == 136
    content += struct.pack("<i", unit)
    content += struct.pack("<3f", 7.0, 8.0, 9.0)  # place: not used
    content += struct.pack("<3f", 1.0, 1.0, 1.0)  # rotation: not used
    content += struct.pack("<3f", 2.0, 2.0, 2.0)  # scale: not used
    content += struct.pack("<4f", 0.0, 0.0, 0.0, 0.0)
    assert len(content) == 192
    content += struct.pack("<i", ray_format)
    content += struct.pack("<i", flux_type)
    content += struct.pack("<2i", 0, 0)
    assert len(content) == 208
    for ray in rays:
        for number in ray:
            content += struct.pack("<f", number)
    return content


@pytest.fixture
def goniometer() -> Callable[..., np.ndarray]:
    """Give `direction`."""
    return direction


@pytest.fixture
def ies() -> Callable[..., str]:
    """Give `ies_text`."""
    return ies_text


@pytest.fixture
def ldt() -> Callable[..., str]:
    """Give `ldt_text`."""
    return ldt_text


@pytest.fixture
def tm25() -> Callable[..., bytes]:
    """Give `tm25_bytes`."""
    return tm25_bytes


@pytest.fixture
def zemax() -> Callable[..., bytes]:
    """Give `zemax_bytes`."""
    return zemax_bytes


@pytest.fixture
def written(tmp_path: Path) -> Callable[[str, str | bytes], Path]:
    """Give a function that writes a file, by name and content, and returns its path."""

    def write(name: str, content: str | bytes) -> Path:
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write

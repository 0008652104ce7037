# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Writes small IES and EULUMDAT files from any function of direction."""

from __future__ import annotations

from collections.abc import Callable
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
def written(tmp_path: Path) -> Callable[[str, str | bytes], Path]:
    """Give a function that writes a file, by name and content, and returns its path."""

    def write(name: str, content: str | bytes) -> Path:
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Pictures one after the other in one file: an animated PNG, tagged as a still one is.

Browsers play it; what does not know animation shows the first picture. Source: Portable Network
Graphics (PNG) Specification (Third Edition), W3C 2025, §11.3.4 (``acTL``, ``fcTL``, ``fdAT``).
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lamplit.report.atomic import replacing
from lamplit.report.png import TAIL, chunk, compressed, head

if TYPE_CHECKING:
    from lamplit.colour.display import Display

#: How many pictures are shown in a second.
FRAMES_PER_SECOND = 10

_FOR_EVER = 0
_KEEP, _REPLACE = 0, 0


@dataclass(frozen=True)
class Frame:
    """A picture as the file keeps it."""

    width: int
    height: int
    pixels: bytes

    @classmethod
    def of(cls, encoded: NDArray[np.float64]) -> Frame:
        """Return display values ``encoded`` (H, W, 3) in [0, 1] with 8 bits a channel."""
        height, width, _ = encoded.shape
        return cls(width, height, compressed(encoded, bits=8))


def play_order(count: int, *, circle: bool) -> list[int]:
    """Return which of ``count`` pictures is shown when: round, or there and back.

    >>> play_order(4, circle=True), play_order(4, circle=False)
    ([0, 1, 2, 3], [0, 1, 2, 3, 2, 1])
    """
    there = list(range(count))
    return there if circle else there + there[-2:0:-1]


def write_animation(
    path: Path,
    frames: Sequence[Frame],
    display: Display,
    *,
    circle: bool,
    provenance: Mapping[str, str] | None = None,
) -> int:
    """Write ``frames``, all of one size, as an endless animation; return how many it shows a round.

    ``circle`` goes on with the first after the last, as a full turn does; else it goes back.

    Raises:
        OutputError: The file cannot be written; an older file is left as it was.
    """
    order = play_order(len(frames), circle=circle)
    first = frames[0]
    sequence = 0
    with replacing(path) as partial, partial.open("wb") as file:
        file.write(head(first.width, first.height, display, 8, provenance))
        file.write(chunk(b"acTL", struct.pack(">II", len(order), _FOR_EVER)))
        for shown, at in enumerate(order):
            place = (first.width, first.height, 0, 0)
            timing = (1, FRAMES_PER_SECOND, _KEEP, _REPLACE)
            control = struct.pack(">IIIIIHHBB", sequence, *place, *timing)
            file.write(chunk(b"fcTL", control))
            sequence += 1
            if shown == 0:
                file.write(chunk(b"IDAT", frames[at].pixels))
                continue
            file.write(chunk(b"fdAT", struct.pack(">I", sequence) + frames[at].pixels))
            sequence += 1
        file.write(TAIL)
    return len(order)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""PNG files of 8 or 16 bits that say which colours their numbers mean.

Source: Portable Network Graphics (PNG) Specification, third edition, W3C 2025.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from lamplit.report.atomic import write_bytes

if TYPE_CHECKING:
    from lamplit.colour.display import Display

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_TRUECOLOUR = 2
_FILTER_UP = 2


def write_png(
    path: Path,
    encoded: NDArray[np.float64],
    display: Display,
    *,
    bits: Literal[8, 16] = 8,
    provenance: Mapping[str, str] | None = None,
) -> None:
    """Write display values ``encoded`` (H, W, 3) in [0, 1] as a PNG tagged for ``display``.

    Values are rounded to the nearest code, without dithering. sRGB is tagged by the sRGB chunk
    with the gAMA and cHRM fall-backs of PNG §11.3.2.3; any other display by its ICC profile; and
    either by cICP where the display has code points. ``provenance`` goes into text chunks.

    Raises:
        OutputError: The file cannot be written; an older file is left as it was.
    """
    write_bytes(path, encode_png(encoded, display, bits=bits, provenance=provenance))


def encode_png(
    encoded: NDArray[np.float64],
    display: Display,
    *,
    bits: Literal[8, 16] = 8,
    provenance: Mapping[str, str] | None = None,
) -> bytes:
    """Return the bytes that `write_png` writes."""
    height, width, _ = encoded.shape
    pixels = compressed(encoded, bits=bits)
    return head(width, height, display, bits, provenance) + chunk(b"IDAT", pixels) + TAIL


def head(
    width: int,
    height: int,
    display: Display,
    bits: Literal[8, 16],
    provenance: Mapping[str, str] | None,
) -> bytes:
    """Return all of a PNG that comes before its pixels."""
    header = struct.pack(">IIBBBBB", width, height, bits, _TRUECOLOUR, 0, 0, 0)
    chunks = [chunk(b"IHDR", header), *_colour_chunks(display)]
    chunks += [_text_chunk(keyword, text) for keyword, text in (provenance or {}).items()]
    return _SIGNATURE + b"".join(chunks)


def compressed(encoded: NDArray[np.float64], *, bits: Literal[8, 16]) -> bytes:
    """Return the deflated rows of codes, each stored as its difference to the one above."""
    largest = (1 << bits) - 1
    codes = np.rint(np.clip(encoded, 0.0, 1.0) * largest).astype(">u2" if bits == 16 else "u1")
    rows = np.frombuffer(codes.tobytes(), dtype=np.uint8).reshape(codes.shape[0], -1)
    filtered = np.empty((rows.shape[0], rows.shape[1] + 1), dtype=np.uint8)
    filtered[:, 0] = _FILTER_UP
    filtered[0, 1:] = rows[0]
    np.subtract(rows[1:], rows[:-1], out=filtered[1:, 1:])
    return zlib.compress(filtered.tobytes(), 6)


def _colour_chunks(display: Display) -> list[bytes]:
    chunks: list[bytes] = []
    if display.cicp is not None:
        chunks.append(chunk(b"cICP", bytes(display.cicp)))
    if display.name == "srgb":
        relative_colorimetric = b"\x01"
        corners = np.concatenate([[display.white_xy], display.primaries_xy]).ravel()
        chunks.append(chunk(b"sRGB", relative_colorimetric))
        chunks.append(chunk(b"gAMA", struct.pack(">I", 45455)))
        chunks.append(chunk(b"cHRM", struct.pack(">8I", *np.rint(corners * 1e5).astype(int))))
    else:
        profile = zlib.compress(display.icc_profile(), 9)
        chunks.append(
            chunk(b"iCCP", display.name.encode("latin-1", "replace")[:79] + b"\0\0" + profile)
        )
    return chunks


def _text_chunk(keyword: str, text: str) -> bytes:
    """Return an iTXt chunk: a Latin-1 keyword and UTF-8 text, uncompressed, no language."""
    return chunk(b"iTXt", keyword.encode("latin-1")[:79] + b"\0\0\0\0\0" + text.encode())


def chunk(kind: bytes, body: bytes) -> bytes:
    """Return a chunk with its length and checksum (PNG §5.3)."""
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


#: What a PNG ends with.
TAIL = chunk(b"IEND", b"")

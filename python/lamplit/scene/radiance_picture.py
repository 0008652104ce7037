# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Radiance pictures: three mantissas and a common exponent, flat or run-length encoded.

Source: G. Ward, "Real Pixels", Graphics Gems II, 1991; Radiance, "File Formats", clause "Picture".
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import SceneError
from lamplit.scene.picture_limits import check_primaries, check_size

#: The header must end within so many bytes.
_LONGEST_HEADER = 65536

_SIZE = re.compile(rb"([-+])([XY]) (\d{1,9}) ([-+])([XY]) (\d{1,9})")

#: Scanlines of these widths may be encoded channel by channel.
_NEW_WIDTHS: Final = range(8, 32768)

#: A scanline encoded channel by channel begins with it, and its width in two bytes follows.
_NEW_MARK = b"\2\2"
_LONGEST_RUN = 127

_REPEAT = b"\1\1\1"

#: 1 is stored as mantissa 128 with exponent 129.
_EXPONENT_OF_MANTISSA_ONE = 136


def read_radiance(path: Path) -> NDArray[np.float32]:
    """Return linear RGB (H, W, 3) of a ``.hdr`` file: mantissa · 2^(exponent − 136).

    Raises:
        SceneError: The file is none, is cut off, has XYZE pixels or another orientation than
            ``-Y H +X W``.
        OSError: It cannot be read.
    """
    content = path.read_bytes()
    head, start, height, width = _header(path, content)
    check_size(path, height, width)
    least = 4 * -(-8 * width // (4 * _LONGEST_RUN)) if width in _NEW_WIDTHS else 4
    if height * least > len(content) - start:
        raise SceneError(
            f"{width} × {height} pixels cannot stand in the {len(content) - start} bytes after "
            "the header; the file is cut off, or its size line is wrong",
            file=path,
        )
    mantissas = _Scanlines(path, content, start, width).all(height)
    return _decoded(mantissas.reshape(height, width, 4), _gain(path, head))


def _header(path: Path, content: bytes) -> tuple[list[bytes], int, int, int]:
    """Return the header's lines, where the pixels start, and the height and width."""
    if not content.startswith((b"#?RADIANCE", b"#?RGBE")):
        raise SceneError("this is no Radiance picture: it does not begin with #?", file=path)
    end = content.find(b"\n\n", 0, _LONGEST_HEADER)
    size_end = content.find(b"\n", end + 2, end + 2 + 80)
    if end < 0 or size_end < 0:
        raise SceneError("the header has no end; get the file anew", file=path)
    head = content[:end].split(b"\n")
    where = f"line {len(head) + 2}"
    match = _SIZE.fullmatch(content[end + 2 : size_end].strip())
    if match is None or match[2] == match[5]:
        raise SceneError("a size such as '-Y 512 +X 1024' is due", file=path, where=where)
    if (match[1] + match[2], match[4] + match[5]) != (b"-Y", b"+X"):
        raise SceneError(
            "the picture is turned or mirrored; write it with the orientation -Y +X",
            file=path,
            where=where,
        )
    return head, size_end + 1, int(match[3]), int(match[6])


def _gain(path: Path, head: list[bytes]) -> NDArray[np.float64]:
    """Return what R, G and B are multiplied by: 1 over all exposures and corrections."""
    gain = np.ones(3)
    for number, line in enumerate(head, start=1):
        name, _, text = line.partition(b"=")
        name = name.strip().upper()
        if name == b"FORMAT" and text.strip() != b"32-bit_rle_rgbe":
            raise SceneError(
                "only 32-bit_rle_rgbe is understood; convert the picture to RGBE",
                file=path,
                where=f"line {number}",
            )
        if name in {b"EXPOSURE", b"COLORCORR", b"PRIMARIES"}:
            try:
                values = [float(word) for word in text.split()]
            except ValueError:
                values = []
            if name == b"PRIMARIES":
                check_primaries(path, values)
                continue
            if len(values) != (1 if name == b"EXPOSURE" else 3) or not all(
                1e-30 < value < 1e30 for value in values
            ):
                raise SceneError(
                    f"{name.decode()} is not as many numbers above 0 as it should be; mend it",
                    file=path,
                    where=f"line {number}",
                )
            gain /= values
    return gain


def _decoded(rgbe: NDArray[np.uint8], gain: NDArray[np.float64]) -> NDArray[np.float32]:
    """Return RGB (H, W, 3) of RGBE (H, W, 4), a row at a time to spare memory."""
    scales = np.ldexp(1.0, np.arange(256) - _EXPONENT_OF_MANTISSA_ONE)
    scales[0] = 0.0
    rgb = np.empty((*rgbe.shape[:2], 3), dtype=np.float32)
    with np.errstate(over="ignore"):  # what overflows is infinite, and is refused with its place
        for row, stored in enumerate(rgbe):
            rgb[row] = stored[:, :3] * scales[stored[:, 3]][:, None] * gain
    return rgb


class _Scanlines:
    """Reads scanline after scanline; memory grows with what is really there."""

    def __init__(self, path: Path, content: bytes, start: int, width: int) -> None:
        self._path = path
        self._content = content
        self._at = start
        self._width = width

    def all(self, height: int) -> NDArray[np.uint8]:
        """Return the next ``height`` scanlines, as bytes R G B E of each pixel."""
        pixels = bytearray()
        for row in range(height):
            pixels += self._by_channel(row) if self._is_by_channel(row) else self._by_pixel(row)
        return np.frombuffer(pixels, dtype=np.uint8)

    def _is_by_channel(self, row: int) -> bool:
        """Tell how the next scanline is encoded."""
        mark = self._content[self._at : self._at + 4]
        if self._width not in _NEW_WIDTHS or mark[:2] != _NEW_MARK or mark[2:3] >= b"\x80":
            return False
        if int.from_bytes(mark[2:], "big") != self._width:
            raise self._fault(row, f"has another width than {self._width}")
        return True

    def _by_channel(self, row: int) -> bytes:
        """Return a scanline whose channels follow each other, each in runs and stretches."""
        content, width, at = self._content, self._width, self._at + len(_NEW_MARK) + 2
        planes = bytearray()
        for channel in range(1, 5):
            end = channel * width
            while len(planes) < end:
                code = content[at] if at < len(content) else 0
                if code > 128:
                    planes += content[at + 1 : at + 2] * (code - 128)
                    at += 2
                else:
                    planes += content[at + 1 : at + 1 + code]
                    at += 1 + code
                if code == 0 or at > len(content):
                    raise self._fault(row, "ends too early")
            if len(planes) > end:
                raise self._fault(row, "has a run that is longer than the row")
        self._at = at
        return np.frombuffer(planes, dtype=np.uint8).reshape(4, width).T.tobytes()

    def _by_pixel(self, row: int) -> bytes:
        """Return a scanline of whole pixels; (1, 1, 1, n) repeats the one before n times.

        Repetitions right after each other give the digits of n in the base 256, lowest first.
        """
        content, due = self._content, 4 * self._width
        flat = content[self._at : self._at + due]
        if _REPEAT not in flat:
            self._at += due
            if len(flat) < due:
                raise self._fault(row, "ends too early")
            return flat
        pixels = bytearray()
        shift = 0
        while len(pixels) < due:
            pixel = content[self._at : self._at + 4]
            self._at += 4
            if len(pixel) < 4:
                raise self._fault(row, "ends too early")
            if pixel[:3] != _REPEAT:
                pixels += pixel
                shift = 0
                continue
            repeats = pixel[3] << shift
            shift += 8
            if not pixels or len(pixels) + 4 * repeats > due:
                raise self._fault(row, "repeats more than the row has")
            pixels += pixels[-4:] * repeats
        return bytes(pixels)

    def _fault(self, row: int, what: str) -> SceneError:
        return SceneError(f"the row {what}; get the file anew", file=self._path, where=f"row {row}")

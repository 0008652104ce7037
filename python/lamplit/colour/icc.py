# SPDX-License-Identifier: Apache-2.0 OR MIT
"""ICC profiles of displays with three colorants and three curves: read and written.

Source: ICC.1:2022 (profile version 4.4); numbers in parentheses are its clauses.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamplit.colour.adaptation import adaptation_matrix
from lamplit.colour.transfer import PowerTransfer, TableTransfer, Transfer
from lamplit.errors import LamplitError

#: The white of the profile connection space, D50 (6.3.4.3).
_PCS_WHITE = np.array([0.9642, 1.0, 0.8249])
_PCS_WHITE_XY = (0.9642 / 2.7891, 1.0 / 2.7891)

#: Larger profiles are refused: a matrix profile is a few kB.
_MAX_BYTES = 16 * 2**20
_MAX_TAGS = 1024

#: Parametric curves (10.18): which of g, a, b, c, d, e, f each function type stores.
_PARAMETERS = {0: 1, 1: 3, 2: 4, 3: 5, 4: 7}

_COLORANTS = (b"rXYZ", b"gXYZ", b"bXYZ")
_CURVES = (b"rTRC", b"gTRC", b"bTRC")


class MatrixProfile(NamedTuple):
    """What a matrix profile says of its display."""

    #: XYZ of full red, green and blue as columns, 3×3, under the display's own white.
    colorants: NDArray[np.float64]
    transfer: tuple[Transfer, Transfer, Transfer]


def read_matrix_profile(path: Path) -> MatrixProfile:
    """Return colorants and curves of the profile at ``path``.

    Raises:
        LamplitError: The file cannot be read, or is no RGB display profile with colorants and
            curves.
    """
    try:
        with path.open("rb") as stream:
            content = stream.read(_MAX_BYTES + 1)
    except OSError as fault:
        raise LamplitError(f"cannot be read: {fault.strerror}", file=path) from fault
    try:
        return _parse(content)
    except _ProfileError as fault:
        raise LamplitError(str(fault), file=path) from fault


class _ProfileError(Exception):
    """What is wrong with a profile."""


def _parse(content: bytes) -> MatrixProfile:
    if len(content) > _MAX_BYTES:
        raise _ProfileError(f"larger than {_MAX_BYTES >> 20} MB, which no display profile is")
    if len(content) < 132 or content[36:40] != b"acsp":
        raise _ProfileError("this is no ICC profile")
    if content[16:20] != b"RGB " or content[20:24] != b"XYZ ":
        raise _ProfileError("an RGB profile that connects through XYZ is needed")
    tags = _tags(content)
    if missing := [tag for tag in (*_COLORANTS, *_CURVES) if tag not in tags]:
        absent = b", ".join(missing).decode()
        raise _ProfileError(
            f"the profile has no {absent}: one with look-up tables only does not say what the "
            "primaries are; give a matrix profile, or primaries_xy, white_xy and gamma"
        )
    columns = np.stack([_numbers(tags[tag], b"XYZ ", 3) for tag in _COLORANTS], axis=1)
    colorants = _to_own_white(tags) @ columns
    if (colorants.sum(axis=0) <= 0.0).any():
        raise _ProfileError("a colorant of the profile has no light")
    red, green, blue = (_curve(tags[tag]) for tag in _CURVES)
    return MatrixProfile(colorants, (red, green, blue))


def _tags(content: bytes) -> dict[bytes, bytes]:
    (count,) = struct.unpack_from(">I", content, 128)
    if count > _MAX_TAGS or 132 + 12 * count > len(content):
        raise _ProfileError(f"the profile is cut short, or its {count} tags are a lie")
    tags: dict[bytes, bytes] = {}
    for index in range(count):
        signature, offset, size = struct.unpack_from(">4sII", content, 132 + 12 * index)
        if offset + size > len(content):
            raise _ProfileError(
                f"the tag {_printable(signature)} reaches beyond the end of the file"
            )
        tags[signature] = content[offset : offset + size]
    return tags


def _to_own_white(tags: dict[bytes, bytes]) -> NDArray[np.float64]:
    """Return the matrix from the D50 of the connection space back to the display's own white.

    Version 4 stores the adaptation (``chad``, 9.2.15); older profiles give the display's white
    (``wtpt``), and the adaptation is taken to be Bradford's.
    """
    if b"chad" in tags:
        adaptation = _numbers(tags[b"chad"], b"sf32", 9).reshape(3, 3)
        if abs(float(np.linalg.det(adaptation))) < 1e-6:
            raise _ProfileError("the profile's chromatic adaptation cannot be undone")
        return np.asarray(np.linalg.inv(adaptation), dtype=np.float64)
    if b"wtpt" not in tags:
        return np.eye(3)
    white = _numbers(tags[b"wtpt"], b"XYZ ", 3)
    if white[1] <= 0.0 or (white < 0.0).any():
        raise _ProfileError("the profile's white point has no light")
    white_xy = white[:2] / white.sum()
    return adaptation_matrix(_PCS_WHITE_XY, white_xy, method="bradford")


def _numbers(tag: bytes, kind: bytes, count: int) -> NDArray[np.float64]:
    """Return ``count`` s15Fixed16 numbers of a tag of type ``kind``."""
    if tag[:4] != kind or len(tag) < 8 + 4 * count:
        raise _ProfileError(f"a tag of type {_printable(kind)} is malformed")
    return np.frombuffer(tag, dtype=">i4", count=count, offset=8).astype(np.float64) / 65536.0


def _curve(tag: bytes) -> Transfer:
    if tag[:4] == b"curv" and len(tag) >= 12:
        return _sampled_curve(tag)
    if tag[:4] == b"para" and len(tag) >= 12:
        return _parametric_curve(tag)
    raise _ProfileError("a tone curve is neither 'curv' nor 'para'")


def _sampled_curve(tag: bytes) -> Transfer:
    (count,) = struct.unpack_from(">I", tag, 8)
    if 12 + 2 * count > len(tag):
        raise _ProfileError(f"a tone curve of {count} points is cut short")
    points = np.frombuffer(tag, dtype=">u2", count=count, offset=12).astype(np.float64)
    if count == 0:
        return PowerTransfer(1.0)
    if count == 1:
        if points[0] == 0:
            raise _ProfileError("a tone curve has gamma 0")
        return PowerTransfer(float(points[0]) / 256.0)
    if (np.diff(points) < 0).any() or points[0] >= points[-1]:
        raise _ProfileError("a tone curve falls somewhere; it must rise from black to white")
    light = (points - points[0]) / (points[-1] - points[0])
    return TableTransfer(tuple(light.tolist()))


def _parametric_curve(tag: bytes) -> Transfer:
    (function,) = struct.unpack_from(">H", tag, 8)
    if function not in _PARAMETERS:
        raise _ProfileError(f"a tone curve has the unknown function type {function}")
    stored = _numbers(tag, b"para", 1 + _PARAMETERS[function])[1:]
    g, a, b, c, d, e, f = _completed(function, stored.tolist())
    if g <= 0.0 or a <= 0.0 or c < 0.0:
        raise _ProfileError("a tone curve does not rise from black to white")
    if max(abs(e), abs(f)) > 1e-4:
        raise _ProfileError("a tone curve adds an offset to black, which is not understood")
    return PowerTransfer(g, a, b, c, d)


def _completed(function: int, stored: list[float]) -> list[float]:
    """Return g, a, b, c, d, e, f of any function type, as type 4 writes them (table 68)."""
    if function == 0:
        return [*stored, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    if function in (1, 2):
        g, a, b = stored[:3]
        offset = stored[3] if function == 2 else 0.0
        return [g, a, b, 0.0, -b / a if a else 0.0, offset, offset]
    return [*stored, 0.0, 0.0] if function == 3 else stored


def write_matrix_profile(
    name: str,
    rgb_to_xyz: NDArray[np.float64],
    white_xy: tuple[float, float],
    transfer: tuple[Transfer, Transfer, Transfer],
) -> bytes:
    """Return a version 4 display profile; the same display always gives the same bytes."""
    adaptation = adaptation_matrix(white_xy, _PCS_WHITE_XY, method="bradford")
    colorants = np.rint(adaptation @ rgb_to_xyz * 65536.0).astype(np.int64)
    colorants[:, 1] += np.rint(_PCS_WHITE * 65536.0).astype(np.int64) - colorants.sum(axis=1)
    tags = {
        b"desc": _text(f"Lamplit {name}"),
        b"cprt": _text("CC0-1.0"),
        b"wtpt": _fixed(b"XYZ ", np.rint(_PCS_WHITE * 65536.0)),
        b"chad": _fixed(b"sf32", np.rint(adaptation.ravel() * 65536.0)),
    }
    tags |= {tag: _fixed(b"XYZ ", colorants[:, i]) for i, tag in enumerate(_COLORANTS)}
    tags |= {tag: _curve_tag(curve) for tag, curve in zip(_CURVES, transfer, strict=True)}
    table, body = b"", b""
    start = 128 + 4 + 12 * len(tags)
    for signature, content in tags.items():
        table += struct.pack(">4sII", signature, start + len(body), len(content))
        body += content + b"\0" * (-len(content) % 4)
    return _header(start + len(body)) + struct.pack(">I", len(tags)) + table + body


def _header(size: int) -> bytes:
    white = struct.pack(">3i", *(int(v) for v in np.rint(_PCS_WHITE * 65536.0)))
    date = struct.pack(">6H", 2025, 1, 1, 0, 0, 0)
    return (
        struct.pack(">I4sI4s4s4s", size, b"\0" * 4, 0x04400000, b"mntr", b"RGB ", b"XYZ ")
        + date
        + b"acsp"
        + b"\0" * 28
        + white
        + b"\0" * 48
    )


def _text(text: str) -> bytes:
    encoded = text.encode("utf-16-be")
    return struct.pack(">4sIII4sII", b"mluc", 0, 1, 12, b"enUS", len(encoded), 28) + encoded


def _fixed(kind: bytes, numbers: NDArray[np.float64] | NDArray[np.int64]) -> bytes:
    return kind + b"\0" * 4 + np.asarray(numbers).astype(">i4").tobytes()


def _curve_tag(curve: Transfer) -> bytes:
    if isinstance(curve, TableTransfer):
        points = np.rint(np.array(curve.light) * 65535.0).astype(">u2")
        return b"curv" + struct.pack(">II", 0, points.size) + points.tobytes()
    pure = (curve.a, curve.b, curve.c, curve.d) == (1.0, 0.0, 0.0, 0.0)
    parameters = [curve.gamma] if pure else [curve.gamma, curve.a, curve.b, curve.c, curve.d]
    numbers = np.rint(np.array(parameters) * 65536.0).astype(">i4")
    return b"para" + struct.pack(">IHH", 0, 0 if pure else 3, 0) + numbers.tobytes()


def _printable(signature: bytes) -> str:
    return repr(signature.decode("latin-1"))

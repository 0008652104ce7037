# SPDX-License-Identifier: Apache-2.0 OR MIT
"""STL: three corners for each triangle, in binary or in text."""

from __future__ import annotations

import numpy as np

from lamplit.errors import GeometryError
from lamplit.scene.meshes.raw import RawMesh

_HEADER_BYTES = 84
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_stl(content: bytes) -> RawMesh:
    """Return the triangles of an STL file; its normals are not used.

    Raises:
        GeometryError: The count in the header is not what the file holds, or the text is broken.
    """
    count = int.from_bytes(content[80:84], "little") if len(content) >= _HEADER_BYTES else -1
    expected = _HEADER_BYTES + count * _TRIANGLE.itemsize
    if count < 0 or len(content) != expected:
        if content.lstrip()[:5].lower() == b"solid" and b"facet" in content[:100_000].lower():
            return _read_text(content)
        if count < 0:
            raise GeometryError("this is no STL file, or it was cut off within its header")
        raise GeometryError(
            f"the STL header promises {count} triangles in {expected} bytes, and the file has "
            f"{len(content)} bytes; export or copy the mesh again"
        )
    records = np.frombuffer(content, dtype=_TRIANGLE, count=count, offset=_HEADER_BYTES)
    return _soup(records["corners"].reshape(-1, 3).astype(np.float64))


def _read_text(content: bytes) -> RawMesh:
    words = content.lower().partition(b"\n")[2].split()
    starts = [at for at, word in enumerate(words) if word == b"vertex"]
    facets = words.count(b"endfacet")
    if b"endsolid" not in words or len(starts) != 3 * facets:
        raise GeometryError(
            f"the STL text breaks off: {len(starts)} corners for {facets} complete triangles; "
            "export or copy the mesh again"
        )
    numbers = [number for at in starts for number in words[at + 1 : at + 4]]
    try:
        corners = np.fromiter(map(float, numbers), np.float64, count=9 * facets)
    except ValueError as fault:
        raise GeometryError(f"the STL text has a corner without three numbers: {fault}") from fault
    return _soup(corners.reshape(-1, 3))


def _soup(corners: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> RawMesh:
    return RawMesh(corners, np.arange(len(corners), dtype=np.int64).reshape(-1, 3))

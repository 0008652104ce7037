# SPDX-License-Identifier: Apache-2.0 OR MIT
"""PLY: elements with typed properties, in text or in binary of either byte order.

Source of the format: G. Turk, "The PLY polygon file format" (1994).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import GeometryError
from lamplit.scene.meshes.raw import Floats, Indices, RawMesh, fan, fan_array

_WHOLE = ("i1", "u1", "i2", "u2", "i4", "u4")
_TYPES = {
    **dict(zip(("char", "uchar", "short", "ushort", "int", "uint"), _WHOLE, strict=True)),
    **dict(zip(("int8", "uint8", "int16", "uint16", "int32", "uint32"), _WHOLE, strict=True)),
    "float": "f4",
    "float32": "f4",
    "double": "f8",
    "float64": "f8",
}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_LONGEST_HEADER = 100_000
_INDEX_NAMES = ("vertex_indices", "vertex_index")


@dataclass(frozen=True)
class _Property:
    name: str
    type: str
    count_type: str | None = None


@dataclass(frozen=True)
class _Element:
    name: str
    count: int
    properties: tuple[_Property, ...]

    def position(self, names: Sequence[str]) -> int:
        return next((at for at, own in enumerate(self.properties) if own.name in names), -1)

    def has_lists(self) -> bool:
        return any(own.count_type for own in self.properties)


def read_ply(content: bytes) -> RawMesh:
    """Return the faces of a PLY file, polygons cut into fans.

    Raises:
        GeometryError: The header is broken, or promises more than the file holds.
    """
    order, elements, start = _header(content)
    names = [element.name for element in elements]
    if "vertex" not in names or "face" not in names:
        raise GeometryError(
            "the PLY header has no 'vertex' and 'face' elements; export the mesh as triangles"
        )
    source = _Text(content, start) if order == "" else _Binary(content, start, order)
    vertices: Floats = np.empty((0, 3))
    normals: Floats | None = None
    triangles: Indices = np.empty((0, 3), dtype=np.int64)
    for element in elements:
        if element.name == "vertex":
            columns = source.scalars(element)
            vertices, normals = _vectors(element, columns)
        elif element.name == "face":
            triangles = source.faces(element, _index_list(element))
        elif element.has_lists():
            source.faces(element, -1)
        else:
            source.scalars(element)
    return RawMesh(vertices, triangles, normals)


def _header(content: bytes) -> tuple[str, list[_Element], int]:
    head, mark, _ = content[:_LONGEST_HEADER].partition(b"end_header")
    lines = head.decode("latin-1").split("\n")
    if lines[0].strip() != "ply" or not mark:
        raise GeometryError("this is no PLY file, or it was cut off within its header")
    end = content.find(b"\n", len(head))
    start = len(content) if end < 0 else end + 1
    order: str | None = None
    elements: list[_Element] = []
    for number, line in enumerate(lines[1:], start=2):
        words = line.split()
        try:
            if not words or words[0] in ("comment", "obj_info"):
                continue
            if words[0] == "format":
                order = _ORDERS[words[1]]
            elif words[0] == "element":
                elements.append(_Element(words[1], _count(words[2]), ()))
            elif words[0] == "property":
                last = elements[-1]
                elements[-1] = _Element(last.name, last.count, (*last.properties, _property(words)))
            else:
                raise ValueError
        except (ValueError, KeyError, IndexError) as fault:
            raise GeometryError(f"line {number} of the PLY header is broken: {line!r}") from fault
    if order is None:
        raise GeometryError("the PLY header states no format")
    return order, elements, start


def _count(word: str) -> int:
    if not word.isdecimal() or len(word) > 12:
        raise ValueError
    return int(word)


def _property(words: list[str]) -> _Property:
    if words[1] == "list":
        return _Property(words[4], _TYPES[words[3]], _TYPES[words[2]])
    return _Property(words[2], _TYPES[words[1]])


def _index_list(element: _Element) -> int:
    at = element.position(_INDEX_NAMES)
    if at < 0 or element.properties[at].count_type is None:
        raise GeometryError("the PLY faces have no list 'vertex_indices'; export the mesh again")
    return at


def _vectors(element: _Element, columns: list[Floats]) -> tuple[Floats, Floats | None]:
    at = [element.position((axis,)) for axis in ("x", "y", "z", "nx", "ny", "nz")]
    if min(at[:3]) < 0:
        raise GeometryError("the PLY vertices have no properties x, y and z")
    vertices = np.stack([columns[i] for i in at[:3]], axis=1)
    return vertices, None if min(at) < 0 else np.stack([columns[i] for i in at[3:]], axis=1)


def _too_short(element: _Element) -> GeometryError:
    return GeometryError(
        f"the PLY header promises {element.count} '{element.name}' elements, and the file ends "
        "before them; export or copy the mesh again"
    )


class _Binary:
    """The body of a binary file, read from front to back."""

    def __init__(self, content: bytes, start: int, order: str) -> None:
        self._content, self._at, self._order = content, start, order

    def _records(self, element: _Element, kind: np.dtype[np.void]) -> NDArray[np.void]:
        size = element.count * kind.itemsize
        if size > len(self._content) - self._at:
            raise _too_short(element)
        return np.frombuffer(self._content, kind, element.count, self._at)

    def scalars(self, element: _Element) -> list[Floats]:
        """Return one column for each property."""
        if element.has_lists():
            raise GeometryError(f"the PLY element '{element.name}' has a list that is not expected")
        if not element.properties:
            return []
        kind = np.dtype([(f"p{i}", self._order + p.type) for i, p in enumerate(element.properties)])
        records = self._records(element, kind)
        self._at += element.count * kind.itemsize
        return [records[f"p{i}"].astype(np.float64) for i in range(len(element.properties))]

    def faces(self, element: _Element, wanted: int) -> Indices:
        """Return triangles from the list property number ``wanted``; -1 skips the element."""
        if element.count == 0:
            return np.empty((0, 3), dtype=np.int64)
        lengths = self._first_lengths(element)
        if wanted < 0 or lengths[wanted] >= 3:
            alike = self._alike(element, lengths)
            if alike is not None:
                self._at += element.count * alike.dtype.itemsize
                return fan_array(alike[f"p{wanted}"].astype(np.int64)) if wanted >= 0 else _none()
        polygons = self._one_by_one(element, wanted)
        return fan(polygons) if wanted >= 0 else _none()

    def _first_lengths(self, element: _Element) -> list[int]:
        at = self._at
        lengths: list[int] = []
        for own in element.properties:
            count, at = self._length(element, own, at)
            lengths.append(count)
            at += count * np.dtype(own.type).itemsize
        return lengths

    def _length(self, element: _Element, own: _Property, at: int) -> tuple[int, int]:
        if own.count_type is None:
            return 1, at
        size = np.dtype(own.count_type).itemsize
        if at + size > len(self._content):
            raise _too_short(element)
        if own.count_type.startswith("f"):
            raise GeometryError("a PLY list states its length as a fraction; export the mesh again")
        order = "big" if self._order == ">" else "little"
        count = int.from_bytes(
            self._content[at : at + size], order, signed=own.count_type.startswith("i")
        )
        if not 0 <= count * np.dtype(own.type).itemsize <= len(self._content) - at:
            raise _too_short(element)
        return count, at + size

    def _alike(self, element: _Element, lengths: list[int]) -> NDArray[np.void] | None:
        """Return every record at once if all have lists as long as those of the first one."""
        fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
        for i, (own, length) in enumerate(zip(element.properties, lengths, strict=True)):
            if own.count_type:
                fields.append((f"n{i}", self._order + own.count_type))
                fields.append((f"p{i}", self._order + own.type, (length,)))
            else:
                fields.append((f"p{i}", self._order + own.type))
        kind = np.dtype(fields)
        if element.count * kind.itemsize > len(self._content) - self._at:
            return None
        records = self._records(element, kind)
        lists = [i for i, own in enumerate(element.properties) if own.count_type]
        return records if all((records[f"n{i}"] == lengths[i]).all() for i in lists) else None

    def _one_by_one(self, element: _Element, wanted: int) -> list[list[int]]:
        smallest = sum(np.dtype(p.count_type or p.type).itemsize for p in element.properties)
        if element.count * max(smallest, 1) > len(self._content) - self._at:
            raise _too_short(element)
        polygons: list[list[int]] = []
        for _ in range(element.count):
            for i, own in enumerate(element.properties):
                count, self._at = self._length(element, own, self._at)
                end = self._at + count * int(own.type[1])
                if end > len(self._content):
                    raise _too_short(element)
                if i == wanted:
                    kind = self._order + own.type
                    numbers = np.frombuffer(self._content, kind, count, self._at)
                    polygons.append(numbers.astype(np.int64).tolist())
                self._at = end
        return polygons


class _Text:
    """The body of a text file, one element a line."""

    def __init__(self, content: bytes, start: int) -> None:
        lines = content[start:].split(b"\n")
        self._lines = [words for line in lines if (words := line.split())]
        self._at = 0

    def _take(self, element: _Element) -> list[list[bytes]]:
        taken = self._lines[self._at : self._at + element.count]
        if len(taken) < element.count:
            raise _too_short(element)
        self._at += element.count
        return taken

    def scalars(self, element: _Element) -> list[Floats]:
        """Return one column for each property."""
        width = len(element.properties)
        rows = self._take(element)
        if element.has_lists() or any(len(row) != width for row in rows):
            raise GeometryError(f"a PLY '{element.name}' line does not hold {width} numbers")
        try:
            numbers = np.fromiter(
                (float(word) for row in rows for word in row), np.float64, width * len(rows)
            )
        except ValueError as fault:
            raise GeometryError(f"a PLY '{element.name}' line is broken: {fault}") from fault
        return list(numbers.reshape(-1, width).T)

    def faces(self, element: _Element, wanted: int) -> Indices:
        """Return triangles from the list property number ``wanted``; -1 skips the element."""
        rows = self._take(element)
        if wanted < 0:
            return _none()
        try:
            return fan(_polygon(element, row, wanted) for row in rows)
        except (ValueError, IndexError) as fault:
            raise GeometryError(f"a PLY '{element.name}' line is broken: {fault}") from fault


def _polygon(element: _Element, row: list[bytes], wanted: int) -> list[int]:
    at = 0
    for own in element.properties[:wanted]:
        at += 1 + (int(row[at]) if own.count_type else 0)
    count = int(row[at])
    words = row[at + 1 : at + 1 + count]
    if count != len(words):
        raise ValueError(f"{count} corners are promised, and {len(words)} follow")
    return [int(word) for word in words]


def _none() -> Indices:
    return np.empty((0, 3), dtype=np.int64)

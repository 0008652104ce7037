# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Wavefront OBJ: vertices, normals and faces as text; material files are never opened."""

from __future__ import annotations

import numpy as np

from lamplit.errors import GeometryError
from lamplit.scene.meshes.raw import Floats, RawMesh, fan

_Face = tuple[list[int], list[int]]


def read_obj(content: bytes) -> RawMesh:
    """Return the faces of an OBJ file, polygons cut into fans.

    Raises:
        GeometryError: A line cannot be understood; the message names it.
    """
    vertices: list[list[float]] = []
    normals: list[list[float]] = []
    faces: list[list[int]] = []
    face_normals: list[list[int]] = []
    lines = content.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").split(b"\n")
    for number, line in enumerate(lines, start=1):
        words = line.split()
        if not words:
            continue
        try:
            if words[0] == b"v":
                vertices.append(_three(words))
            elif words[0] == b"f":
                corners, corner_normals = _face(words[1:], len(vertices), len(normals))
                faces.append(corners)
                face_normals.append(corner_normals)
            elif words[0] == b"vn":
                normals.append(_three(words))
        except (ValueError, IndexError) as fault:
            raise GeometryError(
                f"line {number} cannot be understood ({str(fault)[:80]}); export the mesh again"
            ) from fault
        except GeometryError as fault:
            raise GeometryError(f"line {number}: {fault.message}") from fault
    points = np.array(vertices, dtype=np.float64).reshape(-1, 3)
    triangles = fan(faces)
    if not normals or any(
        len(own) != len(face) for own, face in zip(face_normals, faces, strict=True)
    ):
        return RawMesh(points, triangles)
    return _with_normals(RawMesh(points, triangles), np.array(normals), fan(face_normals))


def _three(words: list[bytes]) -> list[float]:
    return [float(words[1]), float(words[2]), float(words[3])]


def _face(words: list[bytes], vertex_count: int, normal_count: int) -> _Face:
    corners: list[int] = []
    normals: list[int] = []
    for word in words:
        parts = word.split(b"/")
        corners.append(_index(parts[0], vertex_count, "vertex"))
        if len(parts) == 3 and parts[2]:
            normals.append(_index(parts[2], normal_count, "normal"))
    if len(corners) < 3:
        raise GeometryError(f"a face has {len(corners)} corners; three at least are needed")
    return corners, normals


def _index(text: bytes, count: int, noun: str) -> int:
    """Return the index from 0; in the file it counts from 1, or from the last one backwards."""
    given = int(text)
    index = given - 1 if given > 0 else count + given
    if given == 0 or not 0 <= index < count:
        raise GeometryError(f"{noun} {given} is named, and there are {count} so far")
    return index


def _with_normals(mesh: RawMesh, normals: Floats, normal_triangles: np.ndarray) -> RawMesh:
    """Return a mesh with one vertex for each pair of a position and a normal."""
    pairs = mesh.triangles * len(normals) + normal_triangles
    unique, corners = np.unique(pairs, return_inverse=True)
    positions, own_normals = np.divmod(unique, len(normals))
    return RawMesh(
        mesh.vertices[positions], corners.reshape(-1, 3).astype(np.int64), normals[own_normals]
    )

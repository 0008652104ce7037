# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`RawMesh`: the triangles of a file as they stand there, checked but not yet understood."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import GeometryError

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

#: The most triangles one file may hold: what a 32-bit index can name with room to spare.
MOST_TRIANGLES = 500_000_000


@dataclass(frozen=True, eq=False)
class RawMesh:
    """Vertices (n, 3) in the file's unit, triangles (m, 3), vertex normals (n, 3) or None."""

    vertices: Floats
    triangles: Indices
    normals: Floats | None = None

    def checked(self) -> RawMesh:
        """Return this mesh if it can be used.

        Raises:
            GeometryError: It is empty, an index names no vertex, or a coordinate is not finite.
        """
        if len(self.triangles) == 0 or len(self.vertices) == 0:
            raise GeometryError("the mesh is empty: it has no triangles")
        low, high = int(self.triangles.min()), int(self.triangles.max())
        if low < 0 or high >= len(self.vertices):
            raise GeometryError(
                f"a triangle names vertex {low if low < 0 else high}, "
                f"and the vertices run from 0 to {len(self.vertices) - 1}; export the mesh again"
            )
        bad = ~np.isfinite(self.vertices).all(axis=1)
        if bad.any():
            raise GeometryError(
                f"vertex {int(np.argmax(bad))} has a coordinate that is not a finite number; "
                "repair the mesh"
            )
        normals = self.normals
        if normals is not None and not np.isfinite(normals).all():
            normals = None
        return RawMesh(self.vertices, self.triangles, normals)


def dot(one: Floats, two: Floats) -> Floats:
    """Return the inner products (n,) of the rows of two arrays (n, 3)."""
    return np.einsum("ij,ij->i", one, two)


def joined(parts: Sequence[RawMesh]) -> RawMesh:
    """Return one mesh of all ``parts``; normals are kept when every part has them."""
    if len(parts) == 1:
        return parts[0]
    counts = [len(part.vertices) for part in parts]
    if not parts:
        return RawMesh(np.empty((0, 3)), np.empty((0, 3), dtype=np.int64))
    starts = np.cumsum([0, *counts[:-1]])
    normals = [part.normals for part in parts if part.normals is not None]
    return RawMesh(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.triangles + at for part, at in zip(parts, starts, strict=True)]),
        np.concatenate(normals) if len(normals) == len(parts) else None,
    )


def fan(polygons: Iterable[Sequence[int]]) -> Indices:
    """Return triangles (m, 3) that fan out from the first corner of each (convex) polygon.

    Raises:
        GeometryError: A polygon has fewer than three corners.
    """
    corners: list[int] = []
    for number, polygon in enumerate(polygons):
        if len(polygon) < 3:
            raise GeometryError(
                f"face {number} has {len(polygon)} corners; three at least are needed"
            )
        first = polygon[0]
        for at in range(1, len(polygon) - 1):
            corners += (first, polygon[at], polygon[at + 1])
    return np.array(corners, dtype=np.int64).reshape(-1, 3)


def fan_array(polygons: Indices) -> Indices:
    """Return the triangles of polygons (p, k) that have the same number k ≥ 3 of corners."""
    count = polygons.shape[1]
    order = [(0, at, at + 1) for at in range(1, count - 1)]
    return polygons[:, order].reshape(-1, 3)

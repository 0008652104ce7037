# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Probe`: is a point inside a closed mesh, or on its surface?"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamplit.scene.meshes.raw import Floats, Indices

#: Cells along a side of the grid at most, entries for each triangle, candidates looked at at once.
_MOST_CELLS = 1024
_ENTRIES = 8
_BATCH = 4_000_000
#: The ends of the side opposite to each corner.
_ONE, _TWO = [1, 2, 0], [2, 0, 1]


def _tilt() -> Floats:
    """Return a rotation after which no edge of a mesh drawn along axes is upright or level."""
    first = np.array([0.8137, 0.2911, 0.5032])
    first /= np.linalg.norm(first)
    second = np.cross(first, [0.1733, 0.9341, -0.3121])
    second /= np.linalg.norm(second)
    return np.stack([first, second, np.cross(first, second)])


_TILT = _tilt()


class Probe:
    """Answers for points by one line through each, along a fixed oblique direction.

    The triangles are sorted into a square grid across that direction, so that a point looks at
    few of them.
    """

    def __init__(self, vertices: Floats, triangles: Indices) -> None:
        """Sort the triangles (m, 3) of ``vertices`` (n, 3, mm) into the grid."""
        self._centre = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
        self._corners = ((vertices - self._centre) @ _TILT.T)[triangles]
        flat = self._corners[:, :, :2]
        low, high = flat.min(axis=1), flat.max(axis=1)
        self._low = low.min(axis=0)
        self._span = np.maximum(high.max(axis=0) - self._low, 1e-300)
        cells = min(_MOST_CELLS, max(1, int(np.sqrt(len(triangles)))))
        while True:
            self._cells = cells
            first, last = self._cell(low), self._cell(high)
            extent = last - first + 1
            counts = extent[:, 0] * extent[:, 1]
            if cells == 1 or int(counts.sum()) <= _ENTRIES * len(triangles) + 100_000:
                break
            cells //= 2
        owner = np.repeat(np.arange(len(triangles)), counts)
        rank = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
        column = first[owner, 0] + rank % extent[owner, 0]
        row = first[owner, 1] + rank // extent[owner, 0]
        cell = row * cells + column
        self._owners = owner[np.argsort(cell, kind="stable")]
        self._starts = np.concatenate([[0], np.cumsum(np.bincount(cell, minlength=cells * cells))])

    def _cell(self, flat: Floats) -> Indices:
        scaled = (flat - self._low) / self._span * self._cells
        return np.clip(scaled, 0, self._cells - 1).astype(np.int64)

    def inside(self, points: Floats) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Return for points (p, 3) in mm whether each lies inside the mesh, which is closed."""
        return self.distances(points) < 0.0

    def distances(self, points: Floats) -> Floats:
        """Return for points (p, 3) a distance in mm to the surface, negative inside.

        The sign is sure for a closed mesh. The number is the distance to the nearest of the
        triangles' planes that the line through the point meets: it is right close to the surface,
        and infinite where the line misses the mesh.
        """
        result = np.empty(len(points))
        for begin, end in self._batches(points):
            result[begin:end] = self._some(points[begin:end])
        return result

    def _candidates(self, flat: Floats) -> tuple[Indices, Indices]:
        cell = self._cell(flat)
        index = cell[:, 1] * self._cells + cell[:, 0]
        return self._starts[index], self._starts[index + 1] - self._starts[index]

    def _batches(self, points: Floats) -> Iterator[tuple[int, int]]:
        flat = ((points - self._centre) @ _TILT.T)[:, :2]
        total = np.cumsum(self._candidates(flat)[1])
        begin = 0
        while begin < len(points):
            done = total[begin - 1] if begin else 0
            end = max(begin + 1, int(np.searchsorted(total, done + _BATCH)))
            yield begin, end
            begin = end

    def _some(self, points: Floats) -> Floats:
        local = (points - self._centre) @ _TILT.T
        starts, counts = self._candidates(local[:, :2])
        point = np.repeat(np.arange(len(points)), counts)
        offset = np.arange(len(point)) - np.repeat(np.cumsum(counts) - counts, counts)
        corners = self._corners[self._owners[starts[point] + offset]]
        relative = corners - local[point][:, None, :]
        x, y, z = relative[:, :, 0], relative[:, :, 1], relative[:, :, 2]
        weights = _areas(x, y)
        met = (weights > 0).all(axis=1) | (weights < 0).all(axis=1)
        point, weights, z, relative = point[met], weights[met], z[met], relative[met]
        height = (weights * z).sum(axis=1) / weights.sum(axis=1)
        normal = np.cross(relative[:, 1] - relative[:, 0], relative[:, 2] - relative[:, 0])
        slope = np.abs(normal[:, 2]) / np.linalg.norm(normal, axis=1)
        nearest = np.full(len(points), np.inf)
        np.minimum.at(nearest, point, np.abs(height) * slope)
        above = np.bincount(point[height > 0], minlength=len(points))
        return np.where(above % 2 == 1, -nearest, nearest)


def _areas(x: Floats, y: Floats) -> Floats:
    """Return twice the signed areas (c, 3) that the origin spans with a triangle's sides.

    Where that is exactly zero, the order of the side's ends gives a sign, which is opposite in the
    two triangles that share the side: one of them is met, and one only.
    """
    one_x, one_y, two_x, two_y = x[:, _ONE], y[:, _ONE], x[:, _TWO], y[:, _TWO]
    areas: Floats = one_x * two_y - two_x * one_y
    if (areas == 0).any():
        rising = (one_x < two_x) | ((one_x == two_x) & (one_y < two_y))
        areas = np.where(areas == 0, np.where(rising, 1e-300, -1e-300), areas)
    return areas

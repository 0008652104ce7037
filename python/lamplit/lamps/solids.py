# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Closed triangle solids from rings of points: swept, revolved, drawn as tubes, repeated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Solid:
    """A closed surface: ``vertices`` (n, 3) in mm, ``triangles`` (m, 3) counter-clockwise outside.

    Every edge belongs to exactly two triangles, which run along it in opposite directions.
    """

    vertices: Floats
    triangles: Indices

    @property
    def volume_mm3(self) -> float:
        """The signed volume; positive because the triangles face outward."""
        return _signed_volume(self.vertices, self.triangles)


def outward(vertices: Floats, triangles: Indices) -> Solid:
    """Return the solid with its triangles turned so that the signed volume is positive."""
    if _signed_volume(vertices, triangles) < 0.0:
        triangles = triangles[:, ::-1]
    return Solid(vertices, np.ascontiguousarray(triangles))


def _signed_volume(vertices: Floats, triangles: Indices) -> float:
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def strip(loops: Indices) -> Indices:
    """Return the triangles between neighbouring closed ``loops`` (k, n) of vertex numbers."""
    a, d = loops[:-1], loops[1:]
    b, c = np.roll(a, -1, axis=1), np.roll(d, -1, axis=1)
    return np.concatenate(
        [np.stack([a, b, c], axis=-1).reshape(-1, 3), np.stack([a, c, d], axis=-1).reshape(-1, 3)]
    )


def swept(
    rings: Floats,
    *,
    closed: bool = False,
    start: ArrayLike | None = None,
    end: ArrayLike | None = None,
) -> Solid:
    """Return the solid whose surface runs through ``rings`` (k, n, 3), each a closed loop.

    With ``closed`` the last ring joins the first (a torus). Otherwise each end is closed by a fan
    to the point ``start`` or ``end``; where none is given, to the middle of that ring (a flat cap).
    """
    count, around = rings.shape[:2]
    loops = np.arange(count * around, dtype=np.int64).reshape(count, around)
    vertices = rings.reshape(-1, 3)
    if closed:
        return outward(vertices, strip(np.concatenate([loops, loops[:1]])))
    poles = [
        rings[k].mean(axis=0) if pole is None else np.asarray(pole, dtype=np.float64)
        for k, pole in ((0, start), (-1, end))
    ]
    first, last = count * around, count * around + 1
    caps = [
        np.stack([np.full(around, first), np.roll(loops[0], -1), loops[0]], axis=-1),
        np.stack([np.full(around, last), loops[-1], np.roll(loops[-1], -1)], axis=-1),
    ]
    return outward(np.concatenate([vertices, poles]), np.concatenate([strip(loops), *caps]))


def revolved(profile: ArrayLike, segments: int) -> Solid:
    """Return the solid of revolution about z of ``profile`` (k, 2), points (radius, z) in mm.

    The profile either runs from axis to axis (first and last radius 0) or is a closed line off
    the axis, whose last point joins the first.
    """
    points = np.asarray(profile, dtype=np.float64)
    on_axis = points[0, 0] == 0.0 and points[-1, 0] == 0.0
    line = points[1:-1] if on_axis else points
    angles = np.arange(segments) * (2.0 * np.pi / segments)
    rings = np.empty((len(line), segments, 3))
    rings[..., 0] = line[:, :1] * np.cos(angles)
    rings[..., 1] = line[:, :1] * np.sin(angles)
    rings[..., 2] = line[:, 1:]
    if not on_axis:
        return swept(rings, closed=True)
    return swept(rings, start=(0.0, 0.0, points[0, 1]), end=(0.0, 0.0, points[-1, 1]))


def tube(path: ArrayLike, radius_mm: float, reference: ArrayLike, sides: int) -> Solid:
    """Return a round wire along ``path`` (k, 3) with flat ends.

    ``reference`` (3,) or (k, 3): a direction that is nowhere parallel to the path; it keeps the
    cross-sections from twisting.
    """
    points = np.asarray(path, dtype=np.float64)
    along = np.gradient(points, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.broadcast_to(np.asarray(reference, dtype=np.float64), points.shape)
    across = across - np.einsum("ij,ij->i", across, along)[:, None] * along
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    angles = np.arange(sides) * (2.0 * np.pi / sides)
    rings = points[:, None] + radius_mm * (
        np.cos(angles)[:, None] * across[:, None]
        + np.sin(angles)[:, None] * np.cross(along, across)[:, None]
    )
    return swept(rings)


def cuboid(low_mm: ArrayLike, high_mm: ArrayLike) -> Solid:
    """Return the box between two corners (3,) in mm."""
    low, high = np.asarray(low_mm, dtype=np.float64), np.asarray(high_mm, dtype=np.float64)
    corners = np.array([(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
    sides = strip(np.arange(8, dtype=np.int64).reshape(2, 4))
    ends = np.array([(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7)])
    return outward(low + corners * (high - low), np.concatenate([sides, ends]))


def joined(*solids: Solid) -> Solid:
    """Return separate solids as one mesh."""
    starts = np.cumsum([0, *(len(solid.vertices) for solid in solids[:-1])])
    return Solid(
        np.concatenate([solid.vertices for solid in solids]),
        np.concatenate([s.triangles + start for s, start in zip(solids, starts, strict=True)]),
    )


def repeated(solid: Solid, offsets_mm: ArrayLike) -> Solid:
    """Return one mesh of copies of ``solid``, moved by ``offsets_mm`` (c, 3)."""
    offsets = np.asarray(offsets_mm, dtype=np.float64)
    steps = np.arange(len(offsets), dtype=np.int64) * len(solid.vertices)
    return Solid(
        (offsets[:, None] + solid.vertices).reshape(-1, 3),
        (steps[:, None, None] + solid.triangles).reshape(-1, 3),
    )

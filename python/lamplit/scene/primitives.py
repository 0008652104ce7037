# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Distances to primitives, and points on them, in the coordinates of their own equations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lamplit.scene.objects import (
    Box,
    Cylinder,
    Disc,
    Plane,
    Primitive,
    Sphere,
    Tetrahedron,
)

Array = NDArray[np.float64]

_GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))
#: A regular polygon of 64 corners around a circle is larger than it by this factor.
_AROUND = 1.0 / np.cos(np.pi / 64)
_FACES = ((1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2))


def unit(vector: Sequence[float] | Array) -> Array:
    """Return ``vector`` (3,) at length 1."""
    array = np.asarray(vector, dtype=np.float64)
    return array / np.linalg.norm(array)


def signed_distances(shape: Primitive, points: Array) -> Array:
    """Return distances (p,) in mm of ``points`` (p, 3) to the surface, negative inside.

    A plane and a disc have no inside. Outside a solid with edges the number is the distance to
    the nearest of its faces' planes or mantles, which is too small beside an edge.
    """
    if isinstance(shape, Sphere):
        return np.linalg.norm(points - shape.centre_mm, axis=1) - shape.radius_mm
    if isinstance(shape, Plane):
        return np.abs((points - shape.point_mm) @ unit(shape.normal))
    if isinstance(shape, (Box, Tetrahedron)):
        feet, normals = _faces(shape)
        return ((points[:, None, :] - feet) * normals).sum(axis=2).max(axis=1)
    if isinstance(shape, Disc):
        height, radius = _axial(points, shape.centre_mm, shape.normal)
        return np.maximum(np.abs(height), radius - shape.radius_mm)
    height, radius = _axial(points, shape.base_mm, shape.axis)
    if isinstance(shape, Cylinder):
        return np.maximum.reduce([-height, height - shape.height_mm, radius - shape.radius_mm])
    slope = shape.radius_mm / shape.height_mm
    mantle = (radius - slope * (shape.height_mm - height)) / np.hypot(1.0, slope)
    return np.maximum(-height, mantle)


def outline(shape: Primitive) -> Array:
    """Return points (p, 3) whose bounds hold the shape, and little more; none for a plane."""
    if isinstance(shape, Plane):
        return np.empty((0, 3))
    if isinstance(shape, Sphere):
        steps = shape.radius_mm * np.concatenate([np.eye(3), -np.eye(3)])
        return np.array(shape.centre_mm) + steps
    if isinstance(shape, Tetrahedron):
        return np.array(shape.points_mm)
    if isinstance(shape, Box):
        ends = (shape.min_mm, shape.max_mm)
        return np.array([[ends[i >> k & 1][k] for k in range(3)] for i in range(8)])
    if isinstance(shape, Disc):
        centre, normal = np.array(shape.centre_mm), unit(shape.normal)
        return _circle(centre, normal, _AROUND * shape.radius_mm, 64)
    base, axis = np.array(shape.base_mm), unit(shape.axis)
    top = base + shape.height_mm * axis
    lower = _circle(base, axis, _AROUND * shape.radius_mm, 64)
    upper = lower + (top - base) if isinstance(shape, Cylinder) else top[None, :]
    return np.concatenate([lower, upper])


def surface_points(shape: Primitive, count: int) -> Array:
    """Return about ``count`` points on the surface, its edges among them; none on a plane."""
    if isinstance(shape, Plane):
        return np.empty((0, 3))
    if isinstance(shape, Sphere):
        return np.array(shape.centre_mm) + shape.radius_mm * _ball(count)
    side = max(2, int(np.sqrt(count / 6)))
    if isinstance(shape, Box):
        return _box_points(shape, side)
    if isinstance(shape, Tetrahedron):
        corners = np.array(shape.points_mm)
        steps = np.arange(side + 1) / side
        one, two = (axis.ravel() for axis in np.meshgrid(steps, steps))
        one, two = one[one + two <= 1.0 + 1e-12], two[one + two <= 1.0 + 1e-12]
        weights = np.stack([one, two, np.maximum(1.0 - one - two, 0.0)], axis=1)
        return np.concatenate([weights @ corners[list(face)] for face in _FACES])
    if isinstance(shape, Disc):
        return _disc(np.array(shape.centre_mm), unit(shape.normal), shape.radius_mm, count)
    base, axis = np.array(shape.base_mm), unit(shape.axis)
    top = base + shape.height_mm * axis
    parts = [_disc(base, axis, shape.radius_mm, count // 4)]
    if isinstance(shape, Cylinder):
        parts.append(_disc(top, axis, shape.radius_mm, count // 4))
    for share in np.linspace(0.0, 1.0, side).tolist():
        radius = shape.radius_mm * (1.0 if isinstance(shape, Cylinder) else 1.0 - share)
        parts.append(_circle(base + share * (top - base), axis, radius, 3 * side))
    return np.concatenate(parts)


def _faces(shape: Box | Tetrahedron) -> tuple[Array, Array]:
    """Return points (f, 3) and outward normals (f, 3) of the planes around a flat-sided solid."""
    if isinstance(shape, Box):
        feet = np.array([shape.min_mm] * 3 + [shape.max_mm] * 3)
        return feet, np.concatenate([-np.eye(3), np.eye(3)])
    corners = np.array(shape.points_mm)
    faces = corners[np.array(_FACES)]
    normals: Array = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    inward = ((corners - faces[:, 0]) * normals).sum(axis=1) > 0.0
    normals[inward] *= -1.0
    return faces[:, 0], normals


def _axial(points: Array, foot: Sequence[float], axis: Sequence[float]) -> tuple[Array, Array]:
    """Return height along ``axis`` over ``foot``, and distance from the axis."""
    relative, way = points - np.asarray(foot), unit(axis)
    height = relative @ way
    return height, np.linalg.norm(relative - height[:, None] * way, axis=1)


def _frame(normal: Array) -> tuple[Array, Array]:
    """Return two unit vectors that stand on ``normal`` and on each other."""
    aside: Array = np.eye(3)[int(np.argmin(np.abs(normal)))]
    across: Array = np.cross(normal, aside)
    first = unit(across)
    return first, np.cross(normal, first)


def _box_points(shape: Box, side: int) -> Array:
    steps = np.linspace(0.0, 1.0, side + 1)
    one, two = (axis.ravel() for axis in np.meshgrid(steps, steps))
    parts: list[Array] = []
    for axis in range(3):
        for end in (0.0, 1.0):
            share = np.full((len(one), 3), end)
            share[:, (axis + 1) % 3], share[:, (axis + 2) % 3] = one, two
            parts.append(share)
    low, high = np.array(shape.min_mm), np.array(shape.max_mm)
    return low + (high - low) * np.concatenate(parts)


def _ball(count: int) -> Array:
    """Return points spread evenly over the unit sphere along a golden spiral."""
    height = 1.0 - 2.0 * (np.arange(count) + 0.5) / count
    angle, across = np.arange(count) * _GOLDEN_ANGLE, np.sqrt(1.0 - height**2)
    return np.stack([across * np.cos(angle), height, across * np.sin(angle)], axis=1)


def _circle(centre: Array, normal: Array, radius: float, count: int) -> Array:
    """Return points spread evenly on a circle."""
    first, second = _frame(normal)
    angle = np.arange(count)[:, None] * (2.0 * np.pi / count)
    return centre + radius * (np.cos(angle) * first + np.sin(angle) * second)


def _disc(centre: Array, normal: Array, radius: float, count: int) -> Array:
    """Return points spread evenly over a disc, its centre and rim among them."""
    first, second = _frame(normal)
    share = np.sqrt(np.arange(count) / max(count - 1, 1))[:, None]
    angle = np.arange(count)[:, None] * _GOLDEN_ANGLE
    return centre + radius * share * (np.cos(angle) * first + np.sin(angle) * second)

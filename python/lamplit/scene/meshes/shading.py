# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Vertex normals, so that a faceted mesh is shaded as the smooth surface it stands for."""

from __future__ import annotations

import numpy as np

from lamplit.scene.meshes.raw import Floats, Indices, dot
from lamplit.scene.meshes.topology import Edges


def normals_and_angles(vertices: Floats, triangles: Indices) -> tuple[Floats, Floats]:
    """Return the unit normals of triangles (m, 3), and the angle in radians at each corner (m, 3).

    A triangle without area has a normal of zero. Two sides span the same area at each corner, so
    that the tangent of its angle is twice the area over the inner product of its sides.
    """
    one, two, three = (vertices[triangles[:, corner]] for corner in range(3))
    sides = (two - one, three - two, one - three)
    normals = np.cross(sides[0], -sides[2])
    doubled = np.sqrt(dot(normals, normals))[:, None]
    inner = [-dot(sides[corner], sides[corner - 1]) for corner in range(3)]
    angles = np.arctan2(doubled, np.stack(inner, axis=1))
    return normals / np.where(doubled > 0, doubled, 1.0), angles


def smooth(
    vertices: Floats, triangles: Indices, edges: Edges, crease_deg: float
) -> tuple[Floats, Indices, Floats]:
    """Return vertices, triangles and unit normals, split where the surface has a crease.

    Corners that meet at a vertex share a normal when they are joined by edges that bend by
    ``crease_deg`` or less. A shared normal is the mean of the faces', weighted by their angles at
    the vertex (G. Thürmer and C. A. Wüthrich, "Computing vertex normals from polygonal facets",
    J. Graphics Tools 3 (1998) 43–46).
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    normals, angles = normals_and_angles(vertices, triangles)
    flat = triangles.reshape(-1)
    bend = dot(normals[edges.pairs[:, 0]], normals[edges.pairs[:, 1]])
    soft = edges.agree & (bend >= np.cos(np.radians(crease_deg)) - 1e-12)
    one, two = edges.pair_slots[soft, 0], edges.pair_slots[soft, 1]
    one_end, two_end = _next_corner(one), _next_corner(two)
    rows = np.concatenate([one, one_end])
    columns = np.concatenate([two_end, two])
    links = coo_matrix((np.ones(len(rows), np.int8), (rows, columns)), shape=(len(flat), len(flat)))
    count, labels = connected_components(links.tocsr(), directed=False)
    group = labels.astype(np.int64)
    weighted = (normals[:, None, :] * angles[:, :, None]).reshape(-1, 3)
    sums = np.stack([np.bincount(group, weighted[:, i], minlength=count) for i in range(3)], axis=1)
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    points = np.empty((count, 3))
    points[group] = vertices[flat]
    smoothed = np.divide(sums, lengths, out=np.zeros_like(sums), where=lengths > 1e-12)
    return (points, group.reshape(-1, 3), _filled(smoothed, normals, group))


def facing(normals: Floats, vertices: Floats, triangles: Indices) -> Floats:
    """Return unit ``normals`` (n, 3), each turned to the side that its triangles face."""
    faces, angles = normals_and_angles(vertices, triangles)
    mean = np.zeros_like(vertices)
    for corner in range(3):
        for axis in range(3):
            mean[:, axis] += np.bincount(
                triangles[:, corner], faces[:, axis] * angles[:, corner], minlength=len(vertices)
            )
    turned = np.where((normals * mean).sum(axis=1, keepdims=True) < 0, -normals, normals)
    lengths = np.linalg.norm(turned, axis=1, keepdims=True)
    means = np.linalg.norm(mean, axis=1, keepdims=True)
    fallback = np.divide(mean, means, out=np.zeros_like(mean), where=means > 0)
    return np.where(lengths > 1e-12, turned / np.maximum(lengths, 1e-300), fallback)


def _next_corner(slots: Indices) -> Indices:
    return slots - slots % 3 + (slots + 1) % 3


def _filled(smoothed: Floats, faces: Floats, group: Indices) -> Floats:
    """Return ``smoothed`` with a face's own normal where a sum of normals has cancelled."""
    empty = (smoothed == 0).all(axis=1)
    if empty.any():
        own = np.zeros_like(smoothed)
        own[group] = np.repeat(faces, 3, axis=0)
        smoothed = np.where(empty[:, None], own, smoothed)
    return smoothed

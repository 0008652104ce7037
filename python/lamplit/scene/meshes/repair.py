# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What may be put right in a mesh without changing its shape: seams, doubles, empty triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamplit.errors import GeometryError
from lamplit.scene.meshes.raw import Floats, Indices, dot
from lamplit.scene.meshes.topology import Edges, find_edges, merge_equal

#: Vertices on open edges closer than this share of the mesh's diagonal are one vertex.
_SEAM = 1e-6


@dataclass(frozen=True, eq=False)
class Repaired:
    """Merged vertices (n, 3) in mm, triangles (m, 3), and where they come from.

    ``edges``: those of ``triangles``; ``origin`` (raw vertices,): the merged vertex of each vertex
    of the file; ``source`` (m, 3): the triangles in the file's own vertices.
    """

    vertices: Floats
    triangles: Indices
    edges: Edges
    origin: Indices
    source: Indices
    notices: tuple[str, ...]


def repair(vertices_mm: Floats, triangles: Indices) -> Repaired:
    """Merge equal vertices, close hairline seams, drop triangles without area and doubles.

    Raises:
        GeometryError: No triangle is left.
    """
    notices: list[str] = []
    vertices, origin = merge_equal(vertices_mm)
    merged = origin[triangles]
    sound = _distinct(merged)
    if not sound.any():
        raise GeometryError("the mesh is empty: every triangle has two corners at one point")
    edges = find_edges(merged[sound])
    if len(edges.open_edges):
        joined = _close_seams(vertices, np.unique(edges.open_edges))
        trial = joined[merged]
        trial_sound = _distinct(trial)
        trial_edges = find_edges(trial[trial_sound]) if trial_sound.any() else edges
        if len(trial_edges.open_edges) < len(edges.open_edges):
            count = int((joined != np.arange(len(joined))).sum())
            notices.append(f"{count} vertices on seams, less than a millionth apart, were joined")
            merged, sound, edges, origin = (trial, trial_sound, trial_edges, joined[origin])
    keep = np.flatnonzero(sound)
    if len(keep) < len(sound):
        notices.append(f"{len(sound) - len(keep)} degenerate triangles were removed")
    if edges.crowded:
        once = _first_of_doubles(merged[keep])
        if len(once) < len(keep):
            notices.append(f"{len(keep) - len(once)} triangles that stood there twice were removed")
            edges = find_edges(merged[keep[once]])
        keep = keep[once]
    kept = merged[keep]
    flat = _without_area(vertices, kept)
    if flat == len(kept):
        raise GeometryError("the mesh is empty: no triangle has an area")
    if flat:
        notices.append(f"{flat} degenerate triangles have no area, and no ray will meet them")
    return Repaired(vertices, kept, edges, origin, triangles[keep], tuple(notices))


def _distinct(triangles: Indices) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    one, two, three = triangles.T
    return (one != two) & (two != three) & (three != one)


def _close_seams(vertices: Floats, rim: Indices) -> Indices:
    """Return for each vertex the one it becomes when near ones of ``rim`` are joined.

    Two grids, one shifted by half a cell, sort the vertices; those that share a cell are joined.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    points = vertices[rim]
    diagonal = float(np.linalg.norm(vertices.max(axis=0) - vertices.min(axis=0)))
    scaled = (points - points.min(axis=0)) / (2.0 * _SEAM * diagonal)
    cells: list[Indices] = []
    taken = len(rim)
    for shift in (0.0, 0.5):
        _, cell = merge_equal(np.floor(scaled + shift))
        cells.append(cell + taken)
        taken += int(cell.max()) + 1
    rows = np.tile(np.arange(len(rim)), 2)
    links = coo_matrix((np.ones(len(rows), np.int8), (rows, np.concatenate(cells))), (taken, taken))
    _, labels = connected_components(links.tocsr(), directed=False)
    _, first, group = np.unique(labels[: len(rim)], return_index=True, return_inverse=True)
    joined = np.arange(len(vertices))
    joined[rim] = rim[first[group]]
    return joined


def _first_of_doubles(triangles: Indices) -> Indices:
    """Return which triangles to keep so that none stands twice with the same side out."""
    first = triangles.argmin(axis=1)
    turned = np.stack([triangles[np.arange(len(first)), (first + i) % 3] for i in range(3)], axis=1)
    _, where = merge_equal(turned.astype(np.float64))
    return np.sort(np.unique(where, return_index=True)[1])


def _without_area(vertices: Floats, triangles: Indices) -> int:
    start, second, third = (vertices[triangles[:, corner]] for corner in range(3))
    one, two = second - start, third - start
    normal = np.cross(one, two)
    longest = np.maximum(dot(one, one), dot(two, two))
    return int((np.sqrt(dot(normal, normal)) <= 1e-12 * longest).sum())

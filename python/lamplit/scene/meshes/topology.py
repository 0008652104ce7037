# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Which triangles are neighbours: closed or open, and which side of each is outside."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamplit.scene.meshes.probe import Probe
from lamplit.scene.meshes.raw import Floats, Indices, dot

_Flags = NDArray[np.bool_]

#: Shells of one mesh beyond this number are not searched for cavities.
_MOST_SHELLS = 2000
_MIX = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], dtype=np.uint64)


def merge_equal(points: Floats) -> tuple[Floats, Indices]:
    """Return the distinct rows of ``points`` (n, 3), and for each row where its value stands."""
    clean = np.ascontiguousarray(points + 0.0)
    keys = clean.view(np.uint64) * _MIX
    keys ^= keys >> np.uint64(29)
    hashes = keys[:, 0] + (keys[:, 1] << np.uint64(1)) + (keys[:, 2] >> np.uint64(1))
    _, first, where = np.unique(hashes, return_index=True, return_inverse=True)
    distinct = clean[first]
    if not np.array_equal(distinct[where], clean):
        distinct, where = np.unique(clean, axis=0, return_inverse=True)
    return distinct, where.reshape(-1).astype(np.int64)


@dataclass(frozen=True, eq=False)
class Edges:
    """The undirected edges of triangles (m, 3), and the pairs of triangles that share one.

    ``open_edges`` (k, 2): vertices of edges with an odd number of triangles. ``crowded``: how many
    edges have more than two. ``pairs`` (p, 2): triangles that share an edge of exactly two;
    ``agree`` (p,): they run through it in opposite directions, as on one side of a surface.
    ``pair_slots`` (p, 2): 3 × triangle + side, for the two sides of each pair.
    """

    open_edges: Indices
    crowded: int
    pairs: Indices
    agree: _Flags
    pair_slots: Indices


def find_edges(triangles: Indices) -> Edges:
    """Return the edges of triangles (m, 3) with merged vertices."""
    starts = triangles.reshape(-1)
    ends = triangles[:, [1, 2, 0]].reshape(-1)
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    order, ordered = _sorted(low * (int(triangles.max()) + 1) + high)
    heads = np.flatnonzero(np.concatenate([[True], ordered[1:] != ordered[:-1]]))
    counts = np.diff(np.append(heads, len(order)))
    odd = order[heads[counts % 2 == 1]]
    twos = heads[counts == 2]
    slots = np.stack([order[twos], order[twos + 1]], axis=1)
    forward = starts < ends
    return Edges(
        np.stack([starts[odd], ends[odd]], axis=1),
        int((counts > 2).sum()),
        slots // 3,
        forward[slots[:, 0]] != forward[slots[:, 1]],
        slots,
    )


def _sorted(keys: Indices) -> tuple[Indices, Indices]:
    """Return the stable order of ``keys`` (n,) >= 0, and the keys in it.

    A key and its place fit into one number unless the mesh is huge, and numbers alone are sorted
    several times faster than their order is found.
    """
    bits = len(keys).bit_length()
    if int(keys.max()) >= 1 << (63 - bits):
        order = np.argsort(keys, kind="stable")
        return order, keys[order]
    packed = np.sort((keys << bits) | np.arange(len(keys)))
    return packed & ((1 << bits) - 1), packed >> bits


@dataclass(frozen=True, eq=False)
class Orientation:
    """Which triangles must be turned so that each closed shell's normals point outward.

    ``turn`` (m,), ``shell`` (m,): the connected part that each triangle belongs to;
    ``one_sided``: parts that have no two sides, as a Möbius strip.
    """

    turn: _Flags
    shell: Indices
    shells: int
    one_sided: int


def orient(vertices: Floats, triangles: Indices, edges: Edges) -> Orientation:
    """Return how to orient ``triangles`` (m, 3): closed shells outward, open ones by majority.

    A closed shell within an odd number of others bounds a cavity: its normals point into it.
    """
    turn, shell, shells, one_sided = _agreeing(len(triangles), edges)
    is_open = np.zeros(shells, dtype=bool)
    if len(edges.open_edges):
        rim = np.zeros(len(vertices), dtype=bool)
        rim[edges.open_edges] = True
        is_open[shell[rim[triangles].any(axis=1)]] = True
    middle: Floats = vertices.mean(axis=0)
    centred = vertices - middle
    one, two, three = (centred[triangles[:, corner]] for corner in range(3))
    volumes = dot(one, np.cross(two, three)) / 6.0
    signed = np.bincount(shell, np.where(turn, -volumes, volumes), minlength=shells)
    turned = np.bincount(shell, turn, minlength=shells)
    sizes = np.bincount(shell, minlength=shells)
    cavity = _cavities(vertices, triangles, shell, sizes, is_open)
    wrong = np.where(is_open, 2 * turned > sizes, (signed < 0.0) != cavity)
    return Orientation(turn ^ wrong[shell], shell, shells, one_sided)


def _agreeing(count: int, edges: Edges) -> tuple[_Flags, Indices, int, int]:
    """Return the turns that make neighbours agree, and the connected parts.

    Two copies of each triangle, one as it is and one turned, are linked where they agree across
    an edge: the copies fall apart into two mirror images for each part that has two sides.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    one, two = edges.pairs[:, 0], edges.pairs[:, 1]
    if edges.agree.all():
        links = coo_matrix((np.ones(len(one), np.int8), (one, two)), shape=(count, count))
        shells, shell = connected_components(links.tocsr(), directed=False)
        return np.zeros(count, dtype=bool), shell.astype(np.int64), int(shells), 0
    across = np.where(edges.agree, 0, count)
    rows = np.concatenate([one, one + count])
    columns = np.concatenate([two + across, two + count - across])
    links = coo_matrix((np.ones(len(rows), np.int8), (rows, columns)), shape=(2 * count, 2 * count))
    _, labels = connected_components(links.tocsr(), directed=False)
    as_is, turned = labels[:count], labels[count:]
    names, shell = np.unique(np.minimum(as_is, turned), return_inverse=True)
    one_sided = np.unique(shell[as_is == turned]).size
    return turned < as_is, shell.astype(np.int64), len(names), one_sided


def _cavities(
    vertices: Floats, triangles: Indices, shell: Indices, sizes: Indices, is_open: _Flags
) -> _Flags:
    """Return for each shell whether it lies within an odd number of closed ones."""
    count = len(sizes)
    depth = np.zeros(count, dtype=np.int64)
    if not 1 < count <= _MOST_SHELLS:
        return depth == 1
    order = np.argsort(shell, kind="stable")
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    corners = vertices[triangles[order]]
    low = np.minimum.reduceat(corners.min(axis=1), starts)
    high = np.maximum.reduceat(corners.max(axis=1), starts)
    for outer in np.flatnonzero(~is_open):
        within = (low > low[outer]).all(axis=1) & (high < high[outer]).all(axis=1)
        inner = np.flatnonzero(within)
        if len(inner):
            own = order[starts[outer] : starts[outer] + sizes[outer]]
            inside = Probe(vertices, triangles[own]).inside(corners[starts[inner], 0])
            depth[inner] += inside
    return depth % 2 == 1

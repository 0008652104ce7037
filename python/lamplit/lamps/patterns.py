# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Patterns of small optics over an outline: pillows in squares, cube corners in triangles.

A pattern is a flat triangulation (`Patch`) whose edges follow the creases of the optics and whose
border lies on the outline, with a height per vertex.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lamplit.lamps.outlines import Superellipse
from lamplit.lamps.solids import Floats, Indices


@dataclass(frozen=True)
class Patch:
    """A flat triangulation inside an outline.

    ``xy`` (n, 2) in mm; ``triangles`` (m, 3) counter-clockwise; ``border`` (b,) the vertices on the
    outline, counter-clockwise; ``height`` (n,) in mm.
    """

    xy: Floats
    triangles: Indices
    border: Indices
    height: Floats


def square_patch(outline: Superellipse, pitch_mm: float, divisions: int) -> Patch:
    """Return squares of ``pitch_mm``, each of ``divisions``² double triangles, at height 0.

    A square's corner lies in the middle of the outline. The diagonals run from each square's
    middle to its corners, so that a square has the symmetry of its optics.
    """
    step = pitch_mm / divisions
    columns = divisions * int(np.ceil(outline.half_width_mm / pitch_mm))
    rows = divisions * int(np.ceil(outline.half_height_mm / pitch_mm))
    i, j = np.meshgrid(np.arange(-columns, columns), np.arange(-rows, rows), indexing="ij")
    i, j = i.ravel(), j.ravel()
    corner = (i + columns) * (2 * rows + 1) + (j + rows)
    right, up = corner + 2 * rows + 1, corner + 1
    far = right + 1
    middle = (divisions - 1) / 2.0
    rising = ((i % divisions) - middle) * ((j % divisions) - middle) >= 0.0
    quads = np.stack([corner, right, far, up], axis=1)
    quads[~rising] = np.roll(quads[~rising], -1, axis=1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    x = np.arange(-columns, columns + 1, dtype=np.float64) * step
    y = np.arange(-rows, rows + 1, dtype=np.float64) * step
    xy = np.stack([np.repeat(x, len(y)), np.tile(y, len(x))], axis=1)
    return clipped(outline, xy, triangles, np.zeros(len(xy)), snap_mm=0.3 * step)


def pillow_height(xy: Floats, pitch_mm: float, radius_of_curvature_mm: float) -> Floats:
    """Return the height (n,) of spherical bumps on squares of ``pitch_mm``, 0 at their corners.

    h = √(R² − u² − v²) − √(R² − p²/2), with (u, v) counted from the middle of the square.
    """
    local = (xy / pitch_mm - np.floor(xy / pitch_mm) - 0.5) * pitch_mm
    radius2 = radius_of_curvature_mm**2
    return np.sqrt(radius2 - np.sum(local**2, axis=1)) - np.sqrt(radius2 - 0.5 * pitch_mm**2)


def pillow_depth(pitch_mm: float, radius_of_curvature_mm: float) -> float:
    """Return the height of a pillow's middle over its corners, in mm."""
    return float(
        pillow_height(np.full((1, 2), 0.5 * pitch_mm), pitch_mm, radius_of_curvature_mm)[0]
    )


def check_pillow(pitch_mm: float, radius_of_curvature_mm: float) -> None:
    """Refuse pillows that are nearly half spheres: their corners would stand upright.

    Raises:
        ValueError: The radius is too small for the pitch.
    """
    if radius_of_curvature_mm < 0.8 * pitch_mm:
        raise ValueError(
            f"pillow_radius_mm must be at least 0.8 times pillow_pitch_mm, here {0.8 * pitch_mm:g}"
        )


def cube_corner_patch(
    outline: Superellipse,
    aperture: Literal["hexagonal", "triangular"],
    pitch_mm: float,
    divisions: int,
    error_arcmin: float = 0.0,
) -> Patch:
    """Return cube corners over ``outline``; the height is how far each point stands behind.

    The faces of one corner meet at right angles. ``hexagonal``: whole cubes, seen along the body
    diagonal, ``pitch_mm`` between neighbouring tips; every part of the aperture sends light back.
    ``triangular``: the classic pressed reflector, ``pitch_mm`` the side of the triangles.
    Each face is cut ``divisions`` times per edge. Its parts are tilted by chance, ``error_arcmin``
    in the root mean square (`_errors`); without it, corners are perfect.
    """
    cells = _hexagonal_cells if aperture == "hexagonal" else _triangular_cells
    side = pitch_mm / np.sqrt(3.0) if aperture == "hexagonal" else pitch_mm
    reach = int(np.ceil(2.0 * outline.largest_radius_mm / side)) + 3
    basis = np.array([[1.0, 0.0], [0.5, np.sqrt(0.75)]]) * (side / 3.0)
    corners, heights = cells(reach)
    margin = 1.0 + side / min(outline.half_width_mm, outline.half_height_mm)
    near = outline.level(corners.mean(axis=1) @ basis) < margin
    tilt = _TILT[aperture] * np.radians(error_arcmin / 60.0)
    heights = heights + _errors(corners) * tilt
    corners, heights = _subdivided(corners[near], heights[near], divisions)
    corners = corners.reshape(-1, 2)
    key = corners[:, 0] * (8 * reach * divisions) + corners[:, 1]
    _, first, triangles = np.unique(key, return_index=True, return_inverse=True)
    xy, height = corners[first] @ basis / divisions, heights.ravel()[first] * side
    triangles = triangles.reshape(-1, 3)
    return clipped(outline, xy, triangles, height, snap_mm=0.02 * side / divisions)


#: RMS error of the corners' heights z, in sides, for each radian of RMS tilt. The gradient of a
#: face is Σ z ∇λ; where the slope is √2, an error of it tilts the normal by a third along the
#: slope, by 1/√3 across: in all √(8/9) z for equilateral faces, √(8/3) z for thirds of them.
_TILT = {"hexagonal": np.sqrt(9.0 / 8.0), "triangular": np.sqrt(3.0 / 8.0)}
#: Errors are no larger than so many standard deviations, and no part comes nearer to the front.
_MOST_SIGMAS = 4.0


def _errors(corners: Indices) -> Floats:
    """Return by how much each corner of (m, 3, 2) is off behind, (m, 3), with a spread of 1.

    Normal numbers by Box and Muller from a hash of the place (SplitMix64 by Steele, Lea and Flood
    2014), so that a lamp is the same everywhere.
    """
    i, j = np.moveaxis(corners.astype(np.int64), -1, 0).view(np.uint64)
    key = _scrambled(i) + j
    u, v = (_uniform(key + np.uint64(half << 40)) for half in (0, 1))
    normal = np.sqrt(-2.0 * np.log1p(-u)) * np.cos(2.0 * np.pi * v)
    return normal.clip(-_MOST_SIGMAS, _MOST_SIGMAS) + _MOST_SIGMAS


def _uniform(key: NDArray[np.uint64]) -> Floats:
    """Return numbers from 0 to 1, one for each key, that look as if drawn by chance."""
    return (_scrambled(key) >> np.uint64(11)).astype(np.float64) * 2.0**-53


def _scrambled(key: NDArray[np.uint64]) -> NDArray[np.uint64]:
    mixed = key * np.uint64(0x9E37_79B9_7F4A_7C15)
    for shift, factor in ((30, 0xBF58_476D_1CE4_E5B9), (27, 0x94D0_49BB_1331_11EB)):
        mixed = (mixed ^ (mixed >> np.uint64(shift))) * np.uint64(factor)
    return mixed ^ (mixed >> np.uint64(31))


def _lattice(reach: int) -> tuple[Indices, Indices]:
    i, j = np.meshgrid(np.arange(-reach, reach), np.arange(-reach, reach), indexing="ij")
    near = np.abs(i + j) <= reach
    return i[near], j[near]


def _hexagonal_cells(reach: int) -> tuple[Indices, Floats]:
    """Corners (m, 3, 2) in thirds of the lattice and heights (m, 3) in units of its side.

    Cubes seen along their diagonal show a triangular lattice whose points lie, in turn, at three
    levels, each a cube edge apart: 1/√2 of the side that the edge shows.
    """
    i, j = _lattice(reach)
    one, right, up, far = ((i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1))
    corners = np.concatenate(
        [
            np.stack([np.stack(p, axis=1) for p in t], axis=1)
            for t in ((one, right, up), (right, far, up))
        ]
    )
    levels = (corners[..., 0] - corners[..., 1]) % 3
    return 3 * corners, (2 - levels) / np.sqrt(2.0)


def _triangular_cells(reach: int) -> tuple[Indices, Floats]:
    """As above: each lattice triangle carries a tip 1/√6 of its side behind its middle."""
    i, j = (3 * index for index in _lattice(reach))
    triples = (
        ((i, j), (i + 3, j), (i, j + 3), (i + 1, j + 1)),
        ((i + 3, j), (i + 3, j + 3), (i, j + 3), (i + 2, j + 2)),
    )
    faces: list[Indices] = []
    for *base, tip in triples:
        for k in range(3):
            face = (base[k], base[(k + 1) % 3], tip)
            faces.append(np.stack([np.stack(p, axis=1) for p in face], axis=1))
    corners = np.concatenate(faces)
    heights = np.zeros(corners.shape[:2])
    heights[:, 2] = 1.0 / np.sqrt(6.0)
    return corners, heights


def _subdivided(corners: Indices, heights: Floats, divisions: int) -> tuple[Indices, Floats]:
    """Cut each triangle into ``divisions``² equal ones; coordinates are then that much finer."""
    n = divisions
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    up, down = i + j < n, i + j < n - 1

    def weights(a: Indices, b: Indices) -> Indices:
        return np.stack([n - a - b, a, b], axis=-1)

    upright = [weights(i[up] + a, j[up] + b) for a, b in ((0, 0), (1, 0), (0, 1))]
    inverted = [weights(i[down] + a, j[down] + b) for a, b in ((1, 0), (1, 1), (0, 1))]
    share = np.concatenate([np.stack(upright, axis=1), np.stack(inverted, axis=1)])
    cut = np.einsum("svk,mkc->msvc", share, corners).reshape(-1, 3, 2)
    return cut, (np.einsum("svk,mk->msv", share, heights) / n).reshape(-1, 3)


def clipped(
    outline: Superellipse, xy: Floats, triangles: Indices, height: Floats, *, snap_mm: float
) -> Patch:
    """Return the part of a triangulation inside ``outline``, with its border on the outline.

    Vertices closer than ``snap_mm`` to the outline (along the ray from the middle) move onto it, so
    that no sliver arises; edges that still cross it are cut there, the height interpolated.
    """
    level = outline.level(xy)
    radius = np.linalg.norm(xy, axis=1)
    near = np.abs(radius * (level - 1.0)) < snap_mm * level
    xy = xy / np.where(near, level, 1.0)[:, None]
    side = np.where(near, 0, np.sign(level - 1.0)).astype(np.int8)
    sides = side[triangles]
    whole = triangles[(sides.max(axis=1) <= 0) & (sides.min(axis=1) < 0)]
    crossed = triangles[(sides.max(axis=1) > 0) & (sides.min(axis=1) < 0)]

    edges = np.sort(crossed[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges = np.unique(edges[side[edges[:, 0]] * side[edges[:, 1]] < 0], axis=0)
    share = _crossing(outline, xy[edges[:, 0]], xy[edges[:, 1]])
    xy, height = (
        np.concatenate([v, v[edges[:, 0]] + (share * (v[edges[:, 1]] - v[edges[:, 0]]).T).T])
        for v in (xy, height)
    )
    pieces = _cut_triangles(crossed, side, edges)
    used, renumbered = np.unique(np.concatenate([whole, pieces]), return_inverse=True)
    triangles = renumbered.reshape(-1, 3)
    xy, height = xy[used], height[used]
    return Patch(xy, triangles, _border(xy, triangles), height)


def _crossing(outline: Superellipse, one: Floats, two: Floats) -> Floats:
    """Return (n,): where on the way from ``one`` to ``two`` the outline is met, by bisection."""
    starts_inside = outline.level(one) < 1.0
    low, high = np.zeros(len(one)), np.ones(len(one))
    for _ in range(48):
        share = 0.5 * (low + high)
        inside = outline.level(one + share[:, None] * (two - one)) < 1.0
        low, high = (
            np.where(inside == starts_inside, share, low),
            np.where(inside == starts_inside, high, share),
        )
    return 0.5 * (low + high)


def _cut_triangles(crossed: Indices, side: NDArray[np.int8], edges: Indices) -> Indices:
    """Return the inner pieces of ``crossed`` triangles; cut k lies on ``edges[k]``."""
    count = len(side)
    keys = edges[:, 0] * count + edges[:, 1]

    def cut(a: Indices, b: Indices) -> Indices:
        wanted = np.minimum(a, b) * count + np.maximum(a, b)
        return count + np.searchsorted(keys, wanted)

    pieces: list[Indices] = []
    for turn in range(3):
        a, b, c = (crossed[:, (turn + k) % 3] for k in range(3))
        sa, sb, sc = side[a], side[b], side[c]
        tip = (sa < 0) & (sb > 0) & (sc > 0)
        pieces.append(np.stack([a[tip], cut(a[tip], b[tip]), cut(a[tip], c[tip])], axis=1))
        base = (sa < 0) & (sb < 0) & (sc > 0)
        to_c, from_c = cut(b[base], c[base]), cut(a[base], c[base])
        pieces.append(np.stack([a[base], b[base], to_c], axis=1))
        pieces.append(np.stack([a[base], to_c, from_c], axis=1))
        ahead = (sa < 0) & (sb > 0) & (sc == 0)
        pieces.append(np.stack([a[ahead], cut(a[ahead], b[ahead]), c[ahead]], axis=1))
        behind = (sa < 0) & (sb == 0) & (sc > 0)
        pieces.append(np.stack([a[behind], b[behind], cut(a[behind], c[behind])], axis=1))
    return np.concatenate(pieces)


def _border(xy: Floats, triangles: Indices) -> Indices:
    """Return the border vertices in order of their angle about the middle."""
    vertices = np.unique(open_edges(triangles))
    return vertices[np.argsort(np.arctan2(xy[vertices, 1], xy[vertices, 0]))]


def open_edges(triangles: Indices) -> Indices:
    """Return the directed edges (b, 2) that belong to one triangle only."""
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    count = int(triangles.max()) + 1
    forward, backward = edges[:, 0] * count + edges[:, 1], edges[:, 1] * count + edges[:, 0]
    return edges[~np.isin(forward, backward)]

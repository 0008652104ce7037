# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Triangle meshes from files: read, checked, merged, and turned so that normals point outward.

The readers are Lamplit's own, since a scene may come from a stranger: a count in a header is held
against the bytes that are there before memory is taken for it, a fault is named with its line where
the file has lines, and no file leads to another one but a glTF document to its own buffers. trimesh
is their oracle in the tests.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import GeometryError, LamplitError
from lamplit.files import resolve_inside
from lamplit.scene.fields import FARTHEST_MM
from lamplit.scene.meshes.gltf import named_buffers, read_glb, read_gltf
from lamplit.scene.meshes.obj import read_obj
from lamplit.scene.meshes.ply import read_ply
from lamplit.scene.meshes.raw import RawMesh
from lamplit.scene.meshes.repair import Repaired, repair
from lamplit.scene.meshes.shading import facing, smooth
from lamplit.scene.meshes.stl import read_stl
from lamplit.scene.meshes.topology import find_edges, orient

__all__ = ["FORMATS", "Mesh", "load_mesh", "mesh_files"]

FORMATS = (".ply", ".stl", ".obj", ".glb", ".gltf")

#: The largest mesh file that is read.
_MOST_BYTES = 4 * 2**30


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles in mm whose normals (right-hand rule) point out of the body.

    ``vertices_mm`` (n, 3) float64; ``triangles`` (m, 3) uint32; ``normals`` (n, 3), unit vectors
    for smooth shading, or None. ``closed``: every edge has its two triangles, so that there is an
    inside; otherwise ``open_edges`` counts those that have not, one of them at ``open_at_mm``.
    ``notices`` say what was put right.
    """

    vertices_mm: NDArray[np.float64]
    triangles: NDArray[np.uint32]
    normals: NDArray[np.float64] | None
    closed: bool
    open_edges: int
    open_at_mm: tuple[float, float, float] | None
    notices: tuple[str, ...]


def load_mesh(
    path: Path,
    *,
    unit_mm: float = 1.0,
    smooth_shading: bool = False,
    crease_deg: float = 30.0,
    root: Path | None = None,
) -> Mesh:
    """Return the mesh in ``path``: a PLY, STL, OBJ, glTF or GLB file.

    ``unit_mm`` is how many mm a length of 1 in the file means. With ``smooth_shading``, the
    file's vertex normals are used, or normals computed with edges sharper than ``crease_deg``
    kept. Buffers of a glTF document are looked for in its own folder, within ``root``.

    Raises:
        GeometryError: The file cannot be read as a mesh; the message names it.
    """
    try:
        raw = _read(path, root or path.parent).checked()
        farthest = float(np.abs(raw.vertices).max()) * unit_mm
        if farthest > FARTHEST_MM:
            raise GeometryError(
                f"a vertex lies {farthest:.3g} mm from the origin, and {FARTHEST_MM:g} mm is the "
                "farthest; check the unit"
            )
        return _understood(raw, unit_mm, smooth_shading=smooth_shading, crease_deg=crease_deg)
    except MemoryError as fault:
        raise GeometryError("the mesh is too large for this machine's memory", file=path) from fault
    except (ValueError, OverflowError) as fault:
        raise GeometryError(f"the mesh is malformed: {fault}", file=path) from fault
    except LamplitError as fault:
        raise GeometryError(fault.message, file=path) from fault


def mesh_files(path: Path, root: Path) -> list[Path]:
    """Return ``path`` and every file that its mesh is made of.

    Raises:
        SceneError: A buffer of a glTF document is missing, or lies outside ``root``.
    """
    if path.suffix.lower() != ".gltf":
        return [path]
    return [path, *(_beside(path, root, name) for name in named_buffers(path.read_bytes()))]


def _beside(path: Path, root: Path, name: str) -> Path:
    folder = path.parent.resolve().relative_to(root.resolve()).as_posix()
    resolve_inside(path.parent, name)
    return resolve_inside(root, name if folder == "." else f"{folder}/{name}")


def _read(path: Path, root: Path) -> RawMesh:
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise GeometryError(
            f"{suffix or 'a name without ending'} is no mesh format that is read; "
            f"use one of {', '.join(FORMATS)}"
        )
    content = _content(path)
    if suffix == ".ply":
        return read_ply(content)
    if suffix == ".stl":
        return read_stl(content)
    if suffix == ".obj":
        return read_obj(content)
    read = read_glb if suffix == ".glb" else read_gltf
    return read(content, lambda name: _content(_beside(path, root, name)))


def _content(path: Path) -> bytes:
    try:
        size = path.stat().st_size
        if size > _MOST_BYTES:
            raise GeometryError(f"the file has {size} bytes; {_MOST_BYTES} are read at most")
        return path.read_bytes()
    except OSError as fault:
        raise GeometryError(f"the file cannot be read: {fault.strerror}") from fault


def _understood(raw: RawMesh, unit_mm: float, *, smooth_shading: bool, crease_deg: float) -> Mesh:
    fixed = repair(raw.vertices * unit_mm, raw.triangles)
    edges = fixed.edges
    orientation = orient(fixed.vertices, fixed.triangles, edges)
    turn = orientation.turn
    triangles = np.where(turn[:, None], fixed.triangles[:, ::-1], fixed.triangles)
    vertices, normals = fixed.vertices, None
    if smooth_shading and raw.normals is not None:
        vertices = fixed.vertices[fixed.origin]
        triangles = np.where(turn[:, None], fixed.source[:, ::-1], fixed.source)
        normals = facing(raw.normals, vertices, triangles)
    elif smooth_shading:
        final = find_edges(triangles) if turn.any() else edges
        vertices, triangles, normals = smooth(vertices, triangles, final, crease_deg)
    open_edges = len(edges.open_edges)
    at = None
    if open_edges:
        x, y, z = fixed.vertices[edges.open_edges[0, 0]].tolist()
        at = (x, y, z)
    used = np.zeros(len(vertices), dtype=bool)
    used[triangles] = True
    renumbered = np.cumsum(used) - 1
    return Mesh(
        np.ascontiguousarray(vertices[used]),
        np.ascontiguousarray(renumbered[triangles], dtype=np.uint32),
        None if normals is None else np.ascontiguousarray(normals[used]),
        open_edges == 0 and orientation.one_sided == 0,
        open_edges,
        at,
        _notices(fixed, int(turn.sum()), len(turn), edges.crowded, orientation.one_sided),
    )


def _notices(
    fixed: Repaired, turned: int, count: int, crowded: int, one_sided: int
) -> tuple[str, ...]:
    notices = list(fixed.notices)
    if turned == count:
        notices.append("the normals pointed inward: every triangle was turned")
    elif turned:
        notices.append(f"the normals were mixed: {turned} of {count} triangles were turned")
    if crowded:
        notices.append(f"{crowded} edges have more than two triangles")
    if one_sided:
        notices.append(f"{one_sided} parts have only one side, like a Möbius strip")
    return tuple(notices)

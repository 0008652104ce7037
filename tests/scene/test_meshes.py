# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Meshes: every format gives the same body, and every body faces outward."""

from __future__ import annotations

import json
import struct
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from lamplit.errors import GeometryError
from lamplit.scene.meshes import Mesh, load_mesh

Cube = tuple[NDArray[np.float64], NDArray[np.int64]]


def volume_mm3(mesh: Mesh) -> float:
    """Return the signed volume: positive where the normals point outward."""
    one, two, three = (mesh.vertices_mm[mesh.triangles[:, i]] for i in range(3))
    return float((one * np.cross(two, three)).sum() / 6.0)


def written_obj(folder: Path, vertices: object, triangles: object) -> Path:
    """Return an OBJ file of these triangles."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(vertices, dtype=float).tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (np.asarray(triangles) + 1).tolist()]
    path = folder / "mesh.obj"
    path.write_text("\n".join(lines))
    return path


def cube_of(cube: Cube, low: float, size: float, first: int = 0) -> Cube:
    """Return a cube from ``low`` on, its vertices numbered from ``first``."""
    return low + size * cube[0], cube[1] + first


@pytest.mark.parametrize("ending", ["ply", "ascii.ply", "stl", "ascii.stl", "obj", "glb", "gltf"])
def test_every_format_gives_the_same_sphere(ending: str, tmp_path: Path) -> None:
    sphere = trimesh.creation.icosphere(subdivisions=3, radius=2.0)
    path = tmp_path / f"sphere.{ending}"
    if ending == "gltf":
        for name, content in trimesh.exchange.gltf.export_gltf(trimesh.Scene(sphere)).items():
            (path if name.endswith(".gltf") else tmp_path / name).write_bytes(content)
    elif ending == "ascii.ply":
        path.write_bytes(trimesh.exchange.ply.export_ply(sphere, encoding="ascii"))
    elif ending == "ascii.stl":
        path.write_text(trimesh.exchange.stl.export_stl_ascii(sphere))
    else:
        sphere.export(path)
    mesh = load_mesh(path, unit_mm=10.0)
    assert mesh.closed
    assert mesh.notices == ()
    assert mesh.vertices_mm.shape == (642, 3)
    assert mesh.triangles.shape == (1280, 3)
    assert mesh.triangles.dtype == np.uint32
    np.testing.assert_allclose(np.linalg.norm(mesh.vertices_mm, axis=1), 20.0, rtol=1e-6)
    assert volume_mm3(mesh) == pytest.approx(1000.0 * sphere.volume, rel=1e-6)


def test_polygons_of_every_length_are_cut_into_triangles(tmp_path: Path) -> None:
    header = (
        "ply\nformat binary_big_endian 1.0\ncomment a pyramid on a square\n"
        "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 5\nproperty uchar flag\nproperty list uchar int vertex_index\nend_header\n"
    )
    points = struct.pack(">15f", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.5, 1)
    faces = [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    body = b"".join(struct.pack(f">BB{len(f)}i", 7, len(f), *f) for f in faces)
    path = tmp_path / "pyramid.ply"
    path.write_bytes(header.encode() + points + body)
    mesh = load_mesh(path)
    assert mesh.closed
    assert len(mesh.triangles) == 6
    assert volume_mm3(mesh) == pytest.approx(1 / 3)


def test_an_obj_may_count_backwards_and_carry_normals(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_text(
        "mtllib ../secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 2\nvt 0 0\n"
        "usemtl none\nf -3/1/1 -2/1/1 \\\n-1/1/-1\n"
    )
    mesh = load_mesh(path, smooth_shading=True)
    assert mesh.normals is not None
    np.testing.assert_array_equal(mesh.normals, [[0, 0, 1]] * 3)
    assert not mesh.closed


def test_a_gltf_node_places_turns_and_mirrors_its_mesh(cube: Cube, tmp_path: Path) -> None:
    points, corners = cube[0].astype("<f4").tobytes(), cube[1].astype("<u2").tobytes()
    half = float(np.sqrt(0.5))
    tree = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [
            {"children": [1], "translation": [10, 0, 0]},
            {"mesh": 0, "rotation": [0, 0, half, half], "scale": [-1, 2, 3]},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 96},
            {"buffer": 0, "byteOffset": 96, "byteLength": 72},
        ],
        "buffers": [{"byteLength": 168, "uri": "my%20cube.bin"}],
    }
    (tmp_path / "my cube.bin").write_bytes(points + corners)
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps(tree))
    mesh = load_mesh(path)
    assert mesh.notices == ()
    assert volume_mm3(mesh) == pytest.approx(6.0, rel=1e-6)
    # A quarter turn takes (−x, 2y, 3z) to (−2y, −x, 3z).
    np.testing.assert_allclose(mesh.vertices_mm.min(axis=0), [8, -1, 0], atol=1e-6)
    np.testing.assert_allclose(mesh.vertices_mm.max(axis=0), [10, 0, 3], atol=1e-6)


def test_inverted_and_mixed_normals_are_turned_outward(cube: Cube, tmp_path: Path) -> None:
    points, triangles = cube
    inverted = load_mesh(written_obj(tmp_path, points, triangles[:, ::-1]))
    assert volume_mm3(inverted) == pytest.approx(1.0)
    assert "every triangle was turned" in inverted.notices[0]
    mixed = triangles.copy()
    mixed[[1, 5, 6]] = mixed[[1, 5, 6], ::-1]
    turned = load_mesh(written_obj(tmp_path, points, mixed))
    assert volume_mm3(turned) == pytest.approx(1.0)
    assert "3 of 12 triangles were turned" in turned.notices[0]


@pytest.mark.parametrize("turns", [(False, True), (True, False), (False, False), (True, True)])
def test_an_inner_shell_bounds_a_cavity_whichever_way_it_faced(
    turns: tuple[bool, bool], cube: Cube, tmp_path: Path
) -> None:
    outer, inner = cube_of(cube, 0.0, 3.0), cube_of(cube, 1.0, 1.0, first=8)
    shells = [t[:, ::-1] if turn else t for (_, t), turn in zip((outer, inner), turns, strict=True)]
    path = written_obj(tmp_path, np.concatenate([outer[0], inner[0]]), np.concatenate(shells))
    mesh = load_mesh(path)
    assert mesh.closed
    assert volume_mm3(mesh) == pytest.approx(26.0)


def test_a_body_within_the_cavity_faces_outward_again(cube: Cube, tmp_path: Path) -> None:
    cubes = [cube_of(cube, float(i), 9.0 - 2.0 * i, first=8 * i) for i in range(3)]
    path = written_obj(
        tmp_path, np.concatenate([p for p, _ in cubes]), np.concatenate([t for _, t in cubes])
    )
    assert volume_mm3(load_mesh(path)) == pytest.approx(9.0**3 - 7.0**3 + 5.0**3)


def test_an_open_mesh_says_where_it_is_open(cube: Cube, tmp_path: Path) -> None:
    points, triangles = cube
    mesh = load_mesh(written_obj(tmp_path, points, triangles[:-1]))
    assert not mesh.closed
    assert mesh.open_edges == 3
    assert mesh.open_at_mm is not None
    assert mesh.open_at_mm[0] == 1.0


def test_two_shells_that_share_an_edge_are_closed(cube: Cube, tmp_path: Path) -> None:
    points, triangles = cube
    beside = points + np.array([1.0, 1.0, 0.0])
    path = written_obj(
        tmp_path, np.concatenate([points, beside]), np.concatenate([triangles, triangles + 8])
    )
    mesh = load_mesh(path)
    assert mesh.closed
    assert volume_mm3(mesh) == pytest.approx(2.0)
    assert any("more than two triangles" in notice for notice in mesh.notices)


def test_a_moebius_strip_has_no_inside(tmp_path: Path) -> None:
    count = 12
    angle = 2 * np.pi * np.arange(count) / count
    rims = []
    for side in (-1.0, 1.0):
        radius = 4 + side * np.cos(angle / 2)
        rims.append(
            np.stack(
                [radius * np.cos(angle), radius * np.sin(angle), side * np.sin(angle / 2)], axis=1
            )
        )
    triangles = []
    for i in range(count):
        a, b = i, i + count
        c, d = (i + 1, i + 1 + count) if i + 1 < count else (count, 0)
        triangles += [(a, c, b), (b, c, d)]
    mesh = load_mesh(written_obj(tmp_path, np.concatenate(rims), triangles))
    assert not mesh.closed
    assert any("one side" in notice for notice in mesh.notices)


def test_degenerate_and_double_triangles_are_removed(cube: Cube, tmp_path: Path) -> None:
    points, triangles = cube
    more = np.concatenate([triangles, [(0, 0, 1), (2, 5, 5)], triangles[3:4, [1, 2, 0]]])
    mesh = load_mesh(written_obj(tmp_path, points, more))
    assert mesh.closed
    assert len(mesh.triangles) == 12
    assert "2 degenerate triangles were removed" in mesh.notices
    assert any("stood there twice" in notice for notice in mesh.notices)


def test_a_hairline_seam_is_closed_and_said(cube: Cube, tmp_path: Path) -> None:
    soup = cube[0][cube[1]].reshape(-1, 3)
    rounded = soup + 1e-8 * np.random.default_rng(7).uniform(-1, 1, soup.shape)
    mesh = load_mesh(written_obj(tmp_path, rounded, np.arange(36).reshape(-1, 3)))
    assert mesh.closed
    assert len(mesh.vertices_mm) == 8
    assert any("seams" in notice for notice in mesh.notices)


def test_smooth_normals_of_a_sphere_point_from_its_centre(tmp_path: Path) -> None:
    path = tmp_path / "sphere.stl"
    trimesh.creation.icosphere(subdivisions=4, radius=5.0).export(path)
    mesh = load_mesh(path, smooth_shading=True)
    assert mesh.normals is not None
    assert mesh.normals.shape == mesh.vertices_mm.shape
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, rtol=1e-12)
    assert np.abs(mesh.normals - mesh.vertices_mm / 5.0).max() < 3e-3


def test_a_crease_keeps_the_edges_of_a_cube(cube: Cube, tmp_path: Path) -> None:
    path = written_obj(tmp_path, *cube)
    sharp = load_mesh(path, smooth_shading=True, crease_deg=30.0)
    assert len(sharp.vertices_mm) == 24
    assert sharp.normals is not None
    np.testing.assert_array_equal(np.sort(np.abs(sharp.normals), axis=1), [[0, 0, 1]] * 24)
    round_off = load_mesh(path, smooth_shading=True, crease_deg=91.0)
    assert len(round_off.vertices_mm) == 8
    assert round_off.normals is not None
    expected = (round_off.vertices_mm - 0.5) * 2 / np.sqrt(3)
    np.testing.assert_allclose(round_off.normals, expected, atol=1e-12)


def test_normals_from_a_file_turn_with_inverted_triangles(tmp_path: Path) -> None:
    sphere = trimesh.creation.icosphere(subdivisions=2, radius=3.0)
    sphere.invert()
    path = tmp_path / "inverted.ply"
    path.write_bytes(trimesh.exchange.ply.export_ply(sphere, vertex_normal=True))
    mesh = load_mesh(path, smooth_shading=True)
    assert mesh.normals is not None
    assert volume_mm3(mesh) > 0
    assert ((mesh.normals * mesh.vertices_mm).sum(axis=1) > 2.9).all()


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no triangle has an area"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2\n", "two corners at one point"),
        ("v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n", "line 3"),
        ("v 0 0 0\nv 1 0 0\nf 1 2\n", "line 3"),
        ("v 0 0 0\nv 1e300 0 0\nv 0 1 0\nf 1 2 3\n", "check the unit"),
    ],
)
def test_a_useless_mesh_is_refused(content: str, says: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.obj"
    path.write_text(content)
    with pytest.raises(GeometryError, match=says) as caught:
        load_mesh(path)
    assert caught.value.file == path


def mutants(content: bytes) -> list[bytes]:
    """Return copies of a file, cut off or with some bytes changed."""
    random = np.random.default_rng(20)
    found = [content[:at] for at in random.integers(0, len(content), 60)]
    for _ in range(200):
        spoilt = bytearray(content)
        for at in random.integers(0, min(len(content), 600), 3):
            spoilt[at] = int(random.integers(0, 256))
        found.append(bytes(spoilt))
    return found


@pytest.mark.parametrize("ending", ["ply", "ascii.ply", "stl", "ascii.stl", "obj", "glb"])
def test_a_damaged_file_is_read_or_refused_but_never_breaks(ending: str, tmp_path: Path) -> None:
    sphere = trimesh.creation.icosphere(subdivisions=1)
    exports: dict[str, Callable[[], bytes | str]] = {
        "ascii.ply": lambda: trimesh.exchange.ply.export_ply(sphere, encoding="ascii"),
        "ascii.stl": lambda: trimesh.exchange.stl.export_stl_ascii(sphere),
    }
    export = exports.get(ending, lambda: sphere.export(file_type=ending))
    content = export()
    path = tmp_path / f"sphere.{ending}"
    refused = 0
    for mutant in mutants(content if isinstance(content, bytes) else content.encode()):
        path.write_bytes(mutant)
        try:
            mesh = load_mesh(path, smooth_shading=True)
        except GeometryError:
            refused += 1
        else:
            assert np.isfinite(mesh.vertices_mm).all()
            assert mesh.triangles.max() < len(mesh.vertices_mm)
    assert refused >= 50


def test_a_million_triangles_are_understood_in_seconds(tmp_path: Path) -> None:
    side = 708
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(side), np.arange(side)))
    z = np.sin(x / 9.0) * np.cos(y / 7.0)
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    quads = np.stack([corner, corner + 1, corner + side, corner + side + 1], axis=1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [1, 3, 2]]])
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(x)}\nproperty float x\n"
        f"property float y\nproperty float z\nelement face {len(triangles)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    )
    records = np.empty(len(triangles), dtype=[("n", "u1"), ("corners", "<i4", 3)])
    records["n"], records["corners"] = 3, triangles
    points = np.stack([x, y, z], axis=1).astype("<f4")
    path = tmp_path / "waves.ply"
    path.write_bytes(header.encode() + points.tobytes() + records.tobytes())
    begin = time.process_time()
    mesh = load_mesh(path)
    assert len(mesh.triangles) == 2 * (side - 1) ** 2
    assert time.process_time() - begin < 15.0

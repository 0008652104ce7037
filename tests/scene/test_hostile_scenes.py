# SPDX-License-Identifier: Apache-2.0 OR MIT
"""R19: every file of an attack corpus is refused with one of Lamplit's errors within a second."""

from __future__ import annotations

import base64
import json
import struct
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from lamplit.errors import LamplitError
from lamplit.scene import load_scene

SECRET = b"only for the owner's eyes"


#: Given an empty folder and the text of a sound scene, writes a scene file that is none.
Attack = Callable[[Path, str], None]


def changed(piece: str, by: str) -> Attack:
    """Return an attack by another value in the sound scene."""

    def attack(folder: Path, sound: str) -> None:
        assert piece in sound
        (folder / "scene.toml").write_text(sound.replace(piece, by))

    return attack


def added(more: str | bytes) -> Attack:
    """Return an attack by what follows the sound scene."""
    tail = more if isinstance(more, bytes) else more.encode()
    return lambda folder, sound: write(folder / "scene.toml", sound.encode() + tail)


def instead(scene: str) -> Attack:
    """Return an attack by the whole text of the scene file."""
    return lambda folder, _sound: write(folder / "scene.toml", scene.encode())


def mesh_named(name: str) -> Attack:
    """Return an attack by the name of a mesh file."""
    return changed('"part.obj"', json.dumps(name))


def csv_named(name: str) -> Attack:
    """Return an attack by the name of a table of values."""
    return changed("reflectance = 0.5", f"reflectance = {{ csv = {json.dumps(name)} }}")


def beside(name: str, content: bytes) -> Attack:
    """Return an attack by the content of the mesh file."""

    def attack(folder: Path, sound: str) -> None:
        write(folder / name, content)
        mesh_named(name)(folder, sound)

    return attack


def spectrum(key: str, name: str, content: bytes) -> Attack:
    """Return an attack by the content of a file of values."""

    def attack(folder: Path, sound: str) -> None:
        write(folder / name, content)
        changed("reflectance = 0.5", f'reflectance = {{ {key} = "{name}" }}')(folder, sound)

    return attack


def link(name: str, target: str) -> Attack:
    """Return an attack by a symbolic link in the place of the mesh."""

    def attack(folder: Path, sound: str) -> None:
        (folder / name).symlink_to(target)
        mesh_named(name)(folder, sound)

    return attack


def write(path: Path, content: bytes) -> None:
    """Write ``content``."""
    path.write_bytes(content)


def ply(header: str, body: bytes = b"", form: str = "binary_little_endian") -> bytes:
    """Return a PLY file with this header after its format line."""
    return f"ply\nformat {form} 1.0\n{header}\nend_header\n".encode() + body


def stl(count: int, triangles: int) -> bytes:
    """Return a binary STL file whose header promises ``count`` triangles."""
    return bytes(80) + struct.pack("<I", count) + bytes(50 * triangles)


def glb(tree: object, binary: bytes = b"", length: int | None = None) -> bytes:
    """Return a GLB file of a document, which may be any text, and a buffer."""
    document = tree if isinstance(tree, bytes) else json.dumps(tree).encode()
    document += b" " * (-len(document) % 4)
    chunks = struct.pack("<I4s", len(document), b"JSON") + document
    if binary:
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    whole = 12 + len(chunks) if length is None else length
    return b"glTF" + struct.pack("<II", 2, whole) + chunks


def document(**changes: object) -> dict[str, object]:
    """Return a sound glTF document of one triangle, with some of its tables replaced."""
    tree: dict[str, object] = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36}],
    }
    return tree | changes


TRIANGLE = struct.pack("<9f", 0, 0, 0, 10, 0, 0, 0, 10, 0)
XYZ = "property float x\nproperty float y\nproperty float z"
FACES = "property list uchar int vertex_indices"
DOCTYPE = b'<?xml version="1.0"?><!DOCTYPE a [<!ENTITY b "ha"><!ENTITY c "&b;&b;&b;">]><a>&c;</a>'
EXTERNAL = b'<?xml version="1.0"?><!DOCTYPE a SYSTEM "file:///etc/passwd"><a/>'
ACCESSOR = {"bufferView": 0, "componentType": 5126, "count": 2**40, "type": "VEC3"}
DATA_URI = "data:application/octet-stream;base64," + base64.b64encode(TRIANGLE).decode()

ATTACKS: dict[str, Attack] = {
    # Paths that leave the folder.
    "a mesh above the folder": mesh_named("../secret.obj"),
    "a mesh far above": mesh_named("../" * 30 + "etc/passwd"),
    "an absolute mesh": mesh_named("/etc/passwd"),
    "a detour through a folder": mesh_named("a/../../secret.obj"),
    "a drive letter": mesh_named("C:/secret.obj"),
    "backslashes": mesh_named("..\\secret.obj"),
    "a network share": mesh_named("//server/share/secret.obj"),
    "a file URL": mesh_named("file:///etc/passwd"),
    "a web URL": mesh_named("http://127.0.0.1:1/secret.obj"),
    "a device": mesh_named("/dev/zero"),
    "a null character": mesh_named("part.obj\0.png"),
    "an endless name": mesh_named("a" * 100_000),
    "an empty name": mesh_named(""),
    "the folder itself": mesh_named("."),
    "a home directory": mesh_named("~root/secret.obj"),
    "a link out": link("out.obj", "../secret.obj"),
    "a link to a device": link("zero.obj", "/dev/zero"),
    "a link to itself": link("loop.obj", "loop.obj"),
    "a table above the folder": csv_named("../secret.csv"),
    "an absolute table": csv_named("/etc/passwd"),
    "a table on the web": csv_named("https://127.0.0.1:1/secret.csv"),
    "an ICC profile above": added('[display]\nspace = { icc = "../secret.icc" }\n'),
    # Scene files that are too much.
    "deep brackets": instead("lamplit = 1\nname = " + "[" * 200_000),
    "deep tables": instead("lamplit = 1\nname = " + "{a=" * 100_000),
    "deep brackets, spaced": instead("lamplit = 1\nname = " + "[ \n" * 100_000),
    "deep dotted keys": instead("lamplit = 1\n" + "a." * 100_000 + "a = 1"),
    "deep quoted keys": instead("lamplit = 1\n" + '"a" . ' * 100_000 + "a = 1"),
    "a deep header": instead("lamplit = 1\n[" + "a." * 50_000 + "a]"),
    "nested twenty deep": instead("lamplit = 1\nname = " + "[" * 20 + "]" * 20),
    "a giant number": changed("samples = 4", "samples = " + "9" * 100_000),
    "a giant hexadecimal": changed("samples = 4", "samples = 0x" + "f" * 100_000),
    "a giant exponent": changed("radius_mm = 10.0", "radius_mm = 1e999999999"),
    "too many bytes": added("#" * (9 * 2**20)),
    "many samples": changed("samples = 4", "samples = 1000000000000"),
    "not UTF-8": added(b"# \xff\xfe"),
    "a null byte": added("# \0"),
    "code for a value": changed("samples = 4", "samples = __import__('os')"),
    "a long unknown key": added("[" + "x" * 500_000 + "]\n"),
    "a long name": changed("a sound scene", "x" * 500_000),
    "a terminal escape": changed("samples", '"\\u001b[2J"'),
    # XML with entities, and tables that are none.
    "entities in an spdx": spectrum("spdx", "a.spdx", DOCTYPE),
    "an external DTD": spectrum("spdx", "a.spdx", EXTERNAL),
    "deep XML": spectrum("spdx", "a.spdx", b"<a>" * 200_000),
    "a table of noise": spectrum("csv", "a.csv", bytes(range(256)) * 1000),
    "a table of one line": spectrum("csv", "a.csv", b"9" * 1_000_000),
    # Meshes whose headers lie.
    "a PLY of 10^12 vertices": beside(
        "a.ply", ply(f"element vertex 999999999999\n{XYZ}\nelement face 1\n{FACES}", TRIANGLE)
    ),
    "a PLY of 10^12 empty things": beside(
        "a.ply", ply(f"element x 999999999999\nelement vertex 1\n{XYZ}\nelement face 1\n{FACES}")
    ),
    "a PLY with a count below zero": beside("a.ply", ply(f"element vertex -3\n{XYZ}")),
    "a PLY with an endless header": beside("a.ply", b"ply\n" + b"comment x\n" * 300_000),
    "a PLY with a giant list": beside(
        "a.ply",
        ply(
            f"element vertex 3\n{XYZ}\nelement face 1\nproperty list uint int vertex_indices",
            TRIANGLE + b"\xff" * 16,
        ),
    ),
    "a PLY cut off": beside(
        "a.ply", ply(f"element vertex 3\n{XYZ}\nelement face 1\n{FACES}", TRIANGLE[:20])
    ),
    "a PLY with a foreign vertex": beside(
        "a.ply",
        ply(
            f"element vertex 3\n{XYZ}\nelement face 1\n{FACES}",
            TRIANGLE + struct.pack("<B3i", 3, 0, 1, 2**31 - 1),
        ),
    ),
    "a PLY text with a vertex below zero": beside(
        "a.ply",
        ply(
            f"element vertex 3\n{XYZ}\nelement face 1\n{FACES}",
            b"0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n",
            "ascii",
        ),
    ),
    "an STL of 4 thousand million": beside("a.stl", stl(2**32 - 1, 1)),
    "an STL of fewer than it holds": beside("a.stl", stl(1, 3)),
    "an STL text cut off": beside("a.stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0"),
    "an OBJ with a foreign vertex": beside("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"),
    "an OBJ with vertex 0": beside("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"),
    "an OBJ of infinity": beside("a.obj", b"v 0 0 0\nv 1 0 inf\nv 0 1 0\nf 1 2 3\n"),
    "an OBJ that is empty": beside("a.obj", b""),
    "an OBJ with a giant index": beside("a.obj", b"v 0 0 0\nf " + b"9" * 10_000 + b" 1 1\n"),
    "a GLB longer than its file": beside("a.glb", glb(document(), TRIANGLE, 10**9)),
    "a GLB accessor of 2^40": beside("a.glb", glb(document(accessors=[ACCESSOR]), TRIANGLE)),
    "a GLB accessor from nothing": beside(
        "a.glb", glb(document(accessors=[{k: ACCESSOR[k] for k in list(ACCESSOR)[1:]}]), TRIANGLE)
    ),
    "a GLB buffer of 2^40": beside(
        "a.glb", glb(document(buffers=[{"byteLength": 2**40}]), TRIANGLE)
    ),
    "a GLB node that is its own child": beside(
        "a.glb", glb(document(nodes=[{"mesh": 0, "children": [0]}]), TRIANGLE)
    ),
    "a GLB that doubles at every node": beside(
        "a.glb",
        glb(
            document(
                nodes=[{"mesh": 0, "children": [i + 1, i + 1]} for i in range(60)] + [{"mesh": 0}]
            ),
            TRIANGLE,
        ),
    ),
    "a GLB of deep JSON": beside("a.glb", glb(b"[" * 200_000)),
    "a GLB of a list": beside("a.glb", glb([])),
    "a GLB with a stride of 2^62": beside(
        "a.glb",
        glb(document(bufferViews=[{"buffer": 0, "byteLength": 36, "byteStride": 2**62}]), TRIANGLE),
    ),
    "a glTF buffer above": beside(
        "a.gltf",
        json.dumps(document(buffers=[{"byteLength": 25, "uri": "../secret.bin"}])).encode(),
    ),
    "a glTF buffer above, in disguise": beside(
        "a.gltf",
        json.dumps(document(buffers=[{"byteLength": 25, "uri": "%2e%2e/secret.bin"}])).encode(),
    ),
    "a glTF buffer on the web": beside(
        "a.gltf",
        json.dumps(document(buffers=[{"byteLength": 25, "uri": "http://127.0.0.1:1/a"}])).encode(),
    ),
    "a glTF buffer by an absolute name": beside(
        "a.gltf",
        json.dumps(document(buffers=[{"byteLength": 25, "uri": "/etc/passwd"}])).encode(),
    ),
    "an unknown format": beside("a.pickle", b"cos\nsystem\n(S'true'\ntR."),
}


def test_the_corpus_is_large_enough() -> None:
    assert len(ATTACKS) >= 40


@pytest.fixture(scope="module", autouse=True)
def _libraries_are_loaded(
    tmp_path_factory: pytest.TempPathFactory, sound_text: str, tetrahedron_obj: str
) -> None:
    """Read a sound scene once, so that imports do not count against an attack's second."""
    folder = tmp_path_factory.mktemp("sound")
    beside("part.obj", tetrahedron_obj.encode())(folder, sound_text)
    load_scene(folder / "scene.toml").resolved_objects()


@pytest.mark.parametrize("name", ATTACKS)
def test_an_attack_is_refused_within_a_second(
    name: str, tmp_path: Path, sound_text: str, tetrahedron_obj: str
) -> None:
    for ending in ("obj", "csv", "icc", "bin"):
        (tmp_path / f"secret.{ending}").write_bytes(SECRET)
    folder = tmp_path / "scene"
    folder.mkdir()
    write(folder / "part.obj", tetrahedron_obj.encode())
    ATTACKS[name](folder, sound_text)
    begin = time.process_time()
    with pytest.raises(LamplitError) as caught:
        load_scene(folder / "scene.toml").resolved_objects()
    assert time.process_time() - begin < 1.0
    message = str(caught.value)
    assert message.isprintable()
    assert len(message) < 1000
    assert SECRET.decode() not in message


def test_a_triangle_in_a_data_uri_is_no_attack(tmp_path: Path, sound_text: str) -> None:
    tree = document(buffers=[{"byteLength": 36, "uri": DATA_URI}])
    beside("a.gltf", json.dumps(tree).encode())(tmp_path, sound_text)
    mesh = load_scene(tmp_path / "scene.toml").resolved_objects()[1].mesh
    assert mesh is not None
    assert len(mesh.triangles) == 1

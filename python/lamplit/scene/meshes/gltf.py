# SPDX-License-Identifier: Apache-2.0 OR MIT
"""glTF 2.0 and GLB: the triangles of every node, placed by its transforms.

Only geometry is read: no images, materials, animation or extensions. Every count is checked
against the bytes that are there before an array is made of them.
Source: Khronos Group, "glTF 2.0 Specification" (2021), §3.5 to §3.7 and §4.
"""

from __future__ import annotations

import base64
import binascii
import json
from collections.abc import Callable
from typing import Any, TypeAlias
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import GeometryError
from lamplit.scene.meshes.raw import MOST_TRIANGLES, Floats, RawMesh, joined

#: What ``json`` makes of the document; nothing in it may be trusted to have its right type.
Json: TypeAlias = Any
#: Given the name of a file beside the document, returns its content.
Beside: TypeAlias = Callable[[str], bytes]

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_MOST_NODES = 100_000


def read_glb(content: bytes, beside: Beside) -> RawMesh:
    """Return the triangles of a binary glTF file.

    Raises:
        GeometryError: A length in the file is not what the file holds, or the document is broken.
    """
    if content[:4] != b"glTF" or len(content) < 20:
        raise GeometryError("this is no GLB file, or it was cut off within its header")
    version, length, json_length = (
        int.from_bytes(content[i : i + 4], "little") for i in (4, 8, 12)
    )
    if version != 2 or content[16:20] != b"JSON":
        raise GeometryError(f"GLB version {version} cannot be read; export it as glTF 2.0")
    if length != len(content) or 20 + json_length > length:
        raise GeometryError(
            f"the GLB header promises {length} bytes, and the file has {len(content)}; "
            "export or copy the mesh again"
        )
    at = 20 + json_length
    binary = b""
    if at + 8 <= length and content[at + 4 : at + 8] == b"BIN\0":
        size = int.from_bytes(content[at : at + 4], "little")
        if at + 8 + size > length:
            raise GeometryError("the GLB binary chunk is longer than the file; export it again")
        binary = content[at + 8 : at + 8 + size]
    return read_gltf(content[20 : 20 + json_length], beside, binary)


def read_gltf(document: bytes, beside: Beside, binary: bytes = b"") -> RawMesh:
    """Return the triangles of a glTF document; ``binary`` is the GLB's own buffer.

    Raises:
        GeometryError: The document is broken, or needs an extension that is not read.
    """
    try:
        tree = json.loads(document)
    except (ValueError, RecursionError) as fault:
        raise GeometryError(f"the glTF document is not sound JSON: {fault}") from fault
    try:
        return _Document(tree, beside, binary).mesh()
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError) as fault:
        raise GeometryError(
            f"the glTF document is malformed ({type(fault).__name__}: {fault}); export it again"
        ) from fault


def named_buffers(document: bytes) -> list[str]:
    """Return the names of the files that a glTF document takes its buffers from."""
    try:
        buffers = json.loads(document).get("buffers", [])
        return [unquote(b["uri"]) for b in buffers if not b.get("uri", "data:").startswith("data:")]
    except (ValueError, RecursionError, KeyError, TypeError, AttributeError):
        return []


class _Document:
    def __init__(self, tree: Json, beside: Beside, binary: bytes) -> None:
        self._tree = tree
        if needed := [name for name in tree.get("extensionsRequired", []) if "mesh" in str(name)]:
            raise GeometryError(
                f"the file needs the extension {needed[0]}, which is not read; "
                "export it without compression"
            )
        self._buffers = [_buffer(own, beside, binary) for own in tree.get("buffers", [])]

    def mesh(self) -> RawMesh:
        parts: list[RawMesh] = []
        triangles = 0
        for mesh, matrix in self._placed():
            for primitive in self._tree["meshes"][_at(mesh)]["primitives"]:
                part = self._primitive(primitive)
                triangles += len(part.triangles)
                if triangles > MOST_TRIANGLES // 10:
                    raise GeometryError("the glTF nodes repeat their meshes to too many triangles")
                parts.append(_moved(part, matrix))
        return joined(parts)

    def _placed(self) -> list[tuple[int, Floats]]:
        """Return (mesh, matrix to the world) for each node of the scene that has a mesh."""
        nodes = self._tree.get("nodes", [])
        if len(nodes) > _MOST_NODES:
            raise GeometryError(f"the file has {len(nodes)} nodes; {_MOST_NODES} are read at most")
        scenes = self._tree.get("scenes", [])
        if scenes:
            roots = scenes[_at(self._tree.get("scene", 0))].get("nodes", [])
        else:
            children = {child for node in nodes for child in node.get("children", [])}
            roots = [at for at in range(len(nodes)) if at not in children]
        placed: list[tuple[int, Floats]] = []
        seen: set[int] = set()
        waiting = [(_at(root), np.eye(4)) for root in roots]
        while waiting:
            at, above = waiting.pop()
            if at in seen:
                raise GeometryError(f"node {at} of the file has two parents or is its own ancestor")
            seen.add(at)
            node = nodes[at]
            matrix = above @ _local(node)
            if "mesh" in node:
                placed.append((_at(node["mesh"]), matrix))
            waiting += [(_at(child), matrix) for child in node.get("children", [])]
        return placed

    def _primitive(self, primitive: Json) -> RawMesh:
        mode = primitive.get("mode", 4)
        if "KHR_draco_mesh_compression" in primitive.get("extensions", {}):
            raise GeometryError("the mesh is Draco-compressed; export it without compression")
        if mode in (0, 1, 2, 3):
            return joined([])
        attributes = primitive["attributes"]
        vertices = self._array(attributes["POSITION"], 3).astype(np.float64)
        corners = (
            self._array(primitive["indices"], 1)[:, 0].astype(np.int64)
            if "indices" in primitive
            else np.arange(len(vertices), dtype=np.int64)
        )
        normals = attributes.get("NORMAL")
        part = RawMesh(
            vertices,
            _triangles(corners, mode),
            None if normals is None else self._array(normals, 3).astype(np.float64),
        )
        if part.normals is not None and part.normals.shape != vertices.shape:
            raise GeometryError("a primitive has not as many normals as positions; export it again")
        if len(part.triangles) and int(part.triangles.max()) >= len(vertices):
            raise GeometryError(
                f"a triangle names vertex {int(part.triangles.max())}, and there are "
                f"{len(vertices)}; export the mesh again"
            )
        return part

    def _array(self, accessor_at: Json, width: int) -> NDArray[np.generic]:
        """Return an accessor's values (count, width), a view into its buffer."""
        accessor = self._tree["accessors"][_at(accessor_at)]
        if "sparse" in accessor or "bufferView" not in accessor:
            raise GeometryError("sparse glTF accessors are not read; export the mesh without them")
        view = self._tree["bufferViews"][_at(accessor["bufferView"])]
        kind = np.dtype(_COMPONENTS[accessor["componentType"]])
        if _WIDTHS[accessor["type"]] != width or (width == 3 and kind.kind != "f"):
            raise GeometryError("a glTF accessor has another type than its use needs")
        buffer = self._buffers[_at(view["buffer"])]
        count, begin = _at(accessor["count"]), _at(view.get("byteOffset", 0))
        end = begin + _at(view["byteLength"])
        stride = _at(view.get("byteStride", kind.itemsize * width)) or kind.itemsize * width
        start = begin + _at(accessor.get("byteOffset", 0))
        needed = start + (count - 1) * stride + kind.itemsize * width if count else start
        if end > len(buffer) or needed > end or stride < kind.itemsize * width:
            raise GeometryError(
                f"the glTF accessor {accessor_at} promises {count} values, and its buffer ends "
                "before them; export or copy the mesh again"
            )
        return np.ndarray((count, width), kind, buffer, start, (stride, kind.itemsize))


def _at(value: Json) -> int:
    """Return ``value`` as an index or a size: a whole number from 0 on."""
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise ValueError(f"a whole number is expected, not {str(value)[:40]}")
    return value


def _buffer(buffer: Json, beside: Beside, binary: bytes) -> bytes:
    uri = buffer.get("uri")
    if uri is None:
        content = binary
    elif uri.startswith("data:"):
        head, _, text = uri.partition(",")
        if not head.endswith(";base64"):
            raise GeometryError("a data URI of the glTF file is not base64")
        try:
            content = base64.b64decode(text, validate=True)
        except binascii.Error as fault:
            raise GeometryError(f"a data URI of the glTF file is broken: {fault}") from fault
    else:
        content = beside(unquote(uri))
    length = _at(buffer["byteLength"])
    if length > len(content):
        raise GeometryError(
            f"a glTF buffer promises {length} bytes and holds {len(content)}; copy the mesh again"
        )
    return content[:length]


def _local(node: Json) -> Floats:
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = (float(part) for part in node.get("rotation", (0, 0, 0, 1)))
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = rotation * np.array(node.get("scale", (1, 1, 1)), dtype=np.float64)
    matrix[:3, 3] = np.array(node.get("translation", (0, 0, 0)), dtype=np.float64)
    return matrix


def _moved(part: RawMesh, matrix: Floats) -> RawMesh:
    """Return ``part`` placed by ``matrix``; a mirroring matrix also turns the triangles."""
    linear = matrix[:3, :3]
    determinant = float(np.linalg.det(linear))
    if not np.isfinite(determinant) or determinant == 0.0:
        raise GeometryError("a glTF node has a transform that flattens its mesh")
    normals = None if part.normals is None else part.normals @ np.linalg.inv(linear)
    triangles = part.triangles if determinant > 0 else part.triangles[:, ::-1]
    return RawMesh(part.vertices @ linear.T + matrix[:3, 3], triangles, normals)


def _triangles(corners: NDArray[np.int64], mode: int) -> NDArray[np.int64]:
    if mode == 4:
        if len(corners) % 3:
            raise GeometryError(f"{len(corners)} corners do not make whole triangles")
        return corners.reshape(-1, 3)
    if mode == 5:
        strip = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
        strip[1::2] = strip[1::2, [1, 0, 2]]
        return strip
    if mode == 6:
        first = np.full(max(len(corners) - 2, 0), corners[0] if len(corners) else 0)
        return np.stack([first, corners[1:-1], corners[2:]], axis=1)
    raise GeometryError(f"primitives of mode {mode} are not triangles")

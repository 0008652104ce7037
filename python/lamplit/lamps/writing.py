# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A lamp's files, binary PLY and scene.toml, each marked so that it is known again."""

from __future__ import annotations

import hashlib
import json
import secrets
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np

from lamplit.errors import OutputError
from lamplit.lamps.recipe import Lamp, Table, TomlValue
from lamplit.lamps.solids import Solid

_PLY_MARK = "comment written by lamplit lamp"
_SCENE_MARK = "# Written by `lamplit lamp"


def write_files(lamp: Lamp, command: str, directory: Path, *, force: bool) -> Path:
    """Write ``lamp`` into ``directory`` and return the path of its scene.toml.

    Raises:
        OutputError: A file of that name is there that was not written by this function or was
            changed since (unless ``force``), or the directory cannot be written.
    """
    contents = {name: ply_bytes(solid) for name, solid in lamp.meshes.items()}
    contents["scene.toml"] = scene_text(lamp, command).encode()
    try:
        directory.mkdir(parents=True, exist_ok=True)
        for name in contents:
            path = directory / name
            if path.is_dir() or (path.exists() and not force and not _is_own(path)):
                raise OutputError(
                    "is in the way and was not written by this command, or was changed since; "
                    "choose another directory, or say --force",
                    file=path,
                )
        for name, content in contents.items():
            _write_whole(directory / name, content)
    except OSError as fault:
        reason = fault.strerror or str(fault)
        raise OutputError(f"cannot be written ({reason})", file=directory) from fault
    return directory / "scene.toml"


def ply_bytes(solid: Solid) -> bytes:
    """Return a binary little-endian PLY: float32 vertices in mm, int32 triangles."""
    header = (
        f"ply\nformat binary_little_endian 1.0\n{_PLY_MARK}; lengths in mm\n"
        f"element vertex {len(solid.vertices)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"element face {len(solid.triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(solid.triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = solid.triangles
    return header.encode() + solid.vertices.astype("<f4").tobytes() + faces.tobytes()


def scene_text(lamp: Lamp, command: str) -> str:
    """Return the text of scene.toml; its first line carries a checksum of all that follows."""
    body = "\n".join(
        [
            f"#   {command}",
            "",
            "lamplit = 1",
            f"name = {_toml(lamp.title)}",
            *(_table_text(table) for table in lamp.tables),
        ]
    )
    return f"{_SCENE_MARK}`, sha256 {_checksum(body)}:\n{body}\n"


def _table_text(table: Table) -> str:
    head = f"[[{table.key}]]" if table.many else f"[{table.key}]"
    comment = f"\n# {table.comment}" if table.comment else ""
    lines = [f"{key} = {_toml(value)}" for key, value in table.values.items()]
    return "\n".join([f"{comment}\n{head}", *lines])


def _toml(value: TomlValue) -> str:
    if isinstance(value, (str, int)):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, float):
        return repr(round(value, 6) + 0.0)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_toml(own)}" for key, own in value.items()) + " }"
    items: Sequence[TomlValue] = value.tolist() if isinstance(value, np.ndarray) else value
    return "[" + ", ".join(map(_toml, items)) + "]"


def _checksum(body: str) -> str:
    return hashlib.sha256(body.encode()).hexdigest()[:16]


def _is_own(path: Path) -> bool:
    with path.open("rb") as file:
        if path.suffix == ".ply":
            return _PLY_MARK.encode() in file.read(200)
        text = file.read(1 << 20).decode(errors="replace")
    mark, _, body = text.partition("\n")
    return mark == f"{_SCENE_MARK}`, sha256 {_checksum(body.rstrip(chr(10)))}:"


def _write_whole(path: Path, content: bytes) -> None:
    partial = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    try:
        partial.write_bytes(content)
        partial.replace(path)
    finally:
        with suppress(OSError):
            partial.unlink()

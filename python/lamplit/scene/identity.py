# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The hash by which a result says which scene it shows."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import cast

from lamplit.files import resolve_inside
from lamplit.scene.meshes import mesh_files
from lamplit.scene.models import Scene

#: The keys whose value is the name of a file.
FILE_KEYS = frozenset({"file", "csv", "spdx", "icc", "refractiveindex_info"})


def scene_hash(scene: Scene) -> str:
    """Return SHA-256 (hexadecimal) over the scene's values and the contents of its files.

    Key order, comments, white space and the place of the folder do not matter; every value and
    every byte of a file does.

    Raises:
        SceneError: A file is no longer there.
    """
    return _hash_of(scene, _contents(scene))


def share_hashes(scenes: Sequence[Scene]) -> None:
    """Give ``scenes``, which name the same files, their hashes; each file is read once, now.

    Raises:
        SceneError: A file is no longer there.
    """
    contents = _contents(scenes[0])
    for scene in scenes:
        vars(scene)["scene_hash"] = _hash_of(scene, contents)


def _hash_of(scene: Scene, contents: bytes) -> str:
    values = scene.model_dump(mode="json")
    text = json.dumps(values, sort_keys=True, ensure_ascii=False, separators=(",", ":"))
    return hashlib.sha256(text.encode() + contents).hexdigest()


def _contents(scene: Scene) -> bytes:
    """Return the names of the scene's files, each with the SHA-256 of what is in it."""
    found = bytearray()
    root = scene.root.resolve()
    for name in sorted(set(_named_files(scene.model_dump(mode="json")))):
        for path in mesh_files(resolve_inside(scene.root, name), scene.root):
            found += path.relative_to(root).as_posix().encode() + b"\0" + _digest(path)
    return bytes(found)


def _digest(path: Path) -> bytes:
    own = hashlib.sha256()
    with path.open("rb") as stream:
        while block := stream.read(2**20):
            own.update(block)
    return own.digest()


def _named_files(value: object) -> Iterator[str]:
    if isinstance(value, dict):
        for key, inside in cast("dict[str, object]", value).items():
            if key in FILE_KEYS and isinstance(inside, str):
                yield inside
            else:
                yield from _named_files(inside)
    elif isinstance(value, list):
        for inside in cast("list[object]", value):
            yield from _named_files(inside)

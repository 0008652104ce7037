# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The hash by which a result says which scene it shows."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
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
    values = scene.model_dump(mode="json")
    text = json.dumps(values, sort_keys=True, ensure_ascii=False, separators=(",", ":"))
    total = hashlib.sha256(text.encode())
    for name in sorted(set(_named_files(values))):
        for path in mesh_files(resolve_inside(scene.root, name), scene.root):
            total.update(path.relative_to(scene.root.resolve()).as_posix().encode() + b"\0")
            total.update(_digest(path))
    return total.hexdigest()


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

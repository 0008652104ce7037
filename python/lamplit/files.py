# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Paths named by a scene stay inside the scene's folder."""

from __future__ import annotations

import re
from pathlib import Path

from lamplit.errors import SceneError

_URL = re.compile(r"^[A-Za-z][A-Za-z0-9+.-]+:")


def resolve_inside(root: Path, text: str, *, where: str | None = None) -> Path:
    """Return the existing regular file ``text`` names below ``root``.

    Absolute paths, drive letters, URLs, ``..`` and symbolic links that lead out of ``root`` are
    refused, so that a scene from a stranger reads nothing but its own folder.

    Raises:
        SceneError: The path leaves ``root``, or no regular file is there.
    """
    if "\0" in text or not text.strip():
        raise SceneError("a file name is expected, and this one is empty", where=where)
    if _URL.match(text) or "\\" in text or Path(text).is_absolute():
        raise SceneError(
            f"{text!r} must be a path relative to the scene's folder, with forward slashes",
            where=where,
        )
    base = root.resolve()
    try:
        path = (base / text).resolve()
    except (OSError, RuntimeError) as fault:
        raise SceneError(f"{text!r} cannot be followed: {fault}", where=where) from fault
    if not path.is_relative_to(base):
        raise SceneError(f"{text!r} leads out of the scene's folder {base}", where=where)
    if not path.is_file():
        kind = "is not a regular file" if path.exists() else "does not exist"
        raise SceneError(f"{text!r} {kind} in {base}", where=where)
    return path

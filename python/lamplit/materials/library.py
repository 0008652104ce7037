# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The materials that come with Lamplit: one TOML file each, in a scene's own schema."""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path

from pydantic import TypeAdapter

from lamplit.errors import SceneError, nearest_name
from lamplit.materials.models import Material

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

_FOLDER = Path(__file__).parent / "library"


def material_names() -> tuple[str, ...]:
    """Return the names of the library's materials, sorted."""
    return tuple(sorted(path.stem for path in _FOLDER.glob("*.toml")))


@cache
def material(name: str) -> Material:
    """Return the library's material of this name.

    >>> material("pmma-clear").kind
    'dielectric'

    Raises:
        SceneError: The library has no such material; the message names the nearest.
    """
    if name not in material_names():
        raise SceneError(
            f"the library has no material {name!r}{nearest_name(name, material_names())}; "
            "`lamplit materials` lists them"
        )
    with (_FOLDER / f"{name}.toml").open("rb") as stream:
        written = tomllib.load(stream)
    return TypeAdapter[Material](Material).validate_python(written, context={"root": _FOLDER})

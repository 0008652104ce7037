# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From a TOML file to a `Scene`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

from pydantic import ValidationError

from lamplit.errors import LamplitError, SceneError
from lamplit.files import resolve_inside
from lamplit.scene.emission import FileDistribution
from lamplit.scene.eyes import check_eyes
from lamplit.scene.faults import scene_fault
from lamplit.scene.lighting import ImageBackground
from lamplit.scene.measuring import check_measuring
from lamplit.scene.models import Scene
from lamplit.scene.objects import MeshObject
from lamplit.scene.references import check_references
from lamplit.toml_files import DEEPEST, check_depth, read_toml


def load_scene(path: str | Path, *, overrides: Mapping[str, object] | None = None) -> Scene:
    """Return the scene in the TOML file ``path``.

    ``overrides`` replace or add single values by key path, such as ``{"image.samples": 4}`` or
    ``{"lights[0].luminance_cd_m2": 300.0}``. Files that the scene names are looked for in its
    folder.

    Raises:
        LamplitError: The file cannot be read or does not describe a scene. The message is one
            line with the file, the key path or line, what is wrong and what to do.
    """
    file = Path(path)
    written = read_toml(file, noun="scene", error=SceneError)
    for key, value in (overrides or {}).items():
        set_value(written, key, value)
    return _parsed(written, root=file.resolve().parent, path=file)


def parse_scene(mapping: Mapping[str, object], *, root: str | Path) -> Scene:
    """Return the scene that ``mapping`` describes, as a TOML file would; files are below ``root``.

    Raises:
        LamplitError: As for `load_scene`.
    """
    return _parsed(mapping, root=Path(root).resolve(), path=None)


def _parsed(written: Mapping[str, object], *, root: Path, path: Path | None) -> Scene:
    check_depth(written, path, noun="scene", error=SceneError)
    if "lamplit" not in written:
        raise SceneError(
            "this key is missing: a scene file begins with lamplit = 1", file=path, where="lamplit"
        )
    try:
        scene = Scene.model_validate(dict(written), context={"root": root})
    except ValidationError as fault:
        raise scene_fault(fault, written, path) from None
    except LamplitError as fault:
        raise type(fault)(fault.message, file=fault.file or path, where=fault.where) from fault
    scene.place(root, path)
    try:
        check_references(scene)
        check_measuring(scene)
        check_eyes(scene)
        _check_files(scene)
    except LamplitError as fault:
        raise type(fault)(fault.message, file=path or fault.file, where=fault.where) from fault
    return scene


def _check_files(scene: Scene) -> None:
    for at, own in enumerate(scene.objects):
        if isinstance(own, MeshObject):
            resolve_inside(scene.root, own.file, where=f"objects[{at}].file")
        spread = None if own.emission is None else own.emission.distribution
        if isinstance(spread, FileDistribution):
            where = f"objects[{at}].emission.distribution.file"
            resolve_inside(scene.root, spread.file, where=where)
    for at, rays in enumerate(scene.ray_files):
        resolve_inside(scene.root, rays.file, where=f"ray_files[{at}].file")
    if isinstance(scene.background, ImageBackground):
        resolve_inside(scene.root, scene.background.file, where="background.file")
    icc = getattr(scene.display.space, "icc", None)
    if icc is not None:
        resolve_inside(scene.root, icc, where="display.space.icc")


def set_value(written: dict[str, Any], key: str, value: object) -> None:
    """Set ``value`` at a key path; tables on the way are made, list entries must be there."""
    parts = re.findall(r"[^.\[\]]+|\[\d+\]", key)
    plain = "".join(p if p.startswith("[") else f".{p}" for p in parts).removeprefix(".")
    if not parts or plain != key or len(parts) > DEEPEST or parts[0].startswith("["):
        raise SceneError(f"{key!r} is no key path; write it like image.samples or lights[0].source")
    here: Any = written
    for part, following in zip(parts, [*parts[1:], None], strict=True):
        step = int(part[1:-1]) if part.startswith("[") else part
        if isinstance(step, int):
            if not isinstance(here, list) or step >= len(cast("list[object]", here)):
                raise SceneError(f"there is no entry {part} to set", where=key)
        elif not isinstance(here, dict):
            raise SceneError(f"{part!r} cannot be set: what holds it is no table", where=key)
        holder = cast("dict[str | int, Any]", here)
        if following is None:
            holder[step] = value
        elif isinstance(step, str) and step not in holder:
            here = holder[step] = dict[str, Any]()
        else:
            here = holder[step]

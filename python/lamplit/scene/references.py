# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Names in a scene mean something: materials, sources, and objects that can be told apart."""

from __future__ import annotations

from collections.abc import Iterator
from types import UnionType
from typing import Any, TypeAlias, cast

from pydantic import BaseModel

from lamplit.errors import SceneError, nearest_name
from lamplit.materials import Material, material, material_names
from lamplit.scene.models import LibraryMaterial, Scene
from lamplit.sources import source as library_source
from lamplit.sources import source_names
from lamplit.spectra_spec import NamedSource, SourceSpec
from lamplit.spectrum import SpectralDistribution
from lamplit.table_faults import key_path

Keys: TypeAlias = tuple[str | int, ...]


def check_references(scene: Scene) -> None:
    """Check every name that a scene uses.

    Raises:
        SceneError: A name is unknown, given twice, or leads back to itself; or there is no object.
    """
    if not scene.objects:
        raise SceneError(
            "the scene has no objects; add an [[objects]] table with a kind and a material",
            where="objects",
        )
    library = set(material_names())
    for name, own in scene.materials.items():
        if isinstance(own, LibraryMaterial) and own.library not in library:
            raise SceneError(
                f"the library has no material {own.library!r}"
                f"{nearest_name(own.library, library)}{_see('materials')}",
                where=key_path(("materials", name, "library")),
            )
        if isinstance(own, LibraryMaterial):
            _check_finish(name, own)
    seen: dict[str, int] = {}
    known = library | set(scene.materials)
    for at, thing in enumerate(scene.objects):
        if thing.material not in known:
            raise SceneError(
                f"no material is called {thing.material!r}"
                f"{nearest_name(thing.material, known)}{_see('materials')}",
                where=f"objects[{at}].material",
            )
        if thing.name in seen:
            raise SceneError(
                f"objects[{seen[thing.name]}] is called {thing.name!r} too; choose another name",
                where=f"objects[{at}].name",
            )
        seen[thing.name] = at
    _check_ray_files(scene)
    sources = set(source_names())
    for keys, source in values_of(scene, NamedSource):
        name = source.root
        own_definition = keys[:1] == ("sources",)
        if name not in sources and (own_definition or name not in scene.sources):
            names = sources if own_definition else sources | set(scene.sources)
            raise SceneError(
                f"no source is called {name!r}{nearest_name(name, names)}{_see('sources')}",
                where=key_path(keys),
            )


def _check_ray_files(scene: Scene) -> None:
    seen: dict[str, int] = {}
    for at, rays in enumerate(scene.ray_files):
        if rays.name in seen:
            raise SceneError(
                f"ray_files[{seen[rays.name]}] is called {rays.name!r} too; choose another name",
                where=f"ray_files[{at}].name",
            )
        seen[rays.name] = at


def _check_finish(name: str, own: LibraryMaterial) -> None:
    found = material(own.library)
    if own.roughness is not None and "roughness" not in type(found).model_fields:
        raise SceneError(
            f"{own.library!r} is {found.kind}, and has no roughness; "
            "dielectric, conductor, mirror and glossy have one",
            where=key_path(("materials", name, "roughness")),
        )


def _see(noun: str) -> str:
    return f" ('lamplit {noun}' lists the library)"


def values_of(value: object, kind: type | UnionType, keys: Keys = ()) -> Iterator[tuple[Keys, Any]]:
    """Yield every value of type ``kind`` within ``value``, with the keys that lead to it."""
    if isinstance(value, kind):
        yield keys, value
    elif isinstance(value, BaseModel):
        for key in type(value).model_fields:
            yield from values_of(getattr(value, key), kind, (*keys, key))
    elif isinstance(value, dict):
        for key, inside in cast("dict[str, object]", value).items():
            yield from values_of(inside, kind, (*keys, key))
    elif isinstance(value, tuple):
        for at, inside in enumerate(cast("tuple[object, ...]", value)):
            yield from values_of(inside, kind, (*keys, at))


def resolve_source(scene: Scene, source: str | SourceSpec) -> SpectralDistribution:
    """See `Scene.resolve_source`."""
    spec = NamedSource(source) if isinstance(source, str) else source
    if not isinstance(spec, NamedSource):
        return spec.distribution()
    own = scene.sources.get(spec.root)
    if own is not None and not isinstance(own, NamedSource):
        return own.distribution()
    name = spec.root if own is None else own.root
    if name not in source_names():
        near = nearest_name(name, {*source_names(), *scene.sources})
        raise SceneError(f"no source is called {name!r}{near}", file=scene.path)
    return library_source(name).distribution()


def resolve_material(scene: Scene, name: str) -> Material:
    """See `Scene.resolve_material`."""
    own = scene.materials.get(name)
    if own is None:
        if name not in material_names():
            near = nearest_name(name, {*material_names(), *scene.materials})
            raise SceneError(f"no material is called {name!r}{near}", file=scene.path)
        return material(name)
    if not isinstance(own, LibraryMaterial):
        return own
    found = material(own.library)
    given = {key: getattr(own, key) for key in ("hall", "roughness", "texture")}
    changed = {key: value for key, value in given.items() if value is not None}
    return found.model_copy(update=changed) if changed else found

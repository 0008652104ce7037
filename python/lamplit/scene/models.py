# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Scene`: the whole of a scene file as one frozen model."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

from pydantic import Discriminator, Field, PrivateAttr, Tag, model_validator

from lamplit.materials import HallTerms, Material, Roughness, Texture
from lamplit.materials.finish import check_texture
from lamplit.scene.camera import Camera, DisplaySettings, ImageSettings
from lamplit.scene.eyes import MOST_FRAMES, Eye
from lamplit.scene.fields import Name, Table
from lamplit.scene.lighting import BLACK, Ambient, Background, Light
from lamplit.scene.measuring import MeasureSettings
from lamplit.scene.methods import HallSettings, PathSettings
from lamplit.scene.objects import Object
from lamplit.scene.ray_files import RayFile, ResolvedRays
from lamplit.spectra_spec import SourceSpec
from lamplit.spectrum import SpectralDistribution

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from lamplit.scene.resolve import ResolvedObject


class LibraryMaterial(Table):
    """A material of the library, with a finish and shading terms of the scene's own if it likes."""

    library: Name = Field(description="a name of the library; `lamplit materials` lists them")
    roughness: Roughness | None = Field(default=None, description="instead of the library's")
    texture: Texture | None = Field(default=None, description="which faces are rough")
    hall: HallTerms | None = Field(default=None, description="terms of the Hall method")

    @model_validator(mode="after")
    def _is_rough_where_textured(self) -> LibraryMaterial:
        check_texture(self.texture, self.roughness)
        return self


def _material_form(value: object) -> str:
    named = isinstance(value, LibraryMaterial) or (
        isinstance(value, Mapping) and "kind" not in value
    )
    return "<library>" if named else "<own>"


SceneMaterial: TypeAlias = Annotated[
    Annotated[LibraryMaterial, Tag("<library>")] | Annotated[Material, Tag("<own>")],
    Discriminator(_material_form),
]


class Scene(Table):
    """Everything that a picture depends on, as `lamplit.scene.load_scene` reads it.

    Lengths are in mm, wavelengths in nm, angles in degrees; y is up, right-handed.
    """

    lamplit: Literal[1] = Field(description="version of this format")
    name: Annotated[str, Field(max_length=200)] = Field(
        default="", description="title of the picture"
    )
    description: str = Field(default="", description="for people")
    camera: Camera = Field(description="from where the scene is seen")
    image: ImageSettings = Field(default=ImageSettings(), description="size and sampling")
    display: DisplaySettings = Field(
        default=DisplaySettings(), description="from tristimulus values to a picture"
    )
    path_settings: PathSettings = Field(
        default=PathSettings(), alias="path", description="how path transport spends its walks"
    )
    hall: HallSettings = Field(default=HallSettings(), description="how far rays are followed")
    ambient: Ambient | None = Field(default=None, description="light from all around")
    background: Background = Field(default=BLACK, description="what rays meet that leave the scene")
    lights: Annotated[tuple[Light, ...], Field(strict=False, max_length=1000)] = Field(
        default=(), description="what makes highlights and shadows"
    )
    measure: MeasureSettings | None = Field(
        default=None, description="the lamp's axis, its functions, and how it is measured"
    )
    sources: dict[Name, SourceSpec] = Field(
        default_factory=dict[str, Any], description="spectra of light by name"
    )
    materials: dict[Name, SceneMaterial] = Field(
        default_factory=dict[str, Any], description="materials by name"
    )
    objects: Annotated[tuple[Object, ...], Field(strict=False, max_length=10_000)] = Field(
        default=(), description="all bodies and surfaces; one at least"
    )

    ray_files: Annotated[tuple[RayFile, ...], Field(strict=False, max_length=1000)] = Field(
        default=(), description="sources measured ray by ray, for forward transport"
    )

    eyes: Annotated[tuple[Eye, ...], Field(strict=False, max_length=MOST_FRAMES)] = Field(
        default=(), description="more places to see the scene from, one after the other"
    )

    _root: Path = PrivateAttr(default=Path())
    _path: Path | None = PrivateAttr(default=None)

    def place(self, root: Path, path: Path | None) -> None:
        """Say where the scene comes from; the loader does this once."""
        self._root, self._path = root, path

    def changed(self, **tables: object) -> Scene:
        """Return this scene with whole ``tables`` replaced, such as ``image=...``."""
        copy = self.model_copy(update=tables)
        # What was derived from the values was copied with them.
        stale = [
            "scene_hash",
            *(["objects_as_read"] if {"objects", "materials", "sources"} & {*tables} else []),
            *(["environment"] if "background" in tables else []),
        ]
        for name in stale:
            vars(copy).pop(name, None)
        return copy

    @property
    def root(self) -> Path:
        """The folder that every file of the scene lies in."""
        return self._root

    @property
    def path(self) -> Path | None:
        """The scene file, or None for a scene that was never in one."""
        return self._path

    @cached_property
    def scene_hash(self) -> str:
        """SHA-256 over the scene's values and the contents of every file that it names."""
        from lamplit.scene.identity import scene_hash

        return scene_hash(self)

    def resolve_source(self, source: str | SourceSpec) -> SpectralDistribution:
        """Return the spectral distribution of a source, by name or by its specification.

        A name is looked up in the scene's ``[sources]`` first, then in the library.

        Raises:
            SceneError: Neither knows the name.
        """
        from lamplit.scene.references import resolve_source

        return resolve_source(self, source)

    def resolve_material(self, name: str) -> Material:
        """Return the material of this name, from ``[materials]`` or the library.

        Raises:
            SceneError: Neither knows the name.
        """
        from lamplit.scene.references import resolve_material

        return resolve_material(self, name)

    def resolved_objects(self) -> list[ResolvedObject]:
        """Return the objects with their materials and meshes, ready to be traced.

        Meshes are read once and kept. Their triangles are turned so that normals point outward.

        Raises:
            GeometryError: A mesh cannot be read, or an open one is to be a transparent body.
            SceneError: A spectrum does not reach over the wavelengths of the picture, or the
                camera sees none of the objects.
        """
        from lamplit.scene.resolve import resolve_objects

        return list(resolve_objects(self))

    def resolved_rays(self) -> tuple[ResolvedRays, ...]:
        """Return the rays of ``[[ray_files]]`` in the scene's coordinates; each file is read.

        Raises:
            SceneError: A file cannot be used, or nothing says what spectrum its rays have.
        """
        from lamplit.scene.rays import resolve_rays

        return resolve_rays(self)

    @cached_property
    def environment(self) -> NDArray[np.float32] | None:
        """Linear RGB (H, W, 3) of an ``image`` background, rows from the top; None for others.

        Raises:
            SceneError: The picture cannot be read, or a pixel of it is no radiance.
        """
        from lamplit.scene.shining import read_background_image

        return read_background_image(self)

    @cached_property
    def objects_as_read(self) -> tuple[ResolvedObject, ...]:
        """The objects with their meshes as `resolved_objects` gives them, but sound or not."""
        from lamplit.scene.resolve import read_objects

        return read_objects(self)

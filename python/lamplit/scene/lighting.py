# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Lights, the ambient light and the background: all that shines, and how far rays follow it."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from lamplit.scene.fields import Direction, Length, Name, NotNegative, Point, Share, Table
from lamplit.spectra_spec import NamedSource, SourceSpec


class HallSettings(Table):
    """How far the recursion of the founding method goes."""

    max_depth: int = Field(default=12, ge=1, le=64, description="surfaces in one chain of rays")
    contribution_limit: Share = Field(
        default=3e-3, description="a ray that can add less than this share is not followed"
    )
    dispersion_groups: Literal[1, 2, 4, 8, 16] = Field(
        default=1, description="directions that the lanes share at a dispersive refraction"
    )
    shadows: bool = Field(
        default=True,
        description="whether bodies take light from what lies behind them",
    )


class Radiator(Table):
    """A spectrum with a strength."""

    source: SourceSpec = Field(description="the shape of the spectrum; its scale has no meaning")
    luminance_cd_m2: NotNegative = Field(description="how bright it is")


class Ambient(Radiator):
    """Light from all around: the luminance of a perfect reflector in it."""


class _Light(Radiator):
    """A light, its strength given as the luminance of a perfect reflector that faces it."""

    name: Name | None = Field(default=None, description="for people")


class PointLight(_Light):
    """A light at one point."""

    kind: Literal["point"]
    position_mm: Point = Field(description="where the light is")


class DirectionalLight(_Light):
    """A light from infinitely far away."""

    kind: Literal["directional"]
    direction: Direction = Field(description="the way the light travels")


class SphereLight(_Light):
    """A small luminous sphere."""

    kind: Literal["sphere"]
    centre_mm: Point = Field(description="its middle")
    radius_mm: Length = Field(description="its radius: the larger, the softer the shadows")


Light: TypeAlias = Annotated[
    PointLight | DirectionalLight | SphereLight, Field(discriminator="kind")
]


class SoftBox(Radiator):
    """A luminous rectangle that is seen in the background only."""

    centre_mm: Point = Field(description="its middle")
    facing_mm: Point = Field(default=(0.0, 0.0, 0.0), description="the point that it faces")
    up: Direction = Field(default=(0.0, 1.0, 0.0), description="its height runs this way")
    width_mm: Length = Field(description="across up")
    height_mm: Length = Field(description="along up")
    edge_softness: Share = Field(
        default=0.0, description="0: a hard edge; 1: it falls off from the middle"
    )

    @model_validator(mode="after")
    def _faces_somewhere(self) -> SoftBox:
        view = np.subtract(self.facing_mm, self.centre_mm)
        distance = float(np.linalg.norm(view))
        up = np.divide(self.up, np.linalg.norm(self.up))
        if distance < 1e-9 or float(np.linalg.norm(np.cross(view / distance, up))) < 1e-6:
            raise PydanticCustomError(
                "faces_nowhere",
                "facing_mm must differ from centre_mm, and up must not be parallel to the line "
                "between them",
            )
        return self


class ConstantBackground(Radiator):
    """The same light from every direction."""

    kind: Literal["constant"]


class GradientBackground(Table):
    """Light that changes from the zenith (+y) to the nadir."""

    kind: Literal["gradient"]
    zenith: Radiator = Field(description="straight above")
    nadir: Radiator = Field(description="straight below")


class StudioBackground(Table):
    """A constant or a gradient, and soft boxes before it."""

    kind: Literal["studio"]
    source: SourceSpec | None = Field(default=None, description="of a constant")
    luminance_cd_m2: NotNegative | None = Field(default=None, description="of a constant")
    zenith: Radiator | None = Field(default=None, description="of a gradient: straight above")
    nadir: Radiator | None = Field(default=None, description="of a gradient: straight below")
    soft_boxes: Annotated[tuple[SoftBox, ...], Field(strict=False, max_length=64)] = Field(
        default=(), description="the nearer one hides the farther one"
    )

    @model_validator(mode="after")
    def _has_one_base(self) -> StudioBackground:
        constant = (self.source is not None, self.luminance_cd_m2 is not None)
        gradient = (self.zenith is not None, self.nadir is not None)
        if any(constant) + any(gradient) != 1 or not (all(constant) or all(gradient)):
            raise PydanticCustomError(
                "studio_base",
                "a studio needs either source and luminance_cd_m2, or zenith and nadir",
            )
        return self

    @property
    def base(self) -> ConstantBackground | GradientBackground:
        """What is seen where no soft box is."""
        if self.zenith is not None and self.nadir is not None:
            return GradientBackground(kind="gradient", zenith=self.zenith, nadir=self.nadir)
        if self.source is not None and self.luminance_cd_m2 is not None:
            return ConstantBackground(
                kind="constant", source=self.source, luminance_cd_m2=self.luminance_cd_m2
            )
        raise ValueError("this studio was made without its base")


Background: TypeAlias = Annotated[
    ConstantBackground | GradientBackground | StudioBackground, Field(discriminator="kind")
]

#: A black background, for scenes that name none.
BLACK = ConstantBackground(kind="constant", source=NamedSource("E"), luminance_cd_m2=0.0)

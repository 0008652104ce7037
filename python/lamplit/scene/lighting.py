# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Lights, the ambient light and the background: all that shines besides the objects."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from lamplit.scene.fields import (
    Direction,
    FileName,
    GroupName,
    Length,
    Name,
    NotNegative,
    Number,
    Point,
    Positive,
    Share,
    Table,
)
from lamplit.spectra_spec import NamedSource, SourceSpec


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
    group: GroupName = Field(default="background", description="light group")

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


class Sun(Table):
    """A round disc endlessly far away, of even luminance; it is added to what lies behind it."""

    direction: Direction = Field(description="towards the sun")
    angular_diameter_deg: Annotated[Number, Field(ge=0.01, le=90.0)] = Field(
        default=0.533, description="across its disc, as seen from the scene"
    )
    source: SourceSpec = Field(description="the shape of the spectrum; its scale has no meaning")
    illuminance_lx: NotNegative | None = Field(default=None, description="on a plane that faces it")
    luminance_cd_m2: NotNegative | None = Field(default=None, description="of its disc")
    group: GroupName = Field(default="background", description="light group")

    @model_validator(mode="after")
    def _has_one_strength(self) -> Sun:
        if (self.illuminance_lx is None) == (self.luminance_cd_m2 is None):
            raise PydanticCustomError(
                "sun_strength", "a sun needs either illuminance_lx or luminance_cd_m2"
            )
        return self

    @property
    def angular_radius_rad(self) -> float:
        """Half the angle across its disc."""
        return float(np.radians(self.angular_diameter_deg / 2.0))

    @property
    def disc_luminance_cd_m2(self) -> float:
        """Its luminance L = E / (π sin² of its radius), where its illuminance E was given."""
        if self.luminance_cd_m2 is not None:
            return self.luminance_cd_m2
        return (self.illuminance_lx or 0.0) / (np.pi * float(np.sin(self.angular_radius_rad)) ** 2)


class _Background(Table):
    group: GroupName = Field(default="background", description="light group")
    suns: Annotated[tuple[Sun, ...], Field(strict=False, max_length=16)] = Field(
        default=(), description="discs endlessly far away, behind soft boxes"
    )


class ConstantBackground(Radiator, _Background):
    """The same light from every direction."""

    kind: Literal["constant"]


class GradientBackground(_Background):
    """Light that changes from the zenith (+y) to the nadir."""

    kind: Literal["gradient"]
    zenith: Radiator = Field(description="straight above")
    nadir: Radiator = Field(description="straight below")


class SkyBackground(_Background):
    """A sky of ISO 15469 (CIE S 011) over even ground; its sun's disc is one of suns."""

    kind: Literal["sky"]
    model: Literal["cie-overcast", "cie-clear", "cie-general"] = Field(
        description="Moon and Spencer's overcast sky, type 12, or any type of the standard"
    )
    type: Annotated[int, Field(ge=1, le=15)] | None = Field(
        default=None, description="of cie-general: 1 steep overcast to 15 white-blue turbid"
    )
    source: SourceSpec = Field(description="the shape of the spectrum; its scale has no meaning")
    zenith_luminance_cd_m2: NotNegative = Field(description="straight above")
    sun_direction: Direction | None = Field(
        default=None, description="towards the sun; not for cie-overcast"
    )
    ground: Radiator | None = Field(default=None, description="below the horizon; left out: black")

    @model_validator(mode="after")
    def _hangs_together(self) -> SkyBackground:
        if (self.type is not None) != (self.model == "cie-general"):
            raise PydanticCustomError(
                "sky_type", 'type (1 to 15) belongs to model = "cie-general", which needs it'
            )
        if (self.sun_direction is not None) == (self.model == "cie-overcast"):
            raise PydanticCustomError(
                "sky_sun", "the overcast sky has no sun_direction, and all others need it"
            )
        if self.sun_direction is not None and self.sun_direction[1] < 0.0:
            raise PydanticCustomError(
                "sun_below", "sun_direction points below the horizon; its y must be 0 or more"
            )
        return self

    @property
    def general_type(self) -> int | None:
        """The standard's type from 1 to 15; None for the traditional overcast sky."""
        return 12 if self.model == "cie-clear" else self.type


class ImageBackground(_Background):
    """A picture all around; its spectra are derived from RGB, so its colours are a guess."""

    kind: Literal["image"]
    file: FileName = Field(
        description="equirectangular Radiance (.hdr) or OpenEXR (.exr) picture, linear sRGB"
    )
    scale: Positive = Field(default=1.0, description="luminance in cd/m² of R = G = B = 1")
    source: SourceSpec = Field(default=NamedSource("D65"), description="the spectrum of R = G = B")
    rotate_deg: Number = Field(
        default=0.0, description="about y, from +z to +x; at 0 its middle is seen along -z"
    )


class StudioBackground(_Background):
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
            return GradientBackground(
                kind="gradient", zenith=self.zenith, nadir=self.nadir, group=self.group
            )
        if self.source is not None and self.luminance_cd_m2 is not None:
            return ConstantBackground(
                kind="constant",
                source=self.source,
                luminance_cd_m2=self.luminance_cd_m2,
                group=self.group,
            )
        raise ValueError("this studio was made without its base")


Background: TypeAlias = Annotated[
    ConstantBackground | GradientBackground | StudioBackground | SkyBackground | ImageBackground,
    Field(discriminator="kind"),
]

#: A black background, for scenes that name none.
BLACK = ConstantBackground(kind="constant", source=NamedSource("E"), luminance_cd_m2=0.0)

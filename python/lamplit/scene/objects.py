# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The objects of a scene: shapes by their equations, and triangle meshes."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from lamplit.scene.emission import Emission
from lamplit.scene.fields import Direction, FileName, Length, Name, Number, Point, Positive, Table

#: Millimetres in one unit of a mesh file.
UNITS_MM = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}

Angles: TypeAlias = Annotated[tuple[Number, Number, Number], Field(strict=False)]


class Transform(Table):
    """First the scale, then rotations about x, y and z, then the shift."""

    scale: Annotated[Positive, Field(ge=1e-9, le=1e9)] = Field(
        default=1.0, description="factor on all lengths, from the origin"
    )
    rotate_deg: Angles = Field(
        default=(0.0, 0.0, 0.0), description="about x, then y, then z; about z, 90 takes x to y"
    )
    translate_mm: Point = Field(default=(0.0, 0.0, 0.0), description="the shift at last")

    def matrix(self) -> NDArray[np.float64]:
        """Return the 4×4 matrix that acts on column vectors (x, y, z, 1) in mm.

        Right-handed: a rotation of 90° about z takes x to y. A quarter turn is exact.
        """
        rotation = np.eye(3)
        for axis, degrees in enumerate(self.rotate_deg):
            turn = np.eye(3)
            one, two = (axis + 1) % 3, (axis + 2) % 3
            cosine, sine = _exact_turn(degrees)
            turn[one, one] = turn[two, two] = cosine
            turn[two, one], turn[one, two] = sine, -sine
            rotation = turn @ rotation
        matrix = np.eye(4)
        matrix[:3, :3] = self.scale * rotation
        matrix[:3, 3] = self.translate_mm
        return matrix


def _exact_turn(degrees: float) -> tuple[float, float]:
    quarter, rest = divmod(degrees % 360.0, 90.0)
    if rest == 0.0:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
    angle = np.radians(degrees % 360.0)
    return float(np.cos(angle)), float(np.sin(angle))


class _Object(Table):
    name: Name = Field(description="a name of its own, for messages")
    material: Name = Field(description="a name of [materials], or of the library")
    priority: int = Field(
        default=0, ge=-1000, le=1000, description="where bodies share space, the higher one wins"
    )
    transform: Transform = Field(default=Transform(), description="moves it into the scene")
    emission: Emission | None = Field(default=None, description="light from its surface")


class Sphere(_Object):
    """A sphere."""

    kind: Literal["sphere"]
    centre_mm: Point = Field(description="its middle")
    radius_mm: Length = Field(description="its radius")


class Tetrahedron(_Object):
    """The solid between four points: a triangular pyramid."""

    kind: Literal["tetrahedron"]
    points_mm: Annotated[tuple[Point, Point, Point, Point], Field(strict=False)] = Field(
        description="its four corners, in any order"
    )

    @model_validator(mode="after")
    def _is_solid(self) -> Tetrahedron:
        edges = np.subtract(self.points_mm[1:], self.points_mm[0])
        longest = float(np.abs(edges).max())
        if longest == 0.0 or abs(float(np.linalg.det(edges / longest))) < 1e-12:
            raise PydanticCustomError(
                "flat", "points_mm: the four points lie in one plane and enclose no volume"
            )
        return self


class Plane(_Object):
    """A plane without end."""

    kind: Literal["plane"]
    point_mm: Point = Field(description="any point on it")
    normal: Direction = Field(description="stands on it; its length is not used")


class Disc(_Object):
    """A flat round disc without thickness."""

    kind: Literal["disc"]
    centre_mm: Point = Field(description="its middle")
    normal: Direction = Field(description="stands on it; its length is not used")
    radius_mm: Length = Field(description="its radius")


class Box(_Object):
    """A box along the axes, before its transform."""

    kind: Literal["box"]
    min_mm: Point = Field(description="the corner with the lowest x, y and z")
    max_mm: Point = Field(description="the corner with the highest x, y and z")

    @model_validator(mode="after")
    def _is_solid(self) -> Box:
        if not all(low < high for low, high in zip(self.min_mm, self.max_mm, strict=True)):
            raise PydanticCustomError(
                "flat", "each number of min_mm must be below the same number of max_mm"
            )
        return self


class _Upright(_Object):
    base_mm: Point = Field(description="the centre of the base")
    axis: Direction = Field(description="from the base to the other end; its length is not used")
    radius_mm: Length = Field(description="radius of the base")
    height_mm: Length = Field(description="along the axis")


class Cylinder(_Upright):
    """A cylinder with flat caps."""

    kind: Literal["cylinder"]


class Cone(_Upright):
    """A cone with a flat base, its tip ``height_mm`` along ``axis``."""

    kind: Literal["cone"]


class MeshObject(_Object):
    """Triangles from a PLY, STL, OBJ, glTF or GLB file."""

    kind: Literal["mesh"]
    file: FileName = Field(description="mesh file below the scene's folder")
    unit: Literal["mm", "cm", "m", "in"] = Field(description="what a length of 1 in the file means")
    scale: Annotated[Positive, Field(ge=1e-9, le=1e9)] = Field(
        default=1.0, description="factor on the coordinates of the file, besides the unit"
    )
    smooth: bool = Field(default=False, description="shade with vertex normals")
    crease_deg: Annotated[Number, Field(ge=0.0, le=180.0)] = Field(
        default=30.0, description="edges sharper than this stay edges where normals are computed"
    )


#: Shapes that have an equation.
Primitive: TypeAlias = Sphere | Tetrahedron | Plane | Disc | Box | Cylinder | Cone

Object: TypeAlias = Annotated[MeshObject | Primitive, Field(discriminator="kind")]

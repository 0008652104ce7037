# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The field types that the tables of a scene file are made of."""

from __future__ import annotations

from typing import Annotated, TypeAlias

from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic_core import PydanticCustomError

#: The largest coordinate, 1000 km: beyond it, float64 is coarser than the film of a lamp.
FARTHEST_MM = 1e9

Number: TypeAlias = Annotated[float, Field(allow_inf_nan=False)]
Positive: TypeAlias = Annotated[float, Field(allow_inf_nan=False, gt=0.0)]
NotNegative: TypeAlias = Annotated[float, Field(allow_inf_nan=False, ge=0.0)]
#: A flux or a weight: far above any lamp's, and far below what overflows when it is squared.
Amount: TypeAlias = Annotated[float, Field(allow_inf_nan=False, ge=0.0, le=1e9)]
Share: TypeAlias = Annotated[float, Field(allow_inf_nan=False, ge=0.0, le=1.0)]
Coordinate: TypeAlias = Annotated[
    float, Field(allow_inf_nan=False, ge=-FARTHEST_MM, le=FARTHEST_MM)
]
Length: TypeAlias = Annotated[float, Field(allow_inf_nan=False, gt=0.0, le=FARTHEST_MM)]
Name: TypeAlias = Annotated[str, Field(min_length=1, max_length=200)]
FileName: TypeAlias = Annotated[str, Field(min_length=1, max_length=1000)]

Vector: TypeAlias = tuple[float, float, float]


_NOT_IN_GROUPS = frozenset(".,:;=/\\*\"'[]{}")


def is_group_name(name: str) -> bool:
    """Return whether ``name`` can stand as a part of a layer's name and on a command line."""
    return (
        0 < len(name) <= 100
        and name.isprintable()
        and name == name.strip()
        and not _NOT_IN_GROUPS & {*name}
    )


def _layer_name(name: str) -> str:
    if not is_group_name(name):
        raise PydanticCustomError(
            "group_name",
            "a light group's name has letters, digits, '-', '_' and blanks between them, "
            "and {name} is given",
            {"name": repr(name)[:60]},
        )
    return name


def _has_length(vector: Vector) -> Vector:
    if max(abs(part) for part in vector) < 1e-12:
        raise PydanticCustomError("no_direction", "a direction needs a length other than zero")
    return vector


#: The name of a light group: of layers in files, and of terms on the command line.
GroupName: TypeAlias = Annotated[str, Field(min_length=1), AfterValidator(_layer_name)]
#: A point in mm: three numbers in square brackets.
Point: TypeAlias = Annotated[tuple[Coordinate, Coordinate, Coordinate], Field(strict=False)]
#: A direction of any length but zero.
Direction: TypeAlias = Annotated[
    tuple[Coordinate, Coordinate, Coordinate], Field(strict=False), AfterValidator(_has_length)
]


class Table(BaseModel):
    """A table of a scene file: every key known, every value of its own type, none changed later."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

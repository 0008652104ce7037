# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What a lamp generator takes and gives: parameters in; meshes and the tables of a scene out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from lamplit.lamps.solids import Solid


class LampParameters(BaseModel):
    """The base of every lamp's parameters: frozen, finite, no unknown names."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


Triangles = Annotated[
    int,
    Field(ge=2_000, le=8_000_000, description="about how many triangles all meshes have together"),
]
LensColour = Literal["red", "amber", "smoke", "clear"]


def _rough_enough(roughness: float) -> float:
    if 0.0 < roughness < _LEAST_ROUGHNESS:
        raise ValueError(f"a roughness is 0 (smooth) or {_LEAST_ROUGHNESS:g} to 1")
    return roughness


#: What scenes take as the least width α of GGX that is not smooth.
_LEAST_ROUGHNESS = 1e-3
Roughness = Annotated[float, Field(ge=0.0, le=1.0), AfterValidator(_rough_enough)]


#: A value of a TOML file; arrays of numbers may be numpy's.
TomlValue: TypeAlias = (
    "str | float | NDArray[np.floating[Any]] | Sequence[TomlValue] | Mapping[str, TomlValue]"
)


@dataclass(frozen=True)
class Table:
    """One table of a scene file: ``[key]``, or one of the list ``[[key]]`` with ``many``."""

    key: str
    values: Mapping[str, TomlValue]
    comment: str = ""
    many: bool = False


@dataclass(frozen=True)
class Lamp:
    """A generated lamp: the ``tables`` of its scene, and its meshes by file name."""

    title: str
    tables: list[Table]
    meshes: dict[str, Solid] = field(default_factory=dict)

    @property
    def triangles(self) -> int:
        """The number of triangles of all meshes."""
        return sum(len(solid.triangles) for solid in self.meshes.values())


def mesh_object(
    name: str,
    material: str,
    *,
    crease_deg: float | None = None,
    emission: Mapping[str, TomlValue] | None = None,
    comment: str = "",
) -> Table:
    """Return the object of the mesh ``<name>.ply``, shaded smoothly with a ``crease_deg``."""
    light = {} if emission is None else {"emission": emission}
    shading = {} if crease_deg is None else {"smooth": True, "crease_deg": crease_deg}
    values = {"name": name, "kind": "mesh", "file": f"{name}.ply", "unit": "mm", **shading}
    return Table("objects", {**values, "material": material, **light}, comment, many=True)


def lens_material(colour: LensColour) -> str:
    """Return the library's name of PMMA in this colour."""
    return "pmma-clear" if colour == "clear" else f"{colour}-pmma"


def library_material(name: str, roughness: float) -> dict[str, TomlValue]:
    """Return the library's material ``name`` with a GGX ``roughness``, 0 for its own surface."""
    return {"library": name, **({"roughness": roughness} if roughness else {})}

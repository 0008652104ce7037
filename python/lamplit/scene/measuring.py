# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How a lamp is measured: its axis, the receiver, and its functions; and whether that is sound."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from lamplit.errors import SceneError, nearest_name
from lamplit.scene.fields import Amount, Direction, GroupName, Name, Point, Positive, Table

if TYPE_CHECKING:
    from lamplit.scene.models import Scene

#: The full angles that a regulation's receiver subtends, in degrees: 10′ to 1°.
SMALLEST_RECEIVER_DEG, LARGEST_RECEIVER_DEG = 1.0 / 6.0, 1.0

#: The full angle of the source and of the receiver that look at a retro-reflector, in degrees: 10′.
REFLEX_DEG = 0.1667

_Degrees = Annotated[float, Field(allow_inf_nan=False, gt=-80.0, lt=80.0)]
#: Entrance angles V and H.
Entrance = Annotated[tuple[_Degrees, _Degrees], Field(strict=False)]
Observation = Annotated[float, Field(allow_inf_nan=False, ge=0.0, le=10.0)]
ReflexAperture = Annotated[float, Field(allow_inf_nan=False, ge=0.01, le=1.0)]


class LampFunction(Table):
    """What the lamp does when some of its light groups are lit: stop, position, indicator."""

    name: Name = Field(description="such as stop")
    rule: Annotated[str, Field(max_length=300)] | None = Field(
        default=None, description="what it has to meet: RULES/ENTRY, such as un-r148/S1"
    )
    light: dict[GroupName, Amount] = Field(
        default_factory=dict[str, float],
        description="weight of each light group that is lit; left out: all, 1 each",
    )
    sections: Annotated[int, Field(ge=1, le=3)] = Field(
        default=1, description="lighted sections that the function has"
    )
    assembly: Literal["single", "D"] = Field(
        default="single",
        description='"D": two independent lamps that give the function together (UN R148)',
    )
    side: Literal["left", "right"] | None = Field(
        default=None, description="side of the car, for fields that differ inward and outward"
    )
    with_position: Name | None = Field(
        default=None, description="name of the position lamp's function, for ratios to it"
    )


class Reflector(Table):
    """A retro-reflector, lit by illuminant A from each entrance direction; all else is dark."""

    name: Name = Field(description="such as reflector")
    rule: Annotated[str, Field(max_length=300)] | None = Field(
        default=None, description="what it has to meet: RULES/ENTRY, such as un-r150/IA"
    )
    entrance_deg: Annotated[tuple[Entrance, ...], Field(strict=False, max_length=1000)] = Field(
        default=((0.0, 0.0),),
        description="V and H of the light, where no rule says so",
    )
    observation_deg: Annotated[
        tuple[Observation, ...], Field(strict=False, min_length=1, max_length=100)
    ] = Field(
        default=(0.3333, 1.5),
        description="angles of the receiver above the light, where no rule says so",
    )
    source_deg: ReflexAperture = Field(
        default=REFLEX_DEG, description="full angle that the source subtends"
    )
    receiver_deg: ReflexAperture = Field(
        default=REFLEX_DEG, description="full angle that the receiver subtends"
    )


class MeasureSettings(Table):
    """How the lamp is measured: directions (H, V) are those of CONVENTIONS.md about its axis."""

    axis: Direction = Field(description="the lamp's reference axis, towards the observer")
    up: Direction = Field(default=(0.0, 1.0, 0.0), description="the side of V > 0")
    centre_mm: Point | None = Field(
        default=None,
        description="reference centre; left out: the middle of the box round all objects",
    )
    distance_m: Positive | None = Field(
        default=None, description="from the centre to the receiver; left out: the far field"
    )
    receiver_deg: Annotated[
        float, Field(allow_inf_nan=False, ge=SMALLEST_RECEIVER_DEG - 1e-4, le=LARGEST_RECEIVER_DEG)
    ] = Field(default=0.5, description="full angle that the receiver subtends")
    leave_out: Annotated[tuple[Name, ...], Field(strict=False, max_length=1000)] = Field(
        default=(), description="objects of the picture that are not in the laboratory"
    )
    functions: Annotated[tuple[LampFunction, ...], Field(strict=False, max_length=100)] = Field(
        default=(),
        description="what the lamp does; left out: all light together, unless it has reflectors",
    )
    reflectors: Annotated[tuple[Reflector, ...], Field(strict=False, max_length=100)] = Field(
        default=(), description="retro-reflectors, measured in light from outside"
    )

    @model_validator(mode="after")
    def _has_a_frame(self) -> MeasureSettings:
        axis, up = (np.divide(way, np.linalg.norm(way)) for way in (self.axis, self.up))
        if float(np.linalg.norm(np.cross(axis, up))) < 1e-6:
            raise PydanticCustomError(
                "up_along_axis", "up is parallel to axis; choose another up, such as [0, 1, 0]"
            )
        return self


def check_measuring(scene: Scene) -> None:
    """Check the names that [measure] uses.

    Raises:
        SceneError: A name is unknown, or given twice.
    """
    from lamplit.scene.shining import light_groups

    settings = scene.measure
    if settings is None:
        return
    objects = {thing.name for thing in scene.objects}
    for at, name in enumerate(settings.leave_out):
        _known("object", name, objects, f"measure.leave_out[{at}]")
    functions = [function.name for function in settings.functions]
    names = [*functions, *(reflector.name for reflector in settings.reflectors)]
    for at, reflector in enumerate(settings.reflectors):
        if reflector.name in names[: len(functions) + at]:
            raise SceneError(
                f"another one is called {reflector.name!r} too; choose another name",
                where=f"measure.reflectors[{at}].name",
            )
    groups = set(light_groups(scene))
    for at, function in enumerate(settings.functions):
        where = f"measure.functions[{at}]"
        if function.name in functions[:at]:
            first = functions.index(function.name)
            raise SceneError(
                f"functions[{first}] is called {function.name!r} too; choose another name",
                where=f"{where}.name",
            )
        for group in function.light:
            _known("light group", group, groups, f"{where}.light")
        if function.light and not any(function.light.values()):
            raise SceneError(
                "every weight is 0, so the function has no light; give one above 0",
                where=f"{where}.light",
            )
        if function.with_position is not None:
            others = {*functions} - {function.name}
            _known("other function", function.with_position, others, f"{where}.with_position")


def _known(what: str, name: str, names: set[str], where: str) -> None:
    if name not in names:
        raise SceneError(f"no {what} is called {name!r}{nearest_name(name, names)}", where=where)

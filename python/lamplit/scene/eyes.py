# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Eye points: the places that a lamp is looked at from, one after the other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, TypeAdapter, ValidationError

from lamplit.errors import SceneError
from lamplit.scene.camera import Camera
from lamplit.scene.fields import Point, Table, Vector

if TYPE_CHECKING:
    from lamplit.scene.models import Scene

#: The fewest frames of a sweep, and the most of any list.
FEWEST_FRAMES, MOST_FRAMES = 2, 999
#: The angle of a sweep unless another is asked for: 45° to either side of the scene's camera.
USUAL_SWEEP_DEG = 90.0
FULL_CIRCLE_DEG = 360.0

_CAMERAS: TypeAdapter[Camera] = TypeAdapter(Camera)


class Eye(Table):
    """A place that the scene is seen from; all but the place is as ``[camera]`` says."""

    position_mm: Point = Field(description="where the eye is")
    target_mm: Point | None = Field(
        default=None,
        description="the point in the middle of the picture; left out: as [camera] says",
    )


def turntable_eyes(camera: Camera, frames: int, sweep_deg: float = USUAL_SWEEP_DEG) -> list[Eye]:
    """Return ``frames`` places round the camera's target, on a circle about its ``up``.

    The eye moves to its right by equal angles. A sweep has the camera's own place in its middle
    and both ends in the list; a full circle begins there and ends one step before it.

    Raises:
        SceneError: There are too few or too many frames, the angle is none, or the camera looks
            along its own ``up``.
    """
    if not FEWEST_FRAMES <= frames <= MOST_FRAMES:
        raise SceneError(
            f"a turntable has {FEWEST_FRAMES} to {MOST_FRAMES} frames, not {frames}",
            where="turntable",
        )
    if not (math.isfinite(sweep_deg) and 0.0 < sweep_deg <= FULL_CIRCLE_DEG):
        raise SceneError(
            f"a sweep is an angle above 0° and at most 360°, not {sweep_deg:g}°", where="sweep"
        )
    if sweep_deg == FULL_CIRCLE_DEG:
        angles = np.arange(frames) * (FULL_CIRCLE_DEG / frames)
    else:
        angles = np.linspace(-0.5 * sweep_deg, 0.5 * sweep_deg, frames)
    target = np.array(camera.target_mm)
    axis = np.divide(camera.up, np.linalg.norm(camera.up))
    arm = np.subtract(camera.position_mm, target)
    places = [target + _turned(arm, axis, float(angle)) for angle in angles]
    return [
        Eye(position_mm=(float(x), float(y), float(z)) if angle else camera.position_mm)
        for (x, y, z), angle in zip(places, angles, strict=True)
    ]


def _turned(arm: NDArray[np.float64], axis: NDArray[np.float64], deg: float) -> NDArray[np.float64]:
    """Return ``arm`` turned about the unit vector ``axis``, right-handed (Rodrigues)."""
    along = axis * float(axis @ arm)
    cosine, sine = math.cos(math.radians(deg)), math.sin(math.radians(deg))
    return along + (arm - along) * cosine + np.cross(axis, arm) * sine


def eye_at(place: Vector, *, where: str) -> Eye:
    """Return the eye at ``place`` in mm; ``where`` names it in messages.

    Raises:
        SceneError: The place is not three finite numbers.
    """
    try:
        return Eye.model_validate({"position_mm": tuple(float(part) for part in place)})
    except (TypeError, ValueError) as fault:
        raise SceneError("an eye point is three numbers in mm: x, y and z", where=where) from fault


def seen_from(scene: Scene, eyes: Sequence[Eye], *, where: str = "eyes") -> list[Scene]:
    """Return ``scene`` as each of ``eyes`` sees it, by its own camera moved there.

    ``where`` names the list in messages.

    Raises:
        SceneError: The list is empty or too long, or an eye looks nowhere.
    """
    if not 0 < len(eyes) <= MOST_FRAMES:
        raise SceneError(
            f"1 to {MOST_FRAMES} eye points are expected, not {len(eyes)}",
            file=scene.path,
            where=where,
        )
    views: list[Scene] = []
    for at, eye in enumerate(eyes):
        moved = scene.camera.model_dump() | {"position_mm": eye.position_mm}
        if eye.target_mm is not None:
            moved["target_mm"] = eye.target_mm
        try:
            camera = _CAMERAS.validate_python(moved)
        except ValidationError as fault:
            reason = fault.errors()[0]["msg"]
            raise SceneError(reason, file=scene.path, where=f"{where}[{at}]") from fault
        views.append(scene.changed(camera=camera))
    return views


def check_eyes(scene: Scene) -> None:
    """Check that every eye of the scene's ``[[eyes]]`` looks somewhere.

    Raises:
        SceneError: One does not.
    """
    if scene.eyes:
        seen_from(scene, scene.eyes)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Does the camera see anything?"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import LamplitError, SceneError
from lamplit.scene.camera import OrthographicCamera, ThinLensCamera
from lamplit.scene.models import Scene
from lamplit.scene.solids import Body, bodies

Array = NDArray[np.float64]


def view_fault(scene: Scene) -> LamplitError | None:
    """Return an error if no ray of the picture can meet an object, or an opaque body is in the way.

    An object counts as seen when its bounding box is not wholly beside or behind the picture, so a
    camera that does see something is never refused.
    """
    return _fault_among(bodies(scene), scene)


def views_fault(views: Sequence[Scene], *, where: str) -> SceneError | None:
    """Return what is wrong with the first of ``views`` of one scene that cannot be seen.

    ``where`` names the list that the views come from.
    """
    everything = bodies(views[0])
    for at, view in enumerate(views):
        if (fault := _fault_among(everything, view)) is not None:
            place = ", ".join(f"{round(part, 6):.4g}" for part in view.camera.position_mm)
            return SceneError(
                f"from ({place}) mm, {fault.message}", file=view.path, where=f"{where}[{at}]"
            )
    return None


def _fault_among(everything: Sequence[Body], scene: Scene) -> LamplitError | None:
    camera = scene.camera
    eye = np.array(camera.position_mm)
    for body in everything:
        if not body.thing.transparent and body.contains(eye):
            return SceneError(
                f"the camera is inside {body.thing.name!r}, which is opaque: move position_mm out",
                file=scene.path,
                where="camera.position_mm",
            )
    if any(_may_be_seen(scene, body) for body in everything):
        return None
    key = "height_mm" if isinstance(camera, OrthographicCamera) else "field_of_view_deg"
    return SceneError(
        f"the camera sees none of the scene's objects: check position_mm, target_mm and {key}",
        file=scene.path,
        where="camera",
    )


def camera_axes(scene: Scene) -> tuple[Array, Array, Array]:
    """Return unit vectors to the right, up and forward in the picture."""
    camera = scene.camera
    forward = np.subtract(camera.target_mm, camera.position_mm)
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    return right, np.cross(right, forward), forward


def _may_be_seen(scene: Scene, body: Body) -> bool:
    camera, image = scene.camera, scene.image
    right, up, forward = camera_axes(scene)
    aspect = image.width / image.height
    eye = np.array(camera.position_mm)
    if body.plane is not None:
        return _plane_may_be_seen(scene, *body.plane)
    low, high = body.bounds
    corners = np.array([[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]) - eye
    x, y, z = corners @ right, corners @ up, corners @ forward
    if isinstance(camera, OrthographicCamera):
        height = np.full(8, camera.height_mm / 2.0)
    else:
        height = np.tan(np.radians(camera.field_of_view_deg) / 2.0) * z
    width = height * aspect
    if isinstance(camera, ThinLensCamera):
        # A ray from the lens's rim r is r·|1 − z/f| beside the pinhole's: at most r·(1 + z/f).
        spread = camera.aperture_mm / 2.0 * (1.0 + z / camera.focus_distance_mm)
        height, width = height + spread, width + spread
    beyond = (x > width, x < -width, y > height, y < -height, z <= 0.0)
    return not any(bool(side.all()) for side in beyond)


def _plane_may_be_seen(scene: Scene, point: Array, normal: Array) -> bool:
    camera, image = scene.camera, scene.image
    right, up, forward = camera_axes(scene)
    height = float(np.dot(np.subtract(camera.position_mm, point), normal))
    if isinstance(camera, OrthographicCamera):
        return float(np.dot(forward, normal)) * height < 0.0 or height == 0.0
    half = np.tan(np.radians(camera.field_of_view_deg) / 2.0)
    ways = [
        forward + half * (i * right * image.width / image.height + j * up)
        for i in (-1, 1)
        for j in (-1, 1)
    ]
    if isinstance(camera, ThinLensCamera):
        # Lens and plane may cross; else a ray through the rim is that much steeper.
        radius, focus = camera.aperture_mm / 2.0, camera.focus_distance_mm
        across = np.hypot(float(np.dot(right, normal)), float(np.dot(up, normal)))
        if radius * across >= abs(height):
            return True
        steeper = -np.sign(height) * normal * radius * across / focus
        ways = [way + steeper for way in ways]
    return any(float(np.dot(way, normal)) * height < 0.0 for way in ways)

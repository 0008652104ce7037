# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The lit lamp of the candela bench, and a goniometer's receiver as a sensor of Mitsuba."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from comparison_scenes import picture, without_dispersion
from numpy.typing import NDArray

import lamplit as ll
from lamplit.engine.measure import in_laboratory
from lamplit.engine.receivers import Goniometer
from lamplit.lamps import write_lamp
from lamplit.scene.objects import Box, Disc

Array = NDArray[np.float64]

_M2_PER_MM2 = 1e-6
#: How far from the lamp's middle a sensor's rays begin, in mm: beyond all of the lamp.
_CLEAR_MM = 300.0
#: Pixels along the longer side of a sensor's picture: they spread its samples evenly.
_PIXELS = 64
#: The picture that shows the lamp from a receiver is larger than it by this share.
_MARGIN = 0.002


def lit_lamp(name: str, folder: Path, *, triangles: int, distance_m: float) -> ll.Scene:
    """Return an example lamp with its light on, as both programs can walk it.

    Flat triangles, for smooth normals of coarse meshes are not reciprocal; one index for all
    wavelengths; a dark room; each flat source by its luminance, Φ/(π A) of Lambert's law.
    """
    settings: dict[str, Any] = {"triangles": triangles, "lit": True, "cover_colour": "red"}
    path = write_lamp(name, folder / f"{name}-lit-{triangles}", settings)
    scene = in_laboratory(without_dispersion(ll.load_scene(path)))
    assert scene.measure is not None
    return picture(
        scene.changed(
            objects=tuple(_plain(thing) for thing in scene.objects),
            measure=scene.measure.model_copy(update={"distance_m": distance_m, "functions": ()}),
        )
    )


def _plain(thing: Any) -> Any:
    if thing.kind == "mesh":
        return thing.model_copy(update={"smooth": False})
    if thing.emission is None:
        return thing
    area_m2 = np.pi * thing.radius_mm**2 * _M2_PER_MM2
    luminance = thing.emission.flux_lm / (np.pi * area_m2)
    own = thing.emission.model_copy(update={"flux_lm": None, "luminance_cd_m2": luminance})
    return thing.model_copy(update={"emission": own})


def corners_mm(scene: ll.Scene) -> Array:
    """Return points (n, 3) whose projections bound that of the lamp.

    Raises:
        ValueError: An object is no mesh, box or disc.
    """
    points: list[Array] = []
    for thing in scene.resolved_objects():
        shape = thing.shape
        if thing.mesh is not None:
            own = thing.mesh.vertices_mm
        elif isinstance(shape, Box):
            ends = np.array([shape.min_mm, shape.max_mm])
            own = np.array([[ends[i >> a & 1, a] for a in range(3)] for i in range(8)])
        elif isinstance(shape, Disc):
            reach = shape.radius_mm * np.vstack([np.eye(3), -np.eye(3)])
            own = np.add(shape.centre_mm, reach)
        else:
            raise ValueError(f"{thing.name!r}: a {shape.kind} has no corners here")
        points.append(own @ thing.transform[:3, :3].T + thing.transform[:3, 3])
    return np.concatenate(points)


def receiver(gonio: Goniometer, direction: Array, corners: Array) -> tuple[dict[str, Any], float]:
    """Return a sensor that reads what the receiver along ``direction`` does, and its factor.

    A thin lens as large as the receiver, sharp at the lamp's middle, draws a point of the receiver
    and one of a rectangle that holds the lamp: the mean luminance times that rectangle's area in m²
    is the intensity in cd, but for (size/distance)². An orthographic sensor, which this becomes at
    an infinite distance, would read the middle of the receiver alone.

    Raises:
        ValueError: The receiver is infinitely far.
    """
    if gonio.distance_m is None:
        raise ValueError("give the receiver a distance")
    distance = 1e3 * gonio.distance_m
    centre = np.asarray(gonio.centre_mm)
    eye = centre + direction * distance
    radius = distance * np.sin(np.radians(gonio.receiver_deg) / 2.0)
    forward, low, high = -direction, np.zeros(2), np.zeros(2)
    frame: Array = np.eye(4)
    # Turned once to the middle of what it sees, by some milliradians.
    for _ in range(2):
        left = np.cross(gonio.up, forward)
        left /= np.linalg.norm(left)
        up = np.cross(forward, left)
        rays = corners - eye
        scale = distance / (rays @ forward)
        # A point off the plane of sharpness is seen from all of the lens, and shifts by so much.
        blur = radius * np.abs(scale - 1.0)
        x, y = rays @ left * scale, rays @ up * scale
        low = np.array([(x - blur).min(), (y - blur).min()])
        high = np.array([(x + blur).max(), (y + blur).max()])
        middle = 0.5 * (low + high)
        frame[:3] = np.stack([left, up, forward, eye], axis=1)
        ahead = forward * distance + left * middle[0] + up * middle[1]
        forward = ahead / np.linalg.norm(ahead)
    size = (high - low) * (1.0 + _MARGIN)
    columns = _PIXELS
    rows = int(np.ceil(columns * size[1] / size[0]))
    node: dict[str, Any] = {
        "type": "thinlens",
        "aperture_radius": float(radius),
        "focus_distance": float(distance),
        "fov": float(np.degrees(2.0 * np.arctan(0.5 * size[0] / distance))),
        "fov_axis": "x",
        "near_clip": float(distance - _CLEAR_MM),
        "far_clip": float(distance + _CLEAR_MM),
        "to_world": {"matrix": frame.tolist()},
        "film": {
            "type": "hdrfilm",
            "pixel_format": "xyz",
            "component_format": "float32",
            "width": columns,
            "height": rows,
            "rfilter": {"type": "box"},
        },
        "sampler": {"type": "independent"},
    }
    return node, float(size[0] ** 2 * rows / columns * _M2_PER_MM2)

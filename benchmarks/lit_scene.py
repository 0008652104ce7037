# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The four lit lamps of the bench: a filament or dies behind optics, in the dark, seen aslant.

L1  P21W in a glass bulb, paraboloid of rough aluminium (GGX 0.05), clear lens with pillows
L2  the same with a mirror-smooth paraboloid
L3  twelve dies of 1 mm over a matt white floor, behind a clear cover with pillows
L4  as L3, the cover rough (GGX 0.3)

L1-axis is L1 seen from straight ahead.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from candela_scene import corners_mm
from comparison_scenes import picture, without_dispersion
from numpy.typing import NDArray

import lamplit as ll
from lamplit.engine.measure import in_laboratory
from lamplit.lamps import write_lamp
from lamplit.scene import ResolvedObject
from lamplit.scene.objects import Disc

_BULB = {"lens_colour": "clear", "lit": True}
#: Pillows so weak that no die hides in the jump between two of them.
_PILLOWS = {"cover_optics": "pillows", "pillow_radius_mm": 60.0}
_DIES = {"cover_colour": "clear", "optics": "none", "lit": True, **_PILLOWS}
#: Of each lamp of the bench: the example lamp, and its parameters.
LAMPS: dict[str, tuple[str, dict[str, Any]]] = {
    "L1": ("p21w", {**_BULB, "reflector_roughness": 0.05}),
    "L2": ("p21w", _BULB),
    "L3": ("led-array", _DIES),
    "L4": ("led-array", {**_DIES, "cover_roughness": 0.3}),
}
LAMPS["L1-axis"] = LAMPS["L1"]
#: The camera stands so far off the lamp's axis, in a plane turned from the horizontal one.
_OFF_AXIS_DEG, _TURNED_DEG = {"L1-axis": 0.0}, 27.0
_USUAL_OFF_AXIS_DEG = 17.6
#: Width and height of the picture.
WIDTH, HEIGHT = 400, 200
_DISTANCE_MM = 600.0
#: The lamp leaves this share of the picture free.
_MARGIN = 0.04
_M2_PER_MM2 = 1e-6


def lit_scene(name: str, folder: Path, *, triangles: int) -> ll.Scene:
    """Return one of `LAMPS` as both programs can walk it, filling the picture.

    Flat triangles, since smooth normals of coarse meshes are not reciprocal; one index for all
    wavelengths; a dark room; each source by its luminance, Φ/(π A) of Lambert's law.
    """
    lamp, settings = LAMPS[name]
    path = write_lamp(lamp, folder / f"{name}-{triangles}", {**settings, "triangles": triangles})
    scene = in_laboratory(without_dispersion(ll.load_scene(path)))
    areas = {
        thing.name: _area_mm2(thing)
        for thing in scene.resolved_objects()
        if thing.emission is not None
    }
    scene = scene.changed(
        objects=tuple(_plain(thing, areas.get(thing.name)) for thing in scene.objects)
    )
    off_axis_deg = _OFF_AXIS_DEG.get(name, _USUAL_OFF_AXIS_DEG)
    return picture(_seen(scene, off_axis_deg), width=WIDTH, height=HEIGHT)


def _plain(thing: Any, area_mm2: float | None) -> Any:
    changes: dict[str, Any] = {"smooth": False} if thing.kind == "mesh" else {}
    if area_mm2 is not None:
        luminance = thing.emission.flux_lm / (np.pi * area_mm2 * _M2_PER_MM2)
        own = {"flux_lm": None, "luminance_cd_m2": luminance}
        changes["emission"] = thing.emission.model_copy(update=own)
    return thing.model_copy(update=changes)


def _area_mm2(thing: ResolvedObject) -> float:
    if isinstance(thing.shape, Disc):
        return np.pi * thing.shape.radius_mm**2
    if thing.mesh is None:
        raise ValueError(f"{thing.name!r}: a {thing.shape.kind} is no source here")
    a, b, c = np.moveaxis(thing.mesh.vertices_mm[thing.mesh.triangles], 1, 0)
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def _seen(scene: ll.Scene, off_axis_deg: float) -> ll.Scene:
    """Return ``scene`` with a camera that sees all of the lamp, as large as it can be."""
    corners = corners_mm(scene)
    target = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
    off, turned = np.radians(off_axis_deg), np.radians(_TURNED_DEG)
    aside = np.array([np.cos(turned), np.sin(turned), 0.0]) * np.sin(off)
    back = aside + np.array([0.0, 0.0, np.cos(off)])
    eye = target + _DISTANCE_MM * back
    right = np.cross((0.0, 1.0, 0.0), back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    slope = _largest_slope(corners - eye, right, up, -back)
    view = float(np.degrees(2.0 * np.arctan(slope * (1.0 + _MARGIN))))
    camera = scene.camera.model_copy(
        update={
            "position_mm": tuple(eye.tolist()),
            "target_mm": tuple(target.tolist()),
            "up": (0.0, 1.0, 0.0),
            "field_of_view_deg": view,
        }
    )
    return scene.changed(camera=camera)


def _largest_slope(
    rays: NDArray[np.float64],
    right: NDArray[np.float64],
    up: NDArray[np.float64],
    ahead: NDArray[np.float64],
) -> float:
    """Return the tangent of half the vertical angle of view that holds all ``rays`` (n, 3)."""
    depth = rays @ ahead
    across, along = np.abs(rays @ right / depth).max(), np.abs(rays @ up / depth).max()
    return float(max(along, across * HEIGHT / WIDTH))

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Lamps as both programs can show them: constant indices, an even surround, hard soft boxes."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

from pydantic import TypeAdapter

import lamplit as ll
from lamplit.lamps import write_lamp
from lamplit.materials import Dielectric, Glossy, Material
from lamplit.materials.index_spec import IndexSpec
from lamplit.materials.optics import LINE_D_NM
from lamplit.scene.lighting import Background

Light = Literal["surround", "studio"]

#: Luminance of the even surround in cd/m², alone and behind the soft boxes.
SURROUND_CD_M2 = 600.0
STUDIO_BASE_CD_M2 = 90.0

#: Angle of view that lets each lamp fill the picture's height.
_VIEW_DEG = {"p21w": 9.6, "led-array": 8.6}

#: Soft boxes of the lamps' own scenes, with hard edges: luminance, centre and size.
_SOFT_BOXES = (
    (900.0, (0.0, 350.0, 1500.0), (4000.0, 2100.0)),
    (6500.0, (-420.0, 235.0, 1000.0), (760.0, 130.0)),
    (5000.0, (-100.0, 1000.0, 600.0), (900.0, 300.0)),
    (5000.0, (-900.0, 100.0, 450.0), (160.0, 900.0)),
)


def background(light: Light) -> Background:
    """Return the light of D65 all around: even, or dimmer with the studio's soft boxes."""
    table: dict[str, Any] = {
        "kind": "constant",
        "source": "D65",
        "luminance_cd_m2": SURROUND_CD_M2,
    }
    if light == "studio":
        boxes = [
            {
                "source": "D65",
                "luminance_cd_m2": luminance,
                "centre_mm": centre,
                "width_mm": size[0],
                "height_mm": size[1],
            }
            for luminance, centre, size in _SOFT_BOXES
        ]
        table = {
            "kind": "studio",
            "source": "D65",
            "luminance_cd_m2": STUDIO_BASE_CD_M2,
            "soft_boxes": boxes,
        }
    return TypeAdapter[Background](Background).validate_python(table)


def without_dispersion(scene: ll.Scene) -> ll.Scene:
    """Return ``scene`` with every clear material's n_d at all wavelengths."""
    materials: dict[str, Any] = dict(scene.materials)
    for thing in scene.objects:
        materials[thing.material] = _constant(scene.resolve_material(thing.material))
    return scene.changed(materials=materials)


def _constant(material: Material) -> Material:
    if not isinstance(material, (Dielectric, Glossy)):
        return material
    index = round(float(material.index([LINE_D_NM])[0]), 5)
    constant = TypeAdapter[Any](IndexSpec).validate_python(index)
    return material.model_copy(update={"refractive_index": constant})


def picture(scene: ll.Scene, **values: Any) -> ll.Scene:
    """Return ``scene`` with the settings of its picture changed, filtered with a box."""
    changed = {"filter": "box", "sampling": "sobol", **values}
    return scene.changed(image=scene.image.model_copy(update=changed))


def unlit_lamp(
    name: str, folder: Path, *, triangles: int, light: Light, width: int = 400, height: int = 200
) -> ll.Scene:
    """Return an example lamp of about so many triangles, lit by its background alone."""
    path = write_lamp(name, folder / f"{name}-{triangles}", {"triangles": triangles})
    scene = without_dispersion(ll.load_scene(path))
    scene = scene.changed(
        background=background(light),
        lights=(),
        ambient=None,
        camera=scene.camera.model_copy(update={"field_of_view_deg": _VIEW_DEG[name]}),
    )
    return picture(scene, width=width, height=height)

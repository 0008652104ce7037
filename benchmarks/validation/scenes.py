# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Small scenes, each for one part of the physics, that both programs can show."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from comparison_scenes import Light, background, picture, unlit_lamp, without_dispersion

import lamplit as ll
from lamplit.lamps import write_lamp
from lamplit.scene.load import parse_scene

Table = dict[str, Any]

#: A red filter: half the light at 600 nm goes through 10 mm.
_RED = {"dye": {"lambda50_nm": 600.0, "width_nm": 15.0, "thickness_mm": 10.0}}
_GLASS = 1.5
#: Aluminium at seven wavelengths; A. D. Rakić, Appl. Opt. 34, 4755 (1995), rounded.
_ALUMINIUM = {
    "wavelengths_nm": [350, 400, 450, 500, 550, 650, 800],
    "n": [0.37, 0.49, 0.62, 0.77, 0.96, 1.49, 2.77],
    "k": [4.24, 4.86, 5.48, 6.08, 6.69, 7.82, 8.35],
}
_PAINT = {
    "kind": "diffuse",
    "reflectance": {"wavelengths_nm": [360, 500, 560, 850], "values": [0.15, 0.2, 0.75, 0.85]},
}


def on_table(material: Table, shape: Table) -> ll.Scene:
    """Return one body, about 20 mm large, over a grey floor.

    It stands in the studio's light; if it is rough, in an even surround: what a model loses of the
    light is then a share of what the eye sees everywhere.
    """
    light: Light = "surround" if "roughness" in material else "studio"
    return _scene(
        {"body": material, "floor": {"kind": "diffuse", "reflectance": 0.5}},
        [
            {"name": "body", "material": "body", **shape},
            {
                "name": "floor",
                "kind": "disc",
                "material": "floor",
                "centre_mm": [0.0, -14.0, 0.0],
                "normal": [0.0, 1.0, 0.0],
                "radius_mm": 60.0,
            },
        ],
        size=(96, 64),
        background=background(light).model_dump(exclude_unset=True),
    )


def sphere(material: Table) -> ll.Scene:
    """Return a sphere of ``material`` over the floor."""
    return on_table(material, {"kind": "sphere", "centre_mm": [0.0] * 3, "radius_mm": 10.0})


def slab(material: Table) -> ll.Scene:
    """Return a slab of ``material``, 4 mm thick and tilted, over the floor."""
    shape = {"kind": "box", "min_mm": [-12.0, -9.0, -2.0], "max_mm": [12.0, 9.0, 2.0]}
    return on_table(material, {**shape, "transform": {"rotate_deg": [-20.0, 35.0, 0.0]}})


def glass(*, roughness: float = 0.0, absorbing: bool = False) -> Table:
    """Return glass of constant index."""
    return {
        "kind": "dielectric",
        "refractive_index": _GLASS,
        **({"roughness": roughness} if roughness else {}),
        **({"internal_transmittance": _RED} if absorbing else {}),
    }


def opal(anisotropy: float) -> Table:
    """Return scattering and absorbing glass, one mean free path in about 4 mm."""
    scattering = {
        "coefficient_per_mm": {"wavelengths_nm": [360, 850], "values": [0.3, 0.2]},
        "anisotropy": anisotropy,
    }
    return {**glass(absorbing=True), "scattering": scattering}


def metal(roughness: float = 0.0) -> Table:
    """Return aluminium."""
    rough = {"roughness": roughness} if roughness else {}
    return {"kind": "conductor", "refractive_index": _ALUMINIUM, **rough}


def paint() -> Table:
    """Return orange matt paint."""
    return dict(_PAINT)


def plastic() -> Table:
    """Return the same paint under a clear coat."""
    return {**_PAINT, "kind": "glossy", "refractive_index": 1.49}


def lit_box() -> ll.Scene:
    """Return a room of matt walls, lit by a disc under its ceiling, with two bodies in it."""
    white = {"kind": "diffuse", "reflectance": 0.7}
    lamp = {"kind": "diffuse", "reflectance": 0.1}
    half, wall = 50.0, 1.0
    walls: list[Table] = []
    for axis, name in enumerate("xyz"):
        for side in (-1.0, 1.0):
            if (axis, side) == (2, 1.0):
                continue  # open to the camera
            low, high = [-half] * 3, [half] * 3
            low[axis], high[axis] = sorted((side * half, side * (half + wall)))
            material = "orange" if (axis, side) == (0, -1.0) else "white"
            walls.append(
                {
                    "name": f"wall {name}{side:+.0f}",
                    "kind": "box",
                    "material": material,
                    "min_mm": low,
                    "max_mm": high,
                }
            )
    bodies: list[Table] = [
        {
            "name": "lamp",
            "kind": "disc",
            "material": "lamp",
            "centre_mm": [10.0, 48.0, 0.0],
            "normal": [0.0, -1.0, 0.0],
            "radius_mm": 15.0,
            "emission": {"source": "A", "luminance_cd_m2": 5000.0},
        },
        {
            "name": "ball",
            "kind": "sphere",
            "material": "gloss",
            "centre_mm": [20.0, -32.0, 5.0],
            "radius_mm": 16.0,
        },
        {
            "name": "block",
            "kind": "box",
            "material": "white",
            "min_mm": [-35.0, -49.5, -30.0],
            "max_mm": [-5.0, 5.0, 0.0],
            "transform": {"rotate_deg": [0.0, 20.0, 0.0]},
        },
    ]
    materials = {"white": white, "orange": paint(), "lamp": lamp, "gloss": plastic()}
    camera = {"position_mm": [0.0, 0.0, 200.0], "field_of_view_deg": 38.0}
    return _scene(materials, [*walls, *bodies], size=(64, 64), camera=camera)


def lit_bulb(folder: Path) -> ll.Scene:
    """Return the glass bulb of `p21w` with a glowing ball in it, over a grey floor."""
    lamp = without_dispersion(
        ll.load_scene(write_lamp("p21w", folder / "bulb", {"triangles": 20_000}))
    )
    envelope = next(thing for thing in lamp.objects if thing.name == "envelope")
    scene = _scene(
        {"glow": {"kind": "diffuse", "reflectance": 0.3}, "floor": paint()},
        [
            {
                "name": "glow",
                "kind": "sphere",
                "material": "glow",
                "centre_mm": [0.0] * 3,
                "radius_mm": 5.0,
                "emission": {"source": "A", "luminance_cd_m2": 3000.0},
            },
            {
                "name": "floor",
                "kind": "disc",
                "material": "floor",
                "centre_mm": [0.0, -16.0, 0.0],
                "normal": [0.0, 1.0, 0.0],
                "radius_mm": 40.0,
            },
        ],
        size=(64, 48),
        camera={"position_mm": [60.0, 40.0, 110.0], "field_of_view_deg": 24.0},
        root=lamp.root,
    )
    glass_only = {envelope.material: lamp.materials[envelope.material]}
    return scene.changed(
        objects=(*scene.objects, envelope), materials={**scene.materials, **glass_only}
    )


def small_lamp(name: str, folder: Path) -> ll.Scene:
    """Return an example lamp of 20 000 flat triangles in the studio's light.

    Flat, because at a silhouette the smooth normals of a faceted body point away from the eye, and
    what to do then is a choice, not physics.
    """
    scene = unlit_lamp(name, folder, triangles=20_000, light="studio", width=96, height=48)
    flat = [
        thing.model_copy(update={"smooth": False}) if thing.kind == "mesh" else thing
        for thing in scene.objects
    ]
    return scene.changed(objects=tuple(flat))


def _scene(
    materials: Table,
    objects: list[Table],
    *,
    size: tuple[int, int],
    root: Path = Path(),
    camera: Table | None = None,
    **tables: Any,
) -> ll.Scene:
    view = {"position_mm": [15.0, 22.0, 90.0], "field_of_view_deg": 22.0, **(camera or {})}
    written = {
        "lamplit": 1,
        "camera": {"kind": "pinhole", "target_mm": [0.0] * 3, **view},
        "materials": materials,
        "objects": objects,
        **tables,
    }
    return picture(parse_scene(written, root=root), width=size[0], height=size[1])

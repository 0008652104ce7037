# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A rear lamp module for a P21W bulb: housing, paraboloid, bulb, bezel and a red pillow lens.

The filament lies in the origin, which is the paraboloid's focus; +z points at the observer.
Neighbouring parts keep at least 0.2 mm apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from pydantic import Field, model_validator

from lamplit.lamps import studio
from lamplit.lamps.bulb import CAP_RADIUS_MM, Bulb
from lamplit.lamps.cover import Cover, dome_sag, pillow_cover
from lamplit.lamps.outlines import Superellipse
from lamplit.lamps.patterns import check_pillow, pillow_depth
from lamplit.lamps.recipe import (
    Lamp,
    LampParameters,
    LensColour,
    Roughness,
    Table,
    Triangles,
    lens_material,
    library_material,
    mesh_object,
)
from lamplit.lamps.shells import Housing, Paraboloid, bezel
from lamplit.lamps.solids import Solid

#: Shares of the triangles that each part is given.
_SHARES = {
    "lens": 0.42,
    "reflector": 0.18,
    "envelope": 0.16,
    "housing": 0.08,
    "bezel": 0.06,
    "filament": 0.04,
    "cap": 0.02,
    "stem": 0.02,
    "supports": 0.02,
}
_BEZEL_OFFSETS_MM = (-0.5, 6.3)
#: Reference flux of a P21W at 13.5 V (UN R37, category P21W).
_FLUX_LM = 460.0


class Parameters(LampParameters):
    """The parameters of the lamp ``p21w``."""

    width_mm: Annotated[float, Field(ge=90.0, le=240.0, description="width of the lens")] = 112.0
    height_mm: Annotated[float, Field(ge=70.0, le=240.0, description="height of the lens")] = 92.0
    squareness: Annotated[
        float,
        Field(ge=2.0, le=8.0, description="superellipse exponent: 2 is round, 8 nearly square"),
    ] = 3.0
    focal_length_mm: Annotated[
        float, Field(ge=17.0, le=40.0, description="focal length of the reflector")
    ] = 20.0
    reflector_roughness: Annotated[
        Roughness,
        Field(description="GGX width of the aluminised reflector: 0 smooth, or 0.001 to 1"),
    ] = 0.0
    lens_colour: Annotated[LensColour, Field(description="PMMA of the lens")] = "red"
    lens_thickness_mm: Annotated[
        float, Field(ge=1.5, le=5.0, description="wall of the lens, without the pillows")
    ] = 2.8
    lens_dome_radius_mm: Annotated[
        float, Field(ge=150.0, le=5000.0, description="radius of the lens's front")
    ] = 230.0
    pillow_pitch_mm: Annotated[
        float, Field(ge=2.0, le=20.0, description="side of one square pillow")
    ] = 6.0
    pillow_radius_mm: Annotated[
        float, Field(ge=2.0, le=500.0, description="radius of curvature of the pillows")
    ] = 26.0
    bulb_diameter_mm: Annotated[
        float, Field(ge=20.0, le=26.5, description="width of the glass envelope")
    ] = 25.0
    bulb_glass_mm: Annotated[
        float, Field(ge=0.3, le=1.2, description="thickness of the envelope's glass")
    ] = 0.7
    lit: Annotated[bool, Field(description="let the filament shine: 460 lm of illuminant A")] = (
        False
    )
    triangles: Triangles = 400_000

    @model_validator(mode="after")
    def _fits(self) -> Parameters:
        check_pillow(self.pillow_pitch_mm, self.pillow_radius_mm)
        if self.lens_dome_radius_mm < 1.4 * max(self.width_mm, self.height_mm):
            raise ValueError("lens_dome_radius_mm must be at least 1.4 times the lens's width")
        if self.focal_length_mm < max(self.width_mm, self.height_mm) / 6.5:
            raise ValueError("focal_length_mm must be at least the lens's width over 6.5")
        return self


@dataclass(frozen=True)
class _Layout:
    """The shapes that the parts share, set so that each clears its neighbours."""

    outline: Superellipse
    mirror: Paraboloid
    bulb: Bulb
    cover: Cover
    housing: Housing
    bezel_z: float


def build(parameters: Parameters) -> Lamp:
    """Return the lamp's meshes and scene."""
    layout = _layout(parameters)
    parts, lens_crease = _parts(parameters, layout)
    meshes = {f"{name}.ply": solid for name, solid in parts.items()}
    colour = parameters.lens_colour
    return Lamp(f"Rear lamp, P21W, {colour}", _tables(parameters, layout, lens_crease), meshes)


def _layout(p: Parameters) -> _Layout:
    shape = Cover(_superellipse(p, 0.0), 0.0, p.lens_thickness_mm, 1.0 / p.lens_dome_radius_mm, 0.0)
    outline = _superellipse(p, shape.outer_offset)
    bulb = Bulb(p.bulb_diameter_mm, p.bulb_glass_mm)
    mirror = Paraboloid(outline, p.focal_length_mm, 0.5 * p.bulb_diameter_mm + 1.5)
    rim = float(mirror.z(np.array(outline.largest_radius_mm)))
    bezel_z = max(rim + 4.0, 6.0)

    pillow = pillow_depth(p.pillow_pitch_mm, p.pillow_radius_mm)
    depth = p.lens_thickness_mm + shape.pedestal + pillow
    edge = outline.largest_radius_mm + shape.band
    sag = float(dome_sag(np.array(edge**2), shape.dome_curvature))
    apex = depth + 1.0 + max(bezel_z + sag, bulb.tip_z)

    roll_end = Cover(outline, apex, p.lens_thickness_mm, shape.dome_curvature, 0.0).roll_end_z()
    cover = Cover(outline, apex, p.lens_thickness_mm, shape.dome_curvature, roll_end - 9.0)
    housing = Housing(
        outline,
        cavity_offset=cover.inner_offset,
        channel_offset=cover.outer_offset + 0.5,
        ledge_z=cover.skirt_z - 0.4,
        lip_z=roll_end - 1.0,
        floor_z=-p.focal_length_mm - mirror.wall - 5.0,
        bore_radius=CAP_RADIUS_MM + 0.5,
    )
    return _Layout(outline, mirror, bulb, cover, housing, bezel_z)


def _superellipse(p: Parameters, inset_mm: float) -> Superellipse:
    return Superellipse(0.5 * p.width_mm - inset_mm, 0.5 * p.height_mm - inset_mm, p.squareness)


def _parts(p: Parameters, layout: _Layout) -> tuple[dict[str, Solid], float]:
    count = {name: round(share * p.triangles) for name, share in _SHARES.items()}
    lens, crease = pillow_cover(layout.cover, p.pillow_pitch_mm, p.pillow_radius_mm, count["lens"])
    steps = max(4, round(np.sqrt(count["bezel"] / 36.0)))
    angles = layout.outline.even_angles(max(24, round(count["bezel"] / (4.0 * (steps + 1)))))
    start = layout.mirror.rim_z(angles) + 0.5
    ring = bezel(
        layout.outline,
        start,
        angles,
        front_z=layout.bezel_z,
        offsets=_BEZEL_OFFSETS_MM,
        steps=steps,
    )
    bulb = layout.bulb
    parts = {
        "lens": lens,
        "bezel": ring,
        "reflector": layout.mirror.solid(count["reflector"]),
        "housing": layout.housing.solid(count["housing"]),
        "envelope": bulb.envelope(count["envelope"]),
        "stem": bulb.stem(count["stem"]),
        "cap": bulb.cap(count["cap"]),
        "supports": bulb.supports(count["supports"]),
        "filament": bulb.filament(count["filament"]),
    }
    return parts, crease


def _tables(p: Parameters, layout: _Layout, lens_crease: float) -> list[Table]:
    housing, middle = layout.housing, 0.5 * (layout.cover.apex_z + layout.housing.back_z)
    ground = -(layout.outline.half_height_mm + housing.outer_offset) - 0.5
    glow = {"source": "A", "flux_lm": _FLUX_LM} if p.lit else None
    lamp_light = (
        [studio.sphere_light("filament", "A", 6_000.0, (0.0, 0.0, 0.0), 0.3)] if p.lit else []
    )
    size = max(p.width_mm, 1.35 * p.height_mm)
    return [
        studio.camera(
            (0.0, 0.0, middle),
            azimuth_deg=15.0,
            elevation_deg=8.0,
            distance_mm=5.0 * size,
            view_deg=14.0,
        ),
        *studio.picture(white_luminance_cd_m2=600.0),
        studio.hall(3e-3),
        *studio.laboratory([_function(p)]),
        *studio.surroundings(150.0, 25.0, 30.0),
        studio.soft_box(900.0, (0.0, 350.0, 1500.0), (4000.0, 2100.0), edge_softness=0.7),
        studio.soft_box(6500.0, (-420.0, 235.0, 1000.0), (760.0, 130.0)),
        studio.soft_box(5000.0, (-100.0, 1000.0, 600.0), (900.0, 300.0)),
        studio.soft_box(5000.0, (-900.0, 100.0, 450.0), (160.0, 900.0)),
        studio.point_light("key", "D65", 1500.0, (-500.0, 900.0, 900.0)),
        *lamp_light,
        *_materials(p),
        mesh_object(
            "lens", "lens", crease_deg=lens_crease, comment="the outer lens, pillows inside"
        ),
        mesh_object("bezel", "aluminium-bezel", crease_deg=40.0),
        mesh_object("reflector", "reflector", crease_deg=40.0, comment="focus in the origin"),
        mesh_object("housing", "black-abs", crease_deg=40.0),
        mesh_object("envelope", "bulb-glass", crease_deg=40.0, comment="the bulb"),
        mesh_object("stem", "bulb-glass", crease_deg=40.0),
        mesh_object("cap", "nickel", crease_deg=40.0),
        mesh_object("supports", "nickel", crease_deg=40.0),
        mesh_object("filament", "tungsten", crease_deg=60.0, emission=glow),
        studio.table_top(ground, "black-abs", front_mm=1.7 * size),
    ]


def _function(p: Parameters) -> dict[str, Any]:
    if p.lens_colour == "amber":
        return {"name": "indicator", "rule": "un-r148/2a"}
    if p.lens_colour == "red":
        return {"name": "stop", "rule": "un-r148/S1"}
    return {"name": "reversing", "rule": "un-r148/AR"}


def _materials(p: Parameters) -> list[Table]:
    return [
        Table("materials.lens", {"library": lens_material(p.lens_colour)}),
        Table("materials.reflector", library_material("aluminium", p.reflector_roughness)),
        Table(
            "materials.bulb-glass",
            {"kind": "dielectric", "refractive_index": {"cauchy": [1.513, 0.00396]}},
            "soda-lime glass, n_d 1.524 (two-term fit)",
        ),
        Table(
            "materials.nickel",
            {
                "kind": "conductor",
                "refractive_index": {
                    "wavelengths_nm": [354, 397, 451, 496, 549, 582, 617, 659, 704, 756, 821, 892],
                    "n": [1.74, 1.72, 1.73, 1.82, 1.92, 1.96, 1.99, 1.99, 2.06, 2.13, 2.26, 2.40],
                    "k": [2.32, 2.57, 2.95, 3.25, 3.61, 3.80, 4.02, 4.26, 4.50, 4.73, 4.97, 5.23],
                },
            },
            "P. B. Johnson, R. W. Christy, Phys. Rev. B 9, 5056 (1974); CC0, refractiveindex.info",
        ),
        Table(
            "materials.tungsten",
            {
                "kind": "conductor",
                "refractive_index": {
                    "wavelengths_nm": [350, 400, 449, 494, 549, 600, 646, 701, 755, 794, 833, 873],
                    "n": [3.18, 3.41, 3.31, 3.38, 3.52, 3.56, 3.66, 3.87, 3.86, 3.71, 3.49, 3.28],
                    "k": [2.67, 2.42, 2.51, 2.67, 2.74, 2.86, 2.93, 2.88, 2.78, 2.73, 2.80, 2.95],
                },
            },
            "J. H. Weaver et al., Phys. Rev. B 12, 1293 (1975); CC0, refractiveindex.info",
        ),
    ]

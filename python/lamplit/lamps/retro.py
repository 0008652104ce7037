# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A reflex reflector: one red plate, flat in front, its back full of cube corners.

The front's middle lies in the origin; +z points at the observer. The plate's cube corners
reflect totally, so nothing but air is behind them; the housing keeps its distance. Perfect cubes
would send all light back into its source; a receiver beside it lives by the faces' small errors.
"""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from lamplit.lamps import studio
from lamplit.lamps.cover import Cover
from lamplit.lamps.outlines import Superellipse
from lamplit.lamps.patterns import cube_corner_patch
from lamplit.lamps.recipe import (
    Lamp,
    LampParameters,
    LensColour,
    Table,
    TomlValue,
    Triangles,
    lens_material,
    mesh_object,
)
from lamplit.lamps.shells import Housing
from lamplit.lamps.solids import Solid


class Parameters(LampParameters):
    """The parameters of the lamp ``retro``."""

    width_mm: Annotated[float, Field(ge=30.0, le=300.0, description="width of the plate")] = 90.0
    height_mm: Annotated[float, Field(ge=30.0, le=300.0, description="height of the plate")] = 54.0
    squareness: Annotated[
        float,
        Field(ge=2.0, le=8.0, description="superellipse exponent: 2 is round, 8 nearly square"),
    ] = 4.0
    aperture: Annotated[
        Literal["hexagonal", "triangular"], Field(description="shape of one cube corner's opening")
    ] = "hexagonal"
    pitch_mm: Annotated[
        float,
        Field(
            ge=0.5, le=15.0, description="hexagonal: between tips; triangular: side of triangles"
        ),
    ] = 4.0
    cube_error_arcmin: Annotated[
        float,
        Field(
            ge=0.0,
            le=60.0,
            description="RMS tilt of the cubes' faces from their true place; 0 sends all light "
            "straight back",
        ),
    ] = 7.5
    plate_thickness_mm: Annotated[
        float, Field(ge=1.0, le=6.0, description="from the front to the nearest groove behind")
    ] = 2.0
    colour: Annotated[LensColour, Field(description="PMMA of the plate")] = "red"
    triangles: Triangles = 60_000

    @model_validator(mode="after")
    def _is_a_field(self) -> Parameters:
        largest = min(self.width_mm, self.height_mm) / 5.0
        if self.pitch_mm > largest:
            raise ValueError(f"pitch_mm must be at most {largest:g}, a fifth of the plate")
        return self


def build(parameters: Parameters) -> Lamp:
    """Return the reflector's meshes and scene."""
    p = parameters
    cover = _cover(p)
    plate, depth = _plate(p, cover)
    housing = Housing(
        cover.optics,
        cavity_offset=cover.inner_offset,
        channel_offset=cover.outer_offset + 0.4,
        ledge_z=cover.skirt_z - 0.4,
        lip_z=cover.roll_end_z() - 0.6,
        floor_z=min(cover.skirt_z, cover.apex_z - depth) - 5.0,
        bore_radius=None,
        wall=2.0,
    )
    meshes = {"plate.ply": plate, "housing.ply": housing.solid(round(0.12 * p.triangles))}
    return Lamp(f"Reflex reflector, {p.colour}", _tables(p, cover, housing), meshes)


def _cover(p: Parameters) -> Cover:
    band, inner_radius = 1.2, 0.8
    inset = band + inner_radius + p.plate_thickness_mm
    optics = Superellipse(0.5 * p.width_mm - inset, 0.5 * p.height_mm - inset, p.squareness)
    skirt = -p.plate_thickness_mm - inner_radius - 3.0
    return Cover(optics, 0.0, p.plate_thickness_mm, 0.0, skirt, band, inner_radius, pedestal=0.05)


def _plate(p: Parameters, cover: Cover) -> tuple[Solid, float]:
    """Return the plate and how far its tips lie behind the front."""
    divisions, rolls = np.arange(1, 300), np.arange(1, 300).clip(4, 12)
    faces = 6.0 / (0.5 * np.sqrt(3.0) * p.pitch_mm**2) * cover.optics.area_mm2 * divisions**2
    around = 3.2 * cover.optics.perimeter_mm / p.pitch_mm * divisions
    total = 2.0 * faces + 2.0 * around * (2.7 * rolls + 5.0)
    best = int(np.argmin(np.abs(np.log(total / (0.85 * p.triangles)))))
    patch = cube_corner_patch(
        cover.optics, p.aperture, p.pitch_mm, int(divisions[best]), p.cube_error_arcmin
    )
    roll = int(rolls[best])
    depth = p.plate_thickness_mm + cover.pedestal + float(patch.height.max())
    return cover.solid(patch, patch.height, roll), depth


def _tables(p: Parameters, cover: Cover, housing: Housing) -> list[Table]:
    ground = -(cover.optics.half_height_mm + housing.outer_offset) - 0.5
    size = max(p.width_mm, 1.6 * p.height_mm)
    camera = studio.camera(
        (0.0, 0.0, -3.0), azimuth_deg=12.0, elevation_deg=6.0, distance_mm=6.0 * size, view_deg=10.5
    )
    behind = 1.8 * np.asarray(camera.values["position_mm"])
    return [
        camera,
        *studio.picture(white_luminance_cd_m2=1200.0),
        studio.hall(1e-3),
        *studio.surroundings(320.0, 50.0, 80.0),
        studio.soft_box(
            1500.0,
            np.add(behind, (0.25 * size, 0.3 * size, 0.0)),
            (1.6 * size, 1.0 * size),
            edge_softness=0.8,
        ),
        studio.soft_box(7000.0, (-420.0, 260.0, 1000.0), (760.0, 130.0)),
        studio.soft_box(5000.0, (-100.0, 1000.0, 600.0), (900.0, 300.0)),
        studio.point_light("key", "D65", 1500.0, (-500.0, 900.0, 900.0)),
        Table("materials.plate", {"library": lens_material(p.colour)}),
        mesh_object("plate", "plate", comment="flat faces: cube corners must not be smoothed"),
        mesh_object("housing", "black-abs", crease_deg=40.0),
        studio.table_top(ground, "black-abs", front_mm=1.6 * size),
        *studio.laboratory(reflectors=[_reflector(p)]),
    ]


def _reflector(p: Parameters) -> dict[str, TomlValue]:
    """Return what the plate has to meet; no rule knows smoke."""
    emits = {"red": "red", "amber": "amber", "clear": "colourless"}
    if p.colour not in emits:
        return {"name": "reflector"}
    return {"name": "reflector", "rule": f"un-r150/IA?emits={emits[p.colour]}"}

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The first experiment of the 2002 study: coloured plastic bodies over a checker floor.

A sphere and a triangular pyramid, both exact shapes without meshes. Thick and thin places of
the same plastic show Bouguer–Beer at a glance.
"""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from pydantic import Field

from lamplit.lamps import studio
from lamplit.lamps.recipe import Lamp, LampParameters, LensColour, Table, lens_material


class Parameters(LampParameters):
    """The parameters of the scene ``paper``."""

    sphere_radius_mm: Annotated[float, Field(ge=1.0, le=200.0, description="radius")] = 22.0
    sphere_colour: Annotated[LensColour, Field(description="PMMA of the sphere")] = "red"
    pyramid_edge_mm: Annotated[
        float, Field(ge=1.0, le=400.0, description="edge of the regular pyramid")
    ] = 52.0
    pyramid_colour: Annotated[LensColour, Field(description="PMMA of the pyramid")] = "amber"
    square_mm: Annotated[
        float, Field(ge=0.5, le=200.0, description="side of the floor's squares")
    ] = 16.0
    light_cd_m2: Annotated[
        float,
        Field(ge=0.0, le=1e6, description="luminance of a perfect reflector that faces the light"),
    ] = 900.0


def build(parameters: Parameters) -> Lamp:
    """Return the scene; it has no meshes."""
    p = parameters
    size = max(p.sphere_radius_mm, 0.5 * p.pyramid_edge_mm)
    sphere = {
        "name": "sphere",
        "kind": "sphere",
        "centre_mm": [-0.95 * size, p.sphere_radius_mm + 0.2, 0.0],
        "radius_mm": p.sphere_radius_mm,
        "material": "sphere",
    }
    pyramid = {
        "name": "pyramid",
        "kind": "tetrahedron",
        "points_mm": _pyramid(p.pyramid_edge_mm, (1.15 * size, 0.2, 0.25 * size)),
        "material": "pyramid",
    }
    tables = [
        studio.camera(
            (0.08 * size, 0.8 * size, 0.0),
            azimuth_deg=-14.0,
            elevation_deg=20.0,
            distance_mm=9.0 * size,
            view_deg=22.0,
        ),
        *studio.picture(white_luminance_cd_m2=1000.0, method="hall", sampling="sobol"),
        Table("ambient", {"source": "D65", "luminance_cd_m2": 120.0}),
        Table(
            "background",
            {
                "kind": "gradient",
                "zenith": {"source": "D65", "luminance_cd_m2": 900.0},
                "nadir": {"source": "D65", "luminance_cd_m2": 250.0},
            },
        ),
        studio.point_light("lamp", "D65", p.light_cd_m2, (-7.0 * size, 14.0 * size, 9.0 * size)),
        Table("materials.sphere", {"library": lens_material(p.sphere_colour)}),
        Table("materials.pyramid", {"library": lens_material(p.pyramid_colour)}),
        Table(
            "materials.floor",
            {
                "kind": "checker",
                "reflectance_a": 0.72,
                "reflectance_b": 0.08,
                "square_mm": p.square_mm,
            },
        ),
        Table("objects", sphere, many=True),
        Table("objects", pyramid, many=True),
        Table(
            "objects",
            {
                "name": "floor",
                "kind": "plane",
                "point_mm": [0.0, 0.0, 0.0],
                "normal": [0.0, 1.0, 0.0],
                "material": "floor",
            },
            many=True,
        ),
    ]
    return Lamp("Coloured plastic over a checker floor", tables)


def _pyramid(edge_mm: float, base_centre_mm: tuple[float, float, float]) -> list[list[Any]]:
    """Return the points of a regular pyramid that stands on its base, one corner forward."""
    angles = np.radians([75.0, 195.0, 315.0])
    radius = edge_mm / np.sqrt(3.0)
    base = np.column_stack([radius * np.cos(angles), np.zeros(3), radius * np.sin(angles)])
    points = np.concatenate([base, [[0.0, edge_mm * np.sqrt(2.0 / 3.0), 0.0]]])
    return (points + base_centre_mm).tolist()

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A rear lamp of twelve LEDs: dies on a board, collimators, cups or a white tray, and a cover.

The dies' light-emitting faces lie in the plane z = 0; +z points at the observer. Neighbouring
parts keep at least 0.2 mm apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from lamplit.lamps import studio
from lamplit.lamps.cover import Cover, dome_sag, pillow_cover, smooth_cover
from lamplit.lamps.emitters import Collimator, Tray, grid_mm
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
from lamplit.lamps.shells import Housing
from lamplit.lamps.solids import Floats, Solid, cuboid, repeated

_BOARD_TOP_Z, _BOARD_BACK_Z = -2.5, -4.1
#: Where there are no optics: the white floor, below the dies' faces, and the depth of its tray.
_FLOOR_Z, _FLOOR_DEPTH_MM = -0.5, 12.0
#: What the tray is made of.
_TRAY = {"tir": "black-abs", "cups": "aluminium-bezel", "none": "white-paint"}
_MARGIN_MM = 7.0
_PMMA_INDEX = 1.49
#: Flux of one die, in lm, of an indicator (True) and of a stop lamp: usual orders of size.
_FLUX_LM = {True: 25.0, False: 10.0}
#: Reflectances at `_BANDS_NM`, drawn by eye: ceramic, a bare red die, and silicone with a phosphor
#: that turns blue into amber.
_BANDS_NM = [380, 430, 480, 530, 580, 630, 680, 730]
_CERAMIC = [0.5, 0.8, 0.86, 0.88, 0.88, 0.88, 0.88, 0.88]
_BARE_DIE = [0.12, 0.12, 0.14, 0.2, 0.3, 0.36, 0.38, 0.4]
_PHOSPHOR = [0.2, 0.08, 0.08, 0.45, 0.86, 0.9, 0.9, 0.9]


class Parameters(LampParameters):
    """The parameters of the lamp ``led-array``."""

    layout: Annotated[
        Literal["6x2", "4x3"], Field(description="columns x rows of the twelve dies")
    ] = "6x2"
    pitch_mm: Annotated[
        float, Field(ge=12.0, le=40.0, description="distance between neighbouring dies")
    ] = 17.0
    optics: Annotated[
        Literal["tir", "cups", "none"],
        Field(
            description="totally reflecting collimators of clear PMMA, aluminised cups, or none: "
            "bare dies in a matt white tray"
        ),
    ] = "tir"
    board: Annotated[
        Literal["white", "green"], Field(description="colour of the board's solder mask")
    ] = "white"
    cover_colour: Annotated[LensColour, Field(description="PMMA of the cover")] = "smoke"
    cover_thickness_mm: Annotated[float, Field(ge=1.5, le=5.0, description="wall of the cover")] = (
        2.5
    )
    cover_dome_radius_mm: Annotated[
        float, Field(ge=300.0, le=10_000.0, description="radius of the cover's front")
    ] = 500.0
    cover_optics: Annotated[
        Literal["none", "pillows"], Field(description="what the inside of the cover carries")
    ] = "none"
    pillow_pitch_mm: Annotated[
        float, Field(ge=2.0, le=20.0, description="side of one square pillow, where there are any")
    ] = 6.0
    pillow_radius_mm: Annotated[
        float, Field(ge=2.0, le=500.0, description="radius of curvature of the pillows")
    ] = 26.0
    cover_roughness: Annotated[
        Roughness, Field(description="GGX width of the cover's surfaces: 0 smooth, or 0.001 to 1")
    ] = 0.0
    die_size_mm: Annotated[float, Field(ge=0.3, le=1.4, description="side of the square dies")] = (
        1.0
    )
    lit: Annotated[bool, Field(description="let each die shine, in its colour")] = False
    triangles: Triangles = 300_000

    @model_validator(mode="after")
    def _is_a_pillow(self) -> Parameters:
        check_pillow(self.pillow_pitch_mm, self.pillow_radius_mm)
        return self

    @property
    def amber(self) -> bool:
        """Whether it is an indicator of phosphor-converted amber; else red dies of 624 nm."""
        return self.cover_colour != "red"

    @property
    def columns_rows(self) -> tuple[int, int]:
        """The numbers of columns and rows."""
        columns, rows = self.layout.split("x")
        return int(columns), int(rows)


@dataclass(frozen=True)
class _Layout:
    outline: Superellipse
    collimator: Collimator
    tray: Tray
    cover: Cover
    housing: Housing


def build(parameters: Parameters) -> Lamp:
    """Return the lamp's meshes and scene."""
    layout = _layout(parameters)
    cover, crease = _cover(parameters, layout)
    parts = {"cover": cover, **_parts(parameters, layout)}
    meshes = {f"{name}.ply": solid for name, solid in parts.items()}
    title = f"Rear lamp, twelve LEDs, {parameters.cover_colour} cover"
    return Lamp(title, _tables(parameters, layout, crease), meshes)


def _layout(p: Parameters) -> _Layout:
    columns, rows = p.columns_rows
    outline = Superellipse(
        0.5 * columns * p.pitch_mm + _MARGIN_MM, 0.5 * rows * p.pitch_mm + _MARGIN_MM, 5.0
    )
    collimator = Collimator(0.5 * p.pitch_mm - 0.9, _PMMA_INDEX)
    focal_length = 0.094 * p.pitch_mm
    rise = 4.0
    if p.optics == "tir":
        hole = cup = collimator.radius + 0.4
        land = collimator.height - 0.6
    elif p.optics == "cups":
        hole, cup = 1.6 * focal_length, 0.5 * p.pitch_mm - 0.4
        land = cup**2 / (4.0 * focal_length) - focal_length
    else:
        hole = cup = np.sqrt(2.0) * _package_half_mm(p) + 0.4
        land, rise = _FLOOR_Z, _FLOOR_DEPTH_MM
    tray = Tray(p.pitch_mm, hole, cup, focal_length, land, land + rise)

    curvature = 1.0 / p.cover_dome_radius_mm
    blank = Cover(outline, 0.0, p.cover_thickness_mm, curvature, 0.0)
    sag = float(dome_sag(np.array((outline.largest_radius_mm + blank.band) ** 2), curvature))
    depth = p.cover_thickness_mm
    if p.cover_optics == "pillows":
        depth += blank.pedestal + pillow_depth(p.pillow_pitch_mm, p.pillow_radius_mm)
    apex = tray.frame_z + 1.0 + sag + depth
    roll_end = Cover(outline, apex, p.cover_thickness_mm, curvature, 0.0).roll_end_z()
    cover = Cover(outline, apex, p.cover_thickness_mm, curvature, roll_end - 7.0)
    housing = Housing(
        outline,
        cavity_offset=cover.inner_offset,
        channel_offset=cover.outer_offset + 0.5,
        ledge_z=cover.skirt_z - 0.4,
        lip_z=roll_end - 1.0,
        floor_z=_BOARD_BACK_Z - 4.0,
        bore_radius=None,
    )
    return _Layout(outline, collimator, tray, cover, housing)


def _package_half_mm(p: Parameters) -> float:
    return 0.5 * p.die_size_mm + 0.5


def _cover(p: Parameters, layout: _Layout) -> tuple[Solid, float]:
    """Return the cover and the crease angle that it is shaded with."""
    triangles = round((0.3 if p.optics == "tir" else 0.65) * p.triangles)
    if p.cover_optics == "none":
        return smooth_cover(layout.cover, triangles), 35.0
    return pillow_cover(layout.cover, p.pillow_pitch_mm, p.pillow_radius_mm, triangles)


def _parts(p: Parameters, layout: _Layout) -> dict[str, Solid]:
    places = grid_mm(*p.columns_rows, p.pitch_mm)
    half, body = 0.5 * p.die_size_mm, _package_half_mm(p)
    package = cuboid((-body, -body, _BOARD_TOP_Z + 0.2), (body, body, -0.3))
    parts = {
        "tray": layout.tray.solid(
            places, layout.outline, layout.cover.inner_offset - 2.0, round(0.25 * p.triangles)
        ),
        "housing": layout.housing.solid(round(0.1 * p.triangles)),
        "packages": repeated(package, places),
        "dies": repeated(cuboid((-half, -half, -0.1), (half, half, 0.0)), places),
    }
    if p.optics == "tir":
        parts["collimators"] = layout.collimator.solids(places, round(0.35 * p.triangles))
    return parts


def _tables(p: Parameters, layout: _Layout, cover_crease: float) -> list[Table]:
    housing = layout.housing
    ground = -(layout.outline.half_height_mm + housing.outer_offset) - 0.5
    width = 2.0 * (layout.outline.half_width_mm + housing.outer_offset)
    height = 2.0 * (layout.outline.half_height_mm + housing.outer_offset)
    distance = 4.2 * max(width, 1.6 * height)
    places = grid_mm(*p.columns_rows, p.pitch_mm)
    source = "pc-amber-led" if p.amber else "red-led-624"
    lights = [
        studio.sphere_light(f"die-{k + 1}", source, 2_500.0, (place[0], place[1], 0.6), 0.4)
        for k, place in enumerate(places)
        if p.lit
    ]
    collimators = mesh_object("collimators", "pmma-clear", crease_deg=35.0)
    return [
        studio.camera(
            (0.0, -2.0, 5.0),
            azimuth_deg=11.0,
            elevation_deg=5.0,
            distance_mm=distance,
            view_deg=11.5,
        ),
        *studio.picture(white_luminance_cd_m2=600.0),
        studio.hall(3e-3),
        *studio.laboratory([_function(p)]),
        *studio.surroundings(190.0, 30.0, 120.0),
        studio.soft_box(
            2600.0, (-265.0, 22.0, 1000.0), (420.0, 90.0), edge_softness=0.2, up=(0.12, 1.0, 0.0)
        ),
        studio.soft_box(9000.0, (100.0, 1000.0, 600.0), (1100.0, 300.0)),
        studio.soft_box(6000.0, (-900.0, 100.0, 450.0), (160.0, 900.0)),
        studio.point_light("key", "D65", 4000.0, (-300.0, 700.0, 1200.0)),
        *lights,
        *_materials(p),
        mesh_object("cover", "cover", crease_deg=cover_crease),
        *([collimators] if p.optics == "tir" else []),
        mesh_object(
            "tray",
            _TRAY[p.optics],
            crease_deg=35.0,
            comment="the mask between the collimators, the cups, or the white floor",
        ),
        mesh_object("housing", "black-abs", crease_deg=40.0),
        mesh_object("packages", "package"),
        mesh_object("dies", "die"),
        *([_face(p, k + 1, place, source) for k, place in enumerate(places)] if p.lit else []),
        Table("objects", _board(p), many=True),
        studio.table_top(ground, "black-abs", front_mm=1.5 * width),
    ]


def _face(p: Parameters, number: int, place: Floats, source: str) -> Table:
    """Return the round face, just above a die, that its light leaves by."""
    values = {
        "name": f"die-{number}",
        "kind": "disc",
        "centre_mm": np.add(place, (0.0, 0.0, 0.02)),
        "normal": [0.0, 0.0, 1.0],
        "radius_mm": 0.5 * p.die_size_mm,
        "material": "die",
        "emission": {"source": source, "flux_lm": _FLUX_LM[p.amber], "group": "dies"},
    }
    return Table("objects", values, many=True)


def _board(p: Parameters) -> dict[str, Any]:
    columns, rows = p.columns_rows
    x, y = 0.5 * columns * p.pitch_mm + 1.0, 0.5 * rows * p.pitch_mm + 1.0
    return {
        "name": "board",
        "kind": "box",
        "min_mm": [-x, -y, _BOARD_BACK_Z],
        "max_mm": [x, y, _BOARD_TOP_Z],
        "material": "solder-mask",
    }


def _function(p: Parameters) -> dict[str, Any]:
    if p.amber:
        return {"name": "indicator", "rule": "un-r148/2a"}
    return {"name": "stop", "rule": "un-r148/S1"}


def _materials(p: Parameters) -> list[Table]:
    masks = {
        "white": [0.45, 0.72, 0.80, 0.82, 0.83, 0.84, 0.84, 0.84],
        "green": [0.03, 0.04, 0.06, 0.13, 0.09, 0.04, 0.03, 0.05],
    }
    return [
        Table(
            "materials.cover",
            library_material(lens_material(p.cover_colour), p.cover_roughness),
        ),
        Table("materials.solder-mask", _glossy(masks[p.board]), "drawn by eye, not measured"),
        Table("materials.package", _glossy(_PHOSPHOR if p.amber else _CERAMIC)),
        Table("materials.die", _glossy(_PHOSPHOR if p.amber else _BARE_DIE, 1.8)),
    ]


def _glossy(reflectance: list[float], index: float = 1.5) -> dict[str, Any]:
    table = {
        "wavelengths_nm": _BANDS_NM,
        "values": reflectance,
        "extension": "constant",
    }
    return {"kind": "glossy", "refractive_index": index, "reflectance": table}

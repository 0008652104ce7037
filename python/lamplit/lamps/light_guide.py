# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A light guide: a clear rod with notches along its back, LEDs at its ends, a white trough behind.

Light runs along the rod by total reflection, hundreds of times, until a notch turns it forward. The
rod's middle lies in the origin, the rod along x; +z points at the observer. Neighbouring parts keep
at least 0.2 mm apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from lamplit.lamps import studio
from lamplit.lamps.cover import Cover, smooth_cover
from lamplit.lamps.outlines import Superellipse
from lamplit.lamps.recipe import (
    Lamp,
    LampParameters,
    Table,
    Triangles,
    mesh_object,
)
from lamplit.lamps.rod import Bow, NotchedRod
from lamplit.lamps.shells import Housing
from lamplit.lamps.solids import Solid, cuboid, joined

#: From the rod's end outward: the face that shines, the die, its package, the board; half widths.
_FACE, _DIE, _PACKAGE, _BOARD = 0.38, (0.4, 0.5), (0.72, 2.2), (2.45, 4.0)
_PACKAGE_HALF, _BOARD_HALF = 1.4, 2.6
_DIE_RADIUS_MM = 0.5
#: Flux of one LED, in lm: a usual order of size of one that lights a guide.
_FLUX_LM = 8.0
_SOURCE = "red-led-624"
_COVER_MM = 2.5
_PMMA_INDEX = 1.492
#: Surfaces in one walk. Of 64, the usual number, light in the rod needs hundreds.
_MAX_DEPTH = 2000


class Parameters(LampParameters):
    """The parameters of the lamp ``light-guide``."""

    length_mm: Annotated[float, Field(ge=60.0, le=400.0, description="length of the rod")] = 280.0
    diameter_mm: Annotated[float, Field(ge=6.0, le=14.0, description="width of the rod")] = 8.0
    bow_mm: Annotated[
        float, Field(ge=0.0, le=20.0, description="how far the rod's ends lie below its middle")
    ] = 0.0
    notch_pitch_mm: Annotated[
        float, Field(ge=1.0, le=10.0, description="distance between neighbouring notches")
    ] = 3.0
    notch_depth_mm: Annotated[
        float,
        Field(ge=0.1, le=1.5, description="depth of the deepest notch; those near an LED are less"),
    ] = 0.6
    notch_angle_deg: Annotated[
        float, Field(ge=30.0, le=60.0, description="between a notch's sides and the rod's axis")
    ] = 52.0
    attenuation_db_per_m: Annotated[
        float, Field(ge=0.05, le=20.0, description="loss in clear PMMA, at every wavelength")
    ] = 1.0
    leds: Annotated[Literal["one", "both"], Field(description="LEDs at one end, or at both")] = (
        "both"
    )
    housing: Annotated[Literal["white", "black"], Field(description="colour of the trough")] = (
        "white"
    )
    cover: Annotated[
        Literal["none", "clear", "red"], Field(description="PMMA of the cover, if there is one")
    ] = "clear"
    lit: Annotated[bool, Field(description="let each LED shine: 8 lm, red")] = False
    triangles: Triangles = 80_000

    @model_validator(mode="after")
    def _fits(self) -> Parameters:
        deepest = self.diameter_mm / 8.0
        if self.notch_depth_mm > deepest:
            raise ValueError(f"notch_depth_mm must be at most {deepest:g}, an eighth of the rod")
        wide = 2.0 * self.notch_depth_mm / np.tan(np.radians(self.notch_angle_deg))
        if self.notch_pitch_mm < wide + 0.2:
            raise ValueError(
                f"notch_pitch_mm must be at least {wide + 0.2:.3g}: notches are {wide:.3g} mm wide"
            )
        if self.bow_mm > self.length_mm / 12.0:
            raise ValueError(
                f"bow_mm must be at most {self.length_mm / 12.0:.3g}, a twelfth of the length"
            )
        return self


@dataclass(frozen=True)
class _Layout:
    rod: NotchedRod
    bow: Bow
    outline: Superellipse
    cover: Cover
    housing: Housing


def build(parameters: Parameters) -> Lamp:
    """Return the lamp's meshes and scene."""
    layout = _layout(parameters)
    meshes = {f"{name}.ply": solid for name, solid in _parts(parameters, layout).items()}
    return Lamp("Light guide of a rear position lamp", _tables(parameters, layout), meshes)


def _layout(p: Parameters) -> _Layout:
    radius = 0.5 * p.diameter_mm
    rod = NotchedRod(
        p.length_mm,
        radius,
        p.notch_pitch_mm,
        p.notch_depth_mm,
        p.notch_angle_deg,
        fed_from_both_ends=p.leds == "both",
    )
    outline = Superellipse(0.5 * p.length_mm + 3.0, radius + 0.5 * p.bow_mm, 6.0)
    apex = radius + 2.0 + _COVER_MM
    roll_end = Cover(outline, apex, _COVER_MM, 0.0, 0.0).roll_end_z()
    cover = Cover(outline, apex, _COVER_MM, 0.0, roll_end - 7.0)
    ledge = cover.skirt_z - 0.4
    housing = Housing(
        outline,
        cavity_offset=cover.inner_offset,
        channel_offset=cover.outer_offset + 0.5,
        ledge_z=ledge,
        lip_z=roll_end - 1.0,
        floor_z=min(-radius - 3.0, ledge - 5.0),
        bore_radius=None,
    )
    return _Layout(rod, Bow(p.length_mm, p.bow_mm), outline, cover, housing)


def _ends(p: Parameters) -> tuple[float, ...]:
    """Return the sides that LEDs are on: −1 for the end at −x, 1 for that at +x."""
    return (-1.0, 1.0) if p.leds == "both" else (-1.0,)


def _parts(p: Parameters, layout: _Layout) -> dict[str, Solid]:
    shares = {"rod": 0.6, "cover": 0.25, "housing": 0.15}
    if p.cover == "none":
        shares = {"rod": 0.75, "housing": 0.25}
    parts = {
        "rod": layout.bow.bent(layout.rod.solid(round(shares["rod"] * p.triangles))),
        "housing": layout.housing.solid(round(shares["housing"] * p.triangles)),
    }
    if p.cover != "none":
        parts["cover"] = smooth_cover(layout.cover, round(shares["cover"] * p.triangles))
    blocks = {"dies": (_DIE, _DIE_RADIUS_MM), "packages": (_PACKAGE, _PACKAGE_HALF)}
    for name, (reach, half) in {**blocks, "boards": (_BOARD, _BOARD_HALF)}.items():
        solids = [_block(0.5 * p.length_mm, side, reach, half) for side in _ends(p)]
        parts[name] = layout.bow.bent(joined(*solids))
    return parts


def _block(end: float, side: float, reach: tuple[float, float], half: float) -> Solid:
    x = sorted(side * (end + own) for own in reach)
    return cuboid((x[0], -half, -half), (x[1], half, half))


def _tables(p: Parameters, layout: _Layout) -> list[Table]:
    housing = layout.housing
    ground = -(layout.outline.half_height_mm + housing.outer_offset) - 0.5
    width = 2.0 * (layout.outline.half_width_mm + housing.outer_offset)
    wall = "white-paint" if p.housing == "white" else "black-abs"
    matter = "red-pmma" if p.cover == "red" else "pmma"
    cover = [mesh_object("cover", matter, crease_deg=35.0)] if p.cover != "none" else []
    return [
        studio.camera(
            (0.0, 0.0, 0.0),
            azimuth_deg=16.0,
            elevation_deg=9.0,
            distance_mm=4.0 * width,
            view_deg=9.5,
        ),
        *studio.picture(white_luminance_cd_m2=600.0),
        Table(
            "path",
            {"max_depth": _MAX_DEPTH},
            "light is reflected hundreds of times on its way along the rod",
        ),
        studio.hall(3e-3),
        *studio.laboratory([{"name": "position", "rule": "un-r148/R1"}]),
        *studio.surroundings(190.0, 30.0, 120.0),
        studio.soft_box(1200.0, (-300.0, 350.0, 1000.0), (900.0, 350.0)),
        studio.soft_box(1500.0, (100.0, 1000.0, 600.0), (1400.0, 700.0)),
        studio.point_light("key", "D65", 4000.0, (-300.0, 700.0, 1200.0)),
        *(_lights(p, layout) if p.lit else []),
        *_materials(p),
        mesh_object("rod", "pmma", comment="flat faces: smooth ones would round the notches"),
        *cover,
        mesh_object("housing", wall, crease_deg=40.0, comment="the trough behind the rod"),
        mesh_object("packages", "package"),
        mesh_object("dies", "die"),
        mesh_object("boards", "solder-mask"),
        *(_faces(p, layout) if p.lit else []),
        studio.table_top(ground, "black-abs", front_mm=1.5 * width),
    ]


def _faces(p: Parameters, layout: _Layout) -> list[Table]:
    """Return the round faces, just before the dies, that their light leaves by."""
    faces: list[Table] = []
    for number, side in enumerate(_ends(p), start=1):
        x = side * (0.5 * p.length_mm + _FACE)
        values = {
            "name": f"led-{number}",
            "kind": "disc",
            "centre_mm": layout.bow.points(np.array([[x, 0.0, 0.0]]))[0],
            "normal": -side * layout.bow.along(x),
            "radius_mm": _DIE_RADIUS_MM,
            "material": "die",
            "emission": {"source": _SOURCE, "flux_lm": _FLUX_LM, "group": "leds"},
        }
        faces.append(Table("objects", values, many=True))
    return faces


def _lights(p: Parameters, layout: _Layout) -> list[Table]:
    """Return what stands for the LEDs in method hall."""
    x = [side * (0.5 * p.length_mm + 0.5 * _FACE) for side in _ends(p)]
    places = layout.bow.points(np.column_stack([x, np.zeros((len(x), 2))]))
    return [
        studio.sphere_light(f"led-{number}", _SOURCE, 2_500.0, place, 0.1)
        for number, place in enumerate(places, start=1)
    ]


def _materials(p: Parameters) -> list[Table]:
    glossy: dict[str, Any] = {"kind": "glossy", "refractive_index": 1.5}
    per_metre = 10.0 ** (-p.attenuation_db_per_m / 10.0)
    pmma = {
        "kind": "dielectric",
        "refractive_index": _PMMA_INDEX,
        "internal_transmittance": {"thickness_mm": 1000.0, "value": per_metre},
    }
    return [
        Table(
            "materials.pmma",
            pmma,
            "a grade for light guides, by assumption; one index, so that all colours share a walk",
        ),
        Table("materials.package", {**glossy, "reflectance": 0.86}, "white ceramic, by eye"),
        Table("materials.die", {**glossy, "refractive_index": 1.8, "reflectance": 0.3}),
        Table("materials.solder-mask", {**glossy, "reflectance": 0.8}),
    ]

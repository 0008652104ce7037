# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The photographer's half of an example scene: camera, picture, soft boxes, key light, floor.

Soft boxes and surroundings shine in both methods. Hall's matt surfaces do not see them, so a key
light and ambient light stand for them there; path transport leaves these two out.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from lamplit.lamps.recipe import Table, TomlValue

Point: TypeAlias = Sequence[float] | NDArray[np.float64]


def camera(
    target_mm: Point,
    *,
    azimuth_deg: float,
    elevation_deg: float,
    distance_mm: float,
    view_deg: float,
) -> Table:
    """Return a pinhole camera on a sphere about ``target_mm``; azimuth 0 is on the lamp's axis."""
    azimuth, elevation = np.radians(azimuth_deg), np.radians(elevation_deg)
    way = np.array(
        [
            np.sin(azimuth) * np.cos(elevation),
            np.sin(elevation),
            np.cos(azimuth) * np.cos(elevation),
        ]
    )
    position = np.round(np.asarray(target_mm) + distance_mm * way, 2)
    values = {
        "kind": "pinhole",
        "position_mm": position,
        "target_mm": [float(x) for x in target_mm],
        "up": [0.0, 1.0, 0.0],
        "field_of_view_deg": view_deg,
    }
    comment = f"{azimuth_deg:g} deg beside and {elevation_deg:g} deg above the lamp's axis (+z)"
    return Table("camera", values, comment)


def picture(
    *, white_luminance_cd_m2: float, method: Literal["auto", "hall"] = "auto", sampling: str = ""
) -> list[Table]:
    """Return the image and display tables; with "sobol", Hall's moiré turns into fine noise."""
    image: dict[str, TomlValue] = {"method": method, "width": 640, "height": 400, "samples": 16}
    if sampling:
        image["sampling"] = sampling
    return [
        Table("image", image, "samples: per pixel"),
        Table(
            "display",
            {"space": "srgb", "white_luminance_cd_m2": white_luminance_cd_m2, "white": "D65"},
            "the luminance that becomes display white",
        ),
    ]


def soft_box(
    luminance_cd_m2: float, centre_mm: Point, size_mm: tuple[float, float], **more: Any
) -> Table:
    """Return a luminous rectangle of the background, facing the origin unless told otherwise."""
    values = {
        "source": "D65",
        "luminance_cd_m2": luminance_cd_m2,
        "centre_mm": [float(x) for x in centre_mm],
        "width_mm": size_mm[0],
        "height_mm": size_mm[1],
        "edge_softness": 0.25,
        **more,
    }
    return Table("background.soft_boxes", values, many=True)


def surroundings(zenith_cd_m2: float, nadir_cd_m2: float, ambient_cd_m2: float) -> list[Table]:
    """Return ambient light and a studio background, bright above and dim below."""
    return [
        Table("ambient", {"source": "D65", "luminance_cd_m2": ambient_cd_m2}, "method hall"),
        Table(
            "background",
            {
                "kind": "studio",
                "zenith": {"source": "D65", "luminance_cd_m2": zenith_cd_m2},
                "nadir": {"source": "D65", "luminance_cd_m2": nadir_cd_m2},
            },
            "soft boxes are what glass and polished plastic have to show",
        ),
    ]


def point_light(name: str, source: str, luminance_cd_m2: float, position_mm: Point) -> Table:
    """Return a point light of method hall: the luminance of a perfect reflector that faces it."""
    values = {
        "kind": "point",
        "name": name,
        "source": source,
        "luminance_cd_m2": luminance_cd_m2,
        "position_mm": [float(x) for x in position_mm],
    }
    return Table("lights", values, many=True)


def sphere_light(
    name: str, source: str, luminance_cd_m2: float, centre_mm: Point, radius_mm: float
) -> Table:
    """Return a small luminous sphere of method hall."""
    values = {
        "kind": "sphere",
        "name": name,
        "source": source,
        "luminance_cd_m2": luminance_cd_m2,
        "centre_mm": [float(x) for x in centre_mm],
        "radius_mm": radius_mm,
    }
    return Table("lights", values, many=True)


def table_top(y_mm: float, material: str, *, front_mm: float) -> Table:
    """Return the table that the lamp stands on: a disc to far behind, ``front_mm`` to before it.

    It ends close before the lamp, so that the lamp's front shows the room rather than the table.
    """
    radius = 4000.0
    values = {"name": "table", "kind": "disc", "centre_mm": [0.0, y_mm, front_mm - radius]}
    more = {"normal": [0.0, 1.0, 0.0], "radius_mm": radius, "material": material}
    return Table("objects", {**values, **more}, many=True)


def laboratory(
    functions: Sequence[dict[str, TomlValue]] = (), reflectors: Sequence[dict[str, TomlValue]] = ()
) -> list[Table]:
    """Return how the lamp is measured: along its axis, without the table, from far away."""
    measure = {"axis": [0.0, 0.0, 1.0], "leave_out": ["table"]}
    return [
        Table("measure", measure, "photometry: the axis points to the observer"),
        *(Table("measure.functions", own, many=True) for own in functions),
        *(Table("measure.reflectors", own, many=True) for own in reflectors),
    ]


def hall(contribution_limit: float) -> Table:
    """Return how far rays are followed."""
    return Table(
        "hall",
        {"max_depth": 12, "contribution_limit": contribution_limit},
        "method hall: a ray that can add less than this share is not followed",
    )

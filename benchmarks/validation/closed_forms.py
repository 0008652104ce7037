# SPDX-License-Identifier: Apache-2.0 OR MIT
"""T1 to T6 and T10: what paper and pencil say of light, asked of whole renders by `path`.

The estimates are means over a small picture; their standard errors come from eight seeds.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

import lamplit as ll
from lamplit.colour.tristimulus import chromaticity_xy, tristimulus
from lamplit.materials.optics import fresnel_reflectances
from lamplit.scene import parse_scene
from validation.registry import Finding, case

GROUP = "Closed forms and published values"
Table: TypeAlias = dict[str, Any]

SEEDS = range(1, 9)
WHITE_CD_M2 = 100.0
EVEN: Table = {"kind": "constant", "source": "E", "luminance_cd_m2": WHITE_CD_M2}
BLACK: Table = {"kind": "constant", "source": "E", "luminance_cd_m2": 0.0}


def glass(index: float, **more: object) -> Table:
    """Return a clear body without dispersion."""
    return {"kind": "dielectric", "refractive_index": index, **more}


def looking(origin: tuple[float, ...], target: tuple[float, ...], height_mm: float) -> Table:
    """Return a camera of parallel rays."""
    up = [1.0, 0.0, 0.0] if abs(target[1] - origin[1]) > abs(target[2] - origin[2]) else [0, 1, 0]
    return {
        "kind": "orthographic",
        "position_mm": list(origin),
        "target_mm": list(target),
        "up": [float(part) for part in up],
        "height_mm": height_mm,
    }


def luminance(
    objects: list[Table],
    materials: Mapping[str, Table],
    camera: Table,
    background: Table,
    samples: int,
) -> tuple[float, float]:
    """Return the mean luminance over the picture and its standard error, in cd/m²."""
    written: Table = {
        "lamplit": 1,
        "camera": camera,
        "image": {"width": 8, "height": 8, "samples": samples, "filter": "box"},
        "path": {"max_depth": 4000},
        "background": background,
        "materials": dict(materials),
        "objects": [{"name": f"body-{at}", **own} for at, own in enumerate(objects)],
    }
    scene = parse_scene(written, root=Path())
    means = [
        ll.render(
            scene.changed(image=scene.image.model_copy(update={"seed": seed})), method="path"
        ).luminance_cd_m2.mean()
        for seed in SEEDS
    ]
    return float(np.mean(means)), float(np.std(means, ddof=1) / np.sqrt(len(means)))


@case(
    "bouguer-beer",
    title="T1: 3 mm of matter that transmits 0.9 a mm",
    source="Bouguer–Beer: 0.9³; reflections by R = ((n − 1)/(n + 1))²",
    group=GROUP,
)
def bouguer_beer() -> Iterator[Finding]:
    """A plate between plates of the same index, seen straight on: no reflection but outside."""
    transmits = {"value": 0.9, "thickness_mm": 1.0}
    materials = {"dye": glass(1.0, internal_transmittance=transmits)}
    for scale in (1.0, 1e-2, 1e3):
        # The same optical depth at any size of the world: thickness as it is, area scaled.
        wide = 50.0 * max(scale, 1.0)
        plate = {
            "kind": "box",
            "material": "dye",
            "min_mm": [-wide, -wide, 0.0],
            "max_mm": [wide, wide, 3.0],
        }
        camera = looking((0.0, 0.0, 200.0), (0.0, 0.0, 0.0), 10.0 * min(scale, 1.0))
        got, sigma = luminance([plate], materials, camera, EVEN, 32)
        share = got / WHITE_CD_M2
        yield Finding(f"T of 3 mm, plate of {2 * wide:g} mm", 0.729, share, sigma / 100, 0.729e-6)


@case(
    "slab",
    title="T4: clear absorbing plate",
    source="T = (1 − R)²τ/(1 − R²τ²), R the mean of s and p: walks are unpolarised",
    group=GROUP,
)
def slab() -> Iterator[Finding]:
    """All inter-reflections, from 0 to 80 degrees."""
    index, per_mm, thickness = 1.5, 0.9, 2.0
    transmits = {"value": per_mm, "thickness_mm": 1.0}
    materials = {
        "glass": glass(index, internal_transmittance=transmits),
        "lamp": {"kind": "diffuse", "reflectance": 0.0},
    }
    # A black room with one bright wall behind the plate: what is reflected sees nothing.
    wall = {
        "kind": "disc",
        "material": "lamp",
        "centre_mm": [0.0, 0.0, -50.0],
        "normal": [0.0, 0.0, 1.0],
        "radius_mm": 5e4,
        "emission": {"source": "E", "luminance_cd_m2": WHITE_CD_M2},
    }
    plate = {
        "kind": "box",
        "material": "glass",
        "min_mm": [-4e3, -4e3, 0.0],
        "max_mm": [4e3, 4e3, thickness],
    }
    for angle_deg in (0.0, 20.0, 40.0, 60.0, 70.0, 80.0):
        angle = np.radians(angle_deg)
        eye = (400.0 * float(np.sin(angle)), 0.0, thickness + 400.0 * float(np.cos(angle)))
        camera = looking(eye, (0.0, 0.0, thickness), 1.0)
        got, sigma = luminance([wall, plate], materials, camera, BLACK, 256)
        cos_inside = np.sqrt(1.0 - (np.sin(angle) / index) ** 2)
        tau = per_mm ** (thickness / cos_inside)
        mean_r = float(np.mean([float(r) for r in fresnel_reflectances(index, angle_deg)]))
        expected = (1.0 - mean_r) ** 2 * tau / (1.0 - (mean_r * tau) ** 2)
        share, error = got / WHITE_CD_M2, sigma / WHITE_CD_M2
        yield Finding(f"T at {angle_deg:g}°", float(expected), share, error, 1e-6)


@case(
    "furnace",
    title="T5: furnace",
    source="lossless matter in even light is invisible",
    group=GROUP,
)
def furnace() -> Iterator[Finding]:
    """Closed glass, smooth, rough, nested and turbid, and white matter, in even light."""
    outer = {"kind": "sphere", "centre_mm": [0.0, 0.0, 0.0], "radius_mm": 10.0}
    inner = {**outer, "radius_mm": 6.0, "priority": 1}
    turbid = {"coefficient_per_mm": 0.1, "anisotropy": 0.5}
    bodies: dict[str, tuple[list[Table], dict[str, Table]]] = {
        f"glass ball, α = {alpha:g}": (
            [{**outer, "material": "a"}],
            {"a": glass(1.5, roughness=alpha)},
        )
        for alpha in (0.0, 0.1, 0.3, 0.6, 1.0)
    }
    bodies["ball in a ball, α = 0 in 0.2"] = (
        [{**outer, "material": "a"}, {**inner, "material": "b"}],
        {"a": glass(1.5, roughness=0.2), "b": glass(1.7)},
    )
    bodies["turbid ball"] = ([{**outer, "material": "a"}], {"a": glass(1.5, scattering=turbid)})
    white = {"kind": "mirror", "reflectance": 1.0, "roughness": 0.5}
    bodies["rough white mirror, α = 0.5"] = ([{**outer, "material": "a"}], {"a": white})
    for name, (objects, materials) in bodies.items():
        camera = looking((0.0, 0.0, 100.0), (0.0, 0.0, 0.0), 22.0)
        got, sigma = luminance(objects, materials, camera, EVEN, 256)
        yield Finding(name, 1.0, got / WHITE_CD_M2, sigma / WHITE_CD_M2, 1e-3)


@case(
    "cube",
    title="T6: closed matt cube of 4 m with 10 000 lm",
    source="E_indirect = 104.17·ρ/(1 − ρ) lx (CIE 171:2006, 5.8)",
    group=GROUP,
)
def cube() -> Iterator[Finding]:
    """The mean indirect illuminance of the walls round a lamp that is small, white and bright."""
    for rho in (0.2, 0.5, 0.8):
        room: list[Table] = [
            {
                "kind": "plane",
                "material": "wall",
                "point_mm": [2000.0 * sign * float(axis == k) for k in range(3)],
                "normal": [-sign * float(axis == k) for k in range(3)],
            }
            for axis in range(3)
            for sign in (1.0, -1.0)
        ]
        lamp = {
            "kind": "sphere",
            "material": "white",
            "centre_mm": [0.0, 0.0, 0.0],
            "radius_mm": 10.0,
            "emission": {"source": "E", "flux_lm": 10_000.0},
        }
        materials = {
            "wall": {"kind": "diffuse", "reflectance": rho},
            "white": {"kind": "diffuse", "reflectance": 1.0},
        }
        # The whole of one wall, from just behind the lamp.
        camera = looking((0.0, 0.0, -11.0), (0.0, 0.0, -2000.0), 4000.0)
        got, sigma = luminance([*room, lamp], materials, camera, BLACK, 1024)
        illuminance = got * np.pi / rho
        expected = 10_000.0 / (6 * 16.0) / (1.0 - rho)
        yield Finding(
            f"E, direct and indirect, ρ = {rho:g}",
            expected,
            illuminance,
            sigma * np.pi / rho,
            0.005 * expected,
            "lx",
        )


@case(
    "sources",
    title="T2: chromaticity",
    source="CIE 15:2018, table of illuminants, 1931 observer",
    group=GROUP,
)
def sources() -> Iterator[Finding]:
    """The printed chromaticities of standard illuminants."""
    printed = {"A": (0.4476, 0.4074), "D65": (0.3127, 0.3290), "E": (0.3333, 0.3333)}
    scene = parse_scene(
        {
            "lamplit": 1,
            "camera": looking((0.0, 0.0, 9.0), (0.0, 0.0, 0.0), 1.0),
            "objects": [
                {
                    "name": "ball",
                    "kind": "sphere",
                    "material": "bk7",
                    "centre_mm": [0.0, 0.0, 0.0],
                    "radius_mm": 1.0,
                }
            ],
        },
        root=Path(),
    )
    for name, (x, y) in printed.items():
        xyz = tristimulus(
            scene.resolve_source(name), normalisation="relative", range_nm=(360.0, 830.0)
        )
        got = chromaticity_xy(xyz)
        yield Finding(f"x of {name}", x, float(got[0]), tolerance=5e-5)
        yield Finding(f"y of {name}", y, float(got[1]), tolerance=5e-5)


@case(
    "limits",
    title="T10: limits",
    source="α → 0 is smooth; equal indices are no boundary",
    group=GROUP,
)
def limits() -> Iterator[Finding]:
    """The least roughness beside none, and glass in glass beside glass."""
    ball = {"kind": "sphere", "centre_mm": [0.0, 0.0, 0.0], "radius_mm": 10.0, "material": "a"}
    camera = looking((0.0, 0.0, 100.0), (0.0, 0.0, 0.0), 22.0)
    graded: Table = {
        "kind": "gradient",
        "zenith": {"source": "E", "luminance_cd_m2": 2.0 * WHITE_CD_M2},
        "nadir": {"source": "E", "luminance_cd_m2": 0.0},
    }
    smooth, sigma = luminance([ball], {"a": glass(1.5)}, camera, graded, 256)
    rough, error = luminance([ball], {"a": glass(1.5, roughness=1e-3)}, camera, graded, 256)
    yield Finding("ball, α = 0.001", smooth, rough, float(np.hypot(sigma, error)), unit="cd/m²")
    core = {**ball, "radius_mm": 6.0, "material": "b", "priority": 1}
    both = {"a": glass(1.5), "b": glass(1.5)}
    nested, error = luminance([ball, core], both, camera, graded, 256)
    got = float(np.hypot(sigma, error))
    yield Finding("ball in a ball of its index", smooth, nested, got, unit="cd/m²")

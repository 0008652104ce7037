# SPDX-License-Identifier: Apache-2.0 OR MIT
"""T6, T7 and T9: candela by paper and pencil, by the other way of walking, and before a rule."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

import lamplit as ll
from lamplit.engine import Plane
from lamplit.lamps import write_lamp
from lamplit.photometry.observed import Observed
from lamplit.rules import find_rule, judge
from lamplit.scene import Scene, parse_scene
from validation.closed_forms import looking
from validation.registry import Case, Finding, add, case

GROUP = "Candela"
Table: TypeAlias = dict[str, Any]

FLUX_LM = 460.0
_GRID = (np.arange(-90.0, 91.0, 15.0), np.arange(-90.0, 91.0, 15.0))


def _lamp(**shape: Any) -> Scene:
    """Return one black body that shines with 460 lm, with its axis along +z."""
    emission = {"source": "A", "flux_lm": FLUX_LM, **shape.pop("emission", {})}
    body = {"name": "source", "material": "black", "emission": emission, **shape}
    return parse_scene(
        {
            "lamplit": 1,
            "camera": looking((0.0, 0.0, 100.0), (0.0, 0.0, 0.0), 10.0),
            "materials": {"black": {"kind": "diffuse", "reflectance": 0.0}},
            "objects": [body],
            "measure": {"axis": [0.0, 0.0, 1.0]},
        },
        root=Path(),
    )


def _disc() -> Scene:
    return _lamp(kind="disc", centre_mm=[0, 0, 0], normal=[0, 0, 1], radius_mm=1.0)


@case(
    "isotropic",
    title="T6: ball of 460 lm",
    source="I = Φ/4π to every side",
    group=GROUP,
)
def isotropic() -> Iterator[Finding]:
    """A ball with Lambert's law all over has the same intensity to all sides."""
    spots = [(0.0, 0.0), (60.0, 20.0), (-135.0, -40.0), (10.0, 85.0)]
    ball = _lamp(kind="sphere", centre_mm=[0, 0, 0], radius_mm=1.0)
    seen = ll.measure(ball, spots=spots, grid=_GRID, receiver_deg=10.0, paths=1 << 21).observed()
    for at, (h, v) in enumerate(spots):
        yield Finding(
            f"I at H {h:g}°, V {v:g}°",
            FLUX_LM / (4.0 * np.pi),
            float(seen.spot_cd[at]),
            float(seen.spot_standard_error_cd[at]),
            unit="cd",
        )


@case(
    "lambert",
    title="T6: matt disc of 460 lm",
    source="I = (Φ/π) cos θ; its mean over a cone of half angle r is (1 + cos r)/2 of that",
    group=GROUP,
)
def lambert() -> Iterator[Finding]:
    """On the axis I₀ = Φ/π, and the cosine beside it."""
    spots = [(0.0, 0.0), (30.0, 0.0), (-20.0, 40.0), (70.0, 0.0)]
    seen = ll.measure(_disc(), spots=spots, grid=_GRID, receiver_deg=8.0, paths=1 << 21).observed()
    mean = 0.5 * (1.0 + np.cos(np.radians(4.0)))
    for at, (h, v) in enumerate(spots):
        cosine = np.cos(np.radians(h)) * np.cos(np.radians(v))
        yield Finding(
            f"I at H {h:g}°, V {v:g}°",
            float(FLUX_LM / np.pi * cosine * mean),
            float(seen.spot_cd[at]),
            float(seen.spot_standard_error_cd[at]),
            unit="cd",
        )


@case(
    "inverse-square",
    title="T6: a wall before a matt disc of 460 lm",
    source="E = (Φ/π) cos⁴θ/d², over a pixel by Gauss–Legendre; the disc is small: (R/d)² = 10⁻⁶",
    group=GROUP,
)
def inverse_square() -> Iterator[Finding]:
    """1 m and 2 m away, in the middle and at the edge of a wall of 1 m by 1 m."""
    points, weights = np.polynomial.legendre.leggauss(8)
    for distance_mm in (1000.0, 2000.0):
        wall = Plane(
            centre_mm=(0, 0, distance_mm), normal=(0, 0, -1),
            width_mm=1000.0, height_mm=1000.0, columns=5, rows=5,
        )  # fmt: skip
        plane = ll.measure(_disc(), plane=wall, grid=_GRID, paths=1 << 21).plane_xyz
        if plane is None:
            raise AssertionError("a plane was asked for")
        lux = plane[:, :, :, :, 1].sum(axis=1)
        sigma = lux.std(axis=0, ddof=1) / np.sqrt(len(lux))
        for row, column in ((2, 2), (0, 0), (2, 4)):
            x = 200.0 * (column - 2) + 100.0 * points
            y = 200.0 * (row - 2) + 100.0 * points
            square = x[:, None] ** 2 + y[None, :] ** 2 + distance_mm**2
            local = FLUX_LM / np.pi * distance_mm**4 / square**2 / (1e-3 * distance_mm) ** 2
            yield Finding(
                f"E at {distance_mm / 1e3:g} m, row {row}, column {column}",
                float(weights @ local @ weights / 4.0),
                float(lux[:, row, column].mean()),
                float(sigma[row, column]),
                tolerance=1e-5,
                unit="lx",
            )


#: Both ways on the example lamps: where their beams are bright enough for the eye, in a minute.
_SPOTS = [(0.0, 0.0), (4.0, 0.0), (-4.0, 2.0), (0.0, -5.0)]
_LAMPS = ("p21w", "led-array")
#: From the light, and as many looks from all receivers together.
_PATHS = 1 << 20


def both_ways(lamp: str) -> Iterator[Finding]:
    """Compare candela walked from the light and from the eye of a receiver of 2°."""
    with tempfile.TemporaryDirectory(prefix="lamplit-both-ways-") as folder:
        scene = ll.load_scene(write_lamp(lamp, Path(folder), {"lit": True}))
        found = ll.measure(scene, spots=_SPOTS, grid=_GRID, receiver_deg=2.0, paths=_PATHS)
        check = found.cross_check()
    for at, (h, v) in enumerate(_SPOTS):
        sigma = float(np.hypot(check.light_standard_error_cd[at], check.eye_standard_error_cd[at]))
        apart, light_cd = float(check.sigmas[at]), float(check.light_cd[at])
        allowed = float(check.allowed[at])
        seen_percent = 100.0 * (allowed + 0.84) * sigma / light_cd
        yield Finding(
            f"I at H {h:g}°, V {v:g}°, from the eye and from the light",
            float(check.eye_cd[at]),
            light_cd,
            sigma,
            unit="cd",
            note=f"{abs(apart):.2f} σ apart, {allowed:.2f} allowed; a difference of "
            f"{seen_percent:.2g} % would be seen four times in five",
            passed=abs(apart) <= allowed,
        )


for _lamp_name in _LAMPS:
    add(
        Case(
            f"both-ways-{_lamp_name}",
            f"T7: {_lamp_name}, from the light and from the eye",
            "the other way of walking; Student's t, α = 0.01 over all points (Šidák)",
            GROUP,
            lambda name=_lamp_name: both_ways(name),
        )
    )

#: UN R148, 5.6 and Figure A3-I for S1, 60 cd: |H|, V, minimum in cd; and 62 cd cos²⁰θ there.
_S1 = (
    (5, 10, 12.0, 42.2966),
    (20, 5, 6.0, 16.5574),
    (10, 5, 12.0, 42.2966),
    (0, 5, 42.0, 57.4482),
    (10, 0, 21.0, 45.6479),
    (5, 0, 54.0, 57.4482),
    (0, 0, 60.0, 62.0),
    (20, -5, 6.0, 16.5574),
    (10, -5, 12.0, 42.2966),
    (0, -5, 42.0, 57.4482),
    (5, -10, 12.0, 42.2966),
)
#: Its σ: on the axis 62 ± 1.5 is 1.33 σ above 60; elsewhere 1.5 cd decide.
_SIGMA_CD = 1.5


@case(
    "verdict",
    title="T9: 62 cd cos²⁰θ before UN R148 S1",
    source="percentages of Figure A3-I times 60 cd, margins and outcomes by hand",
    group=GROUP,
)
def verdict() -> Iterator[Finding]:
    """Each point's limit and outcome, and that the verdict is never better than its worst point."""
    rule = find_rule("un-r148/S1")
    h, v = rule.spots()
    need = rule.field()
    edges_h = np.arange(need.h_deg[0], need.h_deg[1] + 0.5 * need.cell_deg, need.cell_deg)
    edges_v = np.arange(need.v_deg[0], need.v_deg[1] + 0.5 * need.cell_deg, need.cell_deg)
    middles = np.meshgrid(edges_h[:-1] + 0.5 * need.cell_deg, edges_v[:-1] + 0.5 * need.cell_deg)
    red = np.array([0.690 / 0.305, 1.0, 0.005 / 0.305])

    def law(h_deg: Any, v_deg: Any) -> Any:
        return 62.0 * np.abs(np.cos(np.radians(h_deg)) * np.cos(np.radians(v_deg))) ** 20

    cells = law(*middles)
    seen = Observed(
        name="stop",
        spot_h_deg=h,
        spot_v_deg=v,
        spot_xyz=law(h, v)[:, None] * red,
        spot_xyz_covariance=np.broadcast_to(_SIGMA_CD**2 * np.outer(red, red), (len(h), 3, 3)),
        grid_h_edges_deg=edges_h,
        grid_v_edges_deg=edges_v,
        grid_xyz=cells[..., None] * red,
        grid_standard_error_cd=0.001 * cells,
        paths=1 << 20,
    )
    said = judge(rule, seen)
    points = {
        (own.h_deg, own.v_deg): own
        for own in said.findings
        if own.requirement.startswith("minimum at ")
    }
    for size, at_v, least, cd in _S1:
        for at_h in {size, -size}:
            own = points[float(at_h), float(at_v)]
            expected = "undecided" if at_h == at_v == 0 else "pass"
            yield Finding(
                f"margin at H {at_h:g}°, V {at_v:g}°",
                100.0 * (cd - least) / least,
                own.margin_percent or 0.0,
                tolerance=0.002,
                unit="%",
                note=f"required {own.required:g} cd, {own.outcome}",
                passed=own.outcome == expected
                and own.required == least
                and abs((own.margin_percent or 0.0) - 100.0 * (cd - least) / least) <= 0.002,
            )
    axis = points[0.0, 0.0]
    yield Finding(
        "times as many paths that decide the axis",
        (2.0 * _SIGMA_CD / 2.0) ** 2,
        axis.paths_factor or 0.0,
        tolerance=1e-9,
        note="(2 σ/distance)²",
    )
    yield Finding(
        "findings that the verdict is better than",
        0.0,
        float(said.outcome == "pass"),
        tolerance=0.0,
    )

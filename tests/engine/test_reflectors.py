# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Retro-reflectors of known coefficients: matt discs, mirrors, perfect cube corners."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import lamplit as ll
from lamplit.engine import ReflexInterrupted, ReflexMeasurement, measure_reflector
from lamplit.rules import find_rule, judge_reflex
from lamplit.scene import Scene

Table = dict[str, Any]
Array = NDArray[np.float64]

ANGLES = [
    (v, h, observation)
    for v, h in ((0.0, 0.0), (10.0, 0.0), (-5.0, 20.0))
    for observation in (1.0 / 3.0, 40.0)
]


@pytest.fixture
def plate_of(scene_of: Callable[..., Scene]) -> Callable[..., Scene]:
    """Return a maker of scenes with one object, of index 1.5 or the given material."""

    def make(thing: Table, **material: Any) -> Scene:
        return scene_of(
            objects=[{"name": "plate", "material": "plate"} | thing],
            materials={"plate": material or {"kind": "dielectric", "refractive_index": 1.5}},
            measure={"axis": [0.0, 0.0, 1.0]},
        )

    return make


def disc(normal: Any = (0.0, 0.0, 1.0)) -> Table:
    """Return a disc of 20 mm radius in the origin."""
    own = {"kind": "disc", "centre_mm": [0.0, 0.0, 0.0], "radius_mm": 20.0}
    return own | {"normal": [float(part) for part in normal]}


def to_source(v_deg: float, h_deg: float) -> Array:
    v, h = np.radians([v_deg, h_deg])
    return np.array([np.sin(h) * np.cos(v), np.sin(v), np.cos(h) * np.cos(v)])


def to_receiver(v_deg: float, h_deg: float, observation_deg: float) -> Array:
    """Turn the light's direction about CIE's first axis, which is level and square to it."""
    source = to_source(v_deg, h_deg)
    first = np.cross(source, (0.0, 1.0, 0.0))
    first /= np.linalg.norm(first)
    angle = np.radians(observation_deg)
    return source * np.cos(angle) + np.cross(first, source) * np.sin(angle)


def of_a_cube(edge_mm: float, front_mm: float | None = None) -> tuple[Array, Array]:
    """Return three faces that meet at right angles in the origin and open to +z.

    With ``front_mm`` they close a hexagonal prism whose front lies at that z.
    """
    turn = np.radians([0.0, 120.0, 240.0])
    flat = np.sqrt(2.0 / 3.0)
    edges = np.stack([flat * np.cos(turn), flat * np.sin(turn), np.full(3, 1 / np.sqrt(3.0))], 1)
    rim = [part for k in range(3) for part in (edges[k], edges[k] + edges[(k + 1) % 3])]
    points = edge_mm * np.array([np.zeros(3), *rim])
    faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 6], [0, 6, 1]]
    if front_mm is not None:
        front = points.copy()
        front[:, 2] = front_mm
        points = np.concatenate([points, front])
        for k in range(6):
            here, there = 1 + k, 1 + (k + 1) % 6
            faces += [[here, here + 7, there + 7], [here, there + 7, there]]
            faces.append([7, there + 7, here + 7])
    return points, np.array(faces)


def test_a_matt_disc_has_the_coefficient_of_lambert_at_every_pair_of_angles(
    plate_of: Callable[..., Scene],
) -> None:
    """R = ρ A cos β cos (observation direction)/π, in cd/lx."""
    scene = plate_of(disc(), kind="diffuse", reflectance=0.8)
    found = measure_reflector(scene, ANGLES, receiver_deg=8.0, paths=1 << 20)
    assert len(found.readings) == len(ANGLES)
    for reading in found.readings:
        pair = reading.entrance_v_deg, reading.entrance_h_deg
        source, receiver = to_source(*pair), to_receiver(*pair, reading.observation_deg)
        # The mean of a cosine over a cone is that of its axis times (1 + cos r)/2.
        share = (1.0 + np.cos(np.radians(4.0))) / 2.0
        expected = 1000.0 * 0.8 * np.pi * 0.02**2 * source[2] * receiver[2] * share / np.pi
        error = reading.standard_error_mcd_per_lx
        assert error < 0.02 * expected
        assert abs(reading.cil_mcd_per_lx - expected) < 3.5 * error
    assert found.paths == 3 << 20


def test_no_lumen_of_the_beam_is_lost(plate_of: Callable[..., Scene]) -> None:
    scene = plate_of(disc(), kind="diffuse", reflectance=0.8)
    found = measure_reflector(scene, [(-5.0, 20.0, 0.2)], paths=1 << 16)
    (part,) = found.parts
    ledger = part.ledger
    assert abs(ledger.gap) < 1e-9 * ledger.emitted
    # 1 lx on the disc aslant, of which a fifth stays there.
    stays = 0.2 * np.pi * 0.02**2 * to_source(-5.0, 20.0)[2]
    assert ledger.absorbed["plate"] == pytest.approx(stays, rel=0.01)
    ends = ledger.out + sum(ledger.absorbed.values()) + ledger.chance + ledger.lost
    assert ends + ledger.cut_by_depth == pytest.approx(ledger.emitted, rel=1e-9)


@pytest.mark.parametrize("entrance", [(0.0, 0.0), (10.0, 0.0), (5.0, -20.0)])
def test_the_receiver_stands_above_the_light(
    plate_of: Callable[..., Scene], entrance: tuple[float, float]
) -> None:
    """A mirror half way between them shows the source to the receiver, and to none below it."""
    both = to_source(*entrance) + to_receiver(*entrance, 1.0 / 3.0)
    scene = plate_of(disc(both), kind="mirror", reflectance=0.9)
    angles = [(*entrance, 1.0 / 3.0), (*entrance, 1.0), (*entrance, 0.0)]
    found = measure_reflector(scene, angles, source_deg=0.2, receiver_deg=0.1, paths=1 << 16)
    seen, farther, below = found.readings
    # The luminance of a disc of 0.1° half angle that gives 1 lx, mirrored.
    area = np.pi * 0.02**2 * np.cos(np.radians(1.0 / 6.0))
    expected = 1000.0 * 0.9 * area / (np.pi * np.sin(np.radians(0.1)) ** 2)
    assert abs(seen.cil_mcd_per_lx - expected) < 3.5 * seen.standard_error_mcd_per_lx
    assert seen.standard_error_mcd_per_lx < 0.02 * expected
    assert farther.cil_mcd_per_lx == below.cil_mcd_per_lx == 0.0


def test_three_mirrors_at_right_angles_send_all_light_back_to_its_source(
    plate_of: Callable[..., Scene], write_ply: Callable[..., str]
) -> None:
    """All of a hexagon of √3 a² comes back after three reflections, and nothing at 20′."""
    file = write_ply("cube.ply", *of_a_cube(10.0))
    scene = plate_of({"kind": "mesh", "file": file, "unit": "mm"}, kind="mirror", reflectance=0.9)
    asked = [(0.0, 0.0, 0.0), (0.0, 0.0, 1.0 / 3.0)]
    found = measure_reflector(scene, asked, source_deg=0.02, receiver_deg=0.021, paths=1 << 17)
    on_source, beside = found.readings
    solid_angle = 2.0 * np.pi * (1.0 - np.cos(np.radians(0.0105)))
    lumens, error = (
        value * solid_angle / 1000.0
        for value in (on_source.cil_mcd_per_lx, on_source.standard_error_mcd_per_lx)
    )
    expected = 0.9**3 * np.sqrt(3.0) * 0.01**2
    # At its rim, one in 2000 walks off by the source's width.
    assert abs(lumens - expected) < 3.5 * error + 1e-3 * expected
    assert error < 5e-3 * expected
    assert beside.cil_mcd_per_lx == 0.0


def test_a_perfect_cube_of_glass_loses_what_it_absorbs_alone(
    plate_of: Callable[..., Scene], write_ply: Callable[..., str]
) -> None:
    """F + (1 − F)² τ/(1 − F τ): every way through has twice the depth, and three total mirrors."""
    file = write_ply("cube.ply", *of_a_cube(10.0, front_mm=15.0))
    thing = {"kind": "mesh", "file": file, "unit": "mm"}
    inside = {"thickness_mm": 30.0, "value": 0.6}
    scene = plate_of(thing, kind="dielectric", refractive_index=1.5, internal_transmittance=inside)
    asked = [(0.0, 0.0, 0.0), (0.0, 0.0, 1.0 / 3.0)]
    found = measure_reflector(scene, asked, source_deg=0.02, receiver_deg=0.021, paths=1 << 17)
    on_source, beside = found.readings
    solid_angle = 2.0 * np.pi * (1.0 - np.cos(np.radians(0.0105)))
    lumens = on_source.cil_mcd_per_lx * solid_angle / 1000.0
    error = on_source.standard_error_mcd_per_lx * solid_angle / 1000.0
    face = 0.04
    share = face + (1.0 - face) ** 2 * 0.6 / (1.0 - 0.6 * face)
    expected = share * np.sqrt(3.0) * 0.01**2
    assert abs(lumens - expected) < 3.5 * error + 1e-3 * expected
    assert error < 5e-3 * expected
    assert beside.cil_mcd_per_lx == 0.0


def test_no_light_is_nought_with_an_upper_bound_and_never_passes(
    plate_of: Callable[..., Scene],
) -> None:
    scene = plate_of(disc((0.0, 1.0, 1.0)), kind="mirror", reflectance=0.9)
    rule = find_rule("un-r150/IA", root=None)
    found = measure_reflector(scene, rule.reflex_angles(), paths=1 << 12)
    assert found.relative_error == float("inf")
    # One path brings its share of 1 lx over the sphere round the disc: √3 or so of its radius.
    half = np.array([20.0, 20.0 / np.sqrt(2.0), 20.0 / np.sqrt(2.0)])
    flux = np.pi * float(half @ half) * 1e-6
    solid_angle = 2.0 * np.pi * (1.0 - np.cos(np.radians(1.0 / 12.0)))
    # 2 σ reach what no hit leaves open with 97.7 %: −ln(1 − 0.97725) hits.
    bound = -0.5 * np.log(1.0 - 0.97725) * 1000.0 * flux / 4096 / solid_angle
    for reading in found.readings:
        assert reading.cil_mcd_per_lx == 0.0
        assert reading.standard_error_mcd_per_lx == pytest.approx(bound, rel=0.01)
    verdict = judge_reflex(rule, found.readings)
    outcomes = {finding.required: finding.outcome for finding in verdict.findings}
    assert "pass" not in outcomes.values()
    assert verdict.outcome != "pass"


def test_it_goes_on_until_it_is_enough_and_does_not_depend_on_threads(
    plate_of: Callable[..., Scene],
) -> None:
    scene = plate_of(disc(), kind="diffuse", reflectance=0.8)
    asked: Table = {"receiver_deg": 8.0}
    found = measure_reflector(scene, ANGLES, error=0.05, **asked)
    assert found.complete
    assert 0.01 < found.relative_error <= 0.05
    short = measure_reflector(scene, ANGLES, error=1e-4, paths=1 << 12, **asked)
    assert not short.complete
    assert short.paths == 3 << 12
    seen: list[int] = []

    def enough(so_far: ReflexMeasurement) -> bool:
        seen.append(so_far.paths)
        return len(seen) == 2

    assert measure_reflector(scene, ANGLES, until=enough, **asked).paths == seen[-1] > seen[0]
    timed = measure_reflector(scene, ANGLES, time_s=0.5, **asked)
    assert timed.complete
    assert all(part.paths > 0 for part in timed.parts)
    assert timed.elapsed_s < 4.0
    one, two = (
        measure_reflector(scene, ANGLES, paths=1 << 12, threads=threads, **asked).readings
        for threads in (1, 2)
    )
    assert one == two


def test_ctrl_c_keeps_what_was_walked(plate_of: Callable[..., Scene]) -> None:
    def interrupt(_done: int, _total: int) -> None:
        raise KeyboardInterrupt

    scene = plate_of(disc(), kind="diffuse", reflectance=0.8)
    with pytest.raises(ReflexInterrupted) as caught:
        measure_reflector(scene, ANGLES, time_s=60.0, progress=interrupt)
    found = caught.value.measurement
    assert found.interrupted
    assert not found.complete
    assert len(found.readings) == len(ANGLES)


def test_what_cannot_be_measured_is_told_in_one_line(
    plate_of: Callable[..., Scene], scene_of: Callable[..., Scene]
) -> None:
    scene = plate_of(disc(), kind="diffuse", reflectance=0.8)
    cases: list[tuple[Any, Table, str]] = [
        ([], {}, "no entrance angles"),
        ([(90.0, 0.0, 0.2)], {}, "entrance angles lie within ±90°"),
        ([(0.0, float("nan"), 0.2)], {}, "entrance angles lie within ±90°"),
        ([(0.0, 0.0, -0.2)], {}, "observation"),
        ([(0.0, 0.0, 0.2)], {"source_deg": 0.0}, "a source subtends more than 0°"),
        ([(0.0, 0.0, 0.2)], {"receiver_deg": 11.0}, "a receiver subtends more than 0°"),
        ([(0.0, 0.0, 0.2)], {"paths": 0}, "1 path or more"),
        ([(0.0, 0.0, 0.2)], {"error": 2.0}, "target error"),
    ]
    for angles, options, said in cases:
        with pytest.raises(ll.LamplitError, match=said):
            measure_reflector(scene, angles, **options)
    objects = [disc() | {"name": "plate", "material": "black-abs"}]
    with pytest.raises(ll.LamplitError, match="axis is not given"):
        measure_reflector(scene_of(objects=objects), [(0.0, 0.0, 0.2)])


def test_a_scene_names_its_reflectors_once_and_within_limits(
    scene_of: Callable[..., Scene],
) -> None:
    objects = [disc() | {"name": "plate", "material": "black-abs"}]
    measure: Table = {"axis": [0.0, 0.0, 1.0]}
    cases = [
        ({"reflectors": [{"name": "a"}, {"name": "a"}]}, r"reflectors\[1\]\.name.*too"),
        ({"functions": [{"name": "a"}], "reflectors": [{"name": "a"}]}, r"reflectors\[0\]\.name"),
        ({"reflectors": [{"name": "a", "source_deg": 5.0}]}, "source_deg"),
        ({"reflectors": [{"name": "a", "observation_deg": []}]}, "observation_deg"),
        ({"reflectors": [{"name": "a", "entrance_deg": [[0.0, 95.0]]}]}, "entrance_deg"),
        ({"reflectors": [{"name": "a", "rules": "un-r150/IA"}]}, "rules"),
    ]
    for more, said in cases:
        with pytest.raises(ll.LamplitError, match=said):
            scene_of(objects=objects, measure=measure | more)

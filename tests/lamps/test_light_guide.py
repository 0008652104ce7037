# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The light guide's notches turn light forward, its bow is an arc, and no light is cut off."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

import lamplit as ll
from lamplit.engine.measurement import Measurement
from lamplit.lamps import write_lamp
from lamplit.lamps.rod import Bow
from lamplit.scene.methods import PathSettings
from lamplit.scene.objects import Disc

#: What a light guide may lose to the limit on its walks' length.
MOST_CUT = 1e-3


def rod_of(folder: Path, **settings: object) -> trimesh.Trimesh:
    scene = write_lamp("light-guide", folder, {"triangles": 40_000, **settings})
    mesh = trimesh.load_mesh(scene.parent / "rod.ply")
    assert isinstance(mesh, trimesh.Trimesh)
    return mesh


@pytest.mark.parametrize("angle_deg", [40.0, 45.0, 52.0])
def test_a_notch_turns_light_along_the_rod_by_twice_its_angle(
    angle_deg: float, tmp_path: Path
) -> None:
    """Mirrored at a side that is tilted by α, a ray along x leaves at 2 α from it, to the front."""
    rod = rod_of(tmp_path, notch_angle_deg=angle_deg)
    normals = rod.face_normals
    along = np.abs(normals[:, 0])
    sides = normals[(along > 0.05) & (along < 0.999)]
    sides = sides[np.abs(sides[:, 1]) < 1e-5]
    assert len(sides) > 1000
    ray = np.sign(sides[:, :1]) * (1.0, 0.0, 0.0)
    out = ray - 2.0 * np.sum(ray * sides, axis=1)[:, None] * sides
    turned = np.degrees(np.arccos(np.sum(ray * out, axis=1)))
    assert turned == pytest.approx(np.full(len(sides), 2.0 * angle_deg), abs=0.1)
    assert (out[:, 2] > 0.9).all()


def test_notches_grow_with_the_distance_from_the_leds(tmp_path: Path) -> None:
    both = rod_of(tmp_path / "both", notch_depth_mm=0.6)
    one = rod_of(tmp_path / "one", notch_depth_mm=0.6, leds="one")

    def depth(rod: trimesh.Trimesh, x: float) -> float:
        near = np.abs(rod.vertices[:, 0] - x) < 3.1
        back = near & (np.abs(rod.vertices[:, 1]) < 0.5) & (rod.vertices[:, 2] < 0.0)
        return float(np.ptp(rod.vertices[back, 2]))

    assert depth(both, 0.0) == pytest.approx(0.6, abs=0.01)
    assert depth(both, -130.0) == pytest.approx(depth(both, 130.0))
    assert depth(both, -130.0) < 0.26
    assert depth(one, -130.0) < depth(one, 0.0) < depth(one, 130.0)


def test_a_bow_is_an_arc_of_the_rods_length_and_as_high_as_asked() -> None:
    x = np.linspace(-140.0, 140.0, 20_001)
    line = Bow(280.0, 15.0).points(np.column_stack([x, np.zeros((x.size, 2))]))
    assert np.linalg.norm(np.diff(line, axis=0), axis=1).sum() == pytest.approx(280.0, rel=1e-6)
    assert np.ptp(line[:, 1]) == pytest.approx(15.0, rel=1e-9)
    assert line[:, 1].max() == pytest.approx(7.5)
    # Three points of a circle: chord c and height h give the radius c²/8h + h/2 everywhere.
    for part in (slice(0, 10_001), slice(5_000, 15_001), slice(10_000, 20_001)):
        one, two, three = line[part][[0, 5_000, 10_000]]
        chord = np.linalg.norm(three - one)
        height = np.linalg.norm(two - 0.5 * (one + three))
        assert chord**2 / (8.0 * height) + 0.5 * height == pytest.approx(650.7, rel=1e-3)


def test_each_led_looks_into_the_end_of_the_bent_rod(tmp_path: Path) -> None:
    settings = {"lit": True, "bow_mm": 20.0}
    rod = rod_of(tmp_path, **settings)
    scene = ll.load_scene(tmp_path / "scene.toml")
    faces = [thing for thing in scene.objects if thing.emission is not None]
    assert len(faces) == 2
    for face in faces:
        assert isinstance(face, Disc)
        start, way = np.array([face.centre_mm]), np.array([face.normal])
        hits, _, triangles = rod.ray.intersects_location(start, way, multiple_hits=False)
        assert np.linalg.norm(hits - start) == pytest.approx(0.38, abs=0.02)
        assert float(rod.face_normals[triangles[0]] @ way[0]) == pytest.approx(-1.0, abs=1e-3)


def measured(
    folder: Path, *, paths: int = 1 << 15, max_depth: int | None = None, **settings: object
) -> Measurement:
    path = write_lamp("light-guide", folder, {"triangles": 30_000, "lit": True, **settings})
    scene = ll.load_scene(path)
    if max_depth is not None:
        scene = scene.changed(path_settings=PathSettings(max_depth=max_depth))
    ahead = np.array([-5.0, 5.0])
    return ll.measure(scene, grid=(ahead, ahead), paths=paths, threads=2)


@pytest.mark.parametrize("leds", ["one", "both"])
def test_the_limit_of_depth_cuts_less_than_a_thousandth_of_the_flux(
    leds: str, tmp_path: Path
) -> None:
    ledger = measured(tmp_path, leds=leds).ledger
    assert ledger.cut_by_depth < MOST_CUT * ledger.emitted
    assert abs(ledger.gap) < 1e-9 * ledger.emitted
    assert ledger.out > 0.6 * ledger.emitted


def test_the_limit_that_other_scenes_have_would_cut_more(tmp_path: Path) -> None:
    ledger = measured(tmp_path, max_depth=PathSettings().max_depth).ledger
    assert ledger.cut_by_depth > 2.0 * MOST_CUT * ledger.emitted


def test_even_in_the_clearest_longest_thinnest_rod_little_is_cut(tmp_path: Path) -> None:
    settings = {"length_mm": 400, "diameter_mm": 6, "notch_depth_mm": 0.1, "notch_pitch_mm": 10}
    ledger = measured(tmp_path, paths=1 << 13, attenuation_db_per_m=0.05, **settings).ledger
    assert ledger.cut_by_depth < MOST_CUT * ledger.emitted


def test_it_is_as_bright_ahead_as_a_position_lamp_has_to_be(tmp_path: Path) -> None:
    """UN R148, R1: 4 cd or more on the axis, 17 cd at most; here over ±5°, σ about 5 %."""
    found = measured(tmp_path)
    assert found.scene.measure is not None
    assert found.scene.measure.functions[0].rule == "un-r148/R1"
    ahead = float(found.grid_xyz[..., 1].sum(axis=1).mean())
    assert 5.0 < ahead < 15.0

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What `check_scene` says of meshes, of bodies that meet, of spectra, and of memory."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
import trimesh

from lamplit.errors import LamplitError
from lamplit.scene import Finding, Scene, check_scene, memory_estimate, parse_scene
from lamplit.scene.memory import check_memory

Table = dict[str, object]


def scene_of(objects: Sequence[Table], root: Path, **more: object) -> Scene:
    """Return a scene of these objects, seen from afar; glass unless they name a material."""
    written: Table = {
        "lamplit": 1,
        "camera": {
            "kind": "orthographic",
            "position_mm": [100.0, 200.0, 5000.0],
            "target_mm": [0.0, 0.0, 0.0],
            "height_mm": 1000.0,
        },
        "background": {"kind": "constant", "source": "D65", "luminance_cd_m2": 100.0},
        "objects": [
            {"name": f"body-{i}", "material": "bk7", **own} for i, own in enumerate(objects)
        ],
    }
    return parse_scene(written | more, root=root)


def contacts(objects: Sequence[Table], root: Path) -> list[Finding]:
    """Return the findings about bodies that meet."""
    found = check_scene(scene_of(objects, root)).findings
    assert all(finding.level != "error" for finding in found), found
    return [f for f in found if any(w in f.message for w in ("touch", "overlap", "lies inside"))]


def box(low: Sequence[float], high: Sequence[float], **more: object) -> Table:
    """Return a box."""
    return {"kind": "box", "min_mm": list(low), "max_mm": list(high), **more}


def ball(centre: Sequence[float], radius: float, **more: object) -> Table:
    """Return a sphere."""
    return {"kind": "sphere", "centre_mm": list(centre), "radius_mm": radius, **more}


def mesh_box(root: Path, name: str, low: Sequence[float], high: Sequence[float]) -> Table:
    """Return a box as a mesh file."""
    mesh = trimesh.creation.box(bounds=np.array([low, high], dtype=np.float64))
    mesh.export(root / f"{name}.ply")
    return {"kind": "mesh", "file": f"{name}.ply", "unit": "mm"}


UNIT = ((0.0, 0.0, 0.0), (10.0, 10.0, 10.0))


@pytest.mark.parametrize(
    ("gap_mm", "says"),
    [(0.0, "touch"), (0.0009, "touch"), (0.01, None), (-0.1, "overlap"), (-0.01, "overlap")],
)
@pytest.mark.parametrize("form", ["box", "mesh"])
def test_a_micrometre_decides_whether_boxes_touch(
    gap_mm: float, says: str | None, form: str, tmp_path: Path
) -> None:
    low, high = (10.0 + gap_mm, -2.0, -2.0), (15.0, 12.0, 12.0)
    make: Callable[..., Table] = (
        (lambda name, a, b: mesh_box(tmp_path, name, a, b))
        if form == "mesh"
        else (lambda _name, a, b: box(a, b))
    )
    found = contacts([make("one", *UNIT), make("two", low, high)], tmp_path)
    if says is None:
        assert found == []
    else:
        assert len(found) == 1
        assert says in found[0].message
        assert "'body-0' and 'body-1'" in found[0].message


@pytest.mark.parametrize(("radius", "says"), [(10.0, "touch"), (9.9, None), (10.5, "overlap")])
def test_spheres_that_meet_in_one_point_are_found(
    radius: float, says: str | None, tmp_path: Path
) -> None:
    found = contacts([ball((0, 0, 0), 20.0), ball((0.0, 18.0, 24.0), radius)], tmp_path)
    assert [says in f.message for f in found] == ([] if says is None else [True])


def test_a_sphere_on_a_floor_touches_it(tmp_path: Path) -> None:
    floor: Table = {
        "kind": "plane",
        "point_mm": [0, -20, 0],
        "normal": [0, 2, 0],
        "material": "grey-18",
    }
    found = contacts([ball((3, 0, 4), 20.0), floor], tmp_path)
    assert [f.level for f in found] == ["notice"]
    assert contacts([ball((3, 0.1, 4), 20.0), floor], tmp_path) == []


def test_priorities_settle_an_overlap(tmp_path: Path) -> None:
    one, two = box(*UNIT), ball((10, 5, 5), 3.0)
    (unsettled,) = contacts([one, two], tmp_path)
    assert unsettled.level == "warning"
    assert "higher priority" in unsettled.message
    (settled,) = contacts([one, two | {"priority": 1}], tmp_path)
    assert settled.level == "notice"
    assert "'body-1' wins by priority" in settled.message


def test_a_body_within_a_stronger_one_will_not_be_seen(tmp_path: Path) -> None:
    outer, inner = box(*UNIT), ball((5, 5, 5), 3.0)
    (lost,) = contacts([outer | {"priority": 2}, inner], tmp_path)
    assert lost.level == "warning"
    assert "it will not be seen" in lost.message
    (kept,) = contacts([outer, inner | {"priority": 2}], tmp_path)
    assert kept.level == "notice"
    assert "'body-1' lies inside 'body-0'" in kept.message


def test_a_body_in_a_cavity_touches_nothing(tmp_path: Path) -> None:
    shell = trimesh.creation.icosphere(subdivisions=3, radius=10.0)
    hole = trimesh.creation.icosphere(subdivisions=3, radius=8.0)
    hole.invert()
    trimesh.util.concatenate([shell, hole]).export(tmp_path / "bulb.stl")
    bulb: Table = {"kind": "mesh", "file": "bulb.stl", "unit": "mm"}
    assert contacts([bulb, ball((0, 0, 0), 5.0)], tmp_path) == []
    (found,) = contacts([bulb, ball((0, 0, 0), 9.0)], tmp_path)
    assert "lies inside" in found.message or "overlap" in found.message


@pytest.mark.parametrize("kind", ["cylinder", "cone", "disc", "tetrahedron"])
def test_every_primitive_is_found_on_a_table(kind: str, tmp_path: Path) -> None:
    table = box((-50, -10, -50), (50, 0, 50))
    upright: Table = {"base_mm": [0, 0, 0], "axis": [0, 3, 0], "radius_mm": 7, "height_mm": 9}
    shapes: dict[str, Table] = {
        "cylinder": upright,
        "cone": upright,
        "disc": {
            "centre_mm": [0, 0, 0],
            "normal": [0, -1, 0],
            "radius_mm": 5,
            "material": "grey-18",
        },
        "tetrahedron": {"points_mm": [[0, 0, 0], [9, 0, 0], [0, 0, 9], [0, 9, 0]]},
    }
    own = {"kind": kind, **shapes[kind]}
    assert [f.message.count("touch") for f in contacts([table, own], tmp_path)] == [1]
    lifted = own | {"transform": {"translate_mm": [0, 0.1, 0]}}
    assert contacts([table, lifted], tmp_path) == []


def test_a_transform_moves_turns_and_scales_what_touches(tmp_path: Path) -> None:
    turned = box(
        (0, 0, 0),
        (1, 2, 3),
        transform={
            "scale": 2.0,
            "rotate_deg": [0, 0, 90],
            "translate_mm": [4, 0, 0],
        },
    )
    # Twice the size and turned about z, it fills x from 0 to 4 and y from 0 to 2.
    assert contacts([turned, box((-1, 0, 0), (0, 1, 1))], tmp_path)[0].message.count("touch") == 1
    assert contacts([turned, box((-1, 2.1, 0), (4, 3, 1))], tmp_path) == []


def test_a_report_names_every_fault_and_goes_on(tmp_path: Path) -> None:
    mesh = trimesh.creation.box()
    mesh.update_faces(np.arange(11))
    mesh.export(tmp_path / "open.ply")
    short = {"wavelengths_nm": [400, 500, 600], "values": [1, 1, 1]}
    report = check_scene(
        scene_of(
            [
                {"kind": "mesh", "file": "open.ply", "unit": "m"},
                {"kind": "plane", "point_mm": [0, -900, 0], "normal": [0, 1, 0]},
                {"kind": "mesh", "file": "open.ply", "unit": "mm", "material": "paint"},
            ],
            tmp_path,
            materials={"paint": {"kind": "diffuse", "reflectance": short}},
        )
    )
    assert not report.sound
    errors = [f for f in report.findings if f.level == "error"]
    assert [f.subject for f in errors] == [
        "materials.paint.reflectance",
        "objects[0]",
        "objects[1]",
    ]
    assert report.findings[: len(errors)] == tuple(errors)
    assert any(f.level == "notice" and "thin surface" in f.message for f in report.findings)


def test_what_nothing_uses_is_named(tmp_path: Path) -> None:
    led = {"led_peak_nm": 624, "led_fwhm_nm": 18}
    scene = scene_of(
        [ball((0, 0, 0), 10.0, material="paint")],
        tmp_path,
        materials={"paint": {"kind": "diffuse", "reflectance": 0.5}, "lens": {"library": "bk7"}},
        sources={"key": led, "fill": led, "copy": "D65"},
        ambient={"source": "key", "luminance_cd_m2": 1.0},
        image={"method": "hall"},
    )
    found = [(f.level, f.subject, f.message) for f in check_scene(scene).findings]
    assert found == [
        ("notice", "materials.lens", "nothing uses 'lens'"),
        ("notice", "sources.fill", "nothing uses 'fill'"),
        ("notice", "sources.copy", "nothing uses 'copy'"),
    ]


def test_a_mesh_in_the_wrong_unit_is_doubted(tmp_path: Path) -> None:
    trimesh.creation.box().export(tmp_path / "a.stl")
    own: Table = {"kind": "mesh", "file": "a.stl", "unit": "m", "scale": 1000.0}
    report = check_scene(scene_of([own], tmp_path))
    assert [f.level for f in report.findings] == ["warning"]
    assert "unit" in report.findings[0].message


def test_the_memory_estimate_counts_pixels_bands_and_triangles(tmp_path: Path) -> None:
    trimesh.creation.icosphere(subdivisions=4, radius=30.0).export(tmp_path / "a.stl")
    twice = [{"kind": "mesh", "file": "a.stl", "unit": "mm"}] * 2
    image = {"width": 1000, "height": 1000, "samples": 4}
    scene = scene_of(twice, tmp_path, image=image)
    estimate = memory_estimate(scene)
    assert estimate.triangles == 2 * 5120
    assert estimate.film_bytes == 144_000_000
    assert memory_estimate(scene, bands=10).film_bytes == 304_000_000
    assert memory_estimate(scene, layers=2).film_bytes == 416_000_000
    # The file is read once, and both copies are traced.
    assert estimate.meshes_bytes == 5120 * 12 + 2562 * 24
    assert estimate.tracer_bytes == 2 * 5120 * 100
    assert estimate.reading_bytes == 5120 * 520


def test_a_picture_larger_than_the_memory_is_refused_before_it_is_begun(tmp_path: Path) -> None:
    image = {"width": 1000, "height": 1000, "samples": 4}
    ball: Table = {"kind": "sphere", "centre_mm": [0.0, 0.0, 0.0], "radius_mm": 20.0}
    estimate = memory_estimate(scene_of([ball], tmp_path, image=image))
    check_memory(estimate, estimate.total_bytes)
    with pytest.raises(LamplitError, match=r"takes about .* GiB, and .* raise --max-memory"):
        check_memory(estimate, estimate.total_bytes - 1)

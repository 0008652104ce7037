# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Every lamp is written whole, closed, outward, apart, and as the scene schema wants it."""

from __future__ import annotations

import itertools
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree

from lamplit.errors import LamplitError, OutputError
from lamplit.lamps import lamp_names, lamp_parameters, write_lamp
from lamplit.scene import load_scene
from lamplit.scene.lighting import SphereLight
from lamplit.scene.objects import Disc
from lamplit.scene.shining import path_notices
from lamplit.spectra_spec import NamedSource

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

VARIANTS = [
    ("p21w", {}),
    ("p21w", {"triangles": 5_000}),
    ("p21w", {"triangles": 40_000, "squareness": 2.0, "width_mm": 100, "height_mm": 100}),
    (
        "p21w",
        {"triangles": 60_000, "squareness": 8.0, "pillow_pitch_mm": 3, "lens_colour": "amber"},
    ),
    (
        "p21w",
        {
            "triangles": 30_000,
            "width_mm": 240,
            "height_mm": 70,
            "focal_length_mm": 40,
            "lens_dome_radius_mm": 5000,
        },
    ),
    ("p21w", {"triangles": 30_000, "focal_length_mm": 40, "bulb_diameter_mm": 26.5, "lit": True}),
    ("p21w", {"triangles": 30_000, "pillow_pitch_mm": 20, "pillow_radius_mm": 16}),
    ("led-array", {}),
    ("led-array", {"triangles": 4_000}),
    ("led-array", {"triangles": 50_000, "optics": "cups", "layout": "4x3", "cover_colour": "red"}),
    ("led-array", {"triangles": 50_000, "pitch_mm": 12, "die_size_mm": 0.3, "lit": True}),
    ("led-array", {"triangles": 50_000, "pitch_mm": 40, "optics": "cups"}),
    ("led-array", {"triangles": 50_000, "optics": "none", "cover_optics": "pillows"}),
    (
        "led-array",
        {
            "triangles": 20_000,
            "optics": "none",
            "pitch_mm": 12,
            "die_size_mm": 1.4,
            "layout": "4x3",
        },
    ),
    (
        "led-array",
        {
            "triangles": 60_000,
            "optics": "cups",
            "pitch_mm": 40,
            "cover_optics": "pillows",
            "pillow_pitch_mm": 20,
            "pillow_radius_mm": 16,
            "cover_dome_radius_mm": 300,
        },
    ),
    ("light-guide", {}),
    ("light-guide", {"triangles": 4_000, "cover": "none", "leds": "one", "lit": True}),
    ("light-guide", {"triangles": 30_000, "bow_mm": 20, "cover": "red", "lit": True}),
    ("light-guide", {"triangles": 20_000, "length_mm": 60, "bow_mm": 5, "diameter_mm": 14}),
    (
        "light-guide",
        {
            "triangles": 90_000,
            "length_mm": 400,
            "diameter_mm": 12,
            "notch_depth_mm": 1.5,
            "notch_angle_deg": 30,
            "notch_pitch_mm": 5.5,
        },
    ),
    ("light-guide", {"triangles": 200_000, "diameter_mm": 6, "notch_depth_mm": 0.1}),
    ("retro", {}),
    ("retro", {"triangles": 4_000, "pitch_mm": 6}),
    ("retro", {"aperture": "triangular", "squareness": 2.0}),
    ("retro", {"pitch_mm": 10, "cube_error_arcmin": 60.0}),
    ("retro", {"aperture": "triangular", "pitch_mm": 1.5, "squareness": 8, "triangles": 200_000}),
]
IDS = [f"{name}-{k}" for k, (name, _) in enumerate(VARIANTS)]


def meshes_of(scene: Path) -> dict[str, trimesh.Trimesh]:
    return {
        entry["name"]: trimesh.load_mesh(scene.parent / entry["file"])
        for entry in tomllib.loads(scene.read_text())["objects"]
        if entry["kind"] == "mesh"
    }


@pytest.mark.parametrize(("name", "parameters"), VARIANTS, ids=IDS)
def test_every_body_is_closed_and_faces_outward(
    name: str, parameters: dict[str, object], tmp_path: Path
) -> None:
    for part, mesh in meshes_of(write_lamp(name, tmp_path, parameters)).items():
        edges, uses = np.unique(np.sort(mesh.edges, axis=1), axis=0, return_counts=True)
        assert len(edges) and (uses == 2).all(), part
        assert mesh.is_winding_consistent, part
        assert all(body.volume > 0.0 for body in mesh.split(only_watertight=False)), part
        assert mesh.area_faces.min() > 1e-7, part


@pytest.mark.parametrize(("name", "parameters"), VARIANTS, ids=IDS)
def test_parts_neither_touch_nor_overlap(
    name: str, parameters: dict[str, object], tmp_path: Path
) -> None:
    meshes = meshes_of(write_lamp(name, tmp_path, parameters))
    for (one, a), (two, b) in itertools.combinations(meshes.items(), 2):
        gaps = (np.maximum(a.bounds[0], b.bounds[0]) - np.minimum(a.bounds[1], b.bounds[1])).max()
        if gaps > 0.09:
            continue
        assert cKDTree(a.vertices).query(b.vertices)[0].min() > 0.19, (one, two)
        assert not _vertices_inside(a, b), (one, two)
        assert not _vertices_inside(b, a), (two, one)


def _vertices_inside(solid: trimesh.Trimesh, other: trimesh.Trimesh) -> bool:
    points = other.vertices[:: max(1, len(other.vertices) // 3000)]
    points = points[((points > solid.bounds[0]) & (points < solid.bounds[1])).all(axis=1)]
    return bool(len(points)) and bool(solid.contains(points).any())


@pytest.mark.parametrize(("name", "parameters"), VARIANTS, ids=IDS)
def test_the_scene_loads_without_notices(
    name: str, parameters: dict[str, object], tmp_path: Path
) -> None:
    scene = pytest.importorskip("lamplit.scene").load_scene(write_lamp(name, tmp_path, parameters))
    assert [entry.notices for entry in scene.resolved_objects() if entry.notices] == []


@pytest.mark.parametrize("name", ["p21w", "led-array", "light-guide", "retro"])
@pytest.mark.parametrize("wanted", [30_000, 200_000, 1_000_000])
def test_the_number_of_triangles_is_about_as_asked(name: str, wanted: int, tmp_path: Path) -> None:
    meshes = meshes_of(write_lamp(name, tmp_path, {"triangles": wanted}))
    assert 0.6 < sum(len(mesh.faces) for mesh in meshes.values()) / wanted < 1.6


def test_the_envelope_is_equally_thin_glass_all_over(tmp_path: Path) -> None:
    scene = write_lamp("p21w", tmp_path, {"bulb_glass_mm": 0.7})
    glass = meshes_of(scene)["envelope"]
    assert glass.volume / (0.5 * glass.area) == pytest.approx(0.7, rel=0.03)


def test_the_mirror_sends_light_of_the_filament_straight_ahead(tmp_path: Path) -> None:
    mirror = meshes_of(write_lamp("p21w", tmp_path, {"triangles": 400_000}))["reflector"]
    middles, normals = mirror.triangles_center, mirror.face_normals
    rays = middles / np.linalg.norm(middles, axis=1, keepdims=True)
    facing = (np.einsum("ij,ij->i", rays, normals) < -0.3) & (normals[:, 2] > 0.0)
    out = rays - 2.0 * np.einsum("ij,ij->i", rays, normals)[:, None] * normals
    assert facing.sum() > 10_000
    assert np.degrees(np.arccos(out[facing, 2].clip(-1, 1))).max() < 0.6


@pytest.mark.parametrize("aperture", ["hexagonal", "triangular"])
def test_the_faces_of_a_cube_corner_meet_at_right_angles(aperture: str, tmp_path: Path) -> None:
    settings = {"aperture": aperture, "triangles": 4_000, "cube_error_arcmin": 0.0}
    plate = meshes_of(write_lamp("retro", tmp_path, settings))["plate"]
    central = np.linalg.norm(plate.triangles_center[:, :2], axis=1) < 15.0
    slant = plate.face_normals[central & (plate.face_normals[:, 2] < 0.0)]
    assert len(slant) > 100
    assert np.abs(slant[:, 2] + 1.0 / np.sqrt(3.0)).max() < 1e-4
    kinds = np.unique(np.round(slant, 3), axis=0)
    products = np.abs(kinds @ kinds.T - np.eye(len(kinds)))
    right_angled = (products < 2e-3).sum(axis=1) - 1
    assert (right_angled >= 2).all()


@pytest.mark.parametrize(("aperture", "pitch_mm"), [("hexagonal", 2.0), ("triangular", 3.5)])
def test_faces_of_cube_corners_are_tilted_by_the_error_that_is_asked_for(
    aperture: str, pitch_mm: float, tmp_path: Path
) -> None:
    settings = {"aperture": aperture, "pitch_mm": pitch_mm, "triangles": 9_000}
    normals: list[np.ndarray] = []
    for error in (0.0, 12.0):
        scene = write_lamp(
            "retro", tmp_path / f"{error:g}", settings | {"cube_error_arcmin": error}
        )
        plate = meshes_of(scene)["plate"]
        central = (np.abs(plate.triangles_center[:, :2]) < (38.0, 20.0)).all(axis=1)
        normals.append(plate.face_normals[central & (plate.face_normals[:, 2] < -0.3)])
    true, tilted = normals
    assert len(true) == len(tilted) > 1000
    slant = np.abs(true[:, 2] + 1.0 / np.sqrt(3.0)) < 1e-3
    tilts = 60.0 * np.degrees(np.linalg.norm(true - tilted, axis=1))[slant]
    assert np.sqrt(np.mean(tilts**2)) == pytest.approx(12.0, rel=0.08)
    assert len(np.unique(tilts.round(2))) > 100


def test_errors_of_cube_corners_do_not_depend_on_how_finely_they_are_cut(tmp_path: Path) -> None:
    heights: list[np.ndarray] = []
    for triangles in (9_000, 90_000):
        settings = {"triangles": triangles, "cube_error_arcmin": 10.0}
        plate = meshes_of(write_lamp("retro", tmp_path / str(triangles), settings))["plate"]
        central = np.linalg.norm(plate.vertices[:, :2], axis=1) < 15.0
        heights.append(plate.vertices[central & (plate.vertices[:, 2] < -1.0)])
    coarse, fine = heights
    assert len(fine) > 3 * len(coarse) > 100
    assert cKDTree(fine).query(coarse)[0].max() < 1e-5


def test_a_reflector_names_the_rule_of_its_colour(tmp_path: Path) -> None:
    rules = {"red": "red", "amber": "amber", "clear": "colourless", "smoke": None}
    for colour, emits in rules.items():
        scene = load_scene(write_lamp("retro", tmp_path / colour, {"colour": colour}))
        assert scene.measure is not None
        (reflector,) = scene.measure.reflectors
        assert reflector.rule == (None if emits is None else f"un-r150/IA?emits={emits}")


def test_a_collimator_makes_the_light_of_its_die_parallel() -> None:
    from lamplit.lamps.emitters import Collimator

    profile, index = Collimator(8.0, 1.49).profile(400), 1.49
    bore = int(np.argmin(np.abs(profile[1:, 1]))) + 1
    outside = profile[bore + 1 : -2]
    for one, two in itertools.pairwise(outside[20:]):
        tangent = (two - one) / np.linalg.norm(two - one)
        middle, radius = 0.5 * (one + two), profile[bore, 0]
        low, high = 0.0, middle[1]
        for _ in range(60):
            z = 0.5 * (low + high)
            sine_in = z / np.hypot(radius, z)
            rise = (middle[1] - z) / np.hypot(middle[0] - radius, middle[1] - z)
            low, high = (z, high) if sine_in < index * rise else (low, z)
        inside = (middle - (radius, z)) / np.linalg.norm(middle - (radius, z))
        out = 2.0 * (inside @ tangent) * tangent - inside
        assert out[1] > 0.99995
        assert abs(inside[0] * tangent[1] - inside[1] * tangent[0]) > 1.0 / index**2 * 0.9


def test_a_lamp_is_generated_in_a_few_seconds(tmp_path: Path) -> None:
    start = time.perf_counter()
    write_lamp("p21w", tmp_path, {"triangles": 1_000_000})
    assert time.perf_counter() - start < 10.0


def test_the_paper_scene_needs_no_meshes(tmp_path: Path) -> None:
    scene = tomllib.loads(write_lamp("paper", tmp_path).read_text())
    assert [entry["kind"] for entry in scene["objects"]] == ["sphere", "tetrahedron", "plane"]
    assert [path.name for path in tmp_path.iterdir()] == ["scene.toml"]


def test_the_checker_floor_of_the_paper_scene_shows_no_moire(tmp_path: Path) -> None:
    """Sobol points turn moiré into fine noise, and even the farthest squares span pixels."""
    scene = tomllib.loads(write_lamp("paper", tmp_path).read_text())
    assert scene["image"]["sampling"] == "sobol"
    camera, floor = scene["camera"], scene["materials"]["floor"]
    view = np.subtract(camera["target_mm"], camera["position_mm"])
    down = np.arctan2(-view[1], np.hypot(view[0], view[2]))
    topmost = down - np.radians(camera["field_of_view_deg"] / 2.0)
    assert topmost > 0.0
    farthest_mm = camera["position_mm"][1] / np.sin(topmost)
    square_rad = floor["square_mm"] * np.sin(topmost) / farthest_mm
    pixel_rad = np.radians(camera["field_of_view_deg"]) / scene["image"]["height"]
    assert square_rad > 3.0 * pixel_rad


@pytest.mark.parametrize(("cover", "source"), [("smoke", "pc-amber-led"), ("red", "red-led-624")])
def test_the_dies_have_the_colour_that_they_shine_in(
    cover: str, source: str, tmp_path: Path
) -> None:
    settings = {"triangles": 4_000, "lit": True, "cover_colour": cover}
    scene = tomllib.loads(write_lamp("led-array", tmp_path, settings).read_text())
    dies = [light for light in scene["lights"] if light["kind"] == "sphere"]
    assert len(dies) == 12
    assert {light["source"] for light in dies} == {source}
    die = scene["materials"]["die"]["reflectance"]
    blue, yellow = (die["values"][die["wavelengths_nm"].index(nm)] for nm in (480, 580))
    assert (yellow > 5.0 * blue) == (source == "pc-amber-led")
    mask = {thing["name"]: thing["material"] for thing in scene["objects"]}["tray"]
    assert mask == "black-abs"


@pytest.mark.parametrize("name", ["p21w", "led-array", "light-guide"])
def test_a_lamp_shines_in_path_transport_only_where_it_is_lit(name: str, tmp_path: Path) -> None:
    for lit in (False, True):
        path = write_lamp(name, tmp_path, {"triangles": 4_000, "lit": lit})
        scene = tomllib.loads(path.read_text())
        assert scene["image"]["method"] == "auto"
        shining = [thing for thing in scene["objects"] if "emission" in thing]
        assert bool(shining) == lit
        assert any(light["kind"] == "sphere" for light in scene["lights"]) == lit


def test_the_filament_gives_the_flux_of_a_p21w(tmp_path: Path) -> None:
    scene = load_scene(write_lamp("p21w", tmp_path, {"triangles": 4_000, "lit": True}))
    (filament,) = (thing for thing in scene.resolved_objects() if thing.emission is not None)
    assert (filament.name, filament.kind) == ("filament", "mesh")
    assert filament.emission is not None
    assert (filament.emission.quantity, filament.emission.amount) == ("flux_lm", 460.0)
    assert float(filament.emission.spectrum(560.0)) == 100.0


@pytest.mark.parametrize(("cover", "source"), [("smoke", "pc-amber-led"), ("red", "red-led-624")])
def test_each_die_shines_forward_in_its_own_spectrum(
    cover: str, source: str, tmp_path: Path
) -> None:
    settings = {"triangles": 4_000, "lit": True, "cover_colour": cover, "die_size_mm": 0.8}
    scene = load_scene(write_lamp("led-array", tmp_path, settings))
    faces = [thing for thing in scene.objects if thing.emission is not None]
    lights = {light.name: light for light in scene.lights}
    assert len(faces) == 12
    for face in faces:
        assert isinstance(face, Disc)
        assert (face.normal, face.radius_mm) == ((0.0, 0.0, 1.0), 0.4)
        assert 0.0 < face.centre_mm[2] < 0.1
        hall = lights[face.name]
        assert isinstance(hall, SphereLight)
        assert face.centre_mm[:2] == hall.centre_mm[:2]
        assert face.emission is not None
        assert face.emission.source == NamedSource(source) == hall.source
        assert face.emission.group == "dies"
    assert len({face.emission.flux_lm for face in faces if face.emission is not None}) == 1


@pytest.mark.parametrize(
    ("name", "parameter", "part"),
    [("p21w", "reflector_roughness", "reflector"), ("led-array", "cover_roughness", "cover")],
)
def test_a_surface_is_as_rough_as_asked(
    name: str, parameter: str, part: str, tmp_path: Path
) -> None:
    for roughness in (0.0, 0.3):
        settings = {"triangles": 4_000, parameter: roughness}
        scene = load_scene(write_lamp(name, tmp_path / str(roughness), settings))
        (own,) = (thing for thing in scene.resolved_objects() if thing.name == part)
        assert getattr(own.material, "roughness", None) == roughness


def test_bare_dies_stand_out_of_a_white_floor(tmp_path: Path) -> None:
    settings = {"triangles": 20_000, "optics": "none", "die_size_mm": 1.0}
    path = write_lamp("led-array", tmp_path, settings)
    meshes = meshes_of(path)
    assert "collimators" not in meshes
    tray = load_scene(path).resolve_material("white-paint")
    assert tray.kind == "diffuse"
    materials = {own["name"]: own["material"] for own in tomllib.loads(path.read_text())["objects"]}
    assert materials["tray"] == "white-paint"
    inner = np.abs(meshes["tray"].vertices[:, :2]).max(axis=1) < 17.0
    floor = meshes["tray"].vertices[inner][:, 2].max()
    assert floor < meshes["dies"].vertices[:, 2].max()
    # Seen from straight ahead, nothing but the holes lets one look past the floor.
    start = np.array([[0.0, 0.0, 30.0], [8.5, 8.5, 30.0]])
    down = np.tile([0.0, 0.0, -1.0], (2, 1))
    assert meshes["tray"].ray.intersects_any(start, down).tolist() == [True, False]


@pytest.mark.parametrize("name", lamp_names())
def test_every_lamp_can_be_rendered_by_both_methods(name: str, tmp_path: Path) -> None:
    """Its surroundings shine for path transport; a key light and ambient light for Hall's."""
    scene = load_scene(write_lamp(name, tmp_path, {} if name == "paper" else {"triangles": 4_000}))
    assert scene.image.method == ("hall" if name == "paper" else "auto")
    assert scene.lights
    assert scene.ambient is not None
    (notice,) = path_notices(scene)
    assert "[ambient] and 1 of [[lights]]" in notice


@pytest.mark.parametrize("name", lamp_names())
def test_every_parameter_has_a_default_and_a_meaning(name: str) -> None:
    for parameter in lamp_parameters(name):
        assert parameter.default is not None and parameter.limits and parameter.description


@pytest.mark.parametrize(
    ("name", "parameters", "message"),
    [
        ("p21", {}, "did you mean 'p21w'"),
        ("p21w", {"pillow_pich_mm": "5"}, "did you mean 'pillow_pitch_mm'"),
        ("p21w", {"lens_thickness_mm": "-1"}, "p21w.lens_thickness_mm"),
        ("p21w", {"lens_thickness_mm": "nan"}, "finite"),
        ("p21w", {"lens_colour": "blue"}, "'red'"),
        ("p21w", {"pillow_radius_mm": 3}, "at least 0.8 times"),
        ("p21w", {"triangles": "many"}, "p21w.triangles"),
        ("p21w", {"reflector_roughness": 1e-4}, "0 (smooth) or 0.001 to 1"),
        ("led-array", {"pillow_radius_mm": 3}, "at least 0.8 times"),
        ("light-guide", {"notch_depth_mm": 1.2}, "an eighth of the rod"),
        ("light-guide", {"notch_pitch_mm": 1}, "notches are 0.938 mm wide"),
        ("light-guide", {"length_mm": 60, "bow_mm": 6}, "a twelfth of the length"),
        ("retro", {"pitch_mm": 14}, "fifth of the plate"),
    ],
)
def test_a_wrong_request_is_refused_in_one_line(
    name: str, parameters: dict[str, object], message: str, tmp_path: Path
) -> None:
    with pytest.raises(LamplitError) as caught:
        write_lamp(name, tmp_path / "lamp", parameters)
    assert message in str(caught.value) and "\n" not in str(caught.value)
    assert not (tmp_path / "lamp").exists()


def test_own_files_are_replaced_and_others_are_not(tmp_path: Path) -> None:
    scene = write_lamp("retro", tmp_path, {"triangles": 4_000})
    before = (tmp_path / "plate.ply").read_bytes()
    write_lamp("retro", tmp_path, {"triangles": 30_000})
    assert (tmp_path / "plate.ply").read_bytes() != before

    scene.write_text(scene.read_text().replace("width = 640", "width = 320"))
    edited = scene.read_text()
    with pytest.raises(OutputError, match="--force"):
        write_lamp("retro", tmp_path)
    assert scene.read_text() == edited
    write_lamp("retro", tmp_path, force=True)
    assert "width = 640" in scene.read_text()

    (tmp_path / "plate.ply").write_bytes(b"ply of someone else")
    with pytest.raises(OutputError, match=r"plate\.ply"):
        write_lamp("retro", tmp_path)


def test_a_directory_that_cannot_be_made_is_an_output_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError):
        write_lamp("paper", tmp_path / "file" / "lamp")

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What a scene resolves to, how it is hashed, and the schema that editors read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from pydantic import ValidationError

from lamplit.errors import SceneError
from lamplit.scene import load_scene, parse_scene
from lamplit.scene.objects import Transform
from lamplit.scene.schema import SCHEMA_FILE, scene_schema, schema_text


def test_the_schema_file_is_fresh() -> None:
    """``python -m lamplit.scene.schema`` writes it anew."""
    assert SCHEMA_FILE.read_text(encoding="utf-8") == schema_text()


def test_the_schema_knows_every_table() -> None:
    names = set(scene_schema()["properties"])
    assert names >= {"camera", "image", "display", "hall", "ambient", "background", "lights"}
    assert names >= {"sources", "materials", "objects"}


def test_every_key_of_the_schema_says_what_it_means() -> None:
    schema = scene_schema()
    silent = [
        f"{name}.{key}"
        for name, model in ({"Scene": schema} | schema["$defs"]).items()
        for key, node in model.get("properties", {}).items()
        if not node.get("description") and "const" not in node
    ]
    assert silent == []


def test_a_pixel_takes_as_many_samples_as_the_core_knows_points(sound: Path) -> None:
    assert load_scene(sound, overrides={"image.samples": 256**2}).image.samples == 65_536
    with pytest.raises(SceneError, match=r"image\.samples.*65536"):
        load_scene(sound, overrides={"image.samples": 257**2})


def test_a_hash_follows_values_and_files_and_nothing_else(sound: Path, tmp_path: Path) -> None:
    text = sound.read_text()
    original = load_scene(sound).scene_hash
    assert len(original) == 64

    sound.write_text("# a comment\n" + text.replace("samples = 4", "samples  =  4"))
    assert load_scene(sound).scene_hash == original

    folder = tmp_path / "elsewhere"
    folder.mkdir()
    (folder / "other.toml").write_text(text)
    (folder / "part.obj").write_bytes((tmp_path / "part.obj").read_bytes())
    assert load_scene(folder / "other.toml").scene_hash == original

    sound.write_text(text.replace("radius_mm = 10.0", "radius_mm = 10.000000000000002"))
    assert load_scene(sound).scene_hash != original
    assert load_scene(sound, overrides={"objects[0].radius_mm": 10.0}).scene_hash == original

    sound.write_text(text)
    mesh = tmp_path / "part.obj"
    mesh.write_bytes(mesh.read_bytes() + b"\n")
    assert load_scene(sound).scene_hash != original


def test_a_hash_follows_a_changed_table(sound: Path) -> None:
    scene = load_scene(sound)
    changed = scene.changed(image=scene.image.model_copy(update={"seed": 2}))
    assert changed.scene_hash != scene.scene_hash
    assert changed.root == scene.root


def test_a_scene_cannot_be_changed(sound: Path) -> None:
    scene = load_scene(sound)
    with pytest.raises(ValidationError):
        scene.name = "another"


def test_names_are_looked_up_in_the_scene_first(spoilt: Callable[[str, str], Path]) -> None:
    scene = load_scene(spoilt("[sources.my-led]", "[sources.D65]"))
    led = scene.resolve_source("D65")
    assert float(led(624.0)) == pytest.approx(1.0)
    assert float(led(450.0)) < 1e-6
    assert scene.resolve_material("cover").kind == "dielectric"
    assert scene.resolve_material("red-pmma").kind == "dielectric"
    with pytest.raises(SceneError, match="did you mean 'cover'"):
        scene.resolve_material("covers")
    with pytest.raises(SceneError, match="no source is called 'D64'"):
        scene.resolve_source("D64")


def test_a_library_material_takes_the_scenes_shading_terms(sound: Path) -> None:
    extra = '\n[materials.gloss]\nlibrary = "red-pmma"\nhall = { k_sr = 0.25 }\n'
    sound.write_text(sound.read_text() + extra)
    found = load_scene(sound).resolve_material("gloss")
    assert found.hall is not None
    assert found.hall.k_sr == 0.25
    assert found.kind == "dielectric"


def test_objects_come_back_in_order_with_their_meshes_in_mm(
    spoilt: Callable[[str, str], Path],
) -> None:
    ball, part = load_scene(spoilt('unit = "mm"', 'unit = "in"\npriority = 3')).resolved_objects()
    assert (ball.name, ball.kind, ball.mesh) == ("ball", "sphere", None)
    assert (part.kind, part.priority, part.material_name) == ("mesh", 3, "paint")
    assert part.mesh is not None
    np.testing.assert_allclose(part.mesh.vertices_mm.max(axis=0), [1016, 254, 254])
    np.testing.assert_array_equal(part.transform, np.eye(4))


def test_a_scene_may_come_from_a_mapping(tmp_path: Path) -> None:
    written = {
        "lamplit": 1,
        "camera": {"kind": "pinhole", "position_mm": (0, 0, 100), "target_mm": (0, 0, 0)},
        "objects": [
            {
                "name": "a",
                "kind": "sphere",
                "centre_mm": (0, 0, 0),
                "radius_mm": 1,
                "material": "bk7",
            }
        ],
    }
    scene = parse_scene(written, root=tmp_path)
    assert scene.path is None
    assert scene.root == tmp_path.resolve()
    assert [thing.name for thing in scene.resolved_objects()] == ["a"]


def test_a_transform_scales_then_turns_about_x_y_z_then_shifts() -> None:
    matrix = Transform(scale=2.0, rotate_deg=(90, 0, 90), translate_mm=(1, 2, 3)).matrix()
    # (0, 1, 0) → ×2 → about x to (0, 0, 2) → about z the same → shifted.
    np.testing.assert_array_equal(matrix @ [0, 1, 0, 1], [1, 2, 5, 1])
    # (1, 0, 0) → ×2 → about x the same → about z to (0, 2, 0) → shifted.
    np.testing.assert_array_equal(matrix @ [1, 0, 0, 1], [1, 4, 3, 1])
    turned = Transform(rotate_deg=(10, 20, 30)).matrix()[:3, :3]
    np.testing.assert_allclose(turned @ turned.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(turned) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("background", "says"),
    [
        ({"kind": "studio"}, "either"),
        ({"kind": "studio", "source": "D65"}, "either"),
        ({"kind": "constant", "source": "D65", "luminance_cd_m2": -1.0}, "greater"),
        ({"kind": "gradient", "zenith": {"source": "D65", "luminance_cd_m2": 1.0}}, "missing"),
    ],
)
def test_a_background_needs_its_light(
    background: dict[str, object], says: str, sound: Path
) -> None:
    with pytest.raises(SceneError, match=says):
        load_scene(sound, overrides={"background": background})

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Many pictures of one scene: each the one that `render` makes, assembled once."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lamplit as ll
from lamplit.engine import render_views
from lamplit.engine.assembly import assemble
from lamplit.engine.views import plan_views

SceneOf = Callable[..., ll.Scene]

BALL = {"name": "ball", "kind": "sphere", "centre_mm": [3, 0, 0], "radius_mm": 5}
FACE = {"name": "face", "kind": "disc", "centre_mm": [0, 0, 0], "normal": [0, 0, 1]}
SHINES = {"source": "E", "luminance_cd_m2": 1000.0}


def ball_scene(scene_of: SceneOf, **more: Any) -> ll.Scene:
    objects = [BALL | {"material": "red-pmma"}]
    return scene_of(image={"method": "path", "samples": 4}, objects=objects, **more)


def test_each_picture_is_the_one_that_render_makes_from_there(scene_of: SceneOf) -> None:
    scene = ball_scene(scene_of)
    for image in render_views(scene, turntable=5, sweep_deg=120.0):
        alone = ll.render(image.scene, threads=1)
        np.testing.assert_array_equal(image.xyz, alone.xyz)
        np.testing.assert_array_equal(image.xyz_standard_error, alone.xyz_standard_error)
        assert image.command == alone.command


def test_a_circle_begins_with_the_scene_as_it_is(scene_of: SceneOf) -> None:
    scene = ball_scene(scene_of)
    first = next(render_views(scene, turntable=3, sweep_deg=360.0))
    np.testing.assert_array_equal(first.xyz, ll.render(scene).xyz)


def test_the_scene_is_assembled_once(scene_of: SceneOf, monkeypatch: pytest.MonkeyPatch) -> None:
    assembled: list[ll.Scene] = []

    def counted(scene: ll.Scene, carrier: Any) -> Any:
        assembled.append(scene)
        return assemble(scene, carrier)

    monkeypatch.setattr(sys.modules["lamplit.engine.render"], "assemble", counted)
    assert len(list(render_views(ball_scene(scene_of), turntable=4))) == 4
    assert len(assembled) == 1


def test_a_shining_face_is_seen_as_large_as_the_cosine_says(scene_of: SceneOf) -> None:
    """A face of radius r and luminance L, seen at the angle θ, fills π r² cos θ of the picture."""
    face = FACE | {"radius_mm": 6.0, "material": "black-abs", "emission": SHINES}
    scene = scene_of(
        image={"method": "path", "width": 24, "height": 24, "samples": 64},
        background={"kind": "constant", "source": "E", "luminance_cd_m2": 0.0},
        objects=[face],
    )
    images = list(render_views(scene, turntable=3, sweep_deg=120.0))
    full = 1000.0 * np.pi * 6.0**2 / 20.0**2
    for image, cosine in zip(images, (0.5, 1.0, 0.5), strict=True):
        # The error is that of an edge in evenly spread samples: a few parts in a thousand.
        assert image.luminance_cd_m2.mean() == pytest.approx(full * cosine, rel=0.01)


def test_each_picture_has_the_hash_of_the_scene_with_its_camera_there(scene_of: SceneOf) -> None:
    scene = ball_scene(scene_of)
    places = [(40.0, 0.0, 90.0), (0.0, 30.0, 95.0)]
    for image, place in zip(render_views(scene, eyes=places), places, strict=True):
        camera = scene.camera.model_copy(update={"position_mm": place})
        assert image.scene.scene_hash == scene.changed(camera=camera).scene_hash


def test_the_scenes_own_eyes_are_taken_where_none_are_given(scene_of: SceneOf) -> None:
    eyes = [{"position_mm": [5, 0, 100]}, {"position_mm": [9, 0, 100], "target_mm": [2, 0, 0]}]
    cameras = [image.scene.camera for image in render_views(ball_scene(scene_of, eyes=eyes))]
    assert [camera.position_mm for camera in cameras] == [(5, 0, 100), (9, 0, 100)]
    assert [camera.target_mm for camera in cameras] == [(0, 0, 0), (2, 0, 0)]


def test_the_time_is_shared_by_all_pictures(scene_of: SceneOf) -> None:
    planned = plan_views(ball_scene(scene_of), turntable=4, time_s=10.0)
    assert planned.settled.time_s == 2.5


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        ({}, "eyes: 1 to 999 eye points are expected, not 0"),
        ({"eyes": []}, "eyes: 1 to 999 eye points are expected, not 0"),
        ({"eyes": [(0, 0, 90), (1, 2)]}, "eyes[1]: an eye point is three numbers"),
        ({"eyes": [(0, 0, float("nan"))]}, "eyes[0]: an eye point is three numbers"),
        ({"eyes": [(0, 0, 90), (8, 0, 0)]}, "eyes[1]: from (8, 0, 0) mm, the camera is inside"),
        ({"eyes": [(0, 0, 0)]}, "eyes[0]: the camera looks nowhere"),
        ({"turntable": 1}, "2 to 999 frames"),
        ({"turntable": 3, "eyes": [(0, 0, 90)]}, "exclude each other"),
        ({"turntable": 3, "method": "pth"}, "did you mean 'path'"),
    ],
)
def test_what_cannot_be_seen_is_refused_before_the_first_picture(
    scene_of: SceneOf, monkeypatch: pytest.MonkeyPatch, asked: dict[str, Any], says: str
) -> None:
    scene = scene_of(objects=[BALL | {"material": "black-abs", "radius_mm": 7}])
    monkeypatch.setattr("lamplit.engine.views.set_stage", None)
    with pytest.raises(ll.LamplitError) as caught:
        render_views(scene, **asked)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_view_of_nothing_is_refused(scene_of: SceneOf) -> None:
    scene = ball_scene(scene_of)
    camera = scene.camera.model_copy(update={"target_mm": (0.0, 0.0, 200.0)})
    with pytest.raises(ll.LamplitError, match=r"turntable\[0\].* sees none of the scene's objects"):
        render_views(scene.changed(camera=camera), turntable=3)


def test_progress_tells_the_frame_and_ctrl_c_ends_with_the_picture_that_was_begun(
    scene_of: SceneOf,
) -> None:
    scene = ball_scene(scene_of)
    long = scene.changed(image=scene.image.model_copy(update={"samples": 65_536}))
    seen: list[int] = []

    def stop_in_the_second(at: int, done: int, total: int) -> None:
        assert 0 <= done <= total
        seen.append(at)
        if at == 1 and done > 0:
            raise KeyboardInterrupt

    images: list[ll.Image] = []
    with pytest.raises(ll.RenderInterrupted) as stopped:
        images.extend(render_views(long, turntable=3, progress=stop_in_the_second))
    assert {*seen} == {0, 1}
    assert len(images) == 1
    assert images[0].complete
    assert not stopped.value.image.complete
    assert stopped.value.image.scene.camera.position_mm == scene.camera.position_mm


def test_files_that_the_pictures_share_are_read_once_for_their_hashes(
    scene_of: SceneOf, write_ply: Callable[..., str], box_mesh: Any, tmp_path: Path
) -> None:
    """A mesh that is saved anew while the first picture is made is not the one that is seen."""
    name = write_ply("box.ply", *box_mesh((-3, -3, -3), (3, 3, 3)))
    part = {"name": "part", "kind": "mesh", "file": name, "unit": "mm", "material": "red-pmma"}
    scene = scene_of(image={"method": "path"}, objects=[part])
    as_it_was = [view.scene_hash for view in plan_views(scene, turntable=2).scenes]
    images = render_views(scene, turntable=2)
    seen = [next(images).scene.scene_hash]
    write_ply("box.ply", *box_mesh((-4, -4, -4), (4, 4, 4)))
    seen.append(next(images).scene.scene_hash)
    assert seen == as_it_was
    assert plan_views(scene, turntable=2).scenes[0].scene_hash != as_it_was[0]

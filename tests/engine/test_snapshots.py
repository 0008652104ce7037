# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A picture in the making can be seen, tells how it will end, and is not changed by that."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import lamplit as ll
from lamplit.engine import Snapshot

SceneOf = Callable[..., ll.Scene]
BALL = {"name": "ball", "kind": "sphere", "centre_mm": [3, 0, 0], "radius_mm": 5}


def ball_scene(scene_of: SceneOf) -> ll.Scene:
    background = {
        "kind": "studio",
        "zenith": {"source": "D65", "luminance_cd_m2": 200.0},
        "nadir": {"source": "D65", "luminance_cd_m2": 10.0},
    }
    image = {"method": "path", "width": 160, "height": 120}
    objects = [BALL | {"material": "red-pmma"}]
    return scene_of(image=image, background=background, objects=objects)


def watched(scene: ll.Scene, **asked: Any) -> tuple[ll.Image, list[Snapshot]]:
    seen: list[Snapshot] = []
    return ll.render(scene, preview=seen.append, **asked), seen


@pytest.mark.parametrize("asked", [{"samples": 96}, {"samples": 48, "adaptive": True}])
def test_no_bit_of_a_picture_depends_on_being_watched(
    scene_of: SceneOf, asked: dict[str, Any]
) -> None:
    scene = ball_scene(scene_of)
    alone = ll.render(scene, **asked)
    image, seen = watched(scene, **asked)
    assert seen
    np.testing.assert_array_equal(image.xyz, alone.xyz)
    np.testing.assert_array_equal(image.xyz_standard_error, alone.xyz_standard_error)
    np.testing.assert_array_equal(image.samples_per_pixel, alone.samples_per_pixel)


def test_what_is_seen_is_the_picture_of_as_many_samples(scene_of: SceneOf) -> None:
    """The snapshot of a uniform render is the whole render of its samples, to the last bit."""
    scene = ball_scene(scene_of)
    image, seen = watched(scene, samples=96)
    for snapshot in seen:
        samples, rest = divmod(snapshot.samples, image.width * image.height)
        assert rest == 0
        whole = ll.render(scene, samples=samples)
        np.testing.assert_array_equal(snapshot.xyz, whole.xyz)
        np.testing.assert_array_equal(snapshot.xyz_standard_error, whole.xyz_standard_error)
        assert snapshot.relative_error == whole.relative_error
        assert snapshot.relative_error_at_end == pytest.approx(
            whole.relative_error * (samples / 96.0) ** 0.5, rel=1e-12
        )
        assert snapshot.done_share == pytest.approx(samples / 96.0, rel=1e-12)


def test_the_end_is_not_foretold_before_it_is_counted_out(scene_of: SceneOf) -> None:
    scene = ball_scene(scene_of)
    _, of_time = watched(scene, time_s=1.0, adaptive=False)
    assert of_time
    assert {snapshot.outlook for snapshot in of_time} == {None}
    _, of_error = watched(scene, error=0.1)
    assert of_error[0].outlook is None
    assert of_error[0].relative_error_at_end is None


def test_what_a_preview_raises_ends_the_render(scene_of: SceneOf) -> None:
    def stop(snapshot: Snapshot) -> None:
        raise KeyboardInterrupt

    with pytest.raises(ll.RenderInterrupted) as stopped:
        ll.render(ball_scene(scene_of), samples=65_536, preview=stop)
    assert stopped.value.image.samples < 65_536
    assert stopped.value.image.xyz.any()

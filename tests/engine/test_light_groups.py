# SPDX-License-Identifier: Apache-2.0 OR MIT
"""One render yields a layer per light group, and the layers are the picture."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import lamplit as ll
from lamplit.errors import LamplitError

Table = dict[str, Any]


def ball(name: str, x: float, luminance: float, **more: Any) -> Table:
    emission = {"source": "A", "luminance_cd_m2": luminance, **more}
    return {
        "name": name,
        "kind": "sphere",
        "centre_mm": [x, 6.0, 0.0],
        "radius_mm": 2.0,
        "material": "black-abs",
        "emission": emission,
    }


def lit_floor(scene_of: Callable[..., Any], **image: Any) -> Any:
    """Return two lamps of one group and one of another above a grey floor, in a dim surround."""
    floor = {
        "name": "floor",
        "kind": "plane",
        "point_mm": [0, -6, 0],
        "normal": [0, 1, 0],
        "material": "grey-18",
    }
    return scene_of(
        camera={
            "kind": "orthographic",
            "position_mm": [0.0, 30.0, 100.0],
            "target_mm": [0.0, 0.0, 0.0],
            "height_mm": 30.0,
        },
        image={"method": "path", "width": 16, "height": 10, "samples": 16} | image,
        objects=[
            floor,
            ball("left", -8.0, 3000.0, group="tail"),
            ball("right", 8.0, 3000.0, group="tail"),
            ball("middle", 0.0, 9000.0),
        ],
    )


def test_the_layers_sum_to_the_picture_and_each_has_its_own_light(
    scene_of: Callable[..., Any],
) -> None:
    image = ll.render(lit_floor(scene_of), layers=True)
    assert list(image.layers) == ["background", "tail", "middle"]
    np.testing.assert_allclose(sum(image.layers.values()), image.xyz, rtol=1e-12)
    middle, tail = (image.layers[name][..., 1] for name in ("middle", "tail"))
    y = image.luminance_cd_m2
    # The lamps are seen themselves, and only their own group shows them.
    assert middle.max() > 0.5 * 9000.0 and y[middle.argmax() // 16, middle.argmax() % 16] > 4500
    assert tail.max() > 0.5 * 3000.0
    assert tail[:, 7:9].max() < 300.0
    # 18 % of the surround's 100 cd/m², less what the black lamps hide.
    background = image.layers["background"][..., 1]
    assert background.max() == pytest.approx(18.0, rel=1e-3)
    assert background.min() < 15.0


def test_a_layer_is_what_is_left_when_all_other_lights_are_off(
    scene_of: Callable[..., Any],
) -> None:
    scene = lit_floor(scene_of)
    together = ll.render(scene, layers=True)
    kept = scene.changed(objects=tuple(own for own in scene.objects if own.name != "middle"))
    dark = kept.changed(background=scene.background.model_copy(update={"luminance_cd_m2": 0.0}))
    alone = ll.render(dark, samples=64)
    error = np.hypot(
        together.layers_standard_error["tail"][..., 1], alone.xyz_standard_error[..., 1]
    )
    # On the floor, where "middle" hides nothing.
    seen = np.s_[7:, :]
    apart = (together.layers["tail"][..., 1] - alone.luminance_cd_m2)[seen]
    assert np.abs(apart.mean()) < 4.0 * np.sqrt(np.square(error[seen]).sum()) / apart.size
    assert alone.luminance_cd_m2[seen].mean() > 1.0


def test_layers_are_kept_only_when_they_are_asked_for(scene_of: Callable[..., Any]) -> None:
    scene = lit_floor(scene_of)
    plain, layered = ll.render(scene), ll.render(scene, layers=True)
    assert plain.layers == {} == plain.layers_standard_error
    np.testing.assert_array_equal(plain.xyz, layered.xyz)


def test_hall_has_no_layers(scene_of: Callable[..., Any]) -> None:
    with pytest.raises(LamplitError, match="needs the method path or lit, and this is hall"):
        ll.render(lit_floor(scene_of, method="hall"), layers=True)


def test_an_image_with_layers_is_a_dataset_over_groups(scene_of: Callable[..., Any]) -> None:
    image = ll.render(lit_floor(scene_of), layers=True, features=True)
    dataset = image.to_xarray()
    tail = dataset["layer_xyz"].sel(group="tail", component="Y")
    np.testing.assert_array_equal(tail, image.layers["tail"][..., 1])
    assert dataset["layer_xyz_standard_error"].attrs["units"] == "cd/m2"
    assert dataset["depth"].attrs["units"] == "mm"
    assert dataset["normal"].sel(axis="y").shape == (10, 16)
    assert int(dataset["samples"].max()) == 16

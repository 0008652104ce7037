# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How finely a scene is rendered: samples, an error to reach, a time, and what contradicts."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import lamplit as ll
from lamplit.errors import LamplitError
from lamplit.scene.camera import MOST_SAMPLES

Maker = Callable[..., Any]


@pytest.fixture
def glass_ball(scene_of: Maker) -> Maker:
    """Return a maker of a clear ball over a checkered floor in a studio."""

    def make(**image: Any) -> Any:
        floor = {"kind": "plane", "point_mm": [0, -7, 0], "normal": [0, 1, 0]}
        ball = {"kind": "sphere", "centre_mm": [0, 0, 0], "radius_mm": 6.0}
        return scene_of(
            image={"method": "path", "width": 16, "height": 12, "filter": "gaussian"} | image,
            camera={
                "kind": "pinhole",
                "position_mm": [0.0, 15.0, 60.0],
                "target_mm": [0.0, 0.0, 0.0],
                "field_of_view_deg": 20.0,
            },
            background={
                "kind": "studio",
                "source": "D65",
                "luminance_cd_m2": 100.0,
                "soft_boxes": [
                    {
                        "source": "D65",
                        "luminance_cd_m2": 4000.0,
                        "centre_mm": [100, 300, 100],
                        "width_mm": 80.0,
                        "height_mm": 80.0,
                    }
                ],
            },
            objects=[
                floor | {"name": "floor", "material": "checker-floor"},
                ball | {"name": "ball", "material": "pmma-clear"},
            ],
        )

    return make


def test_the_relative_error_is_of_the_luminance_and_a_hundredth_of_its_mean(
    glass_ball: Maker,
) -> None:
    image = ll.render(glass_ball(), samples=16)
    y, error = image.luminance_cd_m2, image.xyz_standard_error[..., 1]
    expected = np.sqrt(np.mean((error / (y + 0.01 * y.mean())) ** 2))
    assert image.relative_error == pytest.approx(expected, rel=1e-12)
    assert ll.render(glass_ball(), samples=1).relative_error == np.inf


def test_a_target_error_is_reached_and_its_samples_follow_the_noise(glass_ball: Maker) -> None:
    scene = glass_ball(width=24, height=18)
    image = ll.render(scene, error=0.03, samples=4000)
    assert image.error_asked == 0.03
    # The error is foretold from 16 samples of each pixel.
    assert image.relative_error < 1.3 * 0.03
    assert 8 <= image.samples < 4000
    counts = image.samples_per_pixel
    assert counts.min() >= 8 and counts.max() > 2 * counts.min()
    assert image.samples == round(counts.mean())
    uniform = ll.render(scene, samples=image.samples)
    apart = (image.xyz - uniform.xyz)[..., 1].mean()
    errors = np.hypot(image.xyz_standard_error, uniform.xyz_standard_error)[..., 1]
    assert abs(apart) < 4 * np.sqrt(np.square(errors).sum()) / errors.size


def test_an_error_in_the_scene_holds_until_uniform_sampling_is_asked_for(
    glass_ball: Maker,
) -> None:
    scene = glass_ball(error=0.2, samples=64)
    held = ll.render(scene)
    assert (held.error_asked, held.samples_asked) == (0.2, 64)
    even = ll.render(scene, adaptive=False)
    assert (even.error_asked, even.samples) == (None, 64)
    assert np.ptp(even.samples_per_pixel) == 0
    assert even.scene.image.error is None


def test_without_a_number_of_samples_an_error_or_a_time_sets_no_limit(glass_ball: Maker) -> None:
    coarse = ll.render(glass_ball(samples=4), error=0.5)
    assert coarse.samples_asked == MOST_SAMPLES
    assert coarse.complete and coarse.relative_error < 0.6
    assert ll.render(glass_ball(samples=4), time_s=0.05).samples_asked == MOST_SAMPLES


@pytest.mark.parametrize("adaptive", [False, True])
def test_a_time_budget_ends_in_time(glass_ball: Maker, *, adaptive: bool) -> None:
    scene = glass_ball(width=64, height=48)
    ll.render(scene, samples=1)
    started = time.perf_counter()
    image = ll.render(scene, time_s=1.0, adaptive=adaptive)
    spent = time.perf_counter() - started
    # With samples allotted, the clock foretells how many there will be.
    assert 0.5 < image.statistics["trace_s"] < (1.8 if adaptive else 1.3)
    assert spent < 4.0
    assert image.complete and not image.interrupted
    assert 1 <= image.samples < MOST_SAMPLES
    if not adaptive:
        assert np.ptp(image.samples_per_pixel) == 0
        again = ll.render(scene, samples=image.samples)
        np.testing.assert_array_equal(again.xyz, image.xyz)


def test_the_ledger_of_the_walks_closes(glass_ball: Maker) -> None:
    ledger = ll.render(glass_ball(), samples=16).ledger
    assert ledger is not None
    assert set(ledger.absorbed) == {"floor", "ball"}
    entries = [ledger.escaped, ledger.cut_by_depth, ledger.lost, ledger.chance]
    assert abs(sum(entries) + sum(ledger.absorbed.values()) - 1.0) < 1e-9
    assert abs(ledger.gap) < 1e-9
    assert ledger.escaped > 0.1 and ledger.absorbed["floor"] > 0.1
    assert ledger.lost == 0.0
    assert ll.render(glass_ball(method="hall", samples=4)).ledger is None


def test_the_scene_says_by_which_method_unless_the_call_does(glass_ball: Maker) -> None:
    assert ll.render(glass_ball(samples=1)).method == "path"
    by_hall = ll.render(glass_ball(samples=1), method="hall")
    assert by_hall.method == by_hall.scene.image.method == "hall"
    assert ll.compare(glass_ball(samples=1)).spectral.method == "hall"


def test_what_the_path_method_leaves_out_is_noticed(scene_of: Maker) -> None:
    ball = {"name": "ball", "kind": "sphere", "centre_mm": [0, 0, 0], "radius_mm": 6.0}
    lights = {"ambient": {"source": "E", "luminance_cd_m2": 5.0}}
    for tables, found in (({}, 0), (lights, 1)):
        scene = scene_of(objects=[ball | {"material": "grey-18"}], **tables)
        notices = ll.render(scene, method="path").notices
        assert len(notices) == found
        assert all("[ambient]" in notice for notice in notices)
        assert ll.render(scene, method="hall").notices == ()


def test_a_scene_without_light_that_path_follows_is_refused(scene_of: Maker) -> None:
    ball = {"name": "ball", "kind": "sphere", "centre_mm": [0, 0, 0], "radius_mm": 6.0}
    scene = scene_of(
        image={"method": "path"},
        ambient={"source": "E", "luminance_cd_m2": 5.0},
        background={"kind": "constant", "source": "E", "luminance_cd_m2": 0.0},
        objects=[ball | {"material": "grey-18"}],
    )
    with pytest.raises(LamplitError, match="nothing shines that path transport can follow"):
        ll.render(scene)
    assert ll.render(scene, method="hall").luminance_cd_m2.max() > 0.0


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"method": "pathh"}, "did you mean 'path'"),
        ({"method": "hall", "error": 0.1}, "a target error needs the method path"),
        ({"method": "hall", "time_s": 1.0}, "a time budget needs the method path"),
        ({"method": "hall", "adaptive": True}, "adaptive sampling needs the method path"),
        ({"error": 0.1, "adaptive": False}, "uniform sampling cannot reach a target error"),
        ({"error": 0.0}, "above 0 and at most 1"),
        ({"error": 1.5}, "above 0 and at most 1"),
        ({"error": float("nan")}, "above 0 and at most 1"),
        ({"time_s": 0.0}, "seconds above 0"),
        ({"time_s": float("inf")}, "seconds above 0"),
        ({"samples": 0}, "0 samples per pixel"),
        ({"samples": 100_000}, "100000 samples per pixel"),
        ({"method": "hall", "samples": 10}, "a grid needs a square number"),
    ],
)
def test_what_contradicts_or_makes_no_sense_is_refused_in_one_line(
    glass_ball: Maker, asked: dict[str, Any], told: str
) -> None:
    with pytest.raises(LamplitError, match=told) as refused:
        ll.render(glass_ball(), **asked)
    assert "\n" not in str(refused.value)

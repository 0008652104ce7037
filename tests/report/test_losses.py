# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Lost rays and dropped samples are counted, told, and refused where they are too many."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lamplit.engine.image import Image
from lamplit.report.develop import develop
from lamplit.report.exr import write_exr
from lamplit.report.exr_file import read_exr
from lamplit.report.losses import Losses
from lamplit.report.summary import summary

MakeImage = Callable[..., Image]


def counts(**more: Any) -> dict[str, Any]:
    return {"eye_rays": 600_000, "shadow_rays": 400_000, "lost_rays": {}} | more


@pytest.mark.parametrize(
    ("lost", "warned", "refused"), [(100, False, False), (101, True, False), (10_001, True, True)]
)
def test_lost_rays_are_a_share_of_all_segments_over_bodies_and_causes(
    make_image: MakeImage, *, lost: int, warned: bool, refused: bool
) -> None:
    by_body = {
        "lens": {"left_without_entering": 40, "entered_twice": 20},
        "bulb": {"ended_inside": lost - 60},
    }
    losses = Losses.of(make_image(statistics=counts(lost_rays=by_body)))
    assert losses.lost_share == lost / 1e6
    assert bool(losses.warnings()) is warned
    assert (losses.fault() is not None) is refused
    assert losses.fault(allow_lost=True) is None


def test_the_warning_names_the_bodies_that_lose_most_and_how(make_image: MakeImage) -> None:
    by_body = {
        "lens": {"left_without_entering": 400, "entered_twice": 20},
        "bulb": {"ended_inside": 90},
        "stem": {"too_many_bodies": 4},
    }
    (warning,) = Losses.of(make_image(statistics=counts(lost_rays=by_body))).warnings()
    assert warning.startswith("0.051 % of the rays were lost: 400 at 'lens' left a body")
    assert "90 at 'bulb' ended inside" in warning
    assert "stem" not in warning


def test_a_dropped_sample_is_named_by_pixel_and_sample(make_image: MakeImage) -> None:
    statistics = counts(dropped_samples=1, first_dropped_sample=(3 * 40 + 7, 11))
    losses = Losses.of(make_image(statistics=statistics))
    assert losses.samples == 24 * 40 * 16
    assert losses.dropped_share == 1 / (24 * 40 * 16)
    assert losses.first_dropped == (7, 3, 11)
    assert "column 7, row 3, sample 11" in losses.warnings()[0]
    assert losses.fault(allow_lost=True) is not None


def test_one_dropped_sample_in_a_million_is_let_pass(make_image: MakeImage) -> None:
    many = {"samples": 2000, "samples_asked": 2000}
    sound = Losses.of(make_image(statistics=counts(dropped_samples=1), **many))
    assert (sound.warnings(), sound.fault()) == ([], None)
    refused = Losses.of(make_image(statistics=counts(dropped_samples=2), **many))
    assert refused.warnings() and refused.fault()


def test_a_picture_without_losses_is_sound(make_image: MakeImage) -> None:
    losses = Losses.of(make_image())
    assert (losses.segments, losses.lost_share, losses.dropped_share) == (30_000, 0.0, 0.0)
    assert (losses.warnings(), losses.fault()) == ([], None)


def test_the_summary_and_the_exr_header_carry_the_losses(
    make_image: MakeImage, tmp_path: Path
) -> None:
    lost = {"lens": {"ended_inside": 20_000}}
    statistics = counts(lost_rays=lost, dropped_samples=1, first_dropped_sample=(41, 2))
    image = make_image(statistics=statistics)
    written = summary(image, develop(image))["losses"]
    assert written["lost_rays"] == lost
    assert written["lost_share"] == 0.02
    assert written["first_dropped_sample"] == {"column": 1, "row": 1, "sample": 2}
    assert written["fault"]
    write_exr(tmp_path / "a.exr", image, develop(image))
    assert json.loads(read_exr(tmp_path / "a.exr").attributes["lamplit.losses"]) == written

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The comparison's page and numbers."""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as Raster

from lamplit.colour.difference import delta_e_2000
from lamplit.engine.image import Image
from lamplit.errors import LamplitError
from lamplit.report.chromaticity import signal_region
from lamplit.report.comparison import COMPARISON_FILES, write_comparison
from lamplit.report.difference import measure_difference
from lamplit.report.page import draw_page

MakeImage = Callable[..., Image]


@pytest.fixture
def pair(make_image: MakeImage) -> tuple[Image, Image]:
    """Return a spectral picture, and an RGB one whose lower half has less red."""
    spectral = make_image()
    xyz = spectral.xyz.copy()
    xyz[12:, :, 0] *= 0.9
    return spectral, make_image(xyz=xyz, colour="rgb")


def test_all_files_are_written_and_no_other(tmp_path: Path, pair: tuple[Image, Image]) -> None:
    write_comparison(*pair, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == set(COMPARISON_FILES)
    with Raster.open(tmp_path / "spectral.png") as picture:
        assert picture.size == (40, 24)


def test_the_numbers_are_ciede2000_of_the_pixels(tmp_path: Path, pair: tuple[Image, Image]) -> None:
    spectral, rgb = pair
    write_comparison(spectral, rgb, tmp_path)
    numbers = json.loads((tmp_path / "comparison.json").read_text())
    equal_energy_white = np.full(3, 1000.0)
    expected = delta_e_2000(rgb.xyz, spectral.xyz, white_xyz=equal_energy_white)
    found = numbers["delta_e_2000"]
    assert found["mean"] == pytest.approx(expected.mean(), rel=1e-3)
    assert found["percentile_95"] == pytest.approx(np.percentile(expected, 95), rel=1e-3)
    assert found["max"] == pytest.approx(expected.max(), rel=1e-3)
    assert numbers["rgb"]["colour"] == "rgb"


def test_equal_pictures_do_not_differ_and_still_make_a_page(make_image: MakeImage) -> None:
    difference = measure_difference(make_image(), make_image(colour="rgb"))
    assert difference.largest == 0.0
    assert draw_page(make_image(), difference).shape[-1] == 3


def test_black_pictures_have_no_marks_and_still_make_a_page(make_image: MakeImage) -> None:
    black = make_image(xyz=np.zeros((9, 12, 3)))
    difference = measure_difference(black, make_image(xyz=np.zeros((9, 12, 3)), colour="rgb"))
    assert difference.marks == ()
    assert np.isfinite(draw_page(black, difference)).all()


def test_marks_are_found_where_the_pictures_differ(pair: tuple[Image, Image]) -> None:
    marks = measure_difference(*pair).marks
    assert 1 <= len(marks) <= 5
    assert all(mark.row >= 11 for mark in marks[:1])
    assert len({(mark.row, mark.column) for mark in marks}) == len(marks)


def test_marks_stand_in_fields_and_not_on_rims_dark_places_or_single_pixels(
    make_image: MakeImage,
) -> None:
    """A lens differs a little; a thin rim, a dark part and single pixels differ much."""
    xyz = np.full((120, 200, 1), 300.0) * np.array([0.95, 1.0, 1.09])
    y, x = np.mgrid[0:120, 0:200]
    away = np.hypot(x - 80, y - 60)
    rim, dark = (away > 40.0) & (away < 43.0), x > 150
    noise = (away < 40.0) & (x % 9 == 0) & (y % 7 == 0)
    xyz[dark] *= 0.01
    other = xyz.copy()
    other[away <= 40.0, 0] *= 0.93
    for strongly in (rim, dark, noise):
        other[strongly, 0] *= 0.5
    difference = measure_difference(make_image(xyz=xyz), make_image(xyz=other, colour="rgb"))
    marks = difference.marks
    assert all(mark.delta_e == difference.delta_e[mark.row, mark.column] for mark in marks)
    assert [mark.delta_e for mark in marks] == sorted((m.delta_e for m in marks), reverse=True)
    on_lens = [m for m in marks if away[m.row, m.column] < 40.0 and not noise[m.row, m.column]]
    assert len(on_lens) >= 4
    assert not any(rim[m.row, m.column] or dark[m.row, m.column] for m in marks)
    for one, two in itertools.combinations(marks, 2):
        assert np.hypot(one.row - two.row, one.column - two.column) > 20.0


def test_a_mark_tells_of_the_pixel_that_was_asked_for(pair: tuple[Image, Image]) -> None:
    difference = measure_difference(*pair, marks=[(7, 20)])
    (mark,) = difference.marks
    assert mark.delta_e == difference.delta_e[20, 7]
    assert np.array_equal(mark.spectral_xyz, pair[0].xyz[20, 7])


@pytest.mark.parametrize("place", [(40, 0), (0, 24), (-1, 0)])
def test_a_mark_outside_the_picture_is_refused(
    pair: tuple[Image, Image], place: tuple[int, int]
) -> None:
    with pytest.raises(LamplitError, match="outside the picture"):
        measure_difference(*pair, marks=[place])


def test_more_marks_than_fit_the_page_are_refused(pair: tuple[Image, Image]) -> None:
    with pytest.raises(LamplitError, match="5 marks fit"):
        measure_difference(*pair, marks=[(0, 0)] * 6)


def test_pictures_of_two_sizes_are_not_compared(make_image: MakeImage) -> None:
    with pytest.raises(LamplitError, match="differ in size"):
        measure_difference(make_image(), make_image(xyz=np.ones((3, 3, 3)), colour="rgb"))


def test_both_pictures_are_seen_under_one_white(make_image: MakeImage) -> None:
    spectral, rgb = make_image(), make_image(xyz=2.0 * make_image().xyz, colour="rgb")
    for image in (spectral, rgb):
        image.scene.white_luminance_cd_m2 = "auto"  # type: ignore[attr-defined]
    difference = measure_difference(spectral, rgb)
    whites = [view.white_luminance_cd_m2 for view in (difference.rgb, difference.spectral)]
    assert whites[0] == whites[1]


@pytest.mark.parametrize("name", ["$\\frac{", "a" * 200, "", "two\nlines", "赤 ランプ"])
def test_any_name_of_a_scene_can_stand_on_the_page(
    pair: tuple[Image, Image], name: str, recwarn: pytest.WarningsRecorder
) -> None:
    pair[0].scene.name = name  # type: ignore[attr-defined]
    assert draw_page(pair[0], measure_difference(*pair)).std() > 0.0


def test_the_picture_stands_on_the_page_pixel_for_pixel(make_image: MakeImage) -> None:
    rng = np.random.default_rng(2)
    xyz = 500.0 * rng.random((30, 700, 1)) * np.ones(3)
    spectral, rgb = make_image(xyz=xyz), make_image(xyz=xyz, colour="rgb")
    difference = measure_difference(spectral, rgb, marks=[])
    page = np.rint(draw_page(spectral, difference) * 255.0)
    picture = np.rint(difference.spectral.picture.encoded * 255.0)
    first_row = picture[0, :, 0]
    windows = np.lib.stride_tricks.sliding_window_view(page[..., 0], 700, axis=1)
    assert (windows == first_row).all(axis=-1).sum() == 2


@pytest.mark.parametrize(
    ("name", "inside", "outside"),
    [
        ("red", (0.689, 0.311), (0.628, 0.372)),
        ("amber", (0.586, 0.413), (0.628, 0.372)),
    ],
)
def test_signal_regions_hold_a_lamp_led_and_not_the_orange_between(
    name: str, inside: tuple[float, float], outside: tuple[float, float]
) -> None:
    """FACTS: a 624 nm LED is UN red, a 593 nm LED amber, OG570 glass neither."""
    from matplotlib.path import Path as Outline

    region = Outline(signal_region(name))
    assert region.contains_point(inside, radius=1e-3) or region.contains_point(inside, radius=-1e-3)
    assert not region.contains_point(outside)

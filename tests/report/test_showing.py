# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What is drawn beside the exact values: false colours, glare, a tone curve, and one exposure."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image as Raster

from lamplit.colour.eye import pupil_diameter_mm
from lamplit.engine.image import Image
from lamplit.errors import LamplitError
from lamplit.report.develop import automatic_exposure, develop
from lamplit.report.exr_file import read_exr
from lamplit.report.false_colour import draw_false_colour, scale_limits
from lamplit.report.picture_files import picture_files, write_picture
from lamplit.report.view import View

MakeImage = Callable[..., Image]


@pytest.fixture
def lit(make_image: MakeImage) -> MakeImage:
    """Return a maker of pictures with a lamp of 1e6 cd/m², for what [display] is told."""

    def make(**settings: Any) -> Image:
        xyz = np.full((30, 40, 3), 50.0)
        xyz[14:16, 19:21] = (2.2e6, 1e6, 1e4)
        image = make_image(xyz=xyz)
        image.scene.settings = settings  # type: ignore[attr-defined]
        return image

    return make


def pixels(path: Path) -> np.ndarray:
    return np.asarray(Raster.open(path).convert("RGB"), dtype=np.float64)


def test_each_picture_that_is_asked_for_is_written_and_named(
    tmp_path: Path, lit: MakeImage
) -> None:
    for settings in ({}, {"false_colour": True}, {"glare": True, "false_colour": True}):
        out = tmp_path / str(len(settings))
        image = lit(**settings)
        numbers = write_picture(image, out)
        names = {"picture.png", "picture.exr", "summary.json"}
        names |= {"false-colour.png"} if settings.get("false_colour") else set()
        names |= {"picture-glare.png"} if settings.get("glare") else set()
        assert (
            {path.name for path in out.iterdir()}
            == names
            == set(picture_files(image.scene.display))
        )
        assert (numbers["glare"] is not None) == ("glare" in settings)


def test_glare_is_laid_on_a_copy_under_the_exposure_of_the_picture(
    tmp_path: Path, lit: MakeImage
) -> None:
    settings = {"white_luminance_cd_m2": "auto", "tone": "photographic"}
    plain = write_picture(lit(**settings), tmp_path / "plain")
    numbers = write_picture(lit(**settings, glare=True), tmp_path / "glare")
    first, second = (read_exr(tmp_path / name / "picture.exr") for name in ("plain", "glare"))
    assert np.array_equal(first.xyz, second.xyz)
    names = ("plain/picture.png", "glare/picture.png", "glare/picture-glare.png")
    before, after, seen = (pixels(tmp_path / name) for name in names)
    assert np.array_equal(before, after)
    assert (seen[14, 10] > before[14, 10] + 20).any()
    assert numbers["display"] == plain["display"]
    assert 0.0 < numbers["glare"]["left_frame_share"] < 0.2


def test_the_pupil_is_the_one_given_or_that_of_the_pictures_luminance_and_field(
    tmp_path: Path, lit: MakeImage
) -> None:
    given = write_picture(lit(glare=True, eye={"age": 60.0, "pupil_mm": 7.0}), tmp_path)["glare"]
    assert (given["age"], given["pupil_mm"]) == (60.0, 7.0)
    found = write_picture(lit(glare=True, eye={"age": 60.0}), tmp_path)["glare"]
    mean = (50.0 * (1200 - 4) + 4e6) / 1200
    # 20° high, and 2 atan(tan 10° · 4/3) = 26.46° wide, as a flat rectangle: within 2 %.
    assert found["pupil_mm"] == pytest.approx(pupil_diameter_mm(mean, 20.0 * 26.46, 60.0), abs=0.01)
    numbers = json.loads((tmp_path / "summary.json").read_text())
    assert numbers["glare"] == found


def test_an_orthographic_picture_has_no_glare_and_says_why(lit: MakeImage) -> None:
    image = lit(glare=True)
    image.scene.camera = object()  # type: ignore[attr-defined]
    with pytest.raises(LamplitError, match=r"display\.glare: .*orthographic.*pinhole") as fault:
        develop(image)
    assert "\n" not in str(fault.value)


def test_pixels_that_are_not_finite_spoil_neither_glare_nor_false_colours(
    tmp_path: Path, lit: MakeImage
) -> None:
    image = lit(glare=True, false_colour=True)
    image.xyz[3, 4] = np.nan
    numbers = write_picture(image, tmp_path)
    assert np.isfinite(numbers["glare"]["left_frame_share"])
    assert numbers["false_colour"]["highest_cd_m2"] == pytest.approx(1e6)


def test_the_photographic_tone_puts_the_geometric_mean_at_middle_grey(lit: MakeImage) -> None:
    image = lit(white_luminance_cd_m2="auto", tone="photographic")
    found = automatic_exposure(image.xyz, View.of(image.scene))
    key = np.exp((1196 * np.log(50.0) + 4 * np.log(1e6)) / 1200)
    assert found.white_luminance_cd_m2 == pytest.approx(key / 0.18)
    linear = develop(image).picture.linear
    assert found.brightest_luminance_cd_m2 == pytest.approx(
        linear.max() * found.white_luminance_cd_m2, rel=1e-3
    )


def test_a_brightest_that_is_given_counts_and_is_no_less_than_white(lit: MakeImage) -> None:
    settings = {"tone": "photographic", "white_luminance_cd_m2": 500.0}
    for asked, taken in ((9e4, 9e4), (100.0, 500.0)):
        image = lit(**settings, brightest_luminance_cd_m2=asked)
        found = automatic_exposure(image.xyz, View.of(image.scene))
        assert (found.white_luminance_cd_m2, found.brightest_luminance_cd_m2) == (500.0, taken)
    assert automatic_exposure(image.xyz, View.of(lit().scene)).brightest_luminance_cd_m2 is None


def test_a_toned_picture_shows_the_lamp_and_what_is_around_it(
    tmp_path: Path, lit: MakeImage
) -> None:
    """50 cd/m² is 10 % of white, 89 of 255 by IEC 61966-2-1; the lamp stays red."""
    write_picture(lit(tone="photographic", white_luminance_cd_m2=500.0), tmp_path)
    shown = pixels(tmp_path / "picture.png")
    assert shown[3, 3] == pytest.approx([89.0] * 3, abs=1.0)
    assert shown[15, 20, 0] > 240.0
    assert shown[15, 20, 1:].max() < 190.0
    header = read_exr(tmp_path / "picture.exr").attributes
    assert json.loads(header["lamplit.view"])["tone"] == "photographic"


def test_the_scale_spans_what_there_is_from_one_decade_to_seven() -> None:
    even = np.geomspace(1.0, 1e4, 100_001).reshape(1, -1)
    low, top = scale_limits(even)
    assert (low, top) == (pytest.approx(10**0.04, rel=1e-3), pytest.approx(1e4, rel=1e-2))
    assert scale_limits(np.full((3, 3), 50.0)) == (
        pytest.approx(50.0 / 10**0.5),
        pytest.approx(50.0 * 10**0.5),
    )
    low, top = scale_limits(np.geomspace(1e-9, 1e6, 200_001))
    assert top / low == pytest.approx(1e7)
    assert scale_limits(np.zeros((2, 2))) == (0.1, 1.0)


def test_false_colours_rise_with_luminance_and_leave_black_black() -> None:
    """viridis: from a dark violet (68, 1, 84) to a bright yellow (253, 231, 37)."""
    luminance = np.tile(np.geomspace(1.0, 1e5, 600), (80, 1))
    luminance[40:] = 0.0
    page, (low, top) = draw_false_colour(luminance)
    codes = np.rint(255.0 * page[44 : 44 + 80, 16 : 16 + 600])
    lightness = codes[10] @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(lightness) >= -2.0).all()
    assert codes[10, 0] == pytest.approx([68, 1, 84], abs=1)
    assert codes[10, -1] == pytest.approx([253, 231, 37], abs=1)
    assert not codes[60].any()
    assert (low, top) == (pytest.approx(1.12, rel=0.01), pytest.approx(1e5, rel=0.01))

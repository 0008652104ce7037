# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The summary's numbers are those of the picture."""

from __future__ import annotations

import json
from collections.abc import Callable

import numpy as np
import pytest

from lamplit.engine import Ledger
from lamplit.engine.image import Image
from lamplit.report.develop import automatic_exposure, develop
from lamplit.report.gamut_mask import gamut_mask_picture
from lamplit.report.summary import summary
from lamplit.report.view import View

MakeImage = Callable[..., Image]


def ramp() -> np.ndarray:
    luminance = np.arange(1.0, 102.0).reshape(1, 101)
    return luminance[..., None] * np.array([0.9, 1.0, 1.1])


def test_luminance_percentiles_and_mean_are_those_of_the_pixels(make_image: MakeImage) -> None:
    image = make_image(xyz=ramp())
    luminance = summary(image, develop(image))["luminance_cd_m2"]
    assert luminance["mean"] == pytest.approx(51.0)
    found = [luminance["percentiles"][share] for share in ("0", "5", "50", "95", "100")]
    assert found == pytest.approx([1.0, 6.0, 51.0, 96.0, 101.0])


def test_the_standard_error_of_the_mean_falls_with_the_root_of_the_pixels(
    make_image: MakeImage,
) -> None:
    image = make_image(xyz=np.ones((10, 40, 3)), xyz_standard_error=np.full((10, 40, 3), 0.2))
    luminance = summary(image, develop(image))["luminance_cd_m2"]
    assert luminance["mean_standard_error"] == pytest.approx(0.2 / np.sqrt(400))


def test_the_chromaticity_of_the_mean_weighs_pixels_by_their_light(make_image: MakeImage) -> None:
    xyz = np.array([[[2.0, 1.0, 0.0], [0.0, 1.0, 2.0]]])
    image = make_image(xyz=xyz)
    assert summary(image, develop(image))["chromaticity_xy_of_mean"] == (1 / 3, 1 / 3)


def test_black_has_no_chromaticity_and_is_still_valid_json(make_image: MakeImage) -> None:
    image = make_image(xyz=np.zeros((4, 5, 3)))
    numbers = summary(image, develop(image))
    assert numbers["chromaticity_xy_of_mean"] is None
    assert json.loads(json.dumps(numbers, allow_nan=False))["width"] == 5


def test_pixels_that_are_not_finite_are_counted_and_spoil_no_number(
    make_image: MakeImage,
) -> None:
    xyz = ramp()
    xyz[0, 3, 1], xyz[0, 7, 0] = np.nan, np.inf
    image = make_image(xyz=xyz)
    numbers = summary(image, develop(image))
    assert numbers["not_finite_pixels"] == 2
    json.dumps(numbers, allow_nan=False)


def test_the_share_outside_the_display_is_larger_for_srgb_than_for_rec2020(
    make_image: MakeImage,
) -> None:
    shares = {}
    for space in ("srgb", "rec2020"):
        image = make_image()
        image.scene.space = space  # type: ignore[attr-defined]
        shares[space] = summary(image, develop(image))["display"]["out_of_gamut_share"]
    assert shares["srgb"] > 0.2
    assert shares["rec2020"] < shares["srgb"]


def test_the_mask_marks_the_pixels_outside_and_no_other(make_image: MakeImage) -> None:
    picture = develop(make_image()).picture
    mask = gamut_mask_picture(picture)
    coloured = np.ptp(mask, axis=-1) > 1e-12
    assert picture.out_of_gamut.any()
    assert np.array_equal(coloured, picture.out_of_gamut)


def test_automatic_white_leaves_one_pixel_in_a_hundred_above(make_image: MakeImage) -> None:
    grey = ramp() / [0.9, 1.0, 1.1]
    image = make_image()
    image.scene.white_luminance_cd_m2 = "auto"  # type: ignore[attr-defined]
    view = View.of(image.scene)
    white = automatic_exposure(grey, view).white_luminance_cd_m2
    assert white == pytest.approx(100.0, rel=1e-3)
    assert (grey[..., 1] > white).sum() == 1
    assert automatic_exposure(np.zeros((2, 2, 3)), view).white_luminance_cd_m2 == 1.0


def test_automatic_white_leaves_a_saturated_red_its_colour(make_image: MakeImage) -> None:
    red = np.array([0.69 / 0.305, 1.0, 0.005 / 0.305])
    image = make_image(xyz=np.linspace(1.0, 200.0, 2000).reshape(40, 50, 1) * red)
    image.scene.white_luminance_cd_m2 = "auto"  # type: ignore[attr-defined]
    picture = develop(image).picture
    assert picture.over_white_share <= 0.01
    bright = picture.encoded[30, 10]
    assert bright[0] > 0.8
    assert bright[1:].max() < 0.25


def test_the_summary_says_what_error_was_reached_and_how_fast(make_image: MakeImage) -> None:
    xyz = np.full((10, 20, 3), 99.0)
    image = make_image(
        xyz=xyz,
        xyz_standard_error=0.02 * 1.01 * xyz,
        samples_per_pixel=np.repeat(np.array([[8], [24]], np.uint32), [5, 5], axis=0)
        * np.ones((1, 20), np.uint32),
        samples=16,
        error_asked=0.02,
        statistics={"eye_rays": 9000, "shadow_rays": 1000, "lost_rays": {}, "trace_s": 0.5},
    )
    numbers = summary(image, develop(image))
    assert numbers["relative_error_rms"] == pytest.approx(0.02)
    assert numbers["error_asked"] == 0.02
    assert numbers["samples_per_pixel"] == {"fewest": 8, "mean": 16.0, "most": 24}
    assert numbers["speed"] == {"rays_per_s": 20_000.0, "paths_per_s": 200 * 16 / 0.5}
    assert numbers["ledger"] is None
    assert summary(make_image(), develop(make_image()))["speed"]["rays_per_s"] is None


def test_the_summary_has_the_ledger_and_the_notices(make_image: MakeImage) -> None:
    ledger = Ledger(
        escaped=0.5, absorbed={"lens": 0.4}, cut_by_depth=0.06, lost=0.03, chance=0.01, gap=0.0
    )
    image = make_image(ledger=ledger, notices=("nobody looks",), method="path")
    numbers = json.loads(json.dumps(summary(image, develop(image)), allow_nan=False))
    assert numbers["ledger"]["absorbed"] == {"lens": 0.4}
    assert numbers["ledger"]["escaped"] == 0.5
    assert numbers["notices"] == ["nobody looks"]
    assert numbers["method"] == "path"


def test_an_error_that_nobody_knows_is_none(make_image: MakeImage) -> None:
    image = make_image(xyz_standard_error=np.full((24, 40, 3), np.inf))
    assert summary(image, develop(image))["relative_error_rms"] is None


def test_an_image_is_a_dataset_with_units_and_errors(make_image: MakeImage) -> None:
    bands = {"spectral_radiance": np.ones((24, 40, 2)), "band_centres_nm": np.array([450.0, 650.0])}
    dataset = make_image(**bands).to_xarray()
    assert dataset["xyz"].attrs["units"] == "cd/m2"
    assert dataset["xyz_standard_error"].shape == (24, 40, 3)
    assert dataset["spectral_radiance"].sel(wavelength=650.0).shape == (24, 40)
    assert dataset["wavelength"].attrs["units"] == "nm"
    assert dataset.attrs["seed"] == 1

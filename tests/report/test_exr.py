# SPDX-License-Identifier: Apache-2.0 OR MIT
"""OpenEXR files lose no value and carry how they came about."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from colour.io.fichet2021 import PATTERN_FICHET2021

from lamplit.engine import Features
from lamplit.engine.image import Image
from lamplit.errors import OutputError
from lamplit.report.develop import develop
from lamplit.report.exr import band_name, write_exr
from lamplit.report.exr_file import read_exr

MakeImage = Callable[..., Image]


def test_values_from_1e_minus_12_to_1e_12_come_back_as_their_exact_float32(
    tmp_path: Path, make_image: MakeImage
) -> None:
    rng = np.random.default_rng(3)
    xyz = 10.0 ** rng.uniform(-12.0, 12.0, (20, 30, 3))
    xyz[0, 0], xyz[0, 1] = 1e-12, 1e12
    image = make_image(xyz=xyz, xyz_standard_error=xyz / 7)
    write_exr(tmp_path / "a.exr", image, develop(image))
    read = read_exr(tmp_path / "a.exr")
    assert np.array_equal(read.xyz, xyz.astype(np.float32))
    error = read.channels["standard_error.Y"]
    assert np.array_equal(error, (xyz[..., 1] / 7).astype(np.float32))


def test_every_channel_is_float32_and_the_file_is_zip(
    tmp_path: Path, make_image: MakeImage
) -> None:
    image = make_image()
    write_exr(tmp_path / "a.exr", image, develop(image))
    read = read_exr(tmp_path / "a.exr")
    errors = {f"standard_error.{name}" for name in "XYZ"}
    assert set(read.channels) == {*"XYZRGB", "samples"} | errors
    assert {channel.dtype for channel in read.channels.values()} == {np.dtype(np.float32)}
    assert read.attributes["compression"] == OpenEXR.ZIP_COMPRESSION


def test_rgb_at_white_luminance_is_the_luminance_that_the_header_names(
    tmp_path: Path, make_image: MakeImage
) -> None:
    image = make_image()
    write_exr(tmp_path / "a.exr", image, develop(image))
    read = read_exr(tmp_path / "a.exr")
    rgb = np.stack([read.channels[name] for name in "RGB"], axis=-1).astype(np.float64)
    weights = np.array([0.2126, 0.7152, 0.0722])
    grey = image.xyz[0, 0]
    assert read.attributes["whiteLuminance"] == 1000.0
    assert rgb[0, 0] @ weights * 1000.0 == pytest.approx(grey[1], rel=0.02)
    assert read.attributes["chromaticities"][:2] == pytest.approx((0.64, 0.33))


def test_the_header_says_how_to_make_the_file_again(tmp_path: Path, make_image: MakeImage) -> None:
    image = make_image()
    write_exr(tmp_path / "a.exr", image, develop(image))
    header = read_exr(tmp_path / "a.exr").attributes
    assert header["lamplit.scene_hash"] == image.scene.scene_hash
    assert header["lamplit.seed"] == "1"
    assert header["lamplit.samples"] == "16"
    assert header["lamplit.version"] == "0.1.0"
    assert header["lamplit.observer"] == "cie-1931-2"
    assert header["lamplit.white"] == "D65"
    assert header["lamplit.command"] == "lamplit render scene.toml -o out"
    assert json.loads(header["lamplit.statistics"])["eye_rays"] == 20_000


def test_features_are_channels_with_units_and_the_names_of_the_bodies(
    tmp_path: Path, make_image: MakeImage, features: Callable[[int, int], Features]
) -> None:
    seen = features(24, 40)
    counts = np.arange(24 * 40, dtype=np.uint32).reshape(24, 40) + 200_000
    image = make_image(features=seen, samples_per_pixel=counts)
    write_exr(tmp_path / "a.exr", image, develop(image))
    read = read_exr(tmp_path / "a.exr")
    assert {channel.dtype for channel in read.channels.values()} == {np.dtype(np.float32)}
    assert np.array_equal(read.channels["samples"], counts)
    assert np.array_equal(read.channels["depth.mm"], seen.depth_mm.astype(np.float32))
    assert np.isinf(read.channels["depth.mm"][0, 0])
    assert np.array_equal(read.channels["body"], seen.body)
    assert np.array_equal(read.channels["interfaces"], seen.interfaces)
    assert np.array_equal(read.vectors("normal."), seen.normal.astype(np.float32))
    assert np.array_equal(read.vectors("albedo."), seen.albedo.astype(np.float32))
    names = json.loads(read.attributes["lamplit.bodies"])
    assert names[int(read.channels["body"][0, 2])] == "housing of the lamp"
    for name in ("depth.mm: mm", "normal.X/Y/Z", "albedo.X/Y/Z", "interfaces: count"):
        assert name in read.attributes["lamplit.units"]


def with_bands(make_image: MakeImage) -> Image:
    centres = np.arange(382.5, 780.0, 5.0)
    spectra = np.random.default_rng(5).random((6, 8, centres.size)) * 1e-3
    return make_image(xyz=np.ones((6, 8, 3)), spectral_radiance=spectra, band_centres_nm=centres)


def test_spectral_bands_read_back_in_colour_science(tmp_path: Path, make_image: MakeImage) -> None:
    """Needs OpenImageIO, which colour-science reads spectral images with."""
    from colour import read_spectral_image_Fichet2021

    image = with_bands(make_image)
    write_exr(tmp_path / "a.exr", image, develop(image), spectral=True)
    components = read_spectral_image_Fichet2021(tmp_path / "a.exr")
    assert set(components) == {"S0"}
    wavelengths, values = components["S0"]
    assert np.array_equal(wavelengths, image.band_centres_nm)
    assert image.spectral_radiance is not None
    assert np.array_equal(values, image.spectral_radiance.astype(np.float32))


def test_bands_come_back_exactly_under_names_of_the_layout(
    tmp_path: Path, make_image: MakeImage
) -> None:
    import re

    image = with_bands(make_image)
    write_exr(tmp_path / "a.exr", image, develop(image), spectral=True)
    read = read_exr(tmp_path / "a.exr")
    assert read.attributes["spectralLayoutVersion"] == "1.0"
    assert image.spectral_radiance is not None
    for band, centre in enumerate(image.band_centres_nm):
        name = band_name(float(centre))
        assert re.fullmatch(rf"S0\.{PATTERN_FICHET2021}", name)
        expected = image.spectral_radiance[..., band].astype(np.float32)
        assert np.array_equal(read.channels[name], expected)


def test_bands_that_were_not_rendered_are_refused(tmp_path: Path, make_image: MakeImage) -> None:
    image = make_image()
    with pytest.raises(OutputError, match="--spectral"):
        write_exr(tmp_path / "a.exr", image, develop(image), spectral=True)


@pytest.mark.parametrize("content", [b"", b"not an image", b"\x76\x2f\x31\x01" + b"\0" * 40])
def test_a_file_that_is_no_exr_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.exr").write_bytes(content)
    with pytest.raises(OutputError, match=r"a\.exr"):
        read_exr(tmp_path / "a.exr")


def test_a_place_that_cannot_be_written_is_an_output_error(
    tmp_path: Path, make_image: MakeImage
) -> None:
    image = make_image()
    with pytest.raises(OutputError, match="no such file"):
        write_exr(tmp_path / "missing" / "a.exr", image, develop(image))

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""PNG files hold the exact codes and name the display they are for."""

from __future__ import annotations

import struct
import zlib
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageCms

from lamplit.colour.display import Display
from lamplit.report.png import encode_png, write_png


def chunks_of(png: bytes) -> dict[bytes, bytes]:
    """Return the chunks by name, each with its check sum proved."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    found: dict[bytes, bytes] = {}
    at = 8
    while at < len(png):
        (length,) = struct.unpack_from(">I", png, at)
        kind, body = png[at + 4 : at + 8], png[at + 8 : at + 8 + length]
        (check,) = struct.unpack_from(">I", png, at + 8 + length)
        assert check == zlib.crc32(kind + body)
        found[kind] = body
        at += 12 + length
    assert at == len(png)
    assert list(found)[-1] == b"IEND"
    return found


def noise(height: int = 17, width: int = 31) -> np.ndarray:
    return np.random.default_rng(1).random((height, width, 3))


def test_eight_bits_come_back_as_the_nearest_codes() -> None:
    encoded = noise()
    read = np.asarray(Image.open(BytesIO(encode_png(encoded, Display.named("srgb")))))
    assert np.array_equal(read, np.rint(encoded * 255))


def test_sixteen_bits_come_back_as_the_nearest_codes() -> None:
    """The rows are unfiltered here by hand: PNG 9.2, filter type 2."""
    encoded = noise()
    height, width, _ = encoded.shape
    chunks = chunks_of(encode_png(encoded, Display.named("srgb"), bits=16))
    assert struct.unpack(">IIBBBBB", chunks[b"IHDR"]) == (width, height, 16, 2, 0, 0, 0)
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, -1)
    assert (rows[:, 0] == 2).all()
    raw = np.cumsum(rows[:, 1:], axis=0, dtype=np.uint8)
    codes = np.frombuffer(raw.tobytes(), ">u2").reshape(encoded.shape)
    assert np.array_equal(codes, np.rint(encoded * 65535))


def test_values_beyond_the_display_are_cut_and_not_wrapped() -> None:
    encoded = np.array([[[-0.5, 0.0, 0.5], [1.0, 1.5, 1e9]]])
    read = np.asarray(Image.open(BytesIO(encode_png(encoded, Display.named("srgb")))))
    assert read.tolist() == [[[0, 0, 128], [255, 255, 255]]]


def test_srgb_is_tagged_as_srgb_and_with_nothing_that_contradicts_it() -> None:
    chunks = chunks_of(encode_png(noise(), Display.named("srgb")))
    assert chunks[b"sRGB"] == b"\x01"
    assert chunks[b"cICP"] == bytes((1, 13, 0, 1))
    corners = (31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000)
    assert struct.unpack(">8I", chunks[b"cHRM"]) == corners
    assert b"iCCP" not in chunks


@pytest.mark.parametrize("name", ["display-p3", "rec2020"])
def test_a_wide_display_is_tagged_with_a_profile_that_littlecms_reads(name: str) -> None:
    png = encode_png(noise(), Display.named(name))
    assert b"sRGB" not in chunks_of(png)
    profile = Image.open(BytesIO(png)).info["icc_profile"]
    opened = ImageCms.ImageCmsProfile(BytesIO(profile))
    assert opened.profile.xcolor_space == "RGB "
    assert name in ImageCms.getProfileDescription(opened)


def test_a_display_of_its_own_primaries_has_a_profile_and_no_code_points() -> None:
    primaries = [[0.68, 0.31], [0.26, 0.68], [0.15, 0.05]]
    display = Display.from_primaries(primaries, [0.3127, 0.3290], 2.2)
    chunks = chunks_of(encode_png(noise(), display))
    assert b"iCCP" in chunks
    assert b"cICP" not in chunks


def test_text_goes_in_and_comes_back(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    texts = {"Title": "Rückleuchte 赤", "Comment": "seed: 1\nsamples: 4"}
    write_png(path, noise(), Display.named("srgb"), provenance=texts)
    with Image.open(path) as image:
        image.load()
        assert image.text == texts  # pyright: ignore[reportAttributeAccessIssue]

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Pictures of the surround: Radiance and OpenEXR give their RGB, or a line that says why not."""

from __future__ import annotations

import os
import re
import struct
import time
import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamplit.errors import SceneError
from lamplit.scene.hdr import read_environment

HEAD = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"

ONE = bytes([128, 128, 128, 129])


def rgbe_of(rgb: np.ndarray) -> np.ndarray:
    """Return RGBE (…, 4) by Ward's rule: the largest of three has a mantissa from 128 to 255."""
    largest = rgb.max(axis=-1)
    _, exponent = np.frexp(largest)
    mantissas = np.floor(rgb * np.ldexp(1.0, 8 - exponent)[..., None])
    stored = np.concatenate([mantissas, (exponent + 128)[..., None]], axis=-1)
    return np.where(largest[..., None] > 1e-32, stored, 0).astype(np.uint8)


def in_stretches(row: bytes) -> bytes:
    """Return one channel with runs where three equal bytes follow each other."""
    out, at = b"", 0
    while at < len(row):
        run = 1
        while at + run < len(row) and run < 127 and row[at + run] == row[at]:
            run += 1
        if run >= 3:
            out += bytes([128 + run, row[at]])
            at += run
            continue
        end = min(at + 2, len(row))
        out += bytes([end - at]) + row[at:end]
        at = end
    return out


def new_rle(rgbe: np.ndarray) -> bytes:
    mark = b"\2\2" + struct.pack(">H", rgbe.shape[1])
    return b"".join(
        mark + b"".join(in_stretches(row[:, channel].tobytes()) for channel in range(4))
        for row in rgbe
    )


def old_rle(rgbe: np.ndarray) -> bytes:
    out = b""
    for row in rgbe:
        pixels: list[bytes] = [pixel.tobytes() for pixel in row]
        at = 0
        while at < len(pixels):
            out += pixels[at]
            run = 0
            while at + run + 1 < len(pixels) and pixels[at + run + 1] == pixels[at]:
                run += 1
            at += run + 1
            while run:
                out += bytes([1, 1, 1, run & 255])
                run >>= 8
    return out


def flat(rgbe: np.ndarray) -> bytes:
    return rgbe.tobytes()


def picture(height: int, width: int) -> np.ndarray:
    """Return RGB over twelve decades with runs, steps and black in it."""
    random = np.random.default_rng(height * 1000 + width)
    rgb = 10.0 ** random.uniform(-6, 6, (height, width, 1)) * random.uniform(0.01, 1, (1, width, 3))
    rgb[: height // 2, : width // 2] = (0.5, 1.0, 2.0)
    rgb[0, 0] = 0.0
    return rgb


def hdr(rgbe: np.ndarray, encoded: bytes, head: bytes = HEAD) -> bytes:
    return head + f"-Y {rgbe.shape[0]} +X {rgbe.shape[1]}\n".encode() + encoded


def write(path: Path, content: bytes) -> Path:
    path.write_bytes(content)
    return path


def write_exr(
    path: Path, channels: dict[str, np.ndarray], compression: str = "ZIP", **header: Any
) -> Path:
    import OpenEXR

    kind = {"compression": getattr(OpenEXR, f"{compression}_COMPRESSION")}
    OpenEXR.File({**kind, "type": OpenEXR.scanlineimage, **header}, channels).write(str(path))
    return path


def layers(rgb: np.ndarray, kind: type = np.float32) -> dict[str, np.ndarray]:
    return {n: np.ascontiguousarray(rgb[..., i], dtype=kind) for i, n in enumerate("RGB")}


@pytest.mark.parametrize("encode", [flat, old_rle, new_rle])
@pytest.mark.parametrize("size", [(1, 1), (3, 7), (4, 8), (5, 300), (2, 40000)])
def test_a_radiance_picture_comes_back_to_half_a_percent_in_each_encoding(
    tmp_path: Path, encode: Callable[[np.ndarray], bytes], size: tuple[int, int]
) -> None:
    if encode is new_rle and not 8 <= size[1] < 32768:
        encode = flat
    rgb = picture(*size)
    stored = rgbe_of(rgb)
    read = read_environment(write(tmp_path / "a.hdr", hdr(stored, encode(stored))))
    assert read.dtype == np.float32 and read.shape == (*size, 3)
    largest = rgb.max(axis=-1, keepdims=True)
    assert (np.abs(read - rgb) <= largest / 128.0).all()
    assert (read <= rgb * (1 + 1e-6)).all()


def test_one_is_stored_and_read_as_one(tmp_path: Path) -> None:
    content = HEAD + b"-Y 1 +X 2\n" + ONE + bytes([255, 0, 1, 128])
    read = read_environment(write(tmp_path / "a.hdr", content))
    np.testing.assert_array_equal(read, [[[1, 1, 1], [255 / 256, 0, 1 / 256]]])


def test_a_dark_exponent_is_black_whatever_the_mantissas(tmp_path: Path) -> None:
    content = HEAD + b"-Y 1 +X 1\n" + bytes([200, 100, 50, 0])
    assert not read_environment(write(tmp_path / "a.hdr", content)).any()


def test_long_repetitions_count_in_the_base_256(tmp_path: Path) -> None:
    content = HEAD + b"-Y 1 +X 40000\n" + ONE + bytes([1, 1, 1, 39999 & 255, 1, 1, 1, 39999 >> 8])
    read = read_environment(write(tmp_path / "a.hdr", content))
    assert (read == 1.0).all() and read.shape == (1, 40000, 3)


@pytest.mark.parametrize("size", [(3, 7), (33, 64)])
@pytest.mark.parametrize("suffix", [".hdr", ".exr"])
def test_openimageio_reads_and_writes_the_same_pictures(
    tmp_path: Path, size: tuple[int, int], suffix: str
) -> None:
    import OpenImageIO

    path = tmp_path / f"a{suffix}"
    out = OpenImageIO.ImageOutput.create(str(path))
    assert out.open(str(path), OpenImageIO.ImageSpec(size[1], size[0], 3, "float"))
    assert out.write_image(picture(*size).astype(np.float32))
    out.close()
    expected = OpenImageIO.ImageInput.open(str(path)).read_image("float")
    np.testing.assert_array_equal(read_environment(path), expected)


def test_exposures_and_corrections_are_divided_out(tmp_path: Path) -> None:
    head = (
        b"#?RGBE\n# made by a test\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 4.0\n"
        b"COLORCORR=1 2 0.5\nPRIMARIES=0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290\n\n"
    )
    read = read_environment(write(tmp_path / "a.hdr", head + b"-Y 1 +X 1\n" + ONE))
    np.testing.assert_allclose(read[0, 0], [1 / 8, 1 / 16, 1 / 4])


@pytest.mark.parametrize("compression", ["NO", "RLE", "ZIPS", "ZIP", "PIZ"])
@pytest.mark.parametrize("kind", [np.float32, np.float16, np.uint32])
def test_an_exr_picture_comes_back_exactly(tmp_path: Path, compression: str, kind: type) -> None:
    rgb = np.clip(picture(20, 30), 0.0, 60000.0).astype(kind)
    path = write_exr(tmp_path / "a.exr", layers(rgb, kind), compression)
    np.testing.assert_array_equal(read_environment(path), rgb.astype(np.float32))


def test_other_channels_beside_red_green_and_blue_are_left_alone(tmp_path: Path) -> None:
    rgb = picture(4, 5)
    more = {"A": np.full((4, 5), np.nan, np.float32), "depth.Z": np.ones((4, 5), np.float32)}
    read = read_environment(write_exr(tmp_path / "a.EXR", layers(rgb) | more))
    np.testing.assert_array_equal(read, rgb.astype(np.float32))


def test_a_constant_picture_packs_as_tightly_as_it_likes(tmp_path: Path) -> None:
    for compression in ("RLE", "ZIP", "PIZ", "DWAB"):
        rgb = np.ones((512, 1024, 3))
        path = write_exr(tmp_path / "a.exr", layers(rgb), compression)
        assert (read_environment(path) == 1.0).all()


def refused(path: Path, says: str) -> None:
    """Check that the file is refused within a second, in one line that names it."""
    start = time.perf_counter()
    with pytest.raises(SceneError, match=says) as fault:
        read_environment(path)
    assert time.perf_counter() - start < 1.0
    told = str(fault.value)
    assert told.startswith(str(path)) and "\n" not in told and len(told) < 300 + len(str(path))


ROW = new_rle(rgbe_of(np.full((1, 16, 3), 0.5)))

#: Radiance files that are none, and what is said of them.
BAD_HDR = {
    "empty": (b"", "no Radiance picture"),
    "text": (b"hello, surround\n" * 20, "no Radiance picture"),
    "png": (b"\x89PNG\r\n\x1a\n" + bytes(100), "no Radiance picture"),
    "no end of the header": (b"#?RADIANCE\n" + b"NOTE=x\n" * 20000, "header has no end"),
    "header alone": (HEAD, "header has no end"),
    "no size": (HEAD + b"a size of no numbers\n" + ONE, "line 4: a size such as"),
    "size in words": (HEAD + b"-Y one +X one\n" + ONE, "line 4: a size such as"),
    "two heights": (HEAD + b"-Y 1 +Y 1\n" + ONE, "line 4: a size such as"),
    "upside down": (HEAD + b"+Y 1 +X 1\n" + ONE, "line 4: the picture is turned or mirrored"),
    "mirrored": (HEAD + b"-Y 1 -X 1\n" + ONE, "line 4: the picture is turned or mirrored"),
    "columns first": (HEAD + b"+X 1 -Y 1\n" + ONE, "line 4: the picture is turned or mirrored"),
    "no rows": (HEAD + b"-Y 0 +X 5\n" + ONE, "has none"),
    "no columns": (HEAD + b"-Y 5 +X 0\n" + ONE, "has none"),
    "more pixels than any": (HEAD + b"-Y 99999 +X 99999\n" + ONE, "more than 67108864"),
    "digits without end": (HEAD + b"-Y " + b"9" * 50 + b" +X 1\n" + ONE, "a size such as"),
    "size beyond the bytes": (
        HEAD + b"-Y 8192 +X 8192\n" + ONE * 9,
        "cannot stand in the 36 bytes",
    ),
    "old size beyond the bytes": (HEAD + b"-Y 9999999 +X 4\n" + ONE, "cannot stand in the 4 bytes"),
    "no pixels": (HEAD + b"-Y 1 +X 1\n", "cannot stand in the 0 bytes"),
    "flat row cut off": (HEAD + b"-Y 1 +X 7\n" + ONE * 6, "row 0: the row ends too early"),
    "second row cut off": (
        HEAD + b"-Y 2 +X 16\n" + ROW + ROW[:-3],
        "row 1: the row ends too early",
    ),
    "row of another width": (HEAD + b"-Y 1 +X 17\n" + ROW, "row 0: the row has another width"),
    "run beyond the row": (
        HEAD + b"-Y 1 +X 16\n\2\2\0\x10" + bytes([128 + 17, 5] * 8),
        "row 0: the row has a run that is longer",
    ),
    "stretch of nothing": (HEAD + b"-Y 1 +X 16\n\2\2\0\x10" + bytes(60), "row 0: the row ends too"),
    "repetition of nothing": (
        HEAD + b"-Y 1 +X 7\n\1\1\1\7" + ONE * 6,
        "row 0: the row repeats more",
    ),
    "repetition beyond the row": (
        HEAD + b"-Y 1 +X 7\n" + ONE + b"\1\1\1\xff" + ONE * 5,
        "row 0: the row repeats more",
    ),
    "repetition of millions": (
        HEAD + b"-Y 1 +X 7\n" + ONE + b"\1\1\1\0" * 3 + b"\1\1\1\xff" * 3,
        "row 0: the row repeats more",
    ),
    "other pixels": (
        b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + ONE,
        "line 2: only 32-bit_rle_rgbe",
    ),
    "exposure of 0": (b"#?RGBE\nEXPOSURE=0\n\n-Y 1 +X 1\n" + ONE, "line 2: EXPOSURE"),
    "exposure NaN": (b"#?RGBE\nEXPOSURE=nan\n\n-Y 1 +X 1\n" + ONE, "line 2: EXPOSURE"),
    "exposure in words": (b"#?RGBE\nEXPOSURE=dark\n\n-Y 1 +X 1\n" + ONE, "line 2: EXPOSURE"),
    "correction of one": (b"#?RGBE\nCOLORCORR=1\n\n-Y 1 +X 1\n" + ONE, "line 2: COLORCORR"),
    "other primaries": (
        b"#?RGBE\nPRIMARIES=0.7 0.3 0.2 0.8 0.1 0.05 0.33 0.33\n\n-Y 1 +X 1\n" + ONE,
        "primaries are not those of Rec. 709",
    ),
    "a pixel that overflows": (
        b"#?RGBE\nEXPOSURE=1e-20\n\n-Y 1 +X 2\n" + ONE + b"\xff\0\0\xff",
        "row 0, column 1: R is inf",
    ),
}


@pytest.mark.parametrize("name", BAD_HDR)
def test_a_damaged_radiance_picture_is_refused_with_its_place(tmp_path: Path, name: str) -> None:
    content, says = BAD_HDR[name]
    refused(write(tmp_path / "sky.hdr", content), says)


@pytest.mark.parametrize(
    ("value", "said"), [(np.nan, "nan"), (np.inf, "inf"), (-np.inf, "-inf"), (-0.25, r"-0\.25")]
)
def test_an_exr_pixel_that_no_light_gives_is_named_by_row_and_column(
    tmp_path: Path, value: float, said: str
) -> None:
    rgb = picture(6, 9)
    rgb[4, 7, 1] = value
    refused(
        write_exr(tmp_path / "a.exr", layers(rgb)),
        rf"row 4, column 7: G is {said}; mend that pixel",
    )


def bad_exr(folder: Path) -> Iterator[tuple[Path, str]]:
    """Yield EXR files that are none or too much, and what is said of them."""
    import OpenEXR

    rgb = layers(picture(5, 7))
    sound = write_exr(folder / "sound.exr", rgb).read_bytes()
    for name, content in {"empty": b"", "text": b"exr" * 99, "head": sound[:200]}.items():
        yield write(folder / f"{name}.exr", content), "no OpenEXR file, or it is damaged"
    for left in (len(sound) - 20, len(sound) - 100):
        yield write(folder / f"cut-{left}.exr", sound[:left]), "damaged"
    yield write_exr(folder / "y.exr", {"Y": rgb["R"]}), r"no channel R \(there are Y\)"
    yield write_exr(folder / "rg.exr", {n: rgb[n] for n in "RG"}), "no channel B"
    odd = sound.replace(b"\0R\0\2", b"\0\x97\0\2")
    assert odd != sound
    yield write(folder / "odd.exr", odd), "no UTF-8|no OpenEXR file"
    window = (np.array([0, 0], np.int32), np.array([9, 9], np.int32))
    yield write_exr(folder / "cropped.exr", rgb, displayWindow=window), "cropped"
    wide = (0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290)
    yield write_exr(folder / "wide.exr", rgb, chromaticities=wide), "primaries are not those"
    kind = {"type": OpenEXR.scanlineimage}
    parts = [OpenEXR.Part({**kind, "name": name}, rgb) for name in "ab"]
    OpenEXR.File(parts).write(str(folder / "parts.exr"))
    yield folder / "parts.exr", "several parts"
    for size, says in ((2**20, "more than 67108864"), (8000, "cannot stand in")):
        lying = bytearray(sound)
        for name in (b"dataWindow\0box2i\0", b"displayWindow\0box2i\0"):
            at = lying.index(name) + len(name) + 4
            lying[at : at + 16] = struct.pack("<4i", 0, 0, size - 1, size - 1)
        yield write(folder / f"lying-{size}.exr", bytes(lying)), says


def test_an_exr_file_that_is_damaged_or_lies_is_refused(tmp_path: Path) -> None:
    for path, says in bad_exr(tmp_path):
        refused(path, says)


def test_primaries_of_srgb_in_an_exr_header_are_welcome(tmp_path: Path) -> None:
    srgb = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)
    path = write_exr(tmp_path / "a.exr", layers(picture(2, 3)), chromaticities=srgb)
    assert read_environment(path).shape == (2, 3, 3)


def test_sizes_are_held_against_the_bytes_before_memory_is_taken(tmp_path: Path) -> None:
    path = write(tmp_path / "a.hdr", HEAD + b"-Y 8192 +X 8192\n" + ONE * 1000)
    tracemalloc.start()
    try:
        with pytest.raises(SceneError):
            read_environment(path)
        assert tracemalloc.get_traced_memory()[1] < 2**20
    finally:
        tracemalloc.stop()


def test_every_way_to_cut_a_radiance_picture_off_is_refused(tmp_path: Path) -> None:
    stored = rgbe_of(picture(3, 16))
    for encode in (flat, old_rle, new_rle):
        whole = hdr(stored, encode(stored))
        for end in range(len(whole)):
            with pytest.raises(SceneError):
                read_environment(write(tmp_path / "a.hdr", whole[:end]))


def test_other_suffixes_missing_files_and_pipes_are_named(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.hdr")
    refused(write(tmp_path / "a.png", b""), re.escape("'.png' is none of .hdr, .exr"))
    refused(tmp_path / "missing.hdr", "no such file")
    refused(tmp_path / "missing.exr", "no such file")
    refused(tmp_path / "pipe.hdr", "no such file")
    with (tmp_path / "giant.exr").open("wb") as stream:
        stream.truncate(2**31 + 1)
    refused(tmp_path / "giant.exr", "too large")

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""ICC profiles: ours as Little CMS understands them, others' as we do, and broken ones."""

from __future__ import annotations

import io
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageCms

from lamplit.colour.display import Display
from lamplit.colour.transfer import SRGB, PowerTransfer, TableTransfer
from lamplit.errors import LamplitError

CURVE = TableTransfer(tuple((np.linspace(0, 1, 256) ** 2.35).tolist()))
DISPLAYS = [
    Display.named("srgb"),
    Display.named("display-p3"),
    Display.named("rec2020"),
    Display.from_primaries([[0.67, 0.32], [0.21, 0.71], [0.15, 0.05]], [0.3457, 0.3585], 2.2),
    Display(
        "measured", ((0.66, 0.33), (0.27, 0.66), (0.15, 0.06)), (0.30, 0.32), (CURVE, CURVE, SRGB)
    ),
]
each_display = pytest.mark.parametrize("display", DISPLAYS, ids=lambda d: d.name)


def _opened(content: bytes) -> ImageCms.ImageCmsProfile:
    return ImageCms.ImageCmsProfile(io.BytesIO(content))


def _written(folder: Path, content: bytes) -> Path:
    path = folder / "display.icc"
    path.write_bytes(content)
    return path


@each_display
def test_little_cms_finds_the_primaries_in_our_profile(display: Display) -> None:
    profile = _opened(display.icc_profile()).profile
    found = [profile.red_primary, profile.green_primary, profile.blue_primary]
    colorants = np.array([primary[0] for primary in found])
    np.testing.assert_allclose(colorants.sum(axis=0), [0.9642, 1.0, 0.8249], atol=2e-5)
    adaptation = np.array(profile.chromatic_adaptation[0])
    own = colorants @ np.linalg.inv(adaptation).T
    chromaticities = own[:, :2] / own.sum(axis=1, keepdims=True)
    np.testing.assert_allclose(chromaticities, display.primaries_xy, atol=2e-4)


@each_display
def test_little_cms_converts_our_profile_to_the_same_srgb(display: Display) -> None:
    """Colours inside both gamuts, through 8-bit Little CMS and through our own matrices."""
    from lamplit.colour.adaptation import adaptation_matrix

    srgb = Display.named("srgb")
    wanted = np.random.default_rng(4).uniform(0.3, 0.7, (16, 16, 3))
    adapt = adaptation_matrix(srgb.white_xy, display.white_xy, method="bradford")
    linear = srgb.decode(wanted) @ (display.xyz_to_rgb @ adapt @ srgb.rgb_to_xyz).T
    assert linear.min() > 0.0
    assert linear.max() < 1.0
    signal = np.rint(display.encode(linear) * 255).astype(np.uint8)
    converted = ImageCms.profileToProfile(
        Image.fromarray(signal, "RGB"),
        _opened(display.icc_profile()),
        ImageCms.createProfile("sRGB"),
        renderingIntent=ImageCms.Intent.RELATIVE_COLORIMETRIC,
    )
    assert np.abs(np.asarray(converted) / 255.0 - wanted).max() < 2.5 / 255


@each_display
def test_our_profile_reads_back_as_the_same_display(display: Display, tmp_path: Path) -> None:
    back = Display.from_icc(_written(tmp_path, display.icc_profile()))
    np.testing.assert_allclose(back.primaries_xy, display.primaries_xy, atol=1e-4)
    np.testing.assert_allclose(back.white_xy, display.white_xy, atol=1e-4)
    signal = np.linspace(0.0, 1.0, 300)[:, None].repeat(3, axis=1)
    np.testing.assert_allclose(back.decode(signal), display.decode(signal), atol=5e-5)


def test_the_srgb_profile_of_little_cms_reads_as_srgb(tmp_path: Path) -> None:
    content = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    back = Display.from_icc(_written(tmp_path, content))
    srgb = Display.named("srgb")
    np.testing.assert_allclose(back.primaries_xy, srgb.primaries_xy, atol=3e-4)
    np.testing.assert_allclose(back.white_xy, srgb.white_xy, atol=3e-4)
    signal = np.linspace(0.0, 1.0, 256)[:, None].repeat(3, axis=1)
    np.testing.assert_allclose(back.decode(signal), srgb.decode(signal), atol=2e-5)


def test_a_version_2_profile_is_unadapted_by_its_white_point(tmp_path: Path) -> None:
    """Without ``chad`` the white of ``wtpt`` is the display's, as profiles of version 2 have it."""
    display = Display.named("srgb")
    content = bytearray(display.icc_profile())
    tags = {content[132 + 12 * i : 136 + 12 * i].decode(): 132 + 12 * i for i in range(10)}
    content[tags["chad"] : tags["chad"] + 4] = b"none"
    (offset,) = struct.unpack_from(">I", content, tags["wtpt"] + 4)
    white = display.rgb_to_xyz.sum(axis=1)
    struct.pack_into(">3i", content, offset + 8, *np.rint(white * 65536).astype(int).tolist())
    back = Display.from_icc(_written(tmp_path, bytes(content)))
    np.testing.assert_allclose(back.white_xy, display.white_xy, atol=1e-4)
    np.testing.assert_allclose(back.primaries_xy, display.primaries_xy, atol=1e-4)


def test_the_same_display_always_gives_the_same_bytes() -> None:
    assert Display.named("display-p3").icc_profile() == Display.named("display-p3").icc_profile()


@pytest.mark.parametrize("count", [0, 1, 2, 3, 4])
def test_every_parametric_curve_is_understood(count: int, tmp_path: Path) -> None:
    """ICC.1:2022, table 68, function types 0 to 4; the curve is the sRGB one or a power of 2.2."""
    srgb = [2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045]
    stored = {0: [2.2], 1: [2.2, 1, 0], 2: [2.2, 1, 0, 0], 3: srgb, 4: [*srgb, 0, 0]}[count]
    expected = PowerTransfer(2.2) if count < 3 else SRGB
    numbers = np.rint(np.array(stored) * 65536).astype(">i4").tobytes()
    curve = b"para" + struct.pack(">IHH", 0, count, 0) + numbers
    back = Display.from_icc(_written(tmp_path, _with_curve(curve)))
    signal = np.linspace(0.0, 1.0, 256)
    np.testing.assert_allclose(back.transfer[0].decode(signal), expected.decode(signal), atol=5e-5)


def _with_curve(curve: bytes) -> bytes:
    """Return the sRGB profile with another red curve at its end."""
    content = bytearray(Display.named("srgb").icc_profile())
    at = content.index(b"rTRC")
    struct.pack_into(">II", content, at + 4, len(content), len(curve))
    return bytes(content + curve)


def _replaced(old: bytes, new: bytes) -> Callable[[bytes], bytes]:
    return lambda content: content.replace(old, new)


def _curve(content: bytes) -> Callable[[bytes], bytes]:
    return lambda _: _with_curve(content)


_FALLING = b"curv" + struct.pack(">II3H", 0, 3, 65535, 30000, 0)
_SHORT = b"curv" + struct.pack(">II3H", 0, 9999, 0, 30000, 65535)
_UNKNOWN = b"para" + struct.pack(">IHHi", 0, 9, 0, 65536)
_NO_GAMMA = b"para" + struct.pack(">IHHi", 0, 0, 0, 0)


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda _: b"", "no ICC profile"),
        (lambda content: content[:100], "no ICC profile"),
        (lambda content: content[:140], "cut short"),
        (lambda content: content[:-40], "beyond the end"),
        (_replaced(b"acsp", b"spam"), "no ICC profile"),
        (_replaced(b"RGB XYZ ", b"CMYKLab "), "RGB profile"),
        (_replaced(b"gXYZ", b"A2B0"), "no gXYZ: one with look-up tables only"),
        (lambda c: c[:128] + b"\xff\xff\xff\xff" + c[132:], "are a lie"),
        (_replaced(b"XYZ \0\0\0\0", b"text\0\0\0\0"), "malformed"),
        (_replaced(b"sf32", b"sf16"), "malformed"),
        (_curve(_FALLING), "falls somewhere"),
        (_curve(_SHORT), "cut short"),
        (_curve(_UNKNOWN), "unknown function type 9"),
        (_curve(_NO_GAMMA), "does not rise"),
        (_curve(b"mft2" + b"\0" * 20), "neither"),
    ],
)
def test_a_broken_profile_is_refused_by_name(
    damage: Callable[[bytes], bytes], message: str, tmp_path: Path
) -> None:
    path = _written(tmp_path, damage(Display.named("srgb").icc_profile()))
    with pytest.raises(LamplitError, match=message) as caught:
        Display.from_icc(path)
    assert str(caught.value).startswith(str(path))


def test_no_flipped_byte_does_worse_than_a_clear_error(tmp_path: Path) -> None:
    content = Display.named("srgb").icc_profile()
    random = np.random.default_rng(9)
    for at in range(len(content)):
        damaged = bytearray(content)
        damaged[at] = int(random.integers(0, 256))
        try:
            Display.from_icc(_written(tmp_path, bytes(damaged)))
        except LamplitError:
            continue


def test_a_missing_profile_is_a_clear_error(tmp_path: Path) -> None:
    with pytest.raises(LamplitError, match="cannot be read"):
        Display.from_icc(tmp_path / "absent.icc")

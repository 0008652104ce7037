# SPDX-License-Identifier: Apache-2.0 OR MIT
"""R, G and B of an OpenEXR file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import SceneError
from lamplit.scene.picture_limits import MOST_PIXELS, check_primaries, check_size

#: How many times smaller than its pixels a file can be, by its compression: zlib reaches 1032, runs
#: of bytes 64. The others have no such bound.
_MOST_SHRUNK = {"NO": 1, "RLE": 64, "ZIPS": 1032, "ZIP": 1032}

_LEAST_BYTES_OF_A_NUMBER = 2


class _Sampled(Protocol):
    xSampling: int  # noqa: N815 (the library's names)
    ySampling: int  # noqa: N815
    name: str


class _Stored(Protocol):
    """What of OpenEXR's File is used; the library has no types."""

    parts: Sequence[object]

    def channels(self) -> dict[str, Any]: ...

    def header(self) -> dict[str, Any]: ...


def read_exr_rgb(path: Path) -> NDArray[np.float32]:
    """Return linear RGB (H, W, 3) of the channels ``R``, ``G`` and ``B`` of a one-part file.

    Raises:
        SceneError: The file is none, is damaged, has several parts, lacks a channel or has it at a
            lower resolution, or is cropped.
    """
    file = _opened(path, header_only=True)
    try:
        header = file.header()
        channels = {channel.name: channel for channel in cast("list[_Sampled]", header["channels"])}
    except UnicodeDecodeError as fault:
        raise SceneError("a name in the header is no UTF-8; write it anew", file=path) from fault
    height, width = _size(path, header)
    _check_channels(path, channels, height * width)
    shrunk = _MOST_SHRUNK.get(str(header["compression"]).partition(".")[2].partition("_COMP")[0])
    least = 3 * height * width * _LEAST_BYTES_OF_A_NUMBER
    if shrunk is not None and path.stat().st_size * shrunk < least:
        raise SceneError(
            f"{width} × {height} pixels cannot stand in {path.stat().st_size} bytes; "
            "the file is cut off, or its header is wrong",
            file=path,
        )
    stored = _opened(path, header_only=False).channels()
    rgb = np.empty((height, width, 3), dtype=np.float32)
    for index, name in enumerate("RGB"):
        pixels: NDArray[np.float32] | None = stored[name].pixels if name in stored else None
        if pixels is None or pixels.shape != (height, width):
            raise SceneError(f"the channel {name} is damaged; get the file anew", file=path)
        rgb[..., index] = pixels
    return rgb


def _opened(path: Path, *, header_only: bool) -> _Stored:
    """Return the file; the library leaves a file that it cannot read without any part."""
    import OpenEXR

    try:
        file = cast(
            "_Stored", OpenEXR.File(str(path), separate_channels=True, header_only=header_only)
        )
    except (OSError, RuntimeError, ValueError, TypeError) as fault:
        raise SceneError("this is no OpenEXR file, or it is damaged", file=path) from fault
    if len(file.parts) == 1:
        return file
    what = "it has several parts; write one" if file.parts else "its pixels are damaged"
    raise SceneError(f"the OpenEXR file cannot be used: {what}", file=path)


def _size(path: Path, header: dict[str, Any]) -> tuple[int, int]:
    """Return height and width."""
    (left, top), (right, bottom) = (corner.tolist() for corner in header["dataWindow"])
    window = [corner.tolist() for corner in header["displayWindow"]]
    height, width = bottom - top + 1, right - left + 1
    check_size(path, height, width)
    if window != [[left, top], [right, bottom]]:
        raise SceneError("the picture is cropped; write all of its display window", file=path)
    if "chromaticities" in header:
        check_primaries(path, np.ravel(header["chromaticities"]).tolist())
    if not str(header["type"]).endswith(("scanlineimage", "tiledimage")):
        raise SceneError("deep pictures are not understood; flatten it", file=path)
    return height, width


def _check_channels(path: Path, channels: dict[str, _Sampled], pixels: int) -> None:
    """Refuse what is not R, G and B for each pixel, or comes with too much besides."""
    if missing := [name for name in "RGB" if name not in channels]:
        raise SceneError(
            f"there is no channel {missing[0]} (there are {', '.join([*channels][:9])}); "
            "write R, G and B",
            file=path,
        )
    if any(channel.xSampling != 1 or channel.ySampling != 1 for channel in channels.values()):
        raise SceneError("a channel has a lower resolution; write all at the same", file=path)
    if len(channels) * pixels > 8 * MOST_PIXELS:
        raise SceneError(
            f"{len(channels)} channels of {pixels} pixels are too many; write R, G and B alone",
            file=path,
        )

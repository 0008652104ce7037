# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Pictures of the surround in linear RGB: Radiance ``.hdr`` and OpenEXR ``.exr``.

Files come from strangers, so the size of a picture is held against the bytes that are there before
memory is taken for it.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import SceneError
from lamplit.scene.exr_picture import read_exr_rgb
from lamplit.scene.radiance_picture import read_radiance

#: The suffixes of pictures that can surround a scene.
ENVIRONMENT_FORMATS = (".hdr", ".exr")

#: Larger files are refused before they are read.
_MOST_BYTES = 2**31


def read_environment(path: Path) -> NDArray[np.float32]:
    """Return linear RGB (H, W, 3), rows from the top, of a Radiance or an OpenEXR picture.

    The numbers are taken as they stand, for the primaries of Rec. ITU-R BT.709 (sRGB) and its white
    D65; a file that names other primaries is refused. ``EXPOSURE`` and ``COLORCORR`` of a Radiance
    header are divided out, as its manual says.

    Raises:
        SceneError: The file is no such picture, is damaged, is larger than 2²⁶ pixels, or has a
            pixel that is not finite or is negative; the message names its row and column, from 0.
    """
    readers = {".hdr": read_radiance, ".exr": read_exr_rgb}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise SceneError(
            f"the suffix {path.suffix!r} is none of {', '.join(ENVIRONMENT_FORMATS)}; convert it",
            file=path,
        )
    try:
        if not path.is_file():
            raise SceneError("there is no such file; check the name", file=path)
        if (size := path.stat().st_size) > _MOST_BYTES:
            raise SceneError(f"{size / 2**20:.0f} MB is too large for a picture", file=path)
        rgb = reader(path)
    except OSError as fault:
        raise SceneError(f"cannot be read: {fault.strerror}", file=path) from fault
    _check_pixels(path, rgb)
    return rgb


def _check_pixels(path: Path, rgb: NDArray[np.float32]) -> None:
    """Refuse a pixel that no light gives."""
    # NaN is in no order, so this is false for it too.
    good = (rgb >= 0.0) & (rgb < np.inf)
    if good.all():
        return
    row, column, channel = (int(at) for at in np.unravel_index(np.argmin(good), good.shape))
    raise SceneError(
        f"{'RGB'[channel]} is {rgb[row, column, channel]:g}; mend that pixel, as radiances are "
        "finite and not negative",
        file=path,
        where=f"row {row}, column {column}",
    )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""OpenEXR files as named channels and attributes: float32, lossless ZIP, whole or not there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import OutputError
from lamplit.report.atomic import replacing

Channels = Mapping[str, NDArray[np.float32]]


@dataclass(frozen=True, eq=False)
class ExrFile:
    """The channels of an OpenEXR file, each (H, W) as stored, and its header attributes."""

    channels: Channels
    attributes: Mapping[str, Any]

    @property
    def xyz(self) -> NDArray[np.float32]:
        """Tristimulus values, (H, W, 3), in cd/m²."""
        return self.vectors("")

    def vectors(self, prefix: str, names: str = "XYZ") -> NDArray[np.float32]:
        """Return the channels ``prefix`` + each of ``names``, (H, W, len(names)).

        Raises:
            KeyError: One of them is not there.
        """
        return np.stack([self.channels[prefix + name] for name in names], axis=-1)


def planes(prefix: str, names: str, values: NDArray[Any]) -> dict[str, NDArray[np.float32]]:
    """Return (H, W, len(names)) values as channels ``prefix`` + each of ``names``."""
    return {
        prefix + name: np.ascontiguousarray(values[..., at], dtype=np.float32)
        for at, name in enumerate(names)
    }


def save_exr(path: Path, channels: Channels, attributes: Mapping[str, Any]) -> None:
    """Write ``channels``, each (H, W), with ``attributes`` in the header.

    Raises:
        OutputError: The file cannot be written.
    """
    import OpenEXR

    header: dict[str, Any] = {
        "compression": OpenEXR.ZIP_COMPRESSION,
        "type": OpenEXR.scanlineimage,
        **attributes,
    }
    with replacing(path) as partial:
        try:
            OpenEXR.File(header, dict(channels)).write(str(partial))
        except RuntimeError as fault:
            raise OSError(str(fault)) from fault


class _Channel(Protocol):
    pixels: NDArray[np.float32]


class _Stored(Protocol):
    """What of OpenEXR's File is used; the library has no types."""

    def channels(self) -> dict[str, _Channel]: ...

    def header(self) -> dict[str, Any]: ...


def read_exr(path: Path) -> ExrFile:
    """Read back a file of `save_exr`.

    Raises:
        OutputError: The file is missing or is not an OpenEXR file.
    """
    import OpenEXR

    try:
        file = cast("_Stored", OpenEXR.File(str(path), separate_channels=True))
    except (OSError, RuntimeError, ValueError) as fault:
        raise OutputError(f"cannot be read as OpenEXR: {fault}", file=path) from fault
    channels = {name: channel.pixels for name, channel in file.channels().items()}
    return ExrFile(channels, file.header())

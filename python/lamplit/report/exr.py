# SPDX-License-Identifier: Apache-2.0 OR MIT
"""OpenEXR files: float32, lossless ZIP, every value in its unit and with its error.

Spectral bands follow A. Fichet, R. Pacanowski, A. Wilkie, "An OpenEXR Layout for Spectral
Images", Journal of Computer Graphics Techniques 10 (3), 2021.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import OutputError
from lamplit.report.atomic import replacing
from lamplit.report.losses import Losses
from lamplit.report.provenance import provenance

if TYPE_CHECKING:
    from lamplit.engine.image import Image
    from lamplit.report.develop import Developed

_UNITS = (
    "X, Y, Z: cd/m2 (Y is the luminance); standard_error.*: 1 sigma of the mean, cd/m2; "
    "R, G, B: linear, 1 at whiteLuminance, not gamut-mapped; S0.*: W.m^-2.sr^-1.nm^-1"
)


def write_exr(path: Path, image: Image, developed: Developed, *, spectral: bool = False) -> None:
    """Write ``image`` as float32 OpenEXR with ZIP compression.

    Channels: ``X Y Z`` in cd/m², ``standard_error.X`` to ``.Z`` in cd/m², ``R G B`` linear in the
    display's primaries before any gamut mapping, and with ``spectral`` one ``S0.<λ>nm`` per band.
    Header: chromaticities and whiteLuminance of the display, and all of `provenance`, each as
    ``lamplit.<name>``; ``lamplit.statistics`` has the engine's counts and ``lamplit.losses`` what
    is missing from the picture, both as JSON.

    Raises:
        OutputError: The file cannot be written, or bands are asked for that were not rendered.
    """
    import OpenEXR

    header: dict[str, Any] = {
        "compression": OpenEXR.ZIP_COMPRESSION,
        "type": OpenEXR.scanlineimage,
        **_attributes(image, developed),
    }
    channels = _channels(image, developed)
    if spectral:
        channels |= _bands(path, image)
        header |= {"spectralLayoutVersion": "1.0", "emissiveUnits": "W.m^-2.sr^-1.nm^-1"}
    with replacing(path) as partial:
        try:
            OpenEXR.File(header, channels).write(str(partial))
        except RuntimeError as fault:
            raise OSError(str(fault)) from fault


class _Channel(Protocol):
    pixels: NDArray[np.float32]


class _Stored(Protocol):
    """What of OpenEXR's File is used; the library has no types."""

    def channels(self) -> dict[str, _Channel]: ...

    def header(self) -> dict[str, Any]: ...


@dataclass(frozen=True, eq=False)
class ExrFile:
    """The channels of an OpenEXR file, each (H, W) as stored, and its header attributes."""

    channels: Mapping[str, NDArray[np.float32]]
    attributes: Mapping[str, Any]

    @property
    def xyz(self) -> NDArray[np.float32]:
        """Tristimulus values, (H, W, 3), in cd/m²."""
        return np.stack([self.channels[name] for name in "XYZ"], axis=-1)


def read_exr(path: Path) -> ExrFile:
    """Read back a file of `write_exr`.

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


def _channels(image: Image, developed: Developed) -> dict[str, NDArray[np.float32]]:
    layers = [
        ("", "XYZ", image.xyz),
        ("standard_error.", "XYZ", image.xyz_standard_error),
        ("", "RGB", developed.picture.linear),
    ]
    return {
        prefix + name: np.ascontiguousarray(values[..., index], dtype=np.float32)
        for prefix, names, values in layers
        for index, name in enumerate(names)
    }


def _bands(path: Path, image: Image) -> dict[str, NDArray[np.float32]]:
    if image.spectral_radiance is None:
        raise OutputError(
            "no spectral bands were rendered; ask for them with --spectral", file=path
        )
    return {
        band_name(centre): np.ascontiguousarray(image.spectral_radiance[..., band], np.float32)
        for band, centre in enumerate(image.band_centres_nm)
    }


def band_name(centre_nm: float) -> str:
    """Return the channel of a band, in the layout's spelling: a comma for the decimal point.

    >>> band_name(382.5)
    'S0.382,500nm'
    """
    return f"S0.{centre_nm:.3f}".replace(".", ",").replace(",", ".", 1) + "nm"


def _attributes(image: Image, developed: Developed) -> dict[str, Any]:
    display = developed.display
    corners = np.concatenate([display.primaries_xy, [display.white_xy]]).ravel()
    attributes: dict[str, Any] = {
        "software": f"Lamplit {image.version}",
        "chromaticities": tuple(float(value) for value in corners),
        "whiteLuminance": float(developed.white_luminance_cd_m2),
        "lamplit.units": _UNITS,
        "lamplit.losses": json.dumps(Losses.of(image).as_json(), ensure_ascii=True),
        "lamplit.statistics": json.dumps(dict(image.statistics), ensure_ascii=True),
    }
    for name, value in provenance(image).items():
        text = value if isinstance(value, str) else json.dumps(value)
        attributes[f"lamplit.{name}"] = text
    return attributes

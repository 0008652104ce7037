# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A picture as OpenEXR: every value in its unit and with its error.

Spectral bands follow A. Fichet, R. Pacanowski, A. Wilkie, "An OpenEXR Layout for Spectral
Images", Journal of Computer Graphics Techniques 10 (3), 2021.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import OutputError
from lamplit.report.exr_file import planes, save_exr
from lamplit.report.losses import Losses
from lamplit.report.provenance import provenance

if TYPE_CHECKING:
    from lamplit.engine.features import Features
    from lamplit.engine.image import Image
    from lamplit.report.develop import Developed

Array = NDArray[np.float64]
Plane = NDArray[np.float32]

_UNITS = (
    "X, Y, Z: cd/m2 (Y is the luminance); standard_error.*: 1 sigma of the mean, cd/m2; "
    "R, G, B: linear, 1 at whiteLuminance, no tone curve, not gamut-mapped; "
    "S0.*: W.m^-2.sr^-1.nm^-1; samples: count; depth.mm: mm along the ray, infinite where nothing "
    "is; normal.X/Y/Z: of the "
    "first surface, towards the eye; body: place in lamplit.bodies, from 0, or -1; albedo.X/Y/Z: "
    "of the first surface under equal-energy light, Y = 1 is white; interfaces: count"
)


def write_exr(path: Path, image: Image, developed: Developed, *, spectral: bool = False) -> None:
    """Write ``image`` as float32 OpenEXR with ZIP compression.

    Channels: ``X Y Z`` in cd/m², ``standard_error.X`` to ``.Z`` in cd/m², ``R G B`` linear in the
    display's primaries before any gamut mapping, ``samples`` of the pixel, with ``spectral`` one
    ``S0.<λ>nm`` per band, and of an image with features ``depth.mm``, ``normal.X`` to ``.Z``,
    ``body``, ``albedo.X`` to ``.Z`` and ``interfaces``. Header: chromaticities and whiteLuminance
    of the display, ``lamplit.view``, from which `View` is read back, and all of `provenance`, each
    as ``lamplit.<name>``; ``lamplit.statistics`` has the engine's counts, ``lamplit.losses`` what
    is missing from the picture, and ``lamplit.bodies`` the names of the bodies, all as JSON.

    Raises:
        OutputError: The file cannot be written, or bands are asked for that were not rendered.
    """
    channels = picture_channels(image.xyz, image.xyz_standard_error, developed)
    channels["samples"] = image.samples_per_pixel.astype(np.float32)
    attributes = header(image.version, developed, provenance(image)) | {
        "lamplit.units": _UNITS,
        "lamplit.losses": _text(Losses.of(image).as_json()),
        "lamplit.statistics": _text(dict(image.statistics)),
    }
    if spectral:
        channels |= _bands(path, image)
        attributes |= {"spectralLayoutVersion": "1.0", "emissiveUnits": "W.m^-2.sr^-1.nm^-1"}
    if image.features is not None:
        channels |= _features(image.features)
        attributes["lamplit.bodies"] = _text(image.features.body_names)
    save_exr(path, channels, attributes)


def picture_channels(xyz: Array, standard_error: Array, developed: Developed) -> dict[str, Plane]:
    """Return ``X Y Z``, their ``standard_error.*``, and ``R G B``."""
    errors = planes("standard_error.", "XYZ", standard_error)
    return planes("", "XYZ", xyz) | errors | planes("", "RGB", developed.picture.linear)


def header(version: str, developed: Developed, facts: Mapping[str, Any]) -> dict[str, Any]:
    """Return the attributes of a picture: its display, ``lamplit.view``, and all of ``facts``."""
    display = developed.display
    corners = np.concatenate([display.primaries_xy, [display.white_xy]]).ravel()
    own = {
        "software": f"Lamplit {version}",
        "chromaticities": tuple(float(value) for value in corners),
        "whiteLuminance": float(developed.white_luminance_cd_m2),
    }
    return own | fact_attributes({"view": developed.view.facts(), **facts})


def fact_attributes(facts: Mapping[str, Any]) -> dict[str, str]:
    """Return ``facts`` as attributes ``lamplit.<name>``: text as it is, the rest as JSON."""
    return {
        f"lamplit.{name}": value if isinstance(value, str) else _text(value)
        for name, value in facts.items()
    }


def band_name(centre_nm: float) -> str:
    """Return the channel of a band, in the layout's spelling: a comma for the decimal point.

    >>> band_name(382.5)
    'S0.382,500nm'
    """
    return f"S0.{centre_nm:.3f}".replace(".", ",").replace(",", ".", 1) + "nm"


def _bands(path: Path, image: Image) -> dict[str, Plane]:
    if image.spectral_radiance is None:
        raise OutputError(
            "no spectral bands were rendered; ask for them with --spectral", file=path
        )
    return {
        band_name(centre): np.ascontiguousarray(image.spectral_radiance[..., band], np.float32)
        for band, centre in enumerate(image.band_centres_nm)
    }


def _features(features: Features) -> dict[str, Plane]:
    single = {
        "depth.mm": features.depth_mm,
        "body": features.body,
        "interfaces": features.interfaces,
    }
    channels = {name: values.astype(np.float32) for name, values in single.items()}
    normals = planes("normal.", "XYZ", features.normal)
    return channels | normals | planes("albedo.", "XYZ", features.albedo)


def _text(value: object) -> str:
    return json.dumps(value, ensure_ascii=True)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""An image as arrays with labels: dimensions, units, and what made it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import xarray

    from lamplit.engine.features import Features
    from lamplit.engine.image import Image

_PIXELS = ("row", "column")
_VALUES = (*_PIXELS, "component")
_XYZ = "CIE tristimulus values; Y is the luminance"
#: The attributes of an image that say what made it.
_FACTS = ("seed", "samples", "samples_asked", "method", "colour", "version", "command")


def labelled(image: Image) -> xarray.Dataset:
    """See `Image.to_xarray`."""
    import xarray

    variables: dict[str, Any] = {
        "xyz": (_VALUES, image.xyz, _about("cd/m2", _XYZ)),
        "xyz_standard_error": (
            _VALUES,
            image.xyz_standard_error,
            _about("cd/m2", "standard error (1 sigma) of xyz"),
        ),
        "samples": (_PIXELS, image.samples_per_pixel, _about("1", "samples of the pixel")),
    }
    coordinates: dict[str, Any] = {
        "row": ("row", np.arange(image.height), {"long_name": "row from the top"}),
        "column": ("column", np.arange(image.width), {"long_name": "column from the left"}),
        "component": ("component", ["X", "Y", "Z"]),
    }
    if image.spectral_radiance is not None:
        about = _about("W m-2 sr-1 nm-1", "spectral radiance")
        variables["spectral_radiance"] = ((*_PIXELS, "wavelength"), image.spectral_radiance, about)
        middle = {"units": "nm", "long_name": "middle of the band"}
        coordinates["wavelength"] = ("wavelength", image.band_centres_nm, middle)
    if image.layers:
        variables |= _layers(image)
        coordinates["group"] = ("group", list(image.layers), {"long_name": "light group"})
    if image.features is not None:
        variables |= _features(image.features)
        coordinates["axis"] = ("axis", ["x", "y", "z"])
    attributes = {"scene": image.scene.name, "scene_hash": image.scene.scene_hash}
    attributes |= {name: getattr(image, name) for name in _FACTS}
    return xarray.Dataset(variables, coordinates, attributes)


def _about(units: str, long_name: str) -> dict[str, str]:
    return {"units": units, "long_name": long_name}


def _layers(image: Image) -> dict[str, Any]:
    over = ("group", *_VALUES)
    error = np.stack(list(image.layers_standard_error.values()))
    return {
        "layer_xyz": (over, np.stack(list(image.layers.values())), _about("cd/m2", _XYZ)),
        "layer_xyz_standard_error": (
            over,
            error,
            _about("cd/m2", "standard error (1 sigma) of layer_xyz"),
        ),
    }


def _features(features: Features) -> dict[str, Any]:
    names = {"names": ", ".join(features.body_names)}
    return {
        "depth": (_PIXELS, features.depth_mm, _about("mm", "distance to the first surface")),
        "normal": (
            (*_PIXELS, "axis"),
            features.normal,
            _about("1", "normal of the first surface, towards the eye"),
        ),
        "body": (
            _PIXELS,
            features.body,
            _about("1", "place in names of what the middle of the pixel shows, or -1") | names,
        ),
        "albedo": (
            _VALUES,
            features.albedo,
            _about("1", "tristimulus values of the first surface's albedo; Y = 1 is white"),
        ),
        "interfaces": (
            _PIXELS,
            features.interfaces,
            _about("1", "boundaries of transparent bodies until what is opaque"),
        ),
    }

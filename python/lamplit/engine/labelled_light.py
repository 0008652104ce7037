# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A measurement as arrays with labels: dimensions, units, and what made it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from lamplit.photometry.chance import variance_of_mean

if TYPE_CHECKING:
    import xarray

    from lamplit.engine.measurement import Measurement

_XYZ = "X, Y, Z of the intensity; Y is the luminous intensity"


def labelled(measurement: Measurement) -> xarray.Dataset:
    """See `Measurement.to_xarray`."""
    import xarray

    over = ("group", "V", "H")
    of_group = [measurement.observed({name: 1.0}) for name in measurement.groups]
    grid = np.stack([own.grid_xyz for own in of_group])
    errors = np.stack([own.grid_standard_error_cd for own in of_group])
    variables: dict[str, Any] = {
        "intensity": (over, grid[..., 1], _about("cd", "mean luminous intensity in the cell")),
        "intensity_standard_error": (
            over,
            errors,
            _about("cd", "standard error (1 sigma) of intensity"),
        ),
        "intensity_xyz": ((*over, "component"), grid, _about("cd", _XYZ)),
    }
    gonio = measurement.goniometer
    coordinates: dict[str, Any] = {
        "group": ("group", list(measurement.groups), {"long_name": "light group"}),
        "H": ("H", _middles(gonio.h_edges_deg), _about("degree", "to the right of an observer")),
        "V": ("V", _middles(gonio.v_edges_deg), _about("degree", "up")),
        "component": ("component", ["X", "Y", "Z"]),
    }
    if measurement.spot_xyz.shape[2]:
        variables |= _spots(measurement)
        coordinates |= {
            "spot_h": ("spot", gonio.spot_h_deg, _about("degree", "H of the spot")),
            "spot_v": ("spot", gonio.spot_v_deg, _about("degree", "V of the spot")),
            "wavelength": _wavelengths(measurement.band_centres_nm),
        }
    if measurement.grid_spectra is not None:
        wide = "wavelength" if not measurement.spot_xyz.shape[2] else "grid_wavelength"
        coordinates[wide] = (wide, *_wavelengths(measurement.grid_band_centres_nm)[1:])
        about = _about("W sr-1 nm-1", "mean spectral radiant intensity in the cell")
        variables["spectrum"] = ((*over, wide), measurement.grid_spectra, about)
    attributes = {
        "scene": measurement.scene.name,
        "scene_hash": measurement.scene.scene_hash,
        "paths": measurement.paths,
        "seed": measurement.seed,
        "receiver_deg": gonio.receiver_deg,
        "distance_m": "far field" if gonio.distance_m is None else gonio.distance_m,
        "version": measurement.version,
    }
    return xarray.Dataset(variables, coordinates, attributes)


def _spots(measurement: Measurement) -> dict[str, Any]:
    over = ("group", "spot", "component")
    of_group = [measurement.observed({name: 1.0}) for name in measurement.groups]
    errors = [np.sqrt(np.einsum("pii->pi", own.spot_xyz_covariance)) for own in of_group]
    return {
        "spot_xyz": (over, np.stack([own.spot_xyz for own in of_group]), _about("cd", _XYZ)),
        "spot_xyz_standard_error": (
            over,
            np.stack(errors),
            _about("cd", "standard error (1 sigma) of spot_xyz"),
        ),
        "spot_spectrum": (
            ("group", "spot", "wavelength"),
            measurement.spot_spectra,
            _about("W sr-1 nm-1", "spectral radiant intensity"),
        ),
        "spot_spectrum_standard_error": (
            ("group", "spot", "wavelength"),
            np.sqrt(variance_of_mean(measurement.spot_spectra_by_batch)),
            _about("W sr-1 nm-1", "standard error (1 sigma) of spot_spectrum, by its batches"),
        ),
    }


def _wavelengths(centres: Any) -> tuple[str, Any, dict[str, str]]:
    return "wavelength", centres, _about("nm", "middle of the band")


def _middles(edges: Any) -> Any:
    return 0.5 * (edges[:-1] + edges[1:])


def _about(units: str, long_name: str) -> dict[str, str]:
    return {"units": units, "long_name": long_name}

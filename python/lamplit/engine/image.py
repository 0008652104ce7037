# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Image`: what a render hands back, with the error of every number and how it came about."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray

    from lamplit.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, kw_only=True)
class Image:
    """Tristimulus values, and on request spectra, of H rows (from the top) by W columns."""

    #: Tristimulus values X, Y, Z, (H, W, 3), in cd/m² (K_m = 683 lm/W): Y is the luminance.
    xyz: Array
    #: Standard error (1σ) of the mean of each value in ``xyz``, (H, W, 3), in cd/m².
    xyz_standard_error: Array
    #: Mean spectral radiance per band, (H, W, B), in W·m⁻²·sr⁻¹·nm⁻¹; None unless asked for.
    spectral_radiance: Array | None = None
    #: The middle of each band, (B,), in nm, rising.
    band_centres_nm: Array = field(default_factory=lambda: np.empty(0))
    #: Samples per pixel that were taken (in every pixel at least), and that were asked for.
    samples: int
    samples_asked: int
    seed: int
    #: The scene as it was rendered, overrides included.
    scene: Scene
    #: The transport: ``hall`` is the founding shading model.
    method: str = "hall"
    #: ``rgb`` carried three numbers per light and material, ``spectral`` carried spectra.
    colour: Literal["spectral", "rgb"] = "spectral"
    #: Counts and timings of the engine by name (rays, lost rays, rays cut, ...).
    statistics: Mapping[str, Any] = field(default_factory=dict[str, Any])
    elapsed_s: float
    #: Whether all samples asked for are in.
    complete: bool
    #: Whether Ctrl-C or SIGTERM ended the render.
    interrupted: bool = False
    #: The version of Lamplit, and the command or call that makes this image again.
    version: str
    command: str = ""

    @property
    def height(self) -> int:
        """Rows."""
        return self.xyz.shape[0]

    @property
    def width(self) -> int:
        """Columns."""
        return self.xyz.shape[1]

    @property
    def luminance_cd_m2(self) -> Array:
        """Luminance L_v, (H, W), in cd/m²."""
        return self.xyz[..., 1]

    def to_xarray(self) -> xarray.Dataset:
        """Return the image as a labelled dataset; each array has ``units`` and a ``long_name``.

        Variables: ``xyz`` and ``xyz_standard_error`` over (row, column, component), and, where
        bands were kept, ``spectral_radiance`` over (row, column, wavelength). What made the
        picture (seed, samples, scene hash, command) is in the dataset's attributes.
        """
        import xarray

        pixels = ("row", "column")
        variables: dict[str, Any] = {
            "xyz": (
                (*pixels, "component"),
                self.xyz,
                {"units": "cd/m2", "long_name": "CIE tristimulus values; Y is the luminance"},
            ),
            "xyz_standard_error": (
                (*pixels, "component"),
                self.xyz_standard_error,
                {"units": "cd/m2", "long_name": "standard error (1 sigma) of xyz"},
            ),
        }
        coordinates: dict[str, Any] = {
            "row": ("row", np.arange(self.height), {"long_name": "row from the top"}),
            "column": ("column", np.arange(self.width), {"long_name": "column from the left"}),
            "component": ("component", ["X", "Y", "Z"]),
        }
        if self.spectral_radiance is not None:
            variables["spectral_radiance"] = (
                (*pixels, "wavelength"),
                self.spectral_radiance,
                {"units": "W m-2 sr-1 nm-1", "long_name": "spectral radiance"},
            )
            coordinates["wavelength"] = (
                "wavelength",
                self.band_centres_nm,
                {"units": "nm", "long_name": "middle of the band"},
            )
        attributes = {
            "scene": self.scene.name,
            "scene_hash": self.scene.scene_hash,
            "seed": self.seed,
            "samples": self.samples,
            "samples_asked": self.samples_asked,
            "method": self.method,
            "colour": self.colour,
            "version": self.version,
            "command": self.command,
        }
        return xarray.Dataset(variables, coordinates, attributes)

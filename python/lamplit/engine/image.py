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

    from lamplit.engine.features import Features
    from lamplit.engine.ledger import Ledger
    from lamplit.scene import Scene

Array = NDArray[np.float64]

#: The relative error of a pixel is taken of its luminance and this share of the picture's mean.
_FLOOR = 0.01


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
    #: By light group, X, Y, Z of its light alone, (H, W, 3), in cd/m²; empty unless asked for.
    layers: Mapping[str, Array] = field(default_factory=dict[str, Array])
    #: Standard error (1σ) of each value in ``layers``.
    layers_standard_error: Mapping[str, Array] = field(default_factory=dict[str, Array])
    #: What each pixel looks at; None unless asked for.
    features: Features | None = None
    #: Samples per pixel that were taken (on average), and that were asked for (at most).
    samples: int
    samples_asked: int
    #: Samples of each pixel, (H, W).
    samples_per_pixel: NDArray[np.uint32]
    #: The `relative_error` that was asked for, if any.
    error_asked: float | None = None
    #: Where the weight of all walks went; None for a method that keeps no ledger.
    ledger: Ledger | None = None
    seed: int
    #: The scene as it was rendered, overrides included.
    scene: Scene
    #: The transport: ``path`` is physical, ``hall`` is the founding shading model.
    method: str = "path"
    #: ``rgb`` carried three numbers per light and material, ``spectral`` carried spectra.
    colour: Literal["spectral", "rgb"] = "spectral"
    #: Counts and timings of the engine by name (rays, lost rays, rays cut, ...).
    statistics: Mapping[str, Any] = field(default_factory=dict[str, Any])
    elapsed_s: float
    #: What to know of the scene and the method, one line each.
    notices: tuple[str, ...] = ()
    #: Whether all was done that was asked for: samples, an error, or a time.
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

    @property
    def relative_error(self) -> float:
        """Root mean square over the pixels of the luminance's relative standard error.

        It is relative to the pixel's luminance and 1 % of the picture's mean together, since a
        share of black has no meaning. Infinite where a pixel has fewer than two samples.
        """
        return relative_error(self.xyz, self.xyz_standard_error)

    def to_xarray(self) -> xarray.Dataset:
        """Return the image as a labelled dataset; each array has ``units`` and a ``long_name``.

        Variables: ``xyz`` and ``xyz_standard_error`` over (row, column, component), ``samples``
        over (row, column), and, where they were asked for, ``spectral_radiance`` over (row, column,
        wavelength), ``layer_xyz`` and ``layer_xyz_standard_error`` over (group, row, column,
        component), and ``depth``, ``normal``, ``body``, ``albedo`` and ``interfaces``. What made
        the picture (seed, samples, scene hash, command) is in the dataset's attributes.
        """
        from lamplit.engine.labelled import labelled

        return labelled(self)


def relative_error(xyz: Array, standard_error: Array) -> float:
    """Return the `Image.relative_error` of X, Y, Z (H, W, 3) and their standard errors."""
    good = np.isfinite(xyz).all(axis=-1)
    luminance, error = xyz[..., 1][good], standard_error[..., 1][good]
    if not error.any():
        return 0.0
    tone = luminance + _FLOOR * luminance.mean()
    shares = np.divide(error, tone, out=np.zeros_like(error), where=error > 0.0)
    return float(np.sqrt(np.square(shares).mean()))

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Measurement`: what receivers caught of a lamp's light, group by group and batch by batch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from lamplit.engine.lumens import LumenLedger
from lamplit.engine.receivers import Goniometer
from lamplit.errors import LamplitError, nearest_name
from lamplit.photometry.chance import covariance_of_mean, let_out, variance_of_mean
from lamplit.photometry.observed import Observed

if TYPE_CHECKING:
    import xarray

    from lamplit.engine.cross_check import CrossCheck
    from lamplit.engine.eye_reading import EyeReading
    from lamplit.engine.light_sources import Light
    from lamplit.scene import Scene

Array = NDArray[np.float64]

#: A function of the lamp by its name, the weights of light groups, or None for all light.
Lit = str | Mapping[str, float] | None

#: Of spots as bright as this share of the brightest, the noise counts.
BRIGHT_SHARE = 0.05


@dataclass(frozen=True, eq=False, kw_only=True)
class Measurement:
    """Luminous intensity and its colour over directions, for every light group.

    Walks are made in b independent batches of as many paths each. A mean over the batches is the
    result; its standard error is √(s²/b) of their spread, for any weighted sum of groups. Where few
    paths of a group were caught, or none, it is an upper bound (`lamplit.photometry.chance`): hits
    weigh as much as they do over the whole grid, and where all is dark as much as paths that are
    sent out.
    """

    goniometer: Goniometer
    #: The names of the g light groups.
    groups: tuple[str, ...]
    #: (g, 3), X, Y, Z of the flux that each group sends out; Y in lm.
    emitted_xyz: Array
    #: (b, g, 3), of the flux that leaves the lamp.
    out_xyz: Array
    #: (b, g, p, 3), X, Y, Z of the intensity at the spots by the walks from the light; Y in cd.
    spot_xyz: Array
    #: (b, g, v, h, 3), mean intensity in the cells of the grid.
    grid_xyz: Array
    #: (b, g, rows, columns, 3), illuminance on the plane; Y in lx. None without one.
    plane_xyz: Array | None
    #: (b, g, p, n), spectral radiant intensity at the spots in W/(sr nm).
    spot_spectra_by_batch: Array
    #: (b, g, n), spectral flux that leaves the lamp, in W/nm.
    out_spectra_by_batch: Array
    #: (g, v, h, n), spectral radiant intensity in the cells, in W/(sr nm). None unless asked for.
    grid_spectra: Array | None
    #: (n,), the middles of the bands of spots, and of cells.
    band_centres_nm: Array
    grid_band_centres_nm: Array
    #: Paths walked, over all batches.
    paths: int
    #: Where the lumens went, by light group that sends out any.
    ledgers: Mapping[str, LumenLedger]
    #: The scene as it was measured, overrides included, and the light if it is not the scene's own.
    scene: Scene
    light: Light | None
    seed: int
    #: The spots by walks from the eye; None where they were read from the light alone.
    eye: EyeReading | None = None
    threads: int | None = None
    statistics: Mapping[str, Any] = field(default_factory=dict[str, Any])
    elapsed_s: float = 0.0
    #: Whether all was done that was asked for, and whether Ctrl-C ended it.
    complete: bool = True
    interrupted: bool = False
    version: str = ""

    def weights(self, lit: Lit = None) -> Array:
        """Return the weight of each light group, (g,), of a function of the scene's [measure].

        Raises:
            LamplitError: There is no such function or light group.
        """
        if lit is None:
            return np.ones(len(self.groups))
        light: Mapping[str, float]
        if isinstance(lit, str):
            settings = self.scene.measure
            functions = {own.name: own for own in (settings.functions if settings else ())}
            if lit not in functions:
                raise LamplitError(
                    f"the lamp has no function {lit!r}{nearest_name(lit, functions)}"
                )
            light = functions[lit].light
            if not light:
                return np.ones(len(self.groups))
        else:
            light = lit
        for name in light:
            if name not in self.groups:
                raise LamplitError(
                    f"there is no light group {name!r}{nearest_name(name, self.groups)}"
                )
        return np.array([light.get(name, 0.0) for name in self.groups])

    def observed(
        self, lit: Lit = None, *, name: str | None = None, by: Literal["both", "light"] = "both"
    ) -> Observed:
        """Return what a goniometer reads of one function, a weighted sum of light groups.

        Spots are read by the eye where it looked often enough and saw anything of a group, else
        ``by`` the light, as the grid always is.
        """
        weights = self.weights(lit)
        cells = np.einsum("g,bgvhi->bvhi", weights, self.grid_xyz)
        variance = variance_of_mean(cells[..., 1])
        for group, weight in enumerate(weights):
            of_cells = self.grid_xyz[:, group, ..., 1]
            spread, bound = self._let_out(group, of_cells, self.goniometer.cell_sr)
            variance += weight**2 * (bound - spread)
        eye = self.eye if by == "both" and self.eye and self.eye.is_enough else None
        spot_xyz, covariance = self._spots_by_light(weights, eye)
        if eye is not None:
            own, scatter = eye.observed(weights)
            spot_xyz, covariance = spot_xyz + own, covariance + scatter
        own_name = lit if isinstance(lit, str) else "all light" if lit is None else "+".join(lit)
        return Observed(
            name=name or own_name,
            spot_h_deg=self.goniometer.spot_h_deg,
            spot_v_deg=self.goniometer.spot_v_deg,
            spot_xyz=spot_xyz,
            spot_xyz_covariance=covariance,
            grid_h_edges_deg=self.goniometer.h_edges_deg,
            grid_v_edges_deg=self.goniometer.v_edges_deg,
            grid_xyz=cells.mean(axis=0),
            grid_standard_error_cd=np.sqrt(variance),
            paths=self.paths,
        )

    def _spots_by_light(self, weights: Array, eye: EyeReading | None) -> tuple[Array, Array]:
        """Return X, Y, Z (p, 3) of what ``eye`` did not see, and their covariance (p, 3, 3)."""
        shape = self.spot_xyz.shape[1:3]
        left: Array = np.ones(shape) if eye is None else 1.0 - eye.sees
        spots = np.einsum("g,gp,bgpi->bpi", weights, left, self.spot_xyz)
        covariance = covariance_of_mean(spots)
        for group, weight in enumerate(weights):
            few = self._few_hits(group, self.spot_xyz[:, group], self.goniometer.spot_sr)
            covariance += (weight**2 * left[group])[:, None, None] * few
        return spots.mean(axis=0), covariance

    def _let_out(self, group: int, y: Array, solid_angle: Array | float) -> tuple[Array, Array]:
        """Return the variances of the mean of a group's Y (b, …): of the spread, and as a bound."""
        mean, variance = y.mean(axis=0), variance_of_mean(y)
        unseen, seen = self._hits_lm[group].tolist()
        is_seen: Array = np.greater(mean, 0.0).astype(np.float64)
        hit = (is_seen * seen + (1.0 - is_seen) * unseen) / solid_angle
        return variance, let_out(mean, variance, hit)

    def _few_hits(self, group: int, xyz: Array, solid_angle: float) -> Array:
        """Return what the covariance of a group's X, Y, Z (b, p, 3) grows by, (p, 3, 3)."""
        spread, bound = self._let_out(group, xyz[..., 1], solid_angle)
        lit = spread > 0.0
        growth = np.divide(bound - spread, spread, out=np.zeros_like(bound), where=lit)
        sent = self.emitted_xyz[group] / (self.emitted_xyz[group, 1] or 1.0)
        unseen = np.where(lit, 0.0, bound)[:, None, None] * np.diag(sent**2)
        return growth[:, None, None] * covariance_of_mean(xyz) + unseen

    @cached_property
    def _hits_lm(self) -> Array:
        """What a hit brings, in lm over all paths, (g, 2): where none came, and elsewhere.

        A path that is sent out, and Σσ²/Σ over the grid, which of hits of weights w is Σw²/Σw.
        """
        lumens = self.grid_xyz[..., 1] * self.goniometer.cell_sr
        variance = variance_of_mean(lumens).sum(axis=(-2, -1))
        mean = lumens.mean(axis=0).sum(axis=(-2, -1))
        seen = np.divide(variance, mean, out=np.zeros_like(mean), where=mean > 0.0)
        return np.stack([self.emitted_xyz[:, 1] / max(self.paths, 1), seen], axis=-1)

    @property
    def spot_spectra(self) -> Array:
        """The spectral radiant intensity at the spots, (g, p, n), in W/(sr nm)."""
        return np.asarray(self.spot_spectra_by_batch.mean(axis=0), np.float64)

    @property
    def out_spectra(self) -> Array:
        """The spectral flux that leaves the lamp, (g, n), in W/nm."""
        return np.asarray(self.out_spectra_by_batch.mean(axis=0), np.float64)

    @property
    def emitted_lm(self) -> dict[str, float]:
        """The luminous flux that each light group sends out."""
        return dict(zip(self.groups, self.emitted_xyz[:, 1].tolist(), strict=True))

    @property
    def out_lm(self) -> dict[str, float]:
        """The luminous flux of each light group that leaves the lamp."""
        return dict(zip(self.groups, self.out_xyz.mean(axis=0)[:, 1].tolist(), strict=True))

    def efficiency(self, lit: Lit = None) -> float:
        """Return the share of the luminous flux sent out that leaves the lamp; NaN without flux."""
        weights = self.weights(lit)
        emitted = float(weights @ self.emitted_xyz[:, 1])
        return float(weights @ self.out_xyz.mean(axis=0)[:, 1]) / emitted if emitted else np.nan

    @property
    def ledger(self) -> LumenLedger:
        """Where the lumens of all light groups together went."""
        parts = list(self.ledgers.values())
        bodies = {body for part in parts for body in part.absorbed}
        names = ("emitted", "out", "cut_by_depth", "lost", "chance", "gap")
        sums = {name: float(sum(getattr(part, name) for part in parts)) for name in names}
        absorbed = {body: sum(part.absorbed[body] for part in parts) for body in sorted(bodies)}
        return LumenLedger(absorbed=absorbed, **sums)

    @property
    def relative_error(self) -> float:
        """The largest relative standard error among the spots worth it, for all light together.

        Those are the spots with 5 % of the brightest one's intensity or more; without spots, the
        root mean square over such cells of the grid. Infinite where nothing was caught.
        """
        seen = self.observed()
        is_grid = seen.spot_cd.size == 0
        value, error = (seen.grid_cd, seen.grid_standard_error_cd)
        if not is_grid:
            value, error = seen.spot_cd, seen.spot_standard_error_cd
        brightest = float(value.max(initial=0.0))
        bright = value >= BRIGHT_SHARE * brightest
        if brightest <= 0.0:
            return float("inf")
        shares = error[bright] / value[bright]
        return float(np.sqrt(np.square(shares).mean()) if is_grid else shares.max())

    def cross_check(self, lit: Lit = None, **settings: Any) -> CrossCheck:
        """Measure the spots again by walks from the eye; see `lamplit.engine.cross_check`."""
        from lamplit.engine.cross_check import cross_check

        return cross_check(self, lit, **settings)

    def to_xarray(self) -> xarray.Dataset:
        """Return it as a labelled dataset; each array has ``units`` and a ``long_name``.

        Variables: ``intensity`` and its ``intensity_standard_error`` in cd over (group, V, H),
        ``intensity_xyz`` over (group, V, H, component), ``spot_xyz`` and its standard error over
        (group, spot, component), ``spot_spectrum`` and its standard error over (group, spot,
        wavelength), and, with ``spectra``, ``spectrum`` over (group, V, H, wavelength). H and V are
        middles of cells in degrees.
        """
        from lamplit.engine.labelled_light import labelled

        return labelled(self)

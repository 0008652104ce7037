# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Light to measure a lamp by, instead of what shines in its scene: given rays, or a beam."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit import _core
from lamplit.engine.carrier import SpectralCarrier
from lamplit.engine.receivers import Goniometer
from lamplit.errors import LamplitError
from lamplit.scene import Scene
from lamplit.scene.shining import light_groups
from lamplit.spectrum import SpectralDistribution


@dataclass(frozen=True, eq=False, kw_only=True)
class RayLight:
    """Rays, n of them, such as a maker measured of a lamp, in the frame of the scene.

    With a ``spectrum`` for all, whose scale has no meaning, ``flux`` is in lm. With
    ``wavelengths_nm``, one for each ray, it is in W.
    """

    #: (n, 3), where each ray starts.
    positions_mm: ArrayLike
    #: (n, 3), of any length but zero.
    directions: ArrayLike
    #: (n,), in lm or in W.
    flux: ArrayLike
    spectrum: SpectralDistribution | str | None = None
    wavelengths_nm: ArrayLike | None = None
    group: str = "rays"


@dataclass(frozen=True, kw_only=True)
class BeamLight:
    """A beam on the lamp from the direction (H, V), as retro-reflectors are measured in.

    It comes from a disc of ``angular_radius_deg``, and gives a face square to it the illuminance
    ``illuminance_lx``: with 1 lx, intensities are coefficients of luminous intensity R in cd/lx.
    """

    h_deg: float = 0.0
    v_deg: float = 0.0
    #: 5′: half of the 10′ that the source of UN R150's goniometers may subtend.
    angular_radius_deg: float = 1.0 / 12.0
    source: SpectralDistribution | str = "A"
    illuminance_lx: float = 1.0
    group: str = "beam"


Light = RayLight | BeamLight


@dataclass(frozen=True, eq=False, kw_only=True)
class Laboratory:
    """A built scene, and what it is measured with."""

    world: _core.Scene
    scene: Scene
    carrier: SpectralCarrier
    goniometer: Goniometer
    method: _core.PathMethod
    seed: int

    def photometer(self, light: Light | None) -> _core.Photometer:
        """Return the core's photometer for the scene's own light, or for ``light``.

        Raises:
            LamplitError: The light cannot be used.
            ValueError: The core refuses it.
        """
        match light:
            case None:
                return self._shining()
            case BeamLight():
                return self._beam(light)
            case RayLight():
                receivers = self.goniometer.for_core()
                rays = self._rays(light)
                return _core.Photometer.rays(
                    self.world, receivers, self.method, rays, seed=self.seed
                )

    def _beam(self, light: BeamLight) -> _core.Photometer:
        spectrum = self._spectrum(light.source)
        h, v = np.radians(light.h_deg), np.radians(light.v_deg)
        local = np.array([np.sin(h) * np.cos(v), np.sin(v), np.cos(h) * np.cos(v)])
        return _core.Photometer.beam(
            self.world,
            self.goniometer.for_core(),
            self.method,
            (-local @ self.goniometer.frame()).tolist(),
            float(np.radians(light.angular_radius_deg)),
            self.carrier.light(spectrum, light.illuminance_lx, where="beam"),
            seed=self.seed,
        )

    def _rays(self, light: RayLight, group: int = 0) -> _core.Rays:
        spectrum: NDArray[np.float64] | None = None
        wavelengths: NDArray[np.uint32] | None = None
        if light.spectrum is not None and light.wavelengths_nm is None:
            spectrum = self.carrier.light(self._spectrum(light.spectrum), 1.0, where="rays")
        elif light.spectrum is None and light.wavelengths_nm is not None:
            own = np.asarray(light.wavelengths_nm, np.float64)
            wavelengths = _wavelength_numbers(own, self.carrier)
        else:
            raise LamplitError("rays have either one spectrum, or wavelengths_nm of their own")
        return _core.Rays(
            self.world,
            np.ascontiguousarray(light.positions_mm, np.float64),
            np.ascontiguousarray(light.directions, np.float64),
            np.ascontiguousarray(light.flux, np.float64),
            spectrum=spectrum,
            wavelengths=wavelengths,
            step_nm=self.carrier.step_nm,
            group=group,
        )

    def _shining(self) -> _core.Photometer:
        """Return a photometer for the objects that shine, and for the scene's ray files."""
        groups = light_groups(self.scene)
        rays = [
            self._rays(
                RayLight(
                    positions_mm=own.positions_mm,
                    directions=own.directions,
                    flux=own.flux,
                    spectrum=own.spectrum,
                    wavelengths_nm=own.wavelengths_nm,
                ),
                groups.index(own.group),
            )
            for own in self.scene.resolved_rays()
        ]
        receivers = self.goniometer.for_core()
        return _core.Photometer.shining(
            self.world, receivers, self.method, rays=rays, seed=self.seed
        )

    def _spectrum(self, source: SpectralDistribution | str) -> SpectralDistribution:
        return self.scene.resolve_source(source) if isinstance(source, str) else source


def _wavelength_numbers(
    wavelengths_nm: NDArray[np.float64], carrier: SpectralCarrier
) -> NDArray[np.uint32]:
    """Return which of the picture's wavelengths, each the middle of a step, is nearest."""
    low = carrier.wavelengths_nm[0] - carrier.step_nm / 2.0
    places = np.floor((wavelengths_nm - low) / carrier.step_nm)
    outside = ~((places >= 0) & (places < carrier.count))
    if outside.any():
        ray = int(np.argmax(outside))
        raise LamplitError(
            f"ray {ray} has the wavelength {wavelengths_nm[ray]:g} nm, outside of "
            "image.wavelength_range_nm; widen it, or leave such rays out"
        )
    return places.astype(np.uint32)

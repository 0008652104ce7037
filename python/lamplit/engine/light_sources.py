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


def photometer(
    world: _core.Scene,
    scene: Scene,
    goniometer: Goniometer,
    method: _core.PathMethod,
    carrier: SpectralCarrier,
    light: Light | None,
    seed: int,
) -> _core.Photometer:
    """Return the core's photometer for the scene's own light, or for ``light``.

    Raises:
        LamplitError: The light cannot be used.
        ValueError: The core refuses it.
    """
    receivers = goniometer.for_core()
    match light:
        case None:
            return _core.Photometer.shining(world, receivers, method, seed=seed)
        case BeamLight():
            spectrum = _spectrum(scene, light.source)
            irradiance = carrier.light(spectrum, light.illuminance_lx, where="beam")
            h, v = np.radians(light.h_deg), np.radians(light.v_deg)
            local = np.array([np.sin(h) * np.cos(v), np.sin(v), np.cos(h) * np.cos(v)])
            travels = (-local @ goniometer.frame()).tolist()
            radius = float(np.radians(light.angular_radius_deg))
            return _core.Photometer.beam(
                world, receivers, method, travels, radius, irradiance, seed=seed
            )
        case RayLight():
            return _rays(world, scene, receivers, method, carrier, light, seed)


def _rays(
    world: _core.Scene,
    scene: Scene,
    receivers: _core.Receivers,
    method: _core.PathMethod,
    carrier: SpectralCarrier,
    light: RayLight,
    seed: int,
) -> _core.Photometer:
    if (light.spectrum is None) == (light.wavelengths_nm is None):
        raise LamplitError("rays have either one spectrum, or wavelengths_nm of their own")
    arrays = [np.ascontiguousarray(a, np.float64) for a in (light.positions_mm, light.directions)]
    flux = np.ascontiguousarray(light.flux, np.float64)
    if light.spectrum is not None:
        spectrum = carrier.light(_spectrum(scene, light.spectrum), 1.0, where="rays")
        return _core.Photometer.rays(
            world, receivers, method, *arrays, flux, spectrum=spectrum, seed=seed
        )
    numbers = _wavelength_numbers(np.asarray(light.wavelengths_nm, np.float64), carrier)
    return _core.Photometer.rays(
        world,
        receivers,
        method,
        *arrays,
        flux,
        wavelengths=numbers,
        step_nm=carrier.step_nm,
        seed=seed,
    )


def _wavelength_numbers(wavelengths_nm: NDArray[np.float64], carrier: SpectralCarrier) -> NDArray[np.uint32]:
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


def _spectrum(scene: Scene, source: SpectralDistribution | str) -> SpectralDistribution:
    return scene.resolve_source(source) if isinstance(source, str) else source

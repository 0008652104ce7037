# SPDX-License-Identifier: Apache-2.0 OR MIT
"""All that shines, as the compiled core takes it: the background and the emissions of objects."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lamplit import _core
from lamplit.engine.carrier import Array, Carrier
from lamplit.photometry import Photometry
from lamplit.scene import Scene
from lamplit.scene.emission import ResolvedEmission
from lamplit.scene.lighting import (
    ConstantBackground,
    GradientBackground,
    ImageBackground,
    Radiator,
    SkyBackground,
    SoftBox,
    StudioBackground,
)

#: A table that does not go all round is dark beyond its ends, after this angle.
_EDGE_RAD = 1e-6


def radiance(scene: Scene, carrier: Carrier, radiator: Radiator, where: str) -> Array:
    """Return a radiator's spectrum at its luminance, as ``carrier`` carries it."""
    spectrum = scene.resolve_source(radiator.source)
    return carrier.light(spectrum, radiator.luminance_cd_m2, where=f"{where}.source")


def core_background(scene: Scene, carrier: Carrier, groups: Sequence[str]) -> _core.Background:
    """Return all that lies beyond ``scene``; ``groups`` are the names of its light groups."""
    background = scene.background
    surround = _surround(scene, carrier, groups.index(background.group))
    if isinstance(background, StudioBackground):
        for at, soft_box in enumerate(background.soft_boxes):
            surround.add_soft_box(
                radiance(scene, carrier, soft_box, f"background.soft_boxes[{at}]"),
                soft_box.centre_mm,
                *_half_axes(soft_box),
                soft_box.edge_softness,
                groups.index(soft_box.group),
            )
    for at, sun in enumerate(background.suns):
        spectrum = scene.resolve_source(sun.source)
        where = f"background.suns[{at}].source"
        disc = carrier.light(spectrum, sun.disc_luminance_cd_m2, where=where)
        surround.add_sun(disc, sun.direction, sun.angular_radius_rad, groups.index(sun.group))
    return surround


def _surround(scene: Scene, carrier: Carrier, group: int) -> _core.Background:
    background = scene.background
    base = background.base if isinstance(background, StudioBackground) else background
    match base:
        case ConstantBackground():
            even = radiance(scene, carrier, base, "background")
            return _core.Background.constant(even, group)
        case GradientBackground():
            zenith = radiance(scene, carrier, base.zenith, "background.zenith")
            nadir = radiance(scene, carrier, base.nadir, "background.nadir")
            return _core.Background.gradient(zenith, nadir, group)
        case SkyBackground():
            return _sky(scene, carrier, base, group)
        case ImageBackground():
            return _picture(scene, carrier, base, group)


def _sky(scene: Scene, carrier: Carrier, sky: SkyBackground, group: int) -> _core.Background:
    spectrum = scene.resolve_source(sky.source)
    zenith = carrier.light(spectrum, sky.zenith_luminance_cd_m2, where="background.source")
    ground = np.zeros(carrier.count)
    if sky.ground is not None:
        ground = radiance(scene, carrier, sky.ground, "background.ground")
    kind, sun = sky.general_type, sky.sun_direction
    return _core.Background.sky(zenith, ground, group, kind=kind, towards_sun=sun)


def _picture(
    scene: Scene, carrier: Carrier, picture: ImageBackground, group: int
) -> _core.Background:
    pixels = scene.environment
    if pixels is None:
        raise TypeError("an image background has a picture")
    white = scene.resolve_source(picture.source)
    bases = carrier.environment(white, picture.scale)
    turn = float(np.radians(picture.rotate_deg))
    return _core.Background.image(pixels, bases, turn, group)


def _half_axes(soft_box: SoftBox) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return half the width and half the height as vectors whose product points to the front."""
    normal = np.subtract(soft_box.facing_mm, soft_box.centre_mm)
    right = np.cross(soft_box.up, normal)
    right /= np.linalg.norm(right)
    upright = np.cross(normal, right)
    upright /= np.linalg.norm(upright)
    half_width: NDArray[np.float64] = right * (soft_box.width_mm / 2.0)
    half_height: NDArray[np.float64] = upright * (soft_box.height_mm / 2.0)
    return tuple(half_width.tolist()), tuple(half_height.tolist())


def core_emission(emission: ResolvedEmission, carrier: Carrier, *, where: str) -> _core.Emission:
    """Return how an object shines; its light group is given with the object."""
    spectrum, amount = emission.spectrum, emission.amount
    match emission.quantity:
        case "flux_lm":
            # The scaling is that of a luminance; the unit is W/nm.
            shines = _core.Emission.flux(carrier.light(spectrum, amount, where=where))
        case "radiant_flux_w":
            shines = _core.Emission.flux(carrier.radiant(spectrum, amount, where=where))
        case "luminance_cd_m2":
            shines = _core.Emission.radiance(carrier.light(spectrum, amount, where=where))
        case "spectral_radiance":
            shines = _core.Emission.radiance(carrier.absolute(spectrum))
    if emission.photometry is not None:
        polar, azimuths, intensities = _grid(emission.photometry)
        axes = emission.photometry.polar.frame @ emission.frame
        shines.set_intensities(polar, azimuths, intensities, axes.tolist())
    elif emission.cosine_exponent != 1.0:
        shines.set_cosine(emission.cosine_exponent)
    return shines


def _grid(photometry: Photometry) -> tuple[Array, Array, Array]:
    """Return polar angles, azimuths in [0, 2π) and intensities, azimuth by azimuth."""
    table = photometry.polar
    polar = np.ascontiguousarray(np.radians(table.polar_deg))
    azimuths, candela = np.radians(table.azimuths_deg), np.asarray(table.candela)
    span = float(azimuths[-1] - azimuths[0])
    if span > 2.0 * np.pi - 1e-9:
        azimuths, candela = azimuths[:-1], candela[:-1]
    elif len(azimuths) > 1:
        dark = np.zeros((1, candela.shape[1]))
        ends = [[azimuths[0] - _EDGE_RAD], azimuths, [azimuths[-1] + _EDGE_RAD]]
        azimuths, candela = np.concatenate(ends), np.concatenate([dark, candela, dark])
    azimuths = np.mod(azimuths, 2.0 * np.pi)
    order = np.argsort(azimuths)
    return polar, azimuths[order], np.ascontiguousarray(candela[order]).ravel()

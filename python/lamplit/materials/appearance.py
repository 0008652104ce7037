# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What a plate or a surface of a material looks like: its spectrum, and its XYZ under a source."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lamplit.materials.models import Checker, Conductor, Dielectric, Glossy, Material
from lamplit.materials.optics import lacquered_reflectance, normal_reflectance, slab_transmittance
from lamplit.spectrum import Array, SpectralDistribution

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

#: The working range, every nm.
VISIBLE_NM: Array = np.arange(380.0, 781.0)


def plate_transmittance(
    material: Dielectric, wavelengths_nm: ArrayLike, thickness_mm: float
) -> Array:
    """Return the total transmittance of a plane plate at normal incidence, both faces counted."""
    return slab_transmittance(
        material.index(wavelengths_nm), material.absorption_per_mm(wavelengths_nm), thickness_mm
    )


def surface_reflectance(material: Material, wavelengths_nm: ArrayLike) -> Array:
    """Return the total reflectance of one surface at normal incidence.

    A glossy body adds what its matt base gives back to Fresnel's gloss (light that turns back
    inside the surface is left out); a checker counts as the mean of its two squares, and every
    surface as smooth.
    """
    if isinstance(material, Dielectric):
        return normal_reflectance(material.index(wavelengths_nm))
    if isinstance(material, Conductor):
        n, k = material.index(wavelengths_nm), material.extinction(wavelengths_nm)
        if material.lacquer is not None:
            coat = material.lacquer.index(wavelengths_nm)
            depth = material.lacquer.optical_depth(wavelengths_nm)
            return lacquered_reflectance(coat, n, k, depth, factor=material.factor)
        return material.factor * normal_reflectance(n, k)
    if isinstance(material, Checker):
        both = material.reflectance_a_at(wavelengths_nm) + material.reflectance_b_at(wavelengths_nm)
        return 0.5 * both
    if isinstance(material, Glossy):
        gloss = normal_reflectance(material.index(wavelengths_nm))
        return gloss + (1.0 - gloss) ** 2 * material.reflectance_at(wavelengths_nm)
    return material.reflectance_at(wavelengths_nm)


def seen_xyz(values: Array, source_name: str) -> NDArray[np.float64]:
    """Return XYZ (3,) of a transmittance or reflectance under a source of the library.

    ``values`` (401,) stand at `VISIBLE_NM`; Y = 100 for a perfect plate or reflector; CIE 1931 2°.
    """
    from lamplit.colour.tristimulus import tristimulus
    from lamplit.sources import source

    return tristimulus(
        source(source_name).distribution(),
        reflectance=SpectralDistribution.tabulated(VISIBLE_NM, values),
        normalisation="relative",
        range_nm=(380.0, 780.0),
    )

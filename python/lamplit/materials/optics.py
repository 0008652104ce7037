# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Closed forms of plane interfaces: Fresnel, the incoherent slab, Abbe's number."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from lamplit.spectrum import Array

#: The lines F (hydrogen), d (helium) and C (hydrogen) in nm, by which glass is specified.
LINE_F_NM, LINE_D_NM, LINE_C_NM = 486.1327, 587.5618, 656.2725


def abbe_number(index: Callable[[ArrayLike], Array]) -> float:
    """Return V_d = (n_d − 1) / (n_F − n_C); infinite where there is no dispersion.

    ``index`` gives n at wavelengths in nm. Source: ISO 7944.
    """
    n_f, n_d, n_c = (float(n) for n in index(np.array([LINE_F_NM, LINE_D_NM, LINE_C_NM])))
    return (n_d - 1.0) / (n_f - n_c) if n_f != n_c else float("inf")


def normal_reflectance(n: ArrayLike, k: ArrayLike = 0.0) -> Array:
    """Return R = ((n − 1)² + k²) / ((n + 1)² + k²), the reflectance at normal incidence in air.

    >>> round(float(normal_reflectance(1.5)), 3)
    0.04
    """
    index, extinction = np.asarray(n, dtype=np.float64), np.asarray(k, dtype=np.float64)
    return ((index - 1) ** 2 + extinction**2) / ((index + 1) ** 2 + extinction**2)


def lacquered_reflectance(
    coat: ArrayLike, n: ArrayLike, k: ArrayLike, optical_depth: ArrayLike, *, factor: float = 1.0
) -> Array:
    """Return the reflectance at normal incidence of a metal under a coat of index ``coat``, in air.

    R = F + (1 − F)² R₁₂ τ² / (1 − F R₁₂ τ²), τ = exp(−a): every reflection between the coat's
    surface F and the metal R₁₂ = ``factor`` times that of (n + i k)/``coat`` is counted, and
    interference is not. ``optical_depth`` is a, of one passage.

    >>> float(lacquered_reflectance(1.5, 0.0, 5.0, 0.0))
    1.0
    """
    index = np.asarray(coat, dtype=np.float64)
    surface = normal_reflectance(index)
    metal = factor * normal_reflectance(np.asarray(n) / index, np.asarray(k) / index)
    below = metal * np.exp(-2.0 * np.asarray(optical_depth, dtype=np.float64))
    return surface + (1.0 - surface) ** 2 * below / (1.0 - surface * below)


def fresnel_reflectances(n: ArrayLike, angle_deg: float) -> tuple[Array, Array]:
    """Return R_s and R_p of a clear medium of index ``n`` at ``angle_deg`` from the air side."""
    index = np.asarray(n, dtype=np.float64)
    cos_in = np.cos(np.radians(angle_deg))
    cos_out = np.sqrt(1.0 - (np.sin(np.radians(angle_deg)) / index) ** 2)
    r_s = (cos_in - index * cos_out) / (cos_in + index * cos_out)
    r_p = (index * cos_in - cos_out) / (index * cos_in + cos_out)
    return r_s**2, r_p**2


def slab_transmittance(
    n: ArrayLike, absorption_per_mm: ArrayLike, thickness_mm: float, *, angle_deg: float = 0.0
) -> Array:
    """Return the total transmittance of a plane slab in air for unpolarised light.

    T = (1 − R)² τ / (1 − R² τ²), averaged over s and p, with τ = exp(−α b / cos θ') the internal
    transmittance along the refracted path: every reflection between the two faces is counted, and
    interference is not. ``n`` and ``absorption_per_mm`` have one shape, and T has the same.

    Source: M. Born, E. Wolf, Principles of Optics, 1.5; the series of inter-reflections summed.

    >>> round(float(slab_transmittance(1.4915, 0.0, 3.0)), 4)
    0.9251
    """
    index = np.asarray(n, dtype=np.float64)
    cos_inside = np.sqrt(1.0 - (np.sin(np.radians(angle_deg)) / index) ** 2)
    tau = np.exp(-np.asarray(absorption_per_mm, dtype=np.float64) * thickness_mm / cos_inside)
    through = [
        (1.0 - r) ** 2 * tau / (1.0 - (r * tau) ** 2)
        for r in fresnel_reflectances(index, angle_deg)
    ]
    return 0.5 * (through[0] + through[1])

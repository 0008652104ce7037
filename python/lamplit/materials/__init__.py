# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Matter as measured functions of wavelength: plastics, glass, metals, paints."""

from __future__ import annotations

from lamplit.materials.finish import Lacquer, Roughness, Scattering, Texture
from lamplit.materials.library import material, material_names
from lamplit.materials.models import (
    Checker,
    Conductor,
    Dielectric,
    Diffuse,
    DiffuseTransmitter,
    Glossy,
    HallTerms,
    Material,
    Mirror,
)

__all__ = [
    "Checker",
    "Conductor",
    "Dielectric",
    "Diffuse",
    "DiffuseTransmitter",
    "Glossy",
    "HallTerms",
    "Lacquer",
    "Material",
    "Mirror",
    "Roughness",
    "Scattering",
    "Texture",
    "material",
    "material_names",
]

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Matter as measured functions of wavelength: plastics, glass, metals, paints."""

from __future__ import annotations

from lamplit.materials.library import material, material_names
from lamplit.materials.models import (
    Checker,
    Conductor,
    Dielectric,
    Diffuse,
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
    "Glossy",
    "HallTerms",
    "Material",
    "Mirror",
    "material",
    "material_names",
]

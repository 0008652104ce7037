# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What can be added to a material: roughness, a lacquer on a metal, scattering in clear matter."""

from __future__ import annotations

from typing import Annotated, TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic_core import PydanticCustomError

from lamplit.materials.index_spec import IndexSpec
from lamplit.materials.transmittance import TransmittanceSpec
from lamplit.spec_forms import Number, Positive
from lamplit.spectra_spec import CoefficientSpec
from lamplit.spectrum import Array

#: Below it, a rough surface cannot be told from a smooth one, and its peak is too high for doubles.
LEAST_ROUGHNESS = 1e-3

_UM_PER_MM = 1e3


def _rough_enough(roughness: float) -> float:
    if 0.0 < roughness < LEAST_ROUGHNESS:
        raise PydanticCustomError(
            "roughness",
            "a roughness is 0 (smooth) or {least} to 1, and {given} is given",
            {"least": f"{LEAST_ROUGHNESS:g}", "given": f"{roughness:g}"},
        )
    return roughness


def _has_length(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    if max(abs(part) for part in vector) < 1e-12:
        raise PydanticCustomError("no_direction", "a direction needs a length other than zero")
    return vector


#: The width α of the GGX distribution of facets: 0 for smooth, else 0.001 to 1.
Roughness: TypeAlias = Annotated[Number, Field(ge=0, le=1), AfterValidator(_rough_enough)]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Texture(_Part):
    """Which faces are rough: moulded parts often have a texture on one side only."""

    facing: Annotated[
        tuple[Number, Number, Number], Field(strict=False), AfterValidator(_has_length)
    ] = Field(default=(0.0, 0.0, 1.0), description="direction in the scene; of any length")
    within_deg: Annotated[Positive, Field(le=180)] = Field(
        default=80.0, description="faces are rough whose outward normal is this near to it"
    )


def check_texture(texture: Texture | None, roughness: float | None) -> None:
    """Refuse a texture that has no roughness to give."""
    if texture is not None and not roughness:
        raise PydanticCustomError(
            "texture_without_roughness",
            "texture says which faces are rough, and roughness says how much: give both",
        )


class Scattering(_Part):
    """Even turbidity: opal plastic, light guides. Henyey and Greenstein's phase function."""

    coefficient_per_mm: CoefficientSpec = Field(
        description="scattering coefficient σ_s in 1/mm, by wavelength"
    )
    anisotropy: Annotated[Number, Field(gt=-1, lt=1)] = Field(
        default=0.0, description="mean cosine g of the scattering angle: 0 is alike to all sides"
    )

    def per_mm(self, wavelengths_nm: ArrayLike) -> Array:
        """Return σ_s(λ) in 1/mm."""
        return self.coefficient_per_mm.distribution()(wavelengths_nm)


class Lacquer(_Part):
    """A clear or dyed coat of even thickness on a metal, without interference colours."""

    refractive_index: IndexSpec = Field(description="n(λ) of the coat")
    thickness_um: Annotated[Positive, Field(le=10_000)] = Field(description="its thickness in µm")
    internal_transmittance: TransmittanceSpec | None = Field(
        default=None, description="left out: perfectly clear"
    )

    def index(self, wavelengths_nm: ArrayLike) -> Array:
        """Return n(λ) of the coat."""
        return self.refractive_index.index()(wavelengths_nm)

    def optical_depth(self, wavelengths_nm: ArrayLike) -> Array:
        """Return a(λ) = α·thickness, the absorption of one passage at normal incidence."""
        if self.internal_transmittance is None:
            return np.zeros(np.shape(wavelengths_nm))
        thickness_mm = self.thickness_um / _UM_PER_MM
        return self.internal_transmittance.absorption_per_mm(wavelengths_nm) * thickness_mm

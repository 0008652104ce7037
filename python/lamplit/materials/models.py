# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Materials as a scene or a library file writes them, told apart by ``kind``.

dielectric  clear or dyed matter: refractive index and internal transmittance
conductor   a metal by n and k, times a factor (a lacquer's loss)
mirror      a mirror by its measured spectral reflectance
diffuse     a matt surface by its spectral reflectance
checker     a matt surface with squares of two reflectances
glossy      an opaque body: Fresnel gloss over a matt base
diffuse-transmitter  a thin matt sheet that light also comes through, such as paper

Every evaluating method takes wavelengths in nm of any shape and returns float64 of that shape; it
raises SpectrumError where the material's data end and do not say how to go on.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

from lamplit.materials.finish import Lacquer, Roughness, Scattering, Texture, check_texture
from lamplit.materials.index_spec import ComplexIndexSpec, IndexSpec
from lamplit.materials.transmittance import TransmittanceSpec
from lamplit.spec_forms import Number, Positive
from lamplit.spectra_spec import FractionSpec
from lamplit.spectrum import Array, SpectralDistribution

#: Where a picture may lie, in nm.
_CHECKED_NM = (200.0, 2500.0)
#: Values of two tables that together should be 1 may miss it by this much.
_ROUNDING = 1e-9

_Weight: TypeAlias = Annotated[Number, Field(ge=0)]


class HallTerms(BaseModel):
    """The weights and spectra of Hall's shading model, eqs. (3) and (4) of the method.

    What is left out follows from the material: Fresnel's or its own reflectance for
    ``specular_reflectance`` (F_sr), 1 − F_sr for ``specular_transmittance`` (F_st), and for
    ``ambient_reflectance`` (F_sa) the matt reflectance of diffuse, checker and glossy, 0 else.
    Source: R. Hall, Illumination and Color in Computer Generated Imagery, Springer 1989.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    k_sr: _Weight = Field(default=1.0, description="weight of the reflected highlight")
    k_st: _Weight = Field(default=1.0, description="weight of the transmitted highlight")
    k_sa: _Weight = Field(default=1.0, description="weight of the ambient light")
    highlight_exponent: Positive | None = Field(
        default=None, description="n of (L·N)^n; by kind: 1 for diffuse and checker, else 60"
    )
    specular_reflectance: FractionSpec | None = Field(default=None, description="F_sr")
    specular_transmittance: FractionSpec | None = Field(default=None, description="F_st")
    ambient_reflectance: FractionSpec | None = Field(default=None, description="F_sa")


class _Material(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")

    default_highlight_exponent: ClassVar[float] = 60.0

    description: str = Field(default="", description="what it is, in a sentence")
    references: Annotated[tuple[str, ...], Field(strict=False)] = Field(
        default=(), description="where the numbers come from, and how far to trust them"
    )
    licence: str = Field(default="", description="under which terms the numbers may be passed on")
    hall: HallTerms | None = Field(default=None, description="terms of the Hall method")

    def hall_terms(self) -> HallTerms:
        """Return the Hall terms with the exponent that this kind of material has by default."""
        terms = self.hall or HallTerms()
        if terms.highlight_exponent is not None:
            return terms
        return terms.model_copy(update={"highlight_exponent": self.default_highlight_exponent})


class _Finished(_Material):
    """A material whose surface may be rough; Hall's method sees it smooth."""

    roughness: Roughness = Field(
        default=0.0, description="α of GGX: 0 smooth, or 0.001 to 1 (path)"
    )
    texture: Texture | None = Field(default=None, description="left out: all faces are alike")

    @model_validator(mode="after")
    def _is_rough_where_textured(self) -> _Finished:
        check_texture(self.texture, self.roughness)
        return self


class Dielectric(_Finished):
    """Clear or dyed matter that light goes through: plastic, glass."""

    kind: Literal["dielectric"]
    refractive_index: IndexSpec = Field(description="n(λ)")
    internal_transmittance: TransmittanceSpec | None = Field(
        default=None, description="left out: perfectly clear"
    )
    scattering: Scattering | None = Field(default=None, description="left out: no turbidity (path)")

    def index(self, wavelengths_nm: ArrayLike) -> Array:
        """Return n(λ)."""
        return self.refractive_index.index()(wavelengths_nm)

    def absorption_per_mm(self, wavelengths_nm: ArrayLike) -> Array:
        """Return the napierian absorption coefficient α(λ) in 1/mm."""
        if self.internal_transmittance is None:
            return np.zeros(np.shape(wavelengths_nm))
        return self.internal_transmittance.absorption_per_mm(wavelengths_nm)

    def transmittance(self, wavelengths_nm: ArrayLike, thickness_mm: float) -> Array:
        """Return the internal transmittance exp(−α b) of ``thickness_mm``."""
        return np.exp(-self.absorption_per_mm(wavelengths_nm) * thickness_mm)


class Conductor(_Finished):
    """A metal by its complex index n + i k."""

    kind: Literal["conductor"]
    refractive_index: ComplexIndexSpec = Field(description="n(λ) and k(λ)")
    factor: Annotated[Number, Field(ge=0, le=1)] = Field(
        default=1.0, description="times the metal's reflectance: the loss of a film or of dust"
    )
    lacquer: Lacquer | None = Field(default=None, description="a coat on the metal")

    def index(self, wavelengths_nm: ArrayLike) -> Array:
        """Return n(λ)."""
        return self.refractive_index.index()(wavelengths_nm)

    def extinction(self, wavelengths_nm: ArrayLike) -> Array:
        """Return k(λ)."""
        return self.refractive_index.extinction()(wavelengths_nm)


class _Reflecting(BaseModel):
    reflectance: FractionSpec = Field(
        description="share of the light that comes back, by wavelength"
    )

    def reflectance_at(self, wavelengths_nm: ArrayLike) -> Array:
        """Return the spectral reflectance, 0 to 1."""
        return self.reflectance.distribution()(wavelengths_nm)


class Mirror(_Reflecting, _Finished):
    """A mirror by its measured reflectance, the same at every angle."""

    kind: Literal["mirror"]


class Diffuse(_Reflecting, _Material):
    """A matt surface."""

    kind: Literal["diffuse"]
    default_highlight_exponent: ClassVar[float] = 1.0


class Checker(_Material):
    """A matt surface of squares in two reflectances, on planes, discs and boxes."""

    kind: Literal["checker"]
    reflectance_a: FractionSpec = Field(description="of the first squares")
    reflectance_b: FractionSpec = Field(description="of the other squares")
    square_mm: Positive = Field(description="side of a square")
    default_highlight_exponent: ClassVar[float] = 1.0

    def reflectance_a_at(self, wavelengths_nm: ArrayLike) -> Array:
        """Return the spectral reflectance of the first squares."""
        return self.reflectance_a.distribution()(wavelengths_nm)

    def reflectance_b_at(self, wavelengths_nm: ArrayLike) -> Array:
        """Return the spectral reflectance of the other squares."""
        return self.reflectance_b.distribution()(wavelengths_nm)


class Glossy(_Reflecting, _Finished):
    """An opaque body: what Fresnel does not reflect reaches a matt base."""

    kind: Literal["glossy"]
    refractive_index: IndexSpec = Field(description="n(λ) of the surface, for Fresnel")

    def index(self, wavelengths_nm: ArrayLike) -> Array:
        """Return n(λ) of the surface."""
        return self.refractive_index.index()(wavelengths_nm)


class DiffuseTransmitter(_Reflecting, _Material):
    """A thin matt sheet: it gives light back, and lets light through to all sides."""

    kind: Literal["diffuse-transmitter"]
    transmittance: FractionSpec = Field(
        description="share of the light that comes through, by wavelength"
    )
    default_highlight_exponent: ClassVar[float] = 1.0

    @model_validator(mode="after")
    def _gives_no_more_than_it_gets(self) -> DiffuseTransmitter:
        back, through = self.reflectance.distribution(), self.transmittance.distribution()
        nm = _points_of(back, through)
        total = back(nm) + through(nm)
        if (total > 1.0 + _ROUNDING).any():
            at = int(np.argmax(total))
            raise PydanticCustomError(
                "gains_energy",
                "reflectance and transmittance together are at most 1, and {total} at {nm} nm",
                {"total": f"{total[at]:g}", "nm": f"{nm[at]:g}"},
            )
        return self

    def transmittance_at(self, wavelengths_nm: ArrayLike) -> Array:
        """Return the share that comes through, 0 to 1."""
        return self.transmittance.distribution()(wavelengths_nm)


def _points_of(*curves: SpectralDistribution) -> Array:
    """Return every 0.5 nm, and the ends, of where all ``curves`` have values."""
    bounded = [curve.domain_nm for curve in curves if curve.extension == "error"]
    low = max([_CHECKED_NM[0], *(domain[0] for domain in bounded)])
    high = min([_CHECKED_NM[1], *(domain[1] for domain in bounded)])
    ends = [end for curve in curves for end in curve.domain_nm if low <= end <= high]
    return np.append(np.arange(low, high, 0.5), ends)


#: Any material, chosen by its ``kind``.
Material: TypeAlias = Annotated[
    Dielectric | Conductor | Mirror | Diffuse | DiffuseTransmitter | Checker | Glossy,
    Field(discriminator="kind"),
]

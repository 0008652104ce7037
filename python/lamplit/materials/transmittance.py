# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Internal transmittance as a scene or a library file writes it, and Bouguer–Beer's law.

``TransmittanceSpec`` is one of
    { thickness_mm = 3.0, wavelengths_nm = [..], values = [..] }    measured at this thickness
    { thickness_mm = 3.0, csv = "file.csv" }                         the same from a file
    { thickness_mm = 3.0, spdx = "file.spdx" }
    { thickness_mm = 1.0, value = 0.9 }                              the same at every wavelength
    { dye = { lambda50_nm = 612, width_nm = 15 } }                   an analytic dye
    { wavelengths_nm = [..], k = [..] }                              extinction coefficient
    { refractiveindex_info = "file.yml" }                            the k of a database page

Each gives the napierian absorption coefficient α(λ) per mm, and with it T(λ) = exp(−α b) at any
thickness b: Bouguer–Beer's law, exactly t(λ)^(b/b₀) for a transmittance t measured at b₀. Internal
means without the reflections at the two faces; divide a measured total transmittance by them first.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Annotated, TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    model_validator,
)

from lamplit.materials.index_spec import PageForm, TableForm
from lamplit.spec_forms import Number, Positive, form_tag, spec_fault
from lamplit.spectra_spec import Column, CsvSpectrum, SpdxSpectrum, TabulatedSpectrum
from lamplit.spectrum import Array, SpectralDistribution

_NM_PER_MM = 1e6
_Thickness: TypeAlias = Annotated[
    Positive, Field(description="thickness at which the transmittance was measured, mm")
]


class Absorber(BaseModel, ABC):
    """What every form of transmittance can say."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    @abstractmethod
    def absorption_per_mm(self, wavelengths_nm: ArrayLike) -> Array:
        """Return the napierian absorption coefficient α in 1/mm, of the wavelengths' shape.

        Raises:
            SpectrumError: A wavelength lies outside the data, and they do not say how to go on.
        """

    def transmittance(self, wavelengths_nm: ArrayLike, thickness_mm: float) -> Array:
        """Return the internal transmittance exp(−α b) of ``thickness_mm``."""
        return np.exp(-self.absorption_per_mm(wavelengths_nm) * thickness_mm)


class _Measured(Absorber):
    thickness_mm: _Thickness

    @abstractmethod
    def distribution(self) -> SpectralDistribution:
        """Return t(λ) at the reference thickness."""

    def absorption_per_mm(self, wavelengths_nm: ArrayLike) -> Array:
        """Return α = −ln t / b₀."""
        return -np.log(self.distribution()(wavelengths_nm)) / self.thickness_mm


class TabulatedTransmittance(TabulatedSpectrum, _Measured):
    """t(λ) at one thickness, as a table."""


class CsvTransmittance(CsvSpectrum, _Measured):
    """t(λ) at one thickness, from a text file."""


class SpdxTransmittance(SpdxSpectrum, _Measured):
    """t(λ) at one thickness, from an IES TM-27 file."""


class ConstantTransmittance(_Measured):
    """The same t at every wavelength."""

    value: Number = Field(description="t, above 0 and at most 1")

    def distribution(self) -> SpectralDistribution:
        """Return t, the same at every wavelength."""
        return SpectralDistribution.constant(self.value)

    def point_values(self) -> Array:
        """Return t, as an array of shape (1,)."""
        return np.array([self.value])


class Dye(BaseModel):
    """A cut-on dye: α(λ) = min((ln 2 / b) exp(−(λ − λ50) / w), cap) + floor, in 1/mm.

    At λ50 a plate of thickness b lets half the light through (the floor apart); w says how sharp
    the edge is. The form follows measured long-pass glasses and red signal PMMA within 0.02 of
    transmittance; it stands for a family, not for a supplier's grade.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    lambda50_nm: Annotated[Positive, Field(ge=100, le=3000)] = Field(
        description="where half the light goes through"
    )
    width_nm: Annotated[Positive, Field(ge=0.1, le=500)] = Field(
        description="w: the smaller, the sharper the edge"
    )
    thickness_mm: Positive = Field(default=3.0, description="where lambda50_nm holds, mm")
    cap_per_mm: Positive = Field(default=5.0, description="highest absorption, 1/mm")
    floor_per_mm: Annotated[Number, Field(ge=0)] = Field(
        default=0.0017, description="absorption beyond the edge, 1/mm"
    )

    def absorption_per_mm(self, wavelengths_nm: ArrayLike) -> Array:
        """Return α in 1/mm, of the wavelengths' shape."""
        nm = np.asarray(wavelengths_nm, dtype=np.float64)
        at_lambda50 = math.log(math.log(2.0) / self.thickness_mm)
        edge = at_lambda50 - (nm - self.lambda50_nm) / self.width_nm
        return np.exp(np.minimum(edge, math.log(self.cap_per_mm))) + self.floor_per_mm


class DyeTransmittance(Absorber):
    """An analytic dye."""

    dye: Dye = Field(description="its edge")

    def absorption_per_mm(self, wavelengths_nm: ArrayLike) -> Array:
        """Return α of the dye."""
        return self.dye.absorption_per_mm(wavelengths_nm)


class ExtinctionTransmittance(TableForm, Absorber):
    """A table of the extinction coefficient k: α = 4π k / λ."""

    k: Column = Field(description="one extinction coefficient for each wavelength")

    @model_validator(mode="after")
    def _check(self) -> ExtinctionTransmittance:
        self.check(self.k)
        if min(self.k) < 0:
            raise spec_fault(f"k is 0 or more, and {min(self.k):g} is given")
        return self

    def absorption_per_mm(self, wavelengths_nm: ArrayLike) -> Array:
        """Return α = 4π k / λ."""
        return _from_extinction(self.curve(self.k, "the extinction coefficient"), wavelengths_nm)


class PageTransmittance(PageForm, Absorber):
    """The k of a refractiveindex.info page: α = 4π k / λ."""

    @model_validator(mode="after")
    def _has_k(self) -> PageTransmittance:
        self.column("k")
        return self

    def absorption_per_mm(self, wavelengths_nm: ArrayLike) -> Array:
        """Return α = 4π k / λ."""
        return _from_extinction(self.column("k"), wavelengths_nm)


def _from_extinction(k: SpectralDistribution, wavelengths_nm: ArrayLike) -> Array:
    nm = np.asarray(wavelengths_nm, dtype=np.float64)
    return 4.0 * np.pi * k(nm) / (nm / _NM_PER_MM)


_FORMS: dict[str, type[BaseModel]] = {
    "<table>": TabulatedTransmittance,
    "<csv>": CsvTransmittance,
    "<spdx>": SpdxTransmittance,
    "<value>": ConstantTransmittance,
    "<dye>": DyeTransmittance,
    "<k>": ExtinctionTransmittance,
    "<page>": PageTransmittance,
}
AnyTransmittance: TypeAlias = (
    TabulatedTransmittance
    | CsvTransmittance
    | SpdxTransmittance
    | ConstantTransmittance
    | DyeTransmittance
    | ExtinctionTransmittance
    | PageTransmittance
)


def _tag(value: object) -> str | None:
    return form_tag(value, _FORMS)


def _possible(spec: AnyTransmittance) -> AnyTransmittance:
    """Refuse a measured t that Bouguer–Beer's law cannot carry to another thickness."""
    if not isinstance(
        spec, (TabulatedTransmittance, CsvTransmittance, SpdxTransmittance, ConstantTransmittance)
    ):
        return spec
    values = spec.point_values()
    low, high = float(np.min(values)), float(np.max(values))
    if high > 1:
        percent = 1.5 < high <= 100 and not isinstance(spec, ConstantTransmittance)
        advice = "; for values in percent add scale = 0.01" if percent else ""
        raise spec_fault(f"an internal transmittance is at most 1, and {high:g} is given{advice}")
    if low < 0:
        raise spec_fault(f"a transmittance is above 0, and {low:g} is given")
    if low == 0:
        raise spec_fault(
            "a transmittance of exactly 0 says nothing of other thicknesses; "
            "give the smallest value that was measured, such as 1e-6"
        )
    if not isinstance(spec, ConstantTransmittance) and spec.extension == "zero":
        raise spec_fault('extension = "zero" would be opaque at any thickness; use "constant"')
    return spec


#: The internal transmittance of clear or dyed matter.
TransmittanceSpec: TypeAlias = Annotated[
    Annotated[TabulatedTransmittance, Tag("<table>")]
    | Annotated[CsvTransmittance, Tag("<csv>")]
    | Annotated[SpdxTransmittance, Tag("<spdx>")]
    | Annotated[ConstantTransmittance, Tag("<value>")]
    | Annotated[DyeTransmittance, Tag("<dye>")]
    | Annotated[ExtinctionTransmittance, Tag("<k>")]
    | Annotated[PageTransmittance, Tag("<page>")],
    Discriminator(
        _tag,
        custom_error_type="spectrum",
        custom_error_message=(
            "an internal transmittance is { thickness_mm = .., wavelengths_nm = [..], "
            "values = [..] } (or csv, spdx, value), { dye = { lambda50_nm = .., width_nm = .. } }, "
            '{ wavelengths_nm = [..], k = [..] } or { refractiveindex_info = "file.yml" }'
        ),
    ),
    AfterValidator(_possible),
]

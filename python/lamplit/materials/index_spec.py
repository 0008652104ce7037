# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The refractive index as a scene or a library file writes it.

``IndexSpec`` (clear matter) is one of
    1.49
    { cauchy = [A, B, C] }                               n = A + B/λ² + C/λ⁴ …, λ in µm
    { sellmeier_b = [..], sellmeier_c_um2 = [..] }       n² = 1 + Σ B λ²/(λ² − C), λ in µm
    { formula = 3, coefficients = [..] }                 a formula of refractiveindex.info
    { wavelengths_nm = [..], n = [..] }
    { refractiveindex_info = "file.yml" }
and ``ComplexIndexSpec`` (metals) is ``{ n = 1.0, k = 6.6 }``, a table with ``k``, or a file.

A formula holds on ``range_nm`` (380-780 unless stated) and a table between its ends; beyond, asking
is an error unless ``extension`` says "constant" or, for a formula, "formula".
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Annotated, Literal, TypeAlias

import numpy as np
from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    PrivateAttr,
    RootModel,
    Tag,
    ValidationInfo,
    model_validator,
)

from lamplit.errors import LamplitError
from lamplit.materials.refractiveindex_info import (
    IndexExtension,
    IndexPage,
    formula_distribution,
    read_page,
)
from lamplit.spec_forms import Number, Positive, file_below_root, form_tag, spec_fault
from lamplit.spectra_spec import Column
from lamplit.spectrum import Interpolation, SpectralDistribution
from lamplit.spectrum_files import Table, check_table

TableExtension: TypeAlias = Literal["error", "constant"]
_NotNegative: TypeAlias = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0)]


class ConstantIndex(RootModel[Number]):
    """A bare number: the same index at every wavelength."""

    model_config = ConfigDict(frozen=True)

    def index(self) -> SpectralDistribution:
        """Return n(λ)."""
        return SpectralDistribution.constant(self.root)


class _Form(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class _FormulaForm(_Form, ABC):
    """An index by formula: where it holds, and what holds beyond."""

    range_nm: Annotated[tuple[Positive, Positive], Field(strict=False)] = Field(
        default=(380.0, 780.0), description="wavelengths on which the formula was fitted, nm"
    )
    extension: IndexExtension = Field(
        default="error",
        description="outside the range: 'error', 'constant' (end value) or 'formula' (go on)",
    )

    def index(self) -> SpectralDistribution:
        """Return n(λ)."""
        number, coefficients = self.numbered()
        return formula_distribution(number, coefficients, self.range_nm, extension=self.extension)

    @abstractmethod
    def numbered(self) -> tuple[int, tuple[float, ...]]:
        """Return the number and the coefficients of the refractiveindex.info formula."""

    @model_validator(mode="after")
    def _check(self) -> _FormulaForm:
        try:
            self.index()
        except LamplitError as fault:
            raise spec_fault(fault.message) from fault
        return self


class CauchyIndex(_FormulaForm):
    """n = A + B/λ² + C/λ⁴ …, with λ in µm."""

    cauchy: Column = Field(description="A, B in µm², C in µm⁴, ...", min_length=1, max_length=6)

    def numbered(self) -> tuple[int, tuple[float, ...]]:
        """Return formula 5 with the even negative powers."""
        terms = [(c, -2.0 * order) for order, c in enumerate(self.cauchy)]
        return 5, (terms[0][0], *(number for term in terms[1:] for number in term))


class SellmeierIndex(_FormulaForm):
    """n² = 1 + Σ B λ²/(λ² − C), with λ in µm."""

    sellmeier_b: Column = Field(description="B", min_length=1, max_length=8)
    sellmeier_c_um2: Column = Field(description="C in µm², one for each B")

    def numbered(self) -> tuple[int, tuple[float, ...]]:
        """Return formula 2."""
        if len(self.sellmeier_b) != len(self.sellmeier_c_um2):
            raise spec_fault(
                f"sellmeier_b has {len(self.sellmeier_b)} numbers and sellmeier_c_um2 "
                f"{len(self.sellmeier_c_um2)}; each B needs its C"
            )
        pairs = zip(self.sellmeier_b, self.sellmeier_c_um2, strict=True)
        return 2, (0.0, *(number for pair in pairs for number in pair))


class FormulaIndex(_FormulaForm):
    """One of the nine formulas of refractiveindex.info, with λ in µm."""

    formula: Annotated[int, Field(strict=True, ge=1, le=9)] = Field(description="1 to 9")
    coefficients: Column = Field(description="in the database's order", min_length=1)

    def numbered(self) -> tuple[int, tuple[float, ...]]:
        """Return the formula as it stands."""
        return self.formula, self.coefficients


class TableForm(_Form):
    """A table of optical constants: how to read between and beyond its points."""

    wavelengths_nm: Column = Field(description="wavelengths in nm, rising")
    interpolation: Interpolation | None = Field(
        default=None, description="'linear' (default) or 'cubic'; stated, it also allows gaps"
    )
    extension: TableExtension = Field(
        default="error", description="outside the table: 'error' or 'constant' (end value)"
    )

    def curve(self, values: Column, label: str) -> SpectralDistribution:
        """Return one column of the table as a function of wavelength."""
        return SpectralDistribution.tabulated(
            self.wavelengths_nm,
            values,
            interpolation=self.interpolation or "linear",
            extension=self.extension,
            label=label,
        )

    def check(self, values: Column) -> None:
        """Refuse a column that does not fit the wavelengths."""
        try:
            check_table(
                Table(self.wavelengths_nm, values), gaps_allowed=self.interpolation is not None
            )
        except LamplitError as fault:
            raise spec_fault(str(fault)) from fault


class TabulatedIndex(TableForm):
    """Measured n at rising wavelengths."""

    n: Column = Field(description="one index for each wavelength")

    def index(self) -> SpectralDistribution:
        """Return n(λ)."""
        return self.curve(self.n, "the refractive index")

    @model_validator(mode="after")
    def _check(self) -> TabulatedIndex:
        self.check(self.n)
        return self


class PageForm(_Form):
    """A page of the refractiveindex.info database."""

    refractiveindex_info: Annotated[str, Field(strict=True)] = Field(
        description="YAML file below the scene's folder"
    )
    extension: IndexExtension = Field(
        default="error", description="outside the page's range: 'error', 'constant' or 'formula'"
    )
    _page: IndexPage = PrivateAttr(default=IndexPage(None, None, ""))

    @model_validator(mode="after")
    def _read(self, info: ValidationInfo) -> PageForm:
        path = file_below_root(self.refractiveindex_info, info)
        try:
            self._page = read_page(path, extension=self.extension)
        except LamplitError as fault:
            raise spec_fault(str(fault)) from fault
        return self

    def column(self, letter: Literal["n", "k"]) -> SpectralDistribution:
        """Return n(λ) or k(λ) of the page."""
        found = self._page.n if letter == "n" else self._page.k
        if found is None:
            raise spec_fault(f"{self.refractiveindex_info} holds no {letter}, which is needed here")
        return found


class IndexPageFile(PageForm):
    """n by a page of the refractiveindex.info database."""

    def index(self) -> SpectralDistribution:
        """Return n(λ)."""
        return self.column("n")


class ConstantComplexIndex(_Form):
    """The same n and k at every wavelength."""

    n: _NotNegative = Field(description="refractive index")
    k: _NotNegative = Field(description="extinction coefficient")

    def index(self) -> SpectralDistribution:
        """Return n(λ)."""
        return SpectralDistribution.constant(self.n)

    def extinction(self) -> SpectralDistribution:
        """Return k(λ)."""
        return SpectralDistribution.constant(self.k)


class TabulatedComplexIndex(TabulatedIndex):
    """Measured n and k at rising wavelengths."""

    k: Column = Field(description="one extinction coefficient for each wavelength")

    def extinction(self) -> SpectralDistribution:
        """Return k(λ)."""
        return self.curve(self.k, "the extinction coefficient")

    @model_validator(mode="after")
    def _check_k(self) -> TabulatedComplexIndex:
        self.check(self.k)
        return self


class ComplexIndexPageFile(IndexPageFile):
    """n and k by a page of the refractiveindex.info database."""

    def extinction(self) -> SpectralDistribution:
        """Return k(λ)."""
        return self.column("k")


AnyIndex: TypeAlias = (
    ConstantIndex | CauchyIndex | SellmeierIndex | FormulaIndex | TabulatedIndex | IndexPageFile
)
AnyComplexIndex: TypeAlias = ConstantComplexIndex | TabulatedComplexIndex | ComplexIndexPageFile

_INDEX_FORMS: dict[str, type[BaseModel]] = {
    "<number>": ConstantIndex,
    "<cauchy>": CauchyIndex,
    "<sellmeier>": SellmeierIndex,
    "<formula>": FormulaIndex,
    "<table>": TabulatedIndex,
    "<page>": IndexPageFile,
}
_COMPLEX_FORMS: dict[str, type[BaseModel]] = {
    "<constant>": ConstantComplexIndex,
    "<table>": TabulatedComplexIndex,
    "<page>": ComplexIndexPageFile,
}


def _index_tag(value: object) -> str | None:
    return form_tag(value, _INDEX_FORMS)


def _complex_tag(value: object) -> str | None:
    return form_tag(value, _COMPLEX_FORMS)


def _plausible(curve: SpectralDistribution, lowest: float, highest: float, name: str) -> None:
    low, high = curve.domain_nm
    nm = np.arange(380.0, 781.0)
    nm = nm[(nm >= low) & (nm <= high)]
    values = curve(nm)
    wrong = ~((values >= lowest) & (values <= highest))
    if wrong.any():
        at = int(np.argmax(wrong))
        found = f"{values[at]:g}" if np.isfinite(values[at]) else "no real number"
        raise spec_fault(
            f"{name} is {found} at {nm[at]:g} nm, and {lowest:g} to {highest:g} is expected; are "
            "the numbers in their order, and the coefficients for λ in µm?"
        )


def _clear(spec: AnyIndex) -> AnyIndex:
    _plausible(spec.index(), 1.0, 5.0, "the refractive index n")
    return spec


def _metallic(spec: AnyComplexIndex) -> AnyComplexIndex:
    _plausible(spec.index(), 0.0, 20.0, "n")
    _plausible(spec.extinction(), 0.0, 20.0, "k")
    return spec


#: The real refractive index of clear matter, 1 or more.
IndexSpec: TypeAlias = Annotated[
    Annotated[ConstantIndex, Tag("<number>")]
    | Annotated[CauchyIndex, Tag("<cauchy>")]
    | Annotated[SellmeierIndex, Tag("<sellmeier>")]
    | Annotated[FormulaIndex, Tag("<formula>")]
    | Annotated[TabulatedIndex, Tag("<table>")]
    | Annotated[IndexPageFile, Tag("<page>")],
    Discriminator(
        _index_tag,
        custom_error_type="spectrum",
        custom_error_message=(
            "a refractive index is a number, { cauchy = [..] }, "
            "{ sellmeier_b = [..], sellmeier_c_um2 = [..] }, "
            "{ formula = 1-9, coefficients = [..] }, { wavelengths_nm = [..], n = [..] } or "
            '{ refractiveindex_info = "file.yml" }'
        ),
    ),
    AfterValidator(_clear),
]
#: The complex refractive index n + i k of a metal.
ComplexIndexSpec: TypeAlias = Annotated[
    Annotated[ConstantComplexIndex, Tag("<constant>")]
    | Annotated[TabulatedComplexIndex, Tag("<table>")]
    | Annotated[ComplexIndexPageFile, Tag("<page>")],
    Discriminator(
        _complex_tag,
        custom_error_type="spectrum",
        custom_error_message=(
            "a metal's index is { n = .., k = .. }, { wavelengths_nm = [..], n = [..], k = [..] } "
            'or { refractiveindex_info = "file.yml" }'
        ),
    ),
    AfterValidator(_metallic),
]

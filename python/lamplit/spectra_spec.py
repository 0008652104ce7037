# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Spectra as a scene or a library file writes them.

A spectral function is a number (the same at every wavelength) or one of the tables below; a source
may also be a name, a blackbody or an LED. Each form is one frozen pydantic model, and three field
types choose among them: `SpectrumSpec` (any values), `FractionSpec` (values from 0 to 1, for
reflectances and transmittances) and `SourceSpec` (values of 0 and above). Whatever form was
written, the parsed object has ``distribution()``.

>>> from pydantic import TypeAdapter
>>> table = {"wavelengths_nm": [400, 700], "values": [0, 1]}
>>> spec = TypeAdapter(SpectrumSpec).validate_python(table)
>>> float(spec.distribution()(550))
0.5

Files are looked up in the folder ``root`` of pydantic's validation context
(``validate_python(value, context={"root": folder})``) and read at once, so that a fault in a file
is reported under the key that names it. In an error's location the chosen form stands in angle
brackets, such as ``("materials", "lens", "reflectance", "<csv>", "csv")``: leave these parts out
when you print a key path.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, TypeAlias

import numpy as np
from numpy.typing import NDArray
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
from lamplit.led_spec import LedSource
from lamplit.spec_forms import Form, Number, Positive, file_below_root, form_tag, spec_fault
from lamplit.spectrum import Extension, Interpolation, SpectralDistribution
from lamplit.spectrum_files import Table, check_table, read_csv, read_spdx

Column: TypeAlias = Annotated[tuple[Number, ...], Field(strict=False)]


class ConstantSpectrum(RootModel[Number]):
    """A bare number: the same value at every wavelength."""

    model_config = ConfigDict(frozen=True)

    def distribution(self) -> SpectralDistribution:
        """Return the function of wavelength."""
        return SpectralDistribution.constant(self.root)

    def point_values(self) -> NDArray[np.float64]:
        """Return the one value, as an array of shape (1,)."""
        return np.array([self.root])


class _Points(Form):
    """What every measured table says of how to read between and beyond its points."""

    interpolation: Interpolation | None = Field(
        default=None,
        description="'linear' (default) or 'cubic' (shape-preserving); stated, it also allows gaps",
    )
    extension: Extension = Field(
        default="error", description="outside the table: 'error', 'constant' (end value) or 'zero'"
    )
    scale: Positive = Field(
        default=1.0, description="factor on the values: 0.01 for values in percent"
    )
    _table: Table = PrivateAttr(default=Table((), ()))

    def distribution(self) -> SpectralDistribution:
        """Return the function of wavelength."""
        return SpectralDistribution.tabulated(
            self._table.wavelengths_nm,
            self.point_values(),
            interpolation=self.interpolation or "linear",
            extension=self.extension,
            label=self.label(),
        )

    def point_values(self) -> NDArray[np.float64]:
        """Return the values at the measured points, scaled."""
        return np.array(self._table[1]) * self.scale

    def label(self) -> str:
        """Return how messages name this table."""
        return "the spectrum"

    def _keep(self, read: Callable[[], Table]) -> None:
        try:
            table = read()
            check_table(table, gaps_allowed=self.interpolation is not None)
        except LamplitError as fault:
            raise spec_fault(str(fault)) from fault
        self._table = table


class TabulatedSpectrum(_Points):
    """Measured points written in the file itself."""

    wavelengths_nm: Column = Field(description="wavelengths in nm, rising")
    values: Column = Field(description="one value for each wavelength")

    @model_validator(mode="after")
    def _check(self) -> TabulatedSpectrum:
        self._keep(lambda: Table(self.wavelengths_nm, self.values))
        return self


class CsvSpectrum(_Points):
    """Measured points in a text file of two columns, wavelength in nm and value."""

    csv: Annotated[str, Field(strict=True)] = Field(description="file below the scene's folder")

    def label(self) -> str:
        """Return how messages name this table."""
        return self.csv

    @model_validator(mode="after")
    def _read(self, info: ValidationInfo) -> CsvSpectrum:
        if not self._table.values:  # read once: a parsed object may be checked again elsewhere
            path = file_below_root(self.csv, info)
            self._keep(lambda: read_csv(path))
        return self


class SpdxSpectrum(_Points):
    """Measured points in an IES TM-27 file."""

    spdx: Annotated[str, Field(strict=True)] = Field(description="file below the scene's folder")

    def label(self) -> str:
        """Return how messages name this table."""
        return self.spdx

    @model_validator(mode="after")
    def _read(self, info: ValidationInfo) -> SpdxSpectrum:
        if not self._table.values:  # read once: a parsed object may be checked again elsewhere
            path = file_below_root(self.spdx, info)
            self._keep(lambda: read_spdx(path))
        return self


class NamedSource(RootModel[Annotated[str, Field(strict=True, min_length=1)]]):
    """A source by name, one of the scene's own ``[sources]`` or of the library; the scene knows."""

    model_config = ConfigDict(frozen=True)


class BlackbodySource(Form):
    """Planck's law at one temperature."""

    temperature_kelvin: Annotated[Positive, Field(ge=100, le=1e5)] = Field(
        description="its temperature"
    )

    def distribution(self) -> SpectralDistribution:
        """Return the spectral radiance."""
        return SpectralDistribution.blackbody(self.temperature_kelvin)


_TABLES: dict[str, type[BaseModel]] = {
    "<table>": TabulatedSpectrum,
    "<csv>": CsvSpectrum,
    "<spdx>": SpdxSpectrum,
}
_SPECTRA = {"<number>": ConstantSpectrum, **_TABLES}
_SOURCES = {**_TABLES, "<blackbody>": BlackbodySource, "<led>": LedSource}


def _spectrum_tag(value: object) -> str | None:
    return form_tag(value, _SPECTRA)


def _source_tag(value: object) -> str | None:
    return "<name>" if isinstance(value, (str, NamedSource)) else form_tag(value, _SOURCES)


AnySpectrum: TypeAlias = ConstantSpectrum | TabulatedSpectrum | CsvSpectrum | SpdxSpectrum
AnySource: TypeAlias = (
    NamedSource | TabulatedSpectrum | CsvSpectrum | SpdxSpectrum | BlackbodySource | LedSource
)


def _within_unity(spec: AnySpectrum) -> AnySpectrum:
    values = spec.point_values()
    low, high = float(np.min(values)), float(np.max(values))
    if low < 0:
        raise spec_fault(f"values from 0 to 1 are expected, and {low:g} is below 0")
    if high > 1:
        percent = high > 1.5 and high <= 100 and not isinstance(spec, ConstantSpectrum)
        advice = "; for values in percent add scale = 0.01" if percent else ""
        raise spec_fault(f"values from 0 to 1 are expected, and {high:g} is above 1{advice}")
    return spec


def _not_negative(spec: AnySpectrum) -> AnySpectrum:
    low = float(np.min(spec.point_values()))
    if low < 0:
        raise spec_fault(f"values of 0 and above are expected, and {low:g} is below 0")
    return spec


def _emits(spec: AnySource) -> AnySource:
    if isinstance(spec, (TabulatedSpectrum, CsvSpectrum, SpdxSpectrum)):
        values = spec.point_values()
        if float(np.min(values)) < 0:
            raise spec_fault(f"a source emits 0 or more, and {float(np.min(values)):g} is below 0")
        if float(np.max(values)) == 0:
            raise spec_fault("this source emits nothing: every value is 0")
    return spec


_SpectrumUnion: TypeAlias = Annotated[
    Annotated[ConstantSpectrum, Tag("<number>")]
    | Annotated[TabulatedSpectrum, Tag("<table>")]
    | Annotated[CsvSpectrum, Tag("<csv>")]
    | Annotated[SpdxSpectrum, Tag("<spdx>")],
    Discriminator(
        _spectrum_tag,
        custom_error_type="spectrum",
        custom_error_message=(
            "a spectrum is a number, { wavelengths_nm = [..], values = [..] }, "
            '{ csv = "file" } or { spdx = "file" }'
        ),
    ),
]
_SourceUnion: TypeAlias = Annotated[
    Annotated[NamedSource, Tag("<name>")]
    | Annotated[TabulatedSpectrum, Tag("<table>")]
    | Annotated[CsvSpectrum, Tag("<csv>")]
    | Annotated[SpdxSpectrum, Tag("<spdx>")]
    | Annotated[BlackbodySource, Tag("<blackbody>")]
    | Annotated[LedSource, Tag("<led>")],
    Discriminator(
        _source_tag,
        custom_error_type="spectrum",
        custom_error_message=(
            "a source is a name, { temperature_kelvin = .. }, "
            "{ led_peak_nm = .., led_fwhm_nm = .. }, "
            '{ wavelengths_nm = [..], values = [..] }, { csv = "file" } or { spdx = "file" }'
        ),
    ),
]

#: Any spectral function: a number, a table, or a file of measured points.
SpectrumSpec: TypeAlias = _SpectrumUnion
#: A spectral function whose values lie from 0 to 1.
FractionSpec: TypeAlias = Annotated[_SpectrumUnion, AfterValidator(_within_unity)]
#: A spectral function whose values are 0 and above.
CoefficientSpec: TypeAlias = Annotated[_SpectrumUnion, AfterValidator(_not_negative)]
#: The spectral distribution of a light: values of 0 and above, in any unit.
SourceSpec: TypeAlias = Annotated[_SourceUnion, AfterValidator(_emits)]

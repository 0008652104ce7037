# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`SpectralDistribution`: a quantity as a function of wavelength."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.errors import SpectrumError

if TYPE_CHECKING:
    from lamplit.spectrum_files import Table

Interpolation = Literal["linear", "cubic"]
Extension = Literal["error", "constant", "zero"]
LedModel = Literal["ohno", "gaussian"]
Array = NDArray[np.float64]

#: Planck's law constants (CODATA 2018 exact values; CIE 015:2018 uses c2 = 1.4388e-2 m K).
_PLANCK_J_S = 6.62607015e-34
_LIGHT_M_S = 299_792_458.0
_C2_M_K = 1.438776877e-2

#: Full width at half maximum of Ohno's LED model for Δ = 1: 2 √(−ln g) where g + 2 g⁵ = 3/2.
OHNO_FWHM = 0.9218231196498559


@dataclass(frozen=True, eq=False)
class SpectralDistribution:
    """A function of wavelength in nm, defined on ``domain_nm``.

    Call it with wavelengths in nm of any shape; values of the same shape come back. What lies
    outside the domain follows ``extension``: ``error`` raises, ``constant`` holds the end value,
    ``zero`` is nothing.

    >>> red = SpectralDistribution.tabulated([600, 700], [0.0, 1.0])
    >>> float(red(625))
    0.25
    """

    evaluate: Callable[[Array], Array]
    domain_nm: tuple[float, float] = (0.0, float("inf"))
    extension: Extension = "error"
    label: str = ""

    def __call__(self, wavelengths_nm: ArrayLike) -> Array:
        """Return the values at ``wavelengths_nm``.

        Raises:
            SpectrumError: A wavelength lies outside the domain and ``extension`` is ``error``.
        """
        asked = np.asarray(wavelengths_nm, dtype=np.float64)
        low, high = self.domain_nm
        outside = ~((asked >= low) & (asked <= high))
        if not outside.any():
            return self.evaluate(asked)
        if self.extension == "error":
            first = float(asked[outside][0])
            name = self.label or "the spectrum"
            raise SpectrumError(
                f"{name} is defined from {low:g} to {high:g} nm, and {first:g} nm is asked for; "
                'give more data, or say how to go on with extension = "constant" or "zero"'
            )
        values = self.evaluate(np.minimum(np.maximum(asked, low), high))
        return np.where(outside, 0.0, values) if self.extension == "zero" else values

    def scaled(self, factor: float) -> SpectralDistribution:
        """Return this distribution times ``factor``."""
        return SpectralDistribution(
            lambda nm: factor * self.evaluate(nm), self.domain_nm, self.extension, self.label
        )

    @staticmethod
    def constant(value: float, *, label: str = "") -> SpectralDistribution:
        """Return a distribution with the same ``value`` at every wavelength."""
        return SpectralDistribution(lambda nm: np.full(nm.shape, value), label=label)

    @staticmethod
    def tabulated(
        wavelengths_nm: ArrayLike,
        values: ArrayLike,
        *,
        interpolation: Interpolation = "linear",
        extension: Extension = "error",
        label: str = "",
    ) -> SpectralDistribution:
        """Return a distribution through measured points.

        ``linear`` joins the points by straight lines; ``cubic`` by the shape-preserving cubic of
        Fritsch and Carlson (1980), which makes no overshoot that the data has not.

        Raises:
            SpectrumError: Fewer than two points, a value that is not finite, or wavelengths that
                do not rise from one to the next.
        """
        nm = np.array(wavelengths_nm, dtype=np.float64)
        table = np.array(values, dtype=np.float64)
        name = label or "the spectrum"
        if nm.ndim != 1 or nm.shape != table.shape or nm.size < 2:
            raise SpectrumError(
                f"{name} needs as many values as wavelengths, two at least; "
                f"it has {nm.size} wavelengths and {table.size} values"
            )
        if not (np.isfinite(nm).all() and np.isfinite(table).all()):
            raise SpectrumError(f"{name} has a number that is not finite; mend or remove that row")
        steps = np.diff(nm)
        if (steps <= 0).any():
            at = int(np.argmax(steps <= 0))
            raise SpectrumError(
                f"{name}: wavelengths must rise, and {nm[at + 1]:g} nm follows {nm[at]:g} nm; "
                "sort the table and remove repeated rows"
            )
        domain = (float(nm[0]), float(nm[-1]))
        if interpolation == "linear":
            return SpectralDistribution(
                lambda asked: np.interp(asked, nm, table), domain, extension, label
            )
        from scipy.interpolate import PchipInterpolator

        with np.errstate(over="ignore"):  # next to a flat piece the slope is 1/∞, and so 0
            curve = PchipInterpolator(nm, table, extrapolate=False)
        return SpectralDistribution(
            lambda asked: np.asarray(curve(asked), dtype=np.float64), domain, extension, label
        )

    @staticmethod
    def from_csv(
        path: Path,
        *,
        interpolation: Interpolation | None = None,
        extension: Extension = "error",
    ) -> SpectralDistribution:
        """Return the distribution of a text file of two columns, wavelength in nm and value.

        Columns part at commas, semicolons, tabs or blanks; lines from ``#`` on are comments, and
        one header line may come first. A hole in the table is a fault unless ``interpolation`` is
        stated.

        Raises:
            SpectrumError: The file cannot be read as that; the message names the line.
        """
        from lamplit.spectrum_files import read_csv

        return _measured(read_csv(path), path, interpolation, extension)

    @staticmethod
    def from_spdx(
        path: Path,
        *,
        interpolation: Interpolation | None = None,
        extension: Extension = "error",
    ) -> SpectralDistribution:
        """Return the distribution of an IES TM-27 file (``.spdx``).

        Raises:
            SpectrumError: The file is no TM-27 document, or declares a DTD.
        """
        from lamplit.spectrum_files import read_spdx

        return _measured(read_spdx(path), path, interpolation, extension)

    @staticmethod
    def blackbody(temperature_kelvin: float) -> SpectralDistribution:
        """Return Planck's spectral radiance L(λ, T) in W·m⁻²·sr⁻¹·nm⁻¹.

        Raises:
            SpectrumError: The temperature is not positive and finite.
        """
        if not (np.isfinite(temperature_kelvin) and temperature_kelvin > 0):
            raise SpectrumError(
                f"a blackbody needs a positive temperature, and {temperature_kelvin:g} K is given"
            )

        def radiance(nm: Array) -> Array:
            metres = nm * 1e-9
            first = 2.0 * _PLANCK_J_S * _LIGHT_M_S**2 / metres**5
            with np.errstate(
                over="ignore"
            ):  # far below the peak the exponential is infinite: L = 0
                return 1e-9 * first / np.expm1(_C2_M_K / (metres * temperature_kelvin))

        return SpectralDistribution(
            radiance, (1.0, 1e7), label=f"blackbody {temperature_kelvin:g} K"
        )

    @staticmethod
    def led(peak_nm: float, fwhm_nm: float, *, model: LedModel = "ohno") -> SpectralDistribution:
        """Return a single-colour LED of full width at half maximum ``fwhm_nm``, 1 at the peak."""
        if model == "gaussian":
            return SpectralDistribution.gaussian(peak_nm, fwhm_nm)
        return SpectralDistribution.ohno_led(peak_nm, fwhm_nm / OHNO_FWHM)

    @staticmethod
    def gaussian(peak_nm: float, fwhm_nm: float) -> SpectralDistribution:
        """Return exp(−4 ln 2 ((λ − peak)/FWHM)²), 1 at the peak."""
        _check_led(peak_nm, fwhm_nm)
        return SpectralDistribution(
            lambda nm: np.exp(-4.0 * np.log(2.0) * ((nm - peak_nm) / fwhm_nm) ** 2),
            label=f"Gaussian {peak_nm:g}/{fwhm_nm:g} nm",
        )

    @staticmethod
    def ohno_led(peak_nm: float, width_nm: float) -> SpectralDistribution:
        """Return Ohno's single-LED model (g + 2 g⁵)/3 with g = exp(−((λ − peak)/Δ)²).

        ``width_nm`` is Δ, the half spectral width of the model; the curve's full width at half
        maximum is ``OHNO_FWHM`` Δ.
        Source: Y. Ohno, "Spectral design considerations for white LED color rendering",
        Opt. Eng. 44 (2005) 111302.
        """
        _check_led(peak_nm, width_nm)

        def shape(nm: Array) -> Array:
            g = np.exp(-(((nm - peak_nm) / width_nm) ** 2))
            return (g + 2.0 * g**5) / 3.0

        return SpectralDistribution(shape, label=f"Ohno LED {peak_nm:g}/{width_nm:g} nm")


def _measured(
    table: Table, path: Path, interpolation: Interpolation | None, extension: Extension
) -> SpectralDistribution:
    from lamplit.spectrum_files import check_table

    check_table(table, gaps_allowed=interpolation is not None, file=path)
    return SpectralDistribution.tabulated(
        table.wavelengths_nm,
        table.values,
        interpolation=interpolation or "linear",
        extension=extension,
        label=path.name,
    )


def _check_led(peak_nm: float, width_nm: float) -> None:
    if not (np.isfinite(peak_nm) and np.isfinite(width_nm) and peak_nm > 0 and width_nm > 0):
        raise SpectrumError(
            f"an LED needs a positive peak and width in nm, not {peak_nm:g} and {width_nm:g}"
        )

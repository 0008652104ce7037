# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The CIE's illuminants."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np

from lamplit.cie_tables import cie_table
from lamplit.sources.entry import SourceEntry
from lamplit.spectrum import Array, SpectralDistribution

_TABLES = "CIE 015:2018, Colorimetry, 4th ed., tables of the CIE; numbers as in colour-science"
_FORMULA = "CIE 015:2018, Colorimetry, 4th ed., 4.1"
_LICENCE = "facts (CIE); table of colour-science, BSD-3-Clause"

_DAYLIGHT = {
    "D50": "daylight, 5003 K (graphic arts)",
    "D55": "daylight, 5503 K",
    "D65": "average daylight, 6504 K",
    "D75": "north-sky daylight, 7504 K",
}

_FLUORESCENT = {
    "FL1": "daylight, 6430 K",
    "FL2": "cool white, 4230 K",
    "FL3": "white, 3450 K",
    "FL4": "warm white, 2940 K",
    "FL5": "daylight, 6350 K",
    "FL6": "light white, 4150 K",
    "FL7": "broad band, 6500 K",
    "FL8": "broad band, 5000 K",
    "FL9": "broad band cool white, 4150 K",
    "FL10": "three bands, 5000 K",
    "FL11": "three bands, 4000 K",
    "FL12": "three bands, 3000 K",
    "FL3.1": "halophosphate, 2932 K",
    "FL3.2": "halophosphate, 3965 K",
    "FL3.3": "halophosphate, 6280 K",
    "FL3.4": "de luxe, 2904 K",
    "FL3.5": "de luxe, 4086 K",
    "FL3.6": "de luxe, 4894 K",
    "FL3.7": "three bands, 2979 K",
    "FL3.8": "three bands, 4006 K",
    "FL3.9": "three bands, 4853 K",
    "FL3.10": "three bands, 5000 K",
    "FL3.11": "three bands, 5854 K",
    "FL3.12": "many bands, 2984 K",
    "FL3.13": "many bands, 4896 K",
    "FL3.14": "many bands, 5045 K",
    "FL3.15": "D65 simulator, 6509 K",
}

_DISCHARGE = {
    "HP1": "standard high-pressure sodium, 1959 K",
    "HP2": "colour-enhanced high-pressure sodium, 2506 K",
    "HP3": "metal halide, 3144 K",
    "HP4": "metal halide, 4002 K",
    "HP5": "metal halide, 4039 K",
}

_LED = {
    "LED-B1": "white LED, blue die and phosphor, 2733 K",
    "LED-B2": "white LED, blue die and phosphor, 2998 K",
    "LED-B3": "white LED, blue die and phosphor, 4103 K",
    "LED-B4": "white LED, blue die and phosphor, 5109 K",
    "LED-B5": "white LED, blue die and phosphor, 6598 K",
    "LED-BH1": "white LED, blue die and phosphor with a red die, 2851 K",
    "LED-RGB1": "white of red, green and blue LEDs, 2840 K",
    "LED-V1": "white LED, violet die and phosphor, 2724 K",
    "LED-V2": "white LED, violet die and phosphor, 4070 K",
}


def illuminant_a() -> SpectralDistribution:
    """Return CIE standard illuminant A by its defining formula, 100 at 560 nm.

    S(λ) = 100 (560/λ)⁵ (exp(1.435e7/(2848·560)) − 1) / (exp(1.435e7/(2848 λ)) − 1), with λ in nm.
    Source: ISO/CIE 11664-2:2022, eq. (1).
    """
    c = 1.435e7 / 2848.0

    def power(nm: Array) -> Array:
        return 100.0 * (560.0 / nm) ** 5 * np.expm1(c / 560.0) / np.expm1(c / nm)

    return SpectralDistribution(power, (100.0, 1e5), label="CIE illuminant A")


def _published(table: str, name: str) -> SpectralDistribution:
    """Return the CIE's 5 nm table, joined by straight lines and zero outside it."""
    found = cie_table(table)
    return SpectralDistribution.tabulated(
        found.wavelengths_nm,
        found.columns[name],
        extension="zero",
        label=f"CIE illuminant {name}",
    )


def cie_entries() -> Iterator[SourceEntry]:
    """Yield the CIE's illuminants; their tables are read when a distribution is asked for."""
    yield SourceEntry(
        "A",
        "CIE standard illuminant A: tungsten lamp, 2856 K; the light of the regulations' tests",
        _FORMULA,
        "facts (CIE)",
        illuminant_a,
    )
    yield SourceEntry(
        "E",
        "CIE illuminant E: the same power at every wavelength",
        _FORMULA,
        "facts (CIE)",
        partial(SpectralDistribution.constant, 100.0, label="CIE illuminant E"),
    )
    groups = (
        ("daylights", "CIE illuminant", _DAYLIGHT),
        ("lamps", "CIE fluorescent lamp", _FLUORESCENT),
        ("lamps", "CIE discharge lamp", _DISCHARGE),
        ("lamps", "CIE", _LED),
    )
    for table, kind, names in groups:
        for name, what in names.items():
            build = partial(_published, table, name)
            yield SourceEntry(name, f"{kind} {name}: {what}", _TABLES, _LICENCE, build)

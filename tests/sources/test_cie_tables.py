# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The tables that are shipped are colour-science's, to the last bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import lamplit
from lamplit.cie_tables import cie_table
from lamplit.colour.observer import OBSERVERS
from lamplit.sources import source, source_names

TITLES = {
    "cie-1931-2": "CIE 1931 2 Degree Standard Observer",
    "cie-1964-10": "CIE 1964 10 Degree Standard Observer",
    "cie-2015-2": "CIE 2015 2 Degree Standard Observer",
}
SOURCES = [name for name in source_names() if name.startswith(("D", "FL", "HP", "LED-"))]


@pytest.mark.parametrize("observer", OBSERVERS)
def test_an_observer_is_colour_sciences_exactly(observer: str) -> None:
    import colour

    table, expected = cie_table(observer), colour.MSDS_CMFS[TITLES[observer]]
    assert np.array_equal(table.wavelengths_nm, expected.wavelengths)
    assert np.array_equal(np.stack([*table.columns.values()], axis=1), expected.values)


@pytest.mark.parametrize("name", SOURCES)
def test_an_illuminant_is_colour_sciences_exactly(name: str) -> None:
    import colour

    expected, found = colour.SDS_ILLUMINANTS[name], source(name).distribution()
    assert found.domain_nm == (expected.wavelengths[0], expected.wavelengths[-1])
    assert np.array_equal(found(expected.wavelengths), expected.values)


def test_every_column_that_is_shipped_is_a_source_and_every_file_credits_its_origin() -> None:
    columns = {*cie_table("daylights").columns, *cie_table("lamps").columns}
    assert columns == set(SOURCES)
    files = sorted((Path(lamplit.__file__).parent / "cie").iterdir())
    assert {path.stem for path in files} == {*OBSERVERS, "daylights", "lamps"}
    for path in files:
        head = path.read_text(encoding="utf-8")[:300]
        assert "CIE" in head and "colour-science" in head and "THIRD_PARTY.md" in head


def test_the_cached_tables_cannot_be_changed() -> None:
    with pytest.raises(ValueError, match="read-only"):
        cie_table("daylights").columns["D65"][0] = 1.0

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Pages of the refractiveindex.info database: real ones, broken ones, hostile ones."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from lamplit.errors import SpectrumError
from lamplit.materials.refractiveindex_info import MAX_BYTES, read_page

# Pages of the database as it publishes them (CC0), cut to some rows.
ALUMINIUM = """\
REFERENCES: |
    A. D. Rakić.
    Algorithm for the determination of intrinsic optical constants of metal films.
    <a href="https://doi.org/10.1364/AO.34.004755"><i>Appl. Opt.</i> <b>34</b>, 4755 (1995)</a>
COMMENTS: |
    \\Optical and electron-energy-loss data for evaporated-aluminum films""
DATA:
  - type: tabulated nk
    data: |
        4.7687E-01 7.2780E-01 5.7781E+00
        5.1660E-01 8.7340E-01 6.2418E+00
        5.6357E-01 1.0728E+00 6.7839E+00
        6.1993E-01 1.3660E+00 7.4052E+00
"""
PMMA = """\
REFERENCES: |
    G. Beadie et al., Appl. Opt. 54, F139-F143 (2015)
CONDITIONS:
    temperature: 293.25
DATA:
  - type: formula 3
    wavelength_range: 0.42 1.62
    coefficients: 2.1778 6.1209e-3 2 -1.5004e-3 4 2.3678e-2 -2 -4.2137e-3 -4
      7.3417e-4 -6 -4.5042e-5 -8
"""
GLASS = """\
DATA:
  - type: formula 2
    range: 0.3 2.5
    coefficients: 0 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653
  - type: tabulated k
    data: |
        0.546 6.9658E-09
        0.580 9.2541E-09
SPECS:
    nd: 1.5168
"""


def page(folder: Path, text: str) -> Path:
    path = folder / "page.yml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_table_of_n_and_k_gives_both(tmp_path: Path) -> None:
    read = read_page(page(tmp_path, ALUMINIUM))
    assert read.n is not None
    assert read.k is not None
    assert read.n.domain_nm == pytest.approx((476.87, 619.93))
    assert float(read.n(550.0)) == pytest.approx(1.015, abs=5e-4)
    assert float(read.k(550.0)) == pytest.approx(6.627, abs=5e-4)
    assert read.references.startswith("A. D. Rakić. Algorithm")


def test_a_formula_holds_on_its_range(tmp_path: Path) -> None:
    read = read_page(page(tmp_path, PMMA))
    assert read.n is not None
    assert read.k is None
    assert float(read.n(587.5618)) == pytest.approx(1.4925, abs=5e-5)
    with pytest.raises(SpectrumError, match=r"page.yml: DATA\[0\] is defined from 420 to 1620 nm"):
        read.n(400.0)


def test_beyond_its_range_a_page_goes_on_as_asked(tmp_path: Path) -> None:
    path = page(tmp_path, PMMA)
    held, on = read_page(path, extension="constant").n, read_page(path, extension="formula").n
    assert held is not None
    assert on is not None
    assert float(held(400.0)) == float(held(420.0))
    assert float(on(400.0)) > float(held(400.0))


def test_a_formula_and_a_table_of_k_make_one_page(tmp_path: Path) -> None:
    read = read_page(page(tmp_path, GLASS))
    assert read.n is not None
    assert read.k is not None
    assert float(read.n(587.5618)) == pytest.approx(1.5168, abs=5e-6)
    assert float(read.k(563.0)) == pytest.approx(8.11e-9, abs=5e-12)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "a mapping of keys is expected"),
        ("- 1\n- 2\n", "a mapping of keys is expected"),
        ("DATA: 3\n", "a list DATA is expected"),
        ("DATA: []\n", "a list DATA is expected"),
        ("DATA:\n  - 3\n", r"DATA\[0\]: a mapping of keys"),
        ("DATA:\n  - type: formula 3\n", "wavelength_range needs two numbers"),
        (PMMA.replace("formula 3", "formula 12"), "formula 12 is unknown"),
        (PMMA.replace("formula 3", "formula x"), "formula 0 is unknown"),
        (PMMA.replace("formula 3", "formula 8"), "takes 4 coefficients, and 13"),
        (PMMA.replace("0.42 1.62", "1.62 0.42"), "rises from a positive"),
        (PMMA.replace("2.1778", "two"), "coefficients: 'two' is not a finite number"),
        (ALUMINIUM.replace("tabulated nk", "tabulated n2"), "'tabulated n2' is unknown"),
        (ALUMINIUM.replace("tabulated nk", "tabulated n"), "data line 1 has 3 columns, and 2"),
        (ALUMINIUM.replace("5.7781E+00", ""), "data line 1 has 2 columns, and 3"),
        (ALUMINIUM.replace("8.7340E-01", "nan"), "data row 2: 'nan' is not a finite"),
        (ALUMINIUM.replace("5.1660E-01", "4.1660E-01"), "wavelengths must rise"),
        ("DATA:\n  - type: tabulated n\n    data: 0.5 1.5\n", "two rows at least"),
        ("DATA: [\n", "line 2: the YAML is broken"),
        ("DATA: \x00\n", "the YAML is broken"),
        ("DATA: !!python/object/apply:os.system ['true']\n", "the YAML is broken"),
        ("DATA: &a [*a]\n", "nests or repeats"),
        ("a: &a [x]\nDATA: [*a, *a]\n", "nests or repeats"),
        ("DATA: " + "[" * 200_000, "nests or repeats"),
        ("DATA:\n" + "- 1\n" * 100_000, "nests or repeats"),
        ("DATA: " + "{a: " * 100_000, "nests or repeats"),
    ],
)
def test_what_is_no_page_is_refused_at_once(tmp_path: Path, text: str, said: str) -> None:
    path = page(tmp_path, text)
    start = time.perf_counter()
    with pytest.raises(SpectrumError, match=said) as caught:
        read_page(path)
    assert time.perf_counter() - start < 1.0
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_page_too_large_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "page.yml"
    with path.open("wb") as stream:
        stream.truncate(MAX_BYTES + 1)
    with pytest.raises(SpectrumError, match="too large"):
        read_page(path)


def test_a_page_that_is_no_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "page.yml"
    path.write_bytes(b"DATA: \xff\xfe")
    with pytest.raises(SpectrumError, match="UTF-8"):
        read_page(path)


def test_the_largest_table_that_fits_is_read_in_time(tmp_path: Path) -> None:
    rows = "".join(f"        {0.3 + at * 2e-5:.6f} 1.500000 1.0E-7\n" for at in range(60_000))
    path = page(tmp_path, "DATA:\n  - type: tabulated nk\n    data: |\n" + rows)
    assert path.stat().st_size < MAX_BYTES
    start = time.perf_counter()
    n = read_page(path).n
    assert time.perf_counter() - start < 1.0
    assert n is not None
    np.testing.assert_allclose(n([400.0, 1000.0]), 1.5)

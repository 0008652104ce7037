# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Ray files made byte by byte come back as rays in mm, lm or W, and nm."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lamplit.photometry.rays import RaySet, SpectralTable, read_rays, write_tm25
from lamplit.photometry.text import PhotometryError

Write = Callable[[str, "str | bytes"], Path]
Bytes = Callable[..., bytes]

POSITIONS = [[1.0, 2.0, 3.0], [-1.0, 0.25, 0.0], [0.0, 0.0, -4.0]]
DIRECTIONS = [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, -1.0, 0.0]]
FLUX = [0.5, 1.5, 2.0]


def rows(*columns: list[float]) -> list[tuple[float, ...]]:
    """Return position, direction, and then whatever columns a file has."""
    return [
        (*place, *way, *rest)
        for place, way, rest in zip(POSITIONS, DIRECTIONS, zip(*columns, strict=True), strict=True)
    ]


def check_geometry(rays: RaySet, unit_mm: float = 1.0) -> None:
    assert rays.count == 3
    np.testing.assert_allclose(rays.positions_mm, np.multiply(POSITIONS, unit_mm), rtol=1e-7)
    np.testing.assert_allclose(rays.directions, DIRECTIONS, atol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(rays.directions, axis=1), 1.0, rtol=1e-15)
    assert rays.unit_mm == unit_mm


def test_a_plain_tm25_file_gives_radiant_rays_in_mm(written: Write, tm25: Bytes) -> None:
    rays = read_rays(written("led.TM25RAY", tm25()))
    check_geometry(rays)
    assert rays.quantity == "radiant"
    assert rays.flux.tolist() == FLUX
    assert (rays.total_flux, rays.stated_flux, rays.stated_flux_lm) == (4.0, 4.0, None)
    assert rays.wavelengths_nm is None and rays.spectra == ()
    assert rays.description == "Red LED λ"


def test_a_luminous_tm25_file_gives_lumens(written: Write, tm25: Bytes) -> None:
    content = tm25(flags=(1, 1, 0, 0, 1, 0, 0, 0), lumens=5.0)
    rays = read_rays(written("led.tm25ray", content))
    assert (rays.quantity, rays.total_flux, rays.stated_flux) == ("luminous", 4.0, 5.0)


def test_lumens_are_taken_where_a_tm25_file_has_watts_too(written: Write, tm25: Bytes) -> None:
    content = tm25(rows([0.1, 0.2, 0.3], FLUX), flags=(1, 1, 1, 0, 1, 0, 0, 0))
    rays = read_rays(written("led.tm25ray", content))
    assert (rays.quantity, rays.flux.tolist()) == ("luminous", FLUX)


def test_wavelengths_of_rays_are_nm_in_tm25(written: Write, tm25: Bytes) -> None:
    content = tm25(rows(FLUX, [620.0, 630.0, 640.0]), kind=2, flags=(1, 1, 1, 1, 0, 0, 0, 0))
    rays = read_rays(written("led.tm25ray", content))
    check_geometry(rays)
    assert rays.flux.tolist() == FLUX
    assert rays.wavelengths_nm is not None
    assert rays.wavelengths_nm.tolist() == [620.0, 630.0, 640.0]


def test_one_wavelength_for_all_is_that_of_each(written: Write, tm25: Bytes) -> None:
    rays = read_rays(written("laser.tm25ray", tm25(kind=1, wavelength=632.75)))
    assert rays.wavelengths_nm is not None
    assert rays.wavelengths_nm.tolist() == [632.75] * 3


def test_a_spectral_table_is_read_past_its_filling(written: Write, tm25: Bytes) -> None:
    """4 + 3·8 = 28 bytes, filled up to 32."""
    content = tm25(kind=3, tables=[[(600.0, 0.0), (624.0, 100.0), (650.0, 0.0)]])
    rays = read_rays(written("led.tm25ray", content))
    check_geometry(rays)
    assert rays.spectrum_index is None
    assert rays.spectra[0].wavelengths_nm.tolist() == [600.0, 624.0, 650.0]
    assert rays.spectra[0].weights.tolist() == [0.0, 100.0, 0.0]


def test_each_ray_may_have_a_table_of_its_own(written: Write, tm25: Bytes) -> None:
    """Two tables of 20 and 28 bytes are filled up together, to 64."""
    tables = [[(600.0, 1.0), (650.0, 1.0)], [(400.0, 0.0), (450.0, 1.0), (500.0, 0.0)]]
    content = tm25(rows(FLUX, [2, 1, 2]), kind=4, tables=tables, flags=(1, 1, 1, 0, 0, 0, 0, 1))
    rays = read_rays(written("white.tm25ray", content))
    check_geometry(rays)
    assert rays.spectrum_index is not None and rays.spectrum_index.tolist() == [1, 0, 1]
    assert rays.spectra[1].wavelengths_nm.tolist() == [400.0, 450.0, 500.0]


@pytest.mark.parametrize("stokes", [3, 6])
def test_what_is_not_needed_is_passed_over(written: Write, tm25: Bytes, stokes: int) -> None:
    """Stokes columns as the older and the newer readings have them, X and Z, one column added."""
    unused = [[0.25] * 3] * (stokes + 2)
    content = tm25(
        rows([9.0] * 3, FLUX, *unused, [8.0] * 3),
        flags=(1, 1, 1, 0, 1, 1, 1, 0),
        added=["phase"],
        text=b"made by hand".ljust(32, b"\0"),
    )
    rays = read_rays(written("led.tm25ray", content))
    check_geometry(rays)
    assert rays.flux.tolist() == FLUX


@pytest.mark.parametrize(
    ("unit", "unit_mm"), [(0, 1000.0), (1, 25.4), (2, 10.0), (3, 304.8), (4, 1.0)]
)
def test_a_zemax_file_in_any_unit_is_in_mm(
    written: Write, zemax: Bytes, unit: int, unit_mm: float
) -> None:
    rays = read_rays(written("led.DAT", zemax(unit=unit)))
    check_geometry(rays, unit_mm)
    assert (rays.quantity, rays.flux.tolist(), rays.stated_flux) == ("luminous", FLUX, 4.0)
    assert rays.description == "Amber LED"


def test_the_wavelength_in_a_zemax_header_is_not_taken_for_that_of_rays(
    written: Write, zemax: Bytes
) -> None:
    assert read_rays(written("led.dat", zemax(wavelength=0.624))).wavelengths_nm is None


@pytest.mark.parametrize("identifier", [1010, 8675309])
def test_a_spectral_zemax_file_has_watts_and_micrometres(
    written: Write, zemax: Bytes, identifier: int
) -> None:
    content = zemax(
        rows(FLUX, [0.62, 0.63, 0.64]), ray_format=2, flux_type=0, identifier=identifier
    )
    rays = read_rays(written("led.sdf", content))
    check_geometry(rays)
    assert (rays.quantity, rays.stated_flux_w) == ("radiant", 4.0)
    assert rays.wavelengths_nm is not None
    np.testing.assert_allclose(rays.wavelengths_nm, [620.0, 630.0, 640.0], rtol=1e-6)


def test_directions_rounded_to_four_decimals_are_made_unit_vectors(
    written: Write, zemax: Bytes
) -> None:
    rays = read_rays(written("led.dat", zemax([(0, 0, 0, 0.5774, 0.5774, 0.5773, 1.0)])))
    np.testing.assert_allclose(rays.directions, [[3**-0.5] * 3], atol=1e-4)
    assert np.linalg.norm(rays.directions[0]) == pytest.approx(1.0, abs=1e-15)


def random_rays(count: int, **more: object) -> RaySet:
    chance = np.random.default_rng(3)
    ways = chance.normal(size=(count, 3))
    return RaySet(
        chance.normal(size=(count, 3)).astype(np.float32).astype(np.float64),
        ways / np.linalg.norm(ways, axis=1, keepdims=True),
        chance.uniform(size=count).astype(np.float32).astype(np.float64),
        description="A lamp",
        **more,  # type: ignore[arg-type]
    )


TABLES = (
    SpectralTable(np.array([600.0, 700.0]), np.array([1.0, 0.5])),
    SpectralTable(np.array([400.0, 450.0, 500.0]), np.array([0.0, 1.0, 0.25])),
)

SETS = {
    "luminous": random_rays(7, quantity="luminous"),
    "radiant": random_rays(7, quantity="radiant"),
    "wavelengths": random_rays(7, quantity="radiant", wavelengths_nm=np.linspace(400.0, 700.0, 7)),
    "one table": random_rays(7, quantity="luminous", spectra=TABLES[:1]),
    "tables": random_rays(
        7, quantity="radiant", spectra=TABLES, spectrum_index=np.array([0, 1, 1, 0, 0, 1, 0])
    ),
}


@pytest.mark.parametrize("name", SETS)
def test_what_is_written_as_tm25_is_read_back(tmp_path: Path, name: str) -> None:
    rays = SETS[name]
    write_tm25(tmp_path / "a.tm25ray", rays, created="2026-01-01T00:00:00Z")
    again = read_rays(tmp_path / "a.tm25ray")
    np.testing.assert_array_equal(again.positions_mm, rays.positions_mm)
    np.testing.assert_allclose(again.directions, rays.directions, atol=1e-7)
    np.testing.assert_array_equal(again.flux, rays.flux)
    assert (again.quantity, again.description) == (rays.quantity, rays.description)
    assert again.stated_flux == pytest.approx(rays.total_flux, rel=1e-6)
    if rays.wavelengths_nm is not None:
        np.testing.assert_allclose(again.wavelengths_nm, rays.wavelengths_nm, rtol=1e-7)
    for mine, yours in zip(rays.spectra, again.spectra, strict=True):
        np.testing.assert_array_equal(mine.weights, yours.weights)
        np.testing.assert_array_equal(mine.wavelengths_nm, yours.wavelengths_nm)
    if rays.spectrum_index is not None:
        np.testing.assert_array_equal(again.spectrum_index, rays.spectrum_index)


def test_written_bytes_stand_where_the_layout_has_them(tmp_path: Path, tm25: Bytes) -> None:
    """Against bytes made by hand: header but for date and totals, flags, table and rays."""
    tables = [[(600.0, 1.0), (700.0, 0.5)]]
    by_hand = tm25(kind=3, tables=tables)
    (tmp_path / "hand.tm25ray").write_bytes(by_hand)
    write_tm25(tmp_path / "a.tm25ray", read_rays(tmp_path / "hand.tm25ray"))
    content = (tmp_path / "a.tm25ray").read_bytes()
    assert len(content) == len(by_hand)
    assert content[:12] == by_hand[:12]
    assert content[16:28] == by_hand[16:28]
    assert content[56:64] == by_hand[56:64]
    assert content[76:256] == by_hand[76:256]
    assert content[256:] == by_hand[256:]


def test_luminous_rays_with_wavelengths_are_not_written(tmp_path: Path) -> None:
    rays = random_rays(3, quantity="luminous", wavelengths_nm=np.full(3, 624.0))
    with pytest.raises(PhotometryError, match="a flux in W"):
        write_tm25(tmp_path / "a.tm25ray", rays)
    assert list(tmp_path.iterdir()) == []

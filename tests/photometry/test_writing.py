# SPDX-License-Identifier: Apache-2.0 OR MIT
"""IES and EULUMDAT files that are written read back here and in an independent program."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamplit.errors import OutputError
from lamplit.photometry import Photometry, PhotometryError, read_photometry
from lamplit.photometry.angles import directions
from lamplit.photometry.measured import from_hv, resampled_c
from lamplit.photometry.writing import FileLabels, write_ies, write_ldt

LABELS = FileLabels(
    luminaire="Stop lamp Größe 3",
    manufacturer="Somebody",
    catalogue_number="S-1",
    lamp="P21W",
    report="42",
    date="2026-01-02",
    others={"OTHER": "a long story " * 20},
)

X, Y, Z = np.eye(3)


def steps(first: float, last: float, step: float) -> np.ndarray:
    return np.linspace(first, last, round((last - first) / step) + 1)


def lambert(d: np.ndarray) -> np.ndarray:
    return 100.0 * np.maximum(0.0, d[..., 2])


def skew(d: np.ndarray) -> np.ndarray:
    """Be brighter to the right of the observer, up, and along the axis; flux 4000 π lm."""
    return 1000.0 + d @ np.array([300.0, 200.0, 400.0]) + 1.0 / 3.0


def of_type(kind: str) -> Photometry:
    if kind == "A":
        h, v = steps(-80, 45, 5), steps(-15, 15, 5)
        return from_hv(h, v, skew(directions("A", h[None, :], v[:, None])))
    if kind == "B":
        h, v = steps(-45, 80, 5), steps(-15, 15, 5)
        table = skew(directions("B", -h[:, None], v[None, :]))
        return Photometry("B", h, v, table, 460.0)
    c, gamma = steps(0, 360, 15), steps(0, 180, 5)
    table = skew(directions("C", c[:, None], gamma[None, :]))
    table[-1] = table[0]
    return Photometry("C", c, gamma, table, None)


def photompy() -> Any:
    """Give the independent reader; it needs a later Python than Lamplit does."""
    if sys.version_info < (3, 11):
        pytest.skip("photompy needs Python 3.11")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of its own, about grids that are not type C
        import photompy as reader
    return reader


@pytest.mark.parametrize("kind", "ABC")
def test_an_ies_file_reads_back_to_its_printed_digits(tmp_path: Path, kind: str) -> None:
    photometry = of_type(kind)
    write_ies(tmp_path / "a.ies", photometry, LABELS, opening_m=(0.1, 0.05, 0.0), input_watts=21)
    again = read_photometry(tmp_path / "a.ies")
    assert again.photometric_type == kind
    assert again.lamp_flux_lm == photometry.lamp_flux_lm
    np.testing.assert_array_equal(again.horizontal_deg, photometry.horizontal_deg)
    np.testing.assert_array_equal(again.vertical_deg, photometry.vertical_deg)
    six_digits = np.vectorize(lambda cd: float(f"{cd:.6g}"))
    np.testing.assert_array_equal(again.candela, six_digits(photometry.candela))


@pytest.mark.parametrize("kind", "ABC")
def test_an_ies_file_keeps_right_and_up_where_they_were(tmp_path: Path, kind: str) -> None:
    write_ies(tmp_path / "a.ies", of_type(kind))
    again = read_photometry(tmp_path / "a.ies")
    towards = directions("A", [0, 10, -10, 0, 0], [0, 0, 0, 10, -10])
    np.testing.assert_allclose(again.intensity_cd(towards), skew(towards), rtol=2e-3)


def test_an_ies_file_is_text_that_the_format_allows(tmp_path: Path) -> None:
    write_ies(tmp_path / "a.ies", of_type("A"), LABELS, input_watts=21.5)
    content = (tmp_path / "a.ies").read_bytes()
    lines = content.decode("ascii").split("\r\n")
    assert content.count(b"\n") == content.count(b"\r\n") == len(lines) - 1
    assert lines[:3] == ["IES:LM-63-2019", "[TEST] 42", "[TESTLAB] computed by Lamplit"]
    assert "[LUMINAIRE] Stop lamp Gr??e 3" in lines
    assert max(map(len, lines)) <= 78
    tilt = lines.index("TILT=NONE")
    assert all(line.startswith("[") for line in lines[1:tilt])
    assert sum(line.startswith("[MORE] ") for line in lines) == 3
    assert lines[tilt + 1 : tilt + 3] == ["1 -1 1 7 26 3 2 0 0 0", "1 1.00010 21.5"]
    assert lines[tilt + 3] == "-15 -10 -5 0 5 10 15"
    assert lines[tilt + 4].startswith("-45 -40 ")


@pytest.mark.parametrize("kind", "ABC")
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_photompy_reads_the_same_ies_file(tmp_path: Path, kind: str) -> None:
    photometry = of_type(kind)
    write_ies(tmp_path / "a.ies", photometry, LABELS, input_watts=21)
    theirs = photompy().IESFile.read(tmp_path / "a.ies")
    assert theirs.photometry.photometric_type.name == kind
    np.testing.assert_array_equal(theirs.photometry.phis, photometry.horizontal_deg)
    np.testing.assert_array_equal(theirs.photometry.thetas, photometry.vertical_deg)
    np.testing.assert_allclose(theirs.photometry.values, photometry.candela, rtol=5e-6)
    assert theirs.header.input_watts == 21
    assert theirs.header.lumens_per_lamp == (photometry.lamp_flux_lm or -1)


def test_photompy_finds_the_flux_of_a_lambertian_lamp_in_both_files(tmp_path: Path) -> None:
    """100 cd along the axis: 100 π lm, by its own sum over the sphere."""
    gamma = steps(0, 90, 1)
    lamp = Photometry(
        "C",
        np.array([0.0, 360.0]),
        gamma,
        np.stack([lambert(directions("C", 0.0, gamma))] * 2),
        None,
    )
    lamp = resampled_c(lamp, plane_step_deg=10.0)
    write_ies(tmp_path / "a.ies", lamp)
    write_ldt(tmp_path / "a.ldt", lamp)
    reader = photompy()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fluxes = [
            reader.IESFile.read(tmp_path / "a.ies").photometry.total_optical_power(),
            reader.LDTFile.read(tmp_path / "a.ldt").photometry.total_optical_power(),
        ]
    np.testing.assert_allclose(fluxes, 100.0 * np.pi, rtol=2e-3)


@pytest.mark.parametrize("lamp_flux", [None, 20_000.0])
def test_an_eulumdat_file_reads_back_to_its_printed_digits(
    tmp_path: Path, lamp_flux: float | None
) -> None:
    own = of_type("C")
    photometry = Photometry("C", own.horizontal_deg, own.vertical_deg, own.candela, lamp_flux)
    write_ldt(tmp_path / "a.ldt", photometry, LABELS)
    again = read_photometry(tmp_path / "a.ldt")
    np.testing.assert_array_equal(again.horizontal_deg, photometry.horizontal_deg)
    np.testing.assert_array_equal(again.vertical_deg, photometry.vertical_deg)
    np.testing.assert_allclose(again.candela, photometry.candela, rtol=5e-6)
    assert again.lamp_flux_lm == pytest.approx(lamp_flux or photometry.flux_lm(), rel=5e-6)


def test_the_lines_of_an_eulumdat_file_are_those_of_the_format(tmp_path: Path) -> None:
    """26 lines, 6 of the lamps, 10 ratios, 24 planes, 37 angles, and 24 · 37 intensities.

    Below γ = 90 are 1000.33 · 2 π + 400 · π lm of 1000.33 · 4 π: 59.997 %.
    """
    write_ldt(tmp_path / "lamp.ldt", of_type("C"), LABELS, opening_mm=(100, 50, 20))
    lines = (tmp_path / "lamp.ldt").read_bytes().decode("ascii").split("\r\n")
    assert len(lines) == 26 + 6 + 10 + 24 + 37 + 24 * 37 + 1 and lines[-1] == ""
    assert lines[:7] == ["Somebody", "3", "0", "24", "15", "37", "5"]
    assert lines[7:12] == [
        "42",
        "Stop lamp Gr??e 3",
        "S-1",
        "lamp.ldt",
        "2026-01-02 computed by Lamplit",
    ]
    assert lines[12:21] == ["100", "50", "20", "100", "50", "20", "20", "20", "20"]
    assert float(lines[21]) == pytest.approx(59.997, abs=0.01)
    assert lines[22:28] == ["100", "1", "0", "1", "-1", "P21W"]
    assert float(lines[28]) == pytest.approx(4001.33 * np.pi, rel=2e-3)
    assert lines[32:42] == ["0"] * 10
    assert lines[42:45] == ["0", "15", "30"]


def test_photompy_reads_the_same_eulumdat_file(tmp_path: Path) -> None:
    photometry = of_type("C")
    write_ldt(tmp_path / "a.ldt", photometry, LABELS)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        theirs = photompy().LDTFile.read(tmp_path / "a.ldt")
    np.testing.assert_array_equal(theirs.photometry.phis, photometry.horizontal_deg[:-1])
    np.testing.assert_array_equal(theirs.photometry.thetas, photometry.vertical_deg)
    np.testing.assert_allclose(theirs.photometry.values, photometry.candela[:-1], rtol=5e-6)


def test_a_grid_of_h_and_v_becomes_c_planes_with_the_same_light_inside_of_it(
    tmp_path: Path,
) -> None:
    """And none beyond: the grid reaches 45° to the left, 80° to the right, 15° up and down."""
    h, v = steps(-45, 80, 1), steps(-15, 15, 1)
    measured = from_hv(h, v, skew(directions("A", h[None, :], v[:, None])))
    write_ldt(tmp_path / "a.ldt", measured, plane_step_deg=2.5, gamma_step_deg=1.0)
    again = read_photometry(tmp_path / "a.ldt")
    inside = directions("A", [0, 5, -5, 3, 70, -40, 0], [0, 0, 0, -8, 1, -1, 12])
    np.testing.assert_allclose(again.intensity_cd(inside), skew(inside), rtol=1e-3)
    beyond = directions("A", [0, 0, -60, 100], [30, -30, 0, 0])
    np.testing.assert_array_equal(again.intensity_cd(beyond), 0.0)
    assert again.vertical_deg[-1] == 90.0


def test_h_greater_than_zero_is_to_the_right_in_every_file(tmp_path: Path) -> None:
    """A beam at H = +20, V = +10, written in both formats, leans to +x and up."""
    h, v = steps(-60, 60, 2), steps(-40, 40, 2)
    beam = 50.0 * np.exp(-((h[None, :] - 20.0) ** 2 + (v[:, None] - 10.0) ** 2) / 200.0)
    measured = from_hv(h, v, beam)
    write_ies(tmp_path / "a.ies", measured)
    write_ldt(tmp_path / "a.ldt", measured)
    grid = directions("A", h[None, :], v[:, None])
    for name in ("a.ies", "a.ldt"):
        seen = read_photometry(tmp_path / name).intensity_cd(grid)
        up, right = np.unravel_index(np.argmax(seen), seen.shape)
        assert (h[right], v[up]) == (20.0, 10.0)
        assert seen.max() == pytest.approx(50.0, rel=2e-2)


def test_what_a_file_cannot_hold_is_refused_and_not_written(tmp_path: Path) -> None:
    h = np.array([0.0, 10.0])
    half = Photometry("A", h, np.array([-5.0, 5.0]), np.ones((2, 2)), None)
    lower = Photometry("B", h - 5.0, h, np.ones((2, 2)), None)
    dark = from_hv([-5.0, 5.0], [-5.0, 5.0], np.zeros((2, 2)))
    broken = from_hv([-5.0, 5.0], [-5.0, 5.0], [[1.0, 1.0], [np.nan, 1.0]])
    negative = from_hv([-5.0, 5.0], [-5.0, 5.0], [[1.0, -1.0], [1.0, 1.0]])
    for name, lamp, says in (
        ("a.ies", half, "H begins at 0°"),
        ("a.ies", lower, "V begins at 0°"),
        ("a.ies", broken, "the intensity at 5°, 5° is nan cd"),
        ("a.ies", negative, "the intensity at -5°, -5° is -1 cd"),
        ("a.ldt", broken, "is nan cd"),
        ("a.ldt", dark, "there is no light"),
    ):
        write = write_ies if name.endswith("ies") else write_ldt
        with pytest.raises(PhotometryError, match=says):
            write(tmp_path / name, lamp)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(OutputError, match="cannot be written"):
        write_ies(tmp_path / "absent" / "a.ies", of_type("A"))


def test_a_dark_lamp_has_an_ies_file_of_zeros(tmp_path: Path) -> None:
    write_ies(tmp_path / "a.ies", from_hv([-5.0, 5.0], [-5.0, 5.0], np.zeros((2, 2))))
    assert (tmp_path / "a.ies").read_text().splitlines()[-2:] == ["0 0", "0 0"]


def test_shapes_and_steps_that_do_not_fit_are_refused() -> None:
    for h, v, table in (
        ([0.0, 1.0], [0.0, 1.0, 2.0], np.ones((2, 3))),
        ([0.0], [0.0, 1.0], np.ones((2, 1))),
    ):
        with pytest.raises(ValueError, match="do not fit"):
            from_hv(h, v, table)
    with pytest.raises(ValueError, match="must rise"):
        from_hv([1.0, 0.0], [0.0, 1.0], np.ones((2, 2)))
    for step in (7.0, 0.0, 180.0):
        with pytest.raises(ValueError, match="no whole part"):
            resampled_c(of_type("C"), plane_step_deg=step)

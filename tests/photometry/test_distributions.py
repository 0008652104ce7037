# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Analytic distributions in every type and symmetry come back, with their flux and orientation."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lamplit.photometry import Photometry, PhotometryError, read_photometry

Write = Callable[[str, "str | bytes"], Path]
Text = Callable[..., str]

X, Y, Z = np.eye(3)


def steps(first: float, last: float, step: float) -> list[float]:
    return np.arange(first, last + step / 2, step).tolist()


def uniform(d: np.ndarray) -> np.ndarray:
    return np.full(d.shape[:-1], 10.0)


def lambert(d: np.ndarray) -> np.ndarray:
    return 100.0 * np.maximum(0.0, d[..., 2])


def cosine_to_the_20th(d: np.ndarray) -> np.ndarray:
    return 100.0 * np.maximum(0.0, d[..., 2]) ** 20


def skew(d: np.ndarray) -> np.ndarray:
    """Look different in every octant; flux 4π · 1000 lm, since the rest averages out."""
    return 1000.0 + d @ np.array([300.0, 200.0, 400.0]) + 90.0 * d[..., 0] * d[..., 1]


def even_in_x(d: np.ndarray) -> np.ndarray:
    return 1000.0 + 200.0 * d[..., 1] + 400.0 * d[..., 2] + 300.0 * np.abs(d[..., 0])


def even_in_y(d: np.ndarray) -> np.ndarray:
    return 1000.0 + 200.0 * d[..., 0] + 400.0 * d[..., 2] + 300.0 * np.abs(d[..., 1])


def even_in_both(d: np.ndarray) -> np.ndarray:
    return 1000.0 + 400.0 * d[..., 2] + 300.0 * np.abs(d[..., 0]) + 100.0 * np.abs(d[..., 1])


#: Fluxes in lm of the laws above: ∫ I dω, with ∫ |x| dω = 2π.
FLUX_LM = {
    uniform: 40.0 * np.pi,
    lambert: 100.0 * np.pi,
    cosine_to_the_20th: 200.0 * np.pi / 21.0,
    skew: 4000.0 * np.pi,
    even_in_x: 4000.0 * np.pi + 600.0 * np.pi,
    even_in_y: 4000.0 * np.pi + 600.0 * np.pi,
    even_in_both: 4000.0 * np.pi + 800.0 * np.pi,
}

_GAMMA = steps(0, 180, 2)
_H, _V = steps(-90, 90, 2), steps(-90, 90, 2)
_HALF = steps(0, 90, 2)

#: An IES file for each type and symmetry: type, horizontal and vertical angles, law.
IES = {
    "C all around": ("C", steps(0, 360, 3), _GAMMA, skew),
    "C up to the last plane": ("C", steps(0, 357, 3), _GAMMA, skew),
    "C one plane": ("C", [0.0], _GAMMA, uniform),
    "C one plane, lower half": ("C", [0.0], steps(0, 90, 1), lambert),
    "C one plane, narrow": ("C", [0.0], steps(0, 90, 1), cosine_to_the_20th),
    "C quarters": ("C", steps(0, 90, 3), _GAMMA, even_in_both),
    "C halves about 0-180": ("C", steps(0, 180, 3), _GAMMA, even_in_x),
    "C halves about 90-270": ("C", steps(90, 270, 3), _GAMMA, even_in_y),
    "C halves about 90-270 without 180": ("C", steps(90, 270, 4), _GAMMA, even_in_y),
    "A front": ("A", _H, _V, lambert),
    "A front, narrow": ("A", steps(-90, 90, 1), steps(-90, 90, 1), cosine_to_the_20th),
    "A all around": ("A", steps(-180, 180, 3), _V, skew),
    "A halves": ("A", _HALF, _V, lambert),
    "A quarters": ("A", _HALF, _HALF, lambert),
    "A all around, halves": ("A", steps(0, 180, 3), _V, even_in_x),
    "B front": ("B", _H, _V, lambert),
    "B front, narrow": ("B", steps(-90, 90, 1), steps(-90, 90, 1), cosine_to_the_20th),
    "B all around": ("B", _H, steps(-180, 180, 3), skew),
    "B halves": ("B", _HALF, _V, lambert),
    "B quarters": ("B", _HALF, _HALF, lambert),
}

#: An EULUMDAT file for each symmetry.
LDT = {
    "no symmetry": (0, steps(0, 345, 15), skew),
    "no symmetry, fine": (0, steps(0, 357, 3), skew),
    "axial, many planes listed": (1, steps(0, 345, 15), lambert),
    "axial, one plane listed": (1, [0.0], uniform),
    "about 0-180": (2, steps(0, 357, 3), even_in_x),
    "about 90-270": (3, steps(0, 357, 3), even_in_y),
    "about both": (4, steps(0, 357, 3), even_in_both),
}


def directions(count: int = 4000) -> np.ndarray:
    spread = np.random.default_rng(5).normal(size=(count, 3))
    return spread / np.linalg.norm(spread, axis=-1, keepdims=True)


def check(photometry: Photometry, law: Callable[[np.ndarray], np.ndarray], coarse: float) -> None:
    """Hold intensities against ``law``: the table is bilinear, so second differences bound it."""
    towards = directions()
    expected = law(towards)
    given = photometry.intensity_cd(towards)
    # Next to the edge of a table (cos = 0) an intensity is small, and so is what it may differ by.
    np.testing.assert_allclose(given, expected, rtol=0, atol=coarse * expected.max())
    assert photometry.flux_lm() == pytest.approx(FLUX_LM[law], rel=coarse)


@pytest.mark.parametrize("name", IES)
def test_an_ies_table_of_each_type_and_symmetry_gives_its_law_and_flux(
    written: Write, ies: Text, name: str
) -> None:
    kind, horizontal, vertical, law = IES[name]
    photometry = read_photometry(written("a.ies", ies(kind, horizontal, vertical, law)))
    assert photometry.photometric_type == kind
    assert photometry.lamp_flux_lm == 1000.0
    check(photometry, law, 2e-3)


@pytest.mark.parametrize("name", LDT)
def test_an_eulumdat_table_of_each_symmetry_gives_its_law_and_flux(
    written: Write, ldt: Text, name: str
) -> None:
    symmetry, planes, law = LDT[name]
    photometry = read_photometry(written("a.ldt", ldt(symmetry, planes, steps(0, 180, 2), law)))
    assert photometry.photometric_type == "C"
    assert photometry.lamp_flux_lm == 2000.0
    assert photometry.horizontal_deg[0] == 0.0
    assert photometry.horizontal_deg[-1] == 360.0
    check(photometry, law, 2e-3 if len(planes) > 30 else 1.5e-2)


@pytest.mark.parametrize(
    ("name", "angles"), [("A", (30.0, 20.0)), ("B", (30.0, 20.0)), ("C", (40.0, 50.0))]
)
def test_a_node_of_the_table_lies_where_a_goniometer_of_the_type_points(
    written: Write,
    ies: Text,
    goniometer: Callable[..., np.ndarray],
    name: str,
    angles: tuple[float, float],
) -> None:
    grids = {"C": (steps(0, 360, 10), steps(0, 180, 10))}
    horizontal, vertical = grids.get(name, (steps(-90, 90, 10), steps(-90, 90, 10)))
    photometry = read_photometry(written("a.ies", ies(name, horizontal, vertical, skew)))
    towards = goniometer(name, *map(np.array, angles))
    assert photometry.intensity_cd(towards) == pytest.approx(skew(towards), rel=1e-12)


def test_plane_0_lies_towards_y_and_plane_90_towards_x(written: Write) -> None:
    """Type C: counterclockwise from above, where the axis +z is nadir."""
    table = "\n".join(f"0 {level} 0" for level in (1, 2, 3, 4, 1))
    text = (
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 5 1 2 0 0 0\n1 1 1\n"
        f"0 90 180\n0 90 180 270 360\n{table}"
    )
    photometry = read_photometry(written("a.ies", text))
    np.testing.assert_allclose(photometry.intensity_cd([Y, X, -Y, -X, Z]), [1, 2, 3, 4, 0])


def test_type_a_has_h_to_the_right_of_the_lamp_itself_and_v_upwards(written: Write) -> None:
    """Clockwise from above; the columns are V, the rows H."""
    text = (
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 3 3 2 0 0 0\n1 1 1\n"
        "-90 0 90\n-90 0 90\n7 1 5\n7 2 5\n7 3 5"
    )
    photometry = read_photometry(written("a.ies", text))
    np.testing.assert_allclose(photometry.intensity_cd([X, Z, -X, Y, -Y]), [1, 2, 3, 5, 7])


def test_type_b_has_its_poles_on_the_left_and_right(written: Write) -> None:
    text = (
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 3 2 2 0 0 0\n1 1 1\n"
        "-90 0 90\n-90 0 90\n1 1 1\n4 5 6\n9 9 9"
    )
    photometry = read_photometry(written("a.ies", text))
    np.testing.assert_allclose(photometry.intensity_cd([X, -X, -Y, Z, Y]), [1, 9, 4, 5, 6])


def test_types_a_and_b_agree_on_the_cross_through_the_axis_and_differ_off_it(
    written: Write, ies: Text
) -> None:
    def bump(d: np.ndarray) -> np.ndarray:
        return 5.0 + d[..., 0]

    grid = (steps(-90, 90, 5), steps(-90, 90, 5))
    a, b = (read_photometry(written(f"{kind}.ies", ies(kind, *grid, bump))) for kind in "AB")
    towards = directions()
    front = towards[towards[:, 2] > 0.0]
    np.testing.assert_allclose(a.intensity_cd(front), b.intensity_cd(front), rtol=2e-3)
    assert np.abs(a.candela - b.candela).max() > 0.5


def test_the_flux_of_a_straight_fall_to_the_horizon_is_exact(written: Write) -> None:
    """∫ (1 − 2θ/π) sin θ dθ from 0 to π/2 is 1 − 2/π."""
    text = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n100 0"
    photometry = read_photometry(written("a.ies", text))
    assert photometry.flux_lm() == pytest.approx(200.0 * np.pi * (1.0 - 2.0 / np.pi), rel=1e-14)


@pytest.mark.parametrize("kind", "ABC")
def test_the_flux_is_the_mean_intensity_over_the_sphere(
    written: Write, ies: Text, kind: str
) -> None:
    """A coarse uneven grid: flux against a fine sum over equal areas of the sphere."""

    def rough(d: np.ndarray) -> np.ndarray:
        return 100.0 * (1.2 + np.sin(5.0 * d[..., 0] + 3.0 * d[..., 1] + d[..., 2]))

    grids = {
        "A": ([-180.0, -70.0, 10.0, 25.0, 180.0], [-80.0, -10.0, 15.0, 90.0]),
        "B": ([-90.0, -35.0, 10.0, 60.0], [-180.0, -20.0, 15.0, 180.0]),
        "C": ([0.0, 35.0, 200.0, 290.0], [0.0, 20.0, 75.0, 180.0]),
    }
    photometry = read_photometry(written("a.ies", ies(kind, *grids[kind], rough)))
    z, phi = np.meshgrid(
        (np.arange(800) + 0.5) / 400.0 - 1.0, (np.arange(1600) + 0.5) * np.pi / 800
    )
    r = np.sqrt(1.0 - z**2)
    # Askew, so that no edge of the table runs along a row of points.
    askew, _ = np.linalg.qr(np.array([[1.0, 2.0, 0.5], [0.3, -1.0, 2.0], [2.0, 0.1, 0.7]]))
    even = np.stack([z, r * np.cos(phi), r * np.sin(phi)], axis=-1) @ askew
    mean = photometry.intensity_cd(even).mean()
    assert photometry.flux_lm() == pytest.approx(4.0 * np.pi * mean, rel=3e-4)


def test_beyond_the_table_is_dark_and_its_edge_is_not(written: Write, ies: Text) -> None:
    narrow = (steps(-20, 20, 5), steps(-10, 10, 5))
    photometry = read_photometry(written("a.ies", ies("A", *narrow, uniform)))
    h, v = np.radians([20.0, 20.1, -20.0, 0.0, 0.0, 180.0]), np.radians([10, 0, -10, 10.1, -10, 0])
    towards = np.stack([-np.sin(h) * np.cos(v), np.sin(v), np.cos(h) * np.cos(v)], axis=-1)
    np.testing.assert_allclose(photometry.intensity_cd(towards), [10, 0, 10, 0, 10, 0])


def test_intensities_keep_the_shape_of_the_directions(written: Write, ies: Text) -> None:
    photometry = read_photometry(written("a.ies", ies("C", [0.0], [0.0, 90.0], uniform)))
    assert photometry.intensity_cd(Z).shape == ()
    assert photometry.intensity_cd(np.ones((2, 5, 3))).shape == (2, 5)
    assert np.isnan(photometry.intensity_cd([np.nan, 0.0, 1.0]))


def test_the_polar_table_has_right_angles_and_rising_grids_in_every_type(
    written: Write, ies: Text
) -> None:
    for name, (kind, horizontal, vertical, law) in IES.items():
        polar = read_photometry(written("a.ies", ies(kind, horizontal, vertical, law))).polar
        np.testing.assert_allclose(polar.frame @ polar.frame.T, np.eye(3), atol=0, err_msg=name)
        assert (np.diff(polar.azimuths_deg) > 0).all() and (np.diff(polar.polar_deg) > 0).all()
        assert polar.polar_deg[0] >= 0.0 and polar.polar_deg[-1] <= 180.0
        assert polar.azimuths_deg[-1] - polar.azimuths_deg[0] <= 360.0
        assert polar.candela.shape == (polar.azimuths_deg.size, polar.polar_deg.size)


@pytest.mark.parametrize(
    ("first_line", "factors", "expected"),
    [
        ("A lamp of 1986", "0.5 0.8 60", 0.4),
        ("IESNA91", "0.5 0.8 60", 0.4),
        ("IESNA:LM-63-1995", "0.5 0.8 60", 0.4),
        ("IESNA:LM-63-2002", "0.5 0.8 60", 0.5),
        ("IES:LM-63-2019", "0.5 1.10000 60", 0.5),
    ],
)
def test_the_factors_of_each_edition_multiply_what_they_should(
    written: Write, ies: Text, first_line: str, factors: str, expected: float
) -> None:
    text = ies("C", [0.0], [0.0, 90.0], uniform, first_line=first_line, factors=factors)
    photometry = read_photometry(written("a.ies", text))
    assert photometry.intensity_cd(Z) == pytest.approx(10.0 * expected, rel=1e-14)


def test_the_multiplier_is_applied_and_lamps_are_counted(written: Write, ies: Text) -> None:
    text = ies("C", [0.0], [0.0, 90.0], uniform, multiplier=2.5, lamps="3 400")
    photometry = read_photometry(written("a.ies", text))
    assert photometry.intensity_cd(Z) == pytest.approx(10.0)
    assert photometry.lamp_flux_lm == 1200.0


def test_absolute_photometry_states_no_lamp_flux(written: Write, ies: Text) -> None:
    text = ies("C", [0.0], [0.0, 90.0], uniform, lamps="1 -1")
    photometry = read_photometry(written("a.ies", text))
    assert photometry.lamp_flux_lm is None
    assert photometry.intensity_cd(Z) == pytest.approx(10.0)


def test_a_tilt_that_is_included_is_read_over(written: Write, ies: Text) -> None:
    tilt = "TILT=INCLUDE\n1\n4\n0 30 60 90\n1.0 0.95 0.9 0.8"
    text = ies("C", [0.0], [0.0, 90.0], uniform, tilt=tilt)
    assert read_photometry(written("a.ies", text)).intensity_cd(Z) == pytest.approx(10.0)


def test_eulumdat_intensities_are_per_kilolumen_times_the_conversion_factor(
    written: Write, ldt: Text
) -> None:
    plain = ldt(1, [0.0], [0.0, 90.0], uniform, flux_lm=500.0)
    assert "\r\n20.0\r\n" in plain
    assert read_photometry(written("a.ldt", plain)).intensity_cd(Z) == pytest.approx(10.0)
    text = ldt(1, [0.0], [0.0, 90.0], uniform, flux_lm=500.0, conversion=0.5, lamps=-1)
    assert read_photometry(written("b.ldt", text)).intensity_cd(Z) == pytest.approx(10.0)


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("\n", "\r"),
        lambda text: text.replace(" ", ", "),
        lambda text: text + "\x1a",
        lambda text: "\ufeff" + text,
        lambda text: text.replace("nobody", "Leuchten Müller").encode("latin-1"),
        lambda text: text.replace("10.0", "\n10.0"),
        lambda text: text.replace("TILT=NONE", " tilt = none "),
        lambda text: text.replace("10.0", "1.0E+01"),
    ],
)
def test_what_programs_write_besides_the_standard_is_read(
    written: Write, ies: Text, change: Callable[[str], str | bytes]
) -> None:
    text = ies("C", [0.0, 90.0], [0.0, 45.0, 90.0], uniform)
    photometry = read_photometry(written("A.IES", change(text)))
    assert photometry.candela.shape == (5, 3)
    assert photometry.flux_lm() == pytest.approx(20.0 * np.pi)


def test_an_unknown_suffix_is_named(written: Write) -> None:
    with pytest.raises(PhotometryError, match=r"'\.txt' is none of \.ies, \.ldt"):
        read_photometry(written("a.txt", "TILT=NONE"))

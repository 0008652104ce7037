# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Goniometer angles of types A, B and C against directions worked out by hand; there and back."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lamplit.photometry import PhotometricType, Photometry, read_photometry
from lamplit.photometry.angles import angles, converted, directions, file_horizontal_deg

ROOT_HALF = 0.5**0.5
ROOT_3_HALVES = 0.75**0.5

#: Type, angles, and the direction: x to the observer's right, y up, z to the observer.
BY_HAND = [
    ("A", (0, 0), (0, 0, 1)),
    ("A", (90, 0), (1, 0, 0)),
    ("A", (-90, 0), (-1, 0, 0)),
    ("A", (0, 90), (0, 1, 0)),
    ("A", (30, 0), (0.5, 0, ROOT_3_HALVES)),
    ("A", (0, -30), (0, -0.5, ROOT_3_HALVES)),
    ("A", (45, 30), (ROOT_HALF * ROOT_3_HALVES, 0.5, ROOT_HALF * ROOT_3_HALVES)),
    ("A", (180, 0), (0, 0, -1)),
    ("A", (-60, 60), (-ROOT_3_HALVES / 2, ROOT_3_HALVES, 0.25)),
    ("B", (0, 0), (0, 0, 1)),
    ("B", (90, 0), (1, 0, 0)),
    ("B", (0, 90), (0, 1, 0)),
    ("B", (0, 180), (0, 0, -1)),
    ("B", (0, -30), (0, -0.5, ROOT_3_HALVES)),
    ("B", (30, 45), (0.5, ROOT_3_HALVES * ROOT_HALF, ROOT_3_HALVES * ROOT_HALF)),
    ("B", (-60, 60), (-ROOT_3_HALVES, ROOT_3_HALVES / 2, 0.25)),
    ("C", (0, 0), (0, 0, 1)),
    ("C", (0, 90), (0, 1, 0)),
    ("C", (90, 90), (1, 0, 0)),
    ("C", (180, 90), (0, -1, 0)),
    ("C", (270, 90), (-1, 0, 0)),
    ("C", (0, 180), (0, 0, -1)),
    ("C", (30, 30), (0.25, ROOT_3_HALVES / 2, ROOT_3_HALVES)),
    ("C", (225, 45), (-0.5, -0.5, ROOT_HALF)),
]


@pytest.mark.parametrize(("kind", "at", "towards"), BY_HAND)
def test_angles_point_where_they_point_by_hand(
    kind: PhotometricType, at: tuple[float, float], towards: tuple[float, float, float]
) -> None:
    np.testing.assert_allclose(directions(kind, *at), towards, atol=1e-15)


@pytest.mark.parametrize(("kind", "at", "towards"), BY_HAND)
def test_directions_have_the_angles_that_they_have_by_hand(
    kind: PhotometricType, at: tuple[float, float], towards: tuple[float, float, float]
) -> None:
    h, v = angles(kind, np.multiply(towards, 3.0))
    pole = {"A": abs(at[1]) == 90, "B": abs(at[0]) == 90, "C": at[1] in (0, 180)}[kind]
    np.testing.assert_allclose([h, v], at, atol=1e-12)
    assert not pole or (v == at[1] if kind != "B" else h == at[0])


@pytest.mark.parametrize(("kind", "free"), [("A", 0), ("B", 1), ("C", 0)])
def test_at_a_pole_the_angle_without_meaning_is_zero(kind: PhotometricType, free: int) -> None:
    """±y, ±x and ±z, with zeros of either sign."""
    pole = {"A": [-0.0, 1.0, -0.0], "B": [-1.0, -0.0, -0.0], "C": [-0.0, -0.0, -1.0]}[kind]
    assert angles(kind, pole)[free] == 0.0


def test_types_a_and_b_have_the_same_angles_on_the_cross_and_others_off_it() -> None:
    """At 30°, 30°: sin H_B = sin H cos V = 0.433, tan V_B = tan V / cos H = 2/3."""
    np.testing.assert_allclose(converted("A", "B", [20.0, 0.0], [0.0, 20.0]), [[20, 0], [0, 20]])
    h, v = converted("A", "B", 30.0, 30.0)
    assert float(h) == pytest.approx(25.65890627, abs=1e-8)
    assert float(v) == pytest.approx(33.69006753, abs=1e-8)


def test_the_gamma_of_h_and_v_is_their_distance_from_the_axis() -> None:
    """cos γ = cos H cos V: H 20, V 10 → γ 22.27°; up and to the right, so 0 < C < 90."""
    c, gamma = converted("A", "C", 20.0, 10.0)
    assert float(gamma) == pytest.approx(np.degrees(np.arccos(0.93969262 * 0.98480775)), abs=1e-6)
    assert float(c) == pytest.approx(np.degrees(np.arctan2(0.33682409, 0.17364818)), abs=1e-6)


ANGLE = st.floats(-180.0, 180.0)


@given(kind=st.sampled_from("ABC"), horizontal=ANGLE, vertical=ANGLE)
def test_angles_go_to_directions_and_back(
    kind: PhotometricType, horizontal: float, vertical: float
) -> None:
    ranges = {"A": (1.0, 0.5), "B": (0.5, 1.0), "C": (1.0, 0.5)}[kind]
    h, v = horizontal * ranges[0], vertical * ranges[1]
    if kind == "C":
        h, v = h + 180.0, v + 90.0
    towards = directions(kind, h, v)
    assert np.linalg.norm(towards) == pytest.approx(1.0, abs=1e-15)
    again = directions(kind, *angles(kind, towards))
    np.testing.assert_allclose(again, towards, atol=2e-15)


@given(
    own=st.sampled_from("ABC"),
    other=st.sampled_from("ABC"),
    towards=st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda d: np.linalg.norm(d) > 1e-3),
)
def test_a_direction_is_the_same_by_way_of_any_type(
    own: PhotometricType, other: PhotometricType, towards: tuple[float, float, float]
) -> None:
    h, v = angles(own, towards)
    unit = np.divide(towards, np.linalg.norm(towards))
    np.testing.assert_allclose(directions(other, *converted(own, other, h, v)), unit, atol=5e-15)
    assert {"A": abs(h) <= 180 and abs(v) <= 90, "B": abs(h) <= 90 and abs(v) <= 180}.get(
        own, 0 <= h < 360 and 0 <= v <= 180
    )


@pytest.mark.parametrize("kind", "ABC")
def test_the_frame_is_that_of_files_whose_h_is_the_negative(
    written: Callable[[str, str], Path], ies: Callable[..., str], kind: PhotometricType
) -> None:
    """A node of a file's grid, by these angles, has that node's intensity."""

    def skew(d: np.ndarray) -> np.ndarray:
        return 1000.0 + d @ np.array([300.0, 200.0, 400.0])

    grid = {"A": (-90, 90, -90, 90), "B": (-90, 90, -90, 90), "C": (0, 360, 0, 180)}[kind]
    horizontal = np.arange(grid[0], grid[1] + 1, 10.0).tolist()
    vertical = np.arange(grid[2], grid[3] + 1, 10.0).tolist()
    photometry: Photometry = read_photometry(
        written("a.ies", ies(kind, horizontal, vertical, skew))
    )
    h = np.array(horizontal) if kind == "C" else file_horizontal_deg(horizontal)
    nodes = directions(kind, h[:, None], np.array(vertical)[None, :])
    np.testing.assert_allclose(photometry.intensity_cd(nodes), photometry.candela, rtol=1e-9)


def test_shapes_broadcast_and_zero_has_no_sign() -> None:
    assert directions("A", np.zeros((4, 1)), np.zeros(5)).shape == (4, 5, 3)
    assert angles("C", np.ones((2, 3, 3))).vertical_deg.shape == (2, 3)
    assert not np.signbit(file_horizontal_deg([0.0, 5.0])[0])

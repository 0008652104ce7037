# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Colour regions against their printed corners, and the verdict on a colour that scatters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from lamplit.cie_tables import cie_table
from lamplit.colour.observer import colour_matching_functions
from lamplit.colour.tristimulus import xyz_of_xy
from lamplit.errors import RuleError
from lamplit.rules import Finding, RuleSet, find_rule, judge
from lamplit.rules.colour import build_region, region, region_names

from .conftest import observe, power_law

#: UN R48, 2.29, and SAE J578: corners to three digits as they are printed.
CORNERS = {
    "red": [(0.645, 0.335), (0.665, 0.335), (0.735, 0.265), (0.721, 0.259)],
    "amber": [(0.545, 0.425), (0.560, 0.440), (0.609, 0.390), (0.597, 0.390)],
    "white": [
        (0.310, 0.348),
        (0.453, 0.440),
        (0.500, 0.440),
        (0.500, 0.382),
        (0.443, 0.382),
        (0.310, 0.283),
    ],
    "selective-yellow": [
        (0.454, 0.486),
        (0.480, 0.519),
        (0.545, 0.454),
        (0.521, 0.440),
        (0.500, 0.440),
    ],
}
NAMES = [(name, name.partition("-")[2]) for name in region_names()]


def test_the_un_has_four_colours_and_sae_three() -> None:
    assert sorted(region_names()) == [
        "sae-amber",
        "sae-red",
        "sae-white",
        "un-amber",
        "un-red",
        "un-selective-yellow",
        "un-white",
    ]
    assert region("un-red").trust == "V" and region("sae-red").trust == "V2"


@pytest.mark.parametrize(("name", "colour"), NAMES)
def test_corners_are_those_printed(name: str, colour: str) -> None:
    np.testing.assert_allclose(region(name).vertices, CORNERS[colour], atol=5.5e-4)


@pytest.mark.parametrize(("name", "colour"), NAMES)
def test_printed_corners_lie_on_the_border(name: str, colour: str) -> None:
    for corner in CORNERS[colour]:
        assert abs(region(name).border_distance(corner).distance) < 8e-4, corner


@pytest.mark.parametrize(
    ("name", "at", "wavelength_nm"),
    [("un-red", 1, 609.7), ("un-amber", 1, 587.4), ("un-amber", 2, 596.3)],
)
def test_lines_meet_the_locus_at_the_known_wavelengths(
    name: str, at: int, wavelength_nm: float
) -> None:
    assert region(name).vertices_nm[at] == pytest.approx(wavelength_nm, abs=0.05)


#: The middle of each edge, to three digits or better, and the direction out of the region.
EDGES = [
    # Red: y = .335; the locus, x + y near 1; the purple line; y = .980 − x.
    ("un-red", (0.655, 0.335), (0.0, 1.0)),
    ("un-red", (0.700, 0.300), (1.0, 1.0)),
    ("un-red", (0.728, 0.262), (0.46, -1.0)),
    ("un-red", (0.683, 0.297), (-1.0, -1.0)),
    # Amber: y = x − .120; locus; y = .390; y = .790 − .670 x.
    ("un-amber", (0.552, 0.432), (-1.0, 1.0)),
    ("un-amber", (0.585, 0.4145), (1.0, 1.0)),
    ("un-amber", (0.603, 0.390), (0.0, -1.0)),
    ("un-amber", (0.570, 0.4081), (-0.67, -1.0)),
    # White, round from the green edge.
    ("un-white", (0.380, 0.3932), (-0.64, 1.0)),
    ("un-white", (0.475, 0.440), (0.0, 1.0)),
    ("un-white", (0.500, 0.410), (1.0, 0.0)),
    ("un-white", (0.470, 0.382), (0.0, -1.0)),
    ("un-white", (0.380, 0.335), (0.75, -1.0)),
    ("un-white", (0.310, 0.315), (-1.0, 0.0)),
    # Selective yellow: y = 1.290 x − .100; locus; y = .138 + .580 x; y = .440; y = .940 − x.
    ("un-selective-yellow", (0.467, 0.50243), (-1.29, 1.0)),
    ("un-selective-yellow", (0.5125, 0.4867), (1.0, 1.0)),
    ("un-selective-yellow", (0.533, 0.44714), (0.58, -1.0)),
    ("un-selective-yellow", (0.511, 0.440), (0.0, -1.0)),
    ("un-selective-yellow", (0.477, 0.463), (-1.0, -1.0)),
]


@pytest.mark.parametrize(("name", "middle", "outward"), EDGES)
def test_2_thousandths_inside_and_outside_each_edge_are_told_apart(
    name: str, middle: tuple[float, float], outward: tuple[float, float]
) -> None:
    step = 0.002 * np.array(outward) / np.hypot(*outward)
    assert region(name).contains(middle - step)
    assert not region(name).contains(middle + step)
    outside = region(name).border_distance(middle + step)
    assert outside.distance == pytest.approx(-0.002, abs=4e-4)


GREEN = """
[colours.green]
title = "green"
clause = "1"
trust = "M"
edges = [
  { line = [1.0, 0.0, 0.15], label = "x ≥ 0.15" },
  { locus_nm = [515.0, 600.0], label = "spectral locus" },
  { line = [0.0, 1.0, 0.6], label = "y ≥ 0.6" },
]
"""


def test_the_locus_is_an_arc_and_no_chord(own_rules: Callable[[str], RuleSet]) -> None:
    """CIE 1931: 540 nm is (0.2296, 0.7543); the chord between the lines has y = 0.742 there."""
    green = build_region("green", own_rules(GREEN).file.colours["green"])
    assert green.vertices_nm[1] == pytest.approx(529.0, abs=1.0)
    assert green.vertices_nm[2] == pytest.approx(564.0, abs=1.0)
    assert green.contains((0.2296, 0.748))
    assert green.contains((0.2296, 0.7541))
    assert not green.contains((0.2296, 0.7545))


@pytest.mark.parametrize(
    ("name", "point"), [("un-amber", (0.5752, 0.4242)), ("un-red", (0.7190, 0.2809))]
)
def test_590_and_640_nm_lie_on_the_border(name: str, point: tuple[float, float]) -> None:
    assert region(name).contains(np.array(point) - 1e-4)
    assert not region(name).contains(np.array(point) + 1e-4)


def test_the_red_edge_of_white_holds_only_beyond_x_0443() -> None:
    # y ≥ 0.382 there; at x = 0.40 the purple edge 0.050 + 0.750 x = 0.350 is the lower one.
    assert region("un-white").contains((0.40, 0.352))
    assert not region("un-white").contains((0.40, 0.348))
    assert not region("un-white").contains((0.46, 0.380))
    assert region("un-white").contains((0.46, 0.384))


def test_known_lights_lie_where_they_should() -> None:
    """Measured LEDs, and an orange glass that is neither."""
    reds = [(0.688, 0.312), (0.691, 0.309), (0.706, 0.294)]
    ambers = [(0.584, 0.416), (0.587, 0.412), (0.589, 0.406)]
    for xy in reds:
        # Printed to three digits, next to the locus: 0.0007 inside it they are all red.
        assert region("un-red").contains(np.array(xy) - 7e-4)
        assert not region("un-amber").contains(xy)
    for xy in ambers:
        assert region("un-amber").contains(np.array(xy) - 7e-4)
        assert not region("un-red").contains(xy)
    between = (0.628, 0.372)
    assert not region("un-red").contains(between) and not region("un-amber").contains(between)


def colour_at(xy: tuple[float, float], sigma_y: float) -> Finding:
    """Return the finding on the axis of a stop lamp whose y alone scatters, by ``sigma_y``."""
    rule = find_rule("un-r148/S1")
    readings = observe(rule, power_law(100.0, 0.0), xy=xy)
    # dX, dY, dZ that move y and leave x and the sum as they are: (0, 1, −1)·sum.
    total = float(xyz_of_xy(xy, 100.0).sum())
    move = total * sigma_y * np.array([0.0, 1.0, -1.0])
    covariance = np.broadcast_to(np.outer(move, move), readings.spot_xyz_covariance.shape)
    readings = replace(readings, spot_xyz_covariance=covariance)
    verdict = judge(rule, readings)
    return next(own for own in verdict.findings if own.requirement.startswith("colour"))


def test_a_colour_is_undecided_where_its_ellipse_of_2_sigma_crosses_the_border() -> None:
    # (0.655, 0.332) is 0.003 below y = 0.335 and 0.0092 from the other lines along y.
    assert colour_at((0.655, 0.332), 0.0).outcome == "pass"
    assert colour_at((0.655, 0.332), 0.0014).outcome == "pass"
    near = colour_at((0.655, 0.332), 0.002)
    assert near.outcome == "undecided"
    # 1.5 σ away: (2/1.5)² times the paths.
    assert near.paths_factor == pytest.approx(16.0 / 9.0, rel=1e-3)
    assert near.standard_error == pytest.approx(0.002, rel=1e-3)
    assert near.got == pytest.approx(0.003, rel=1e-3)
    assert "y ≤ 0.335" in near.remark and "x 0.6550, y 0.3320" in near.remark
    assert (near.required, near.sense, near.margin_percent) == (None, None, None)


def test_a_colour_outside_fails_or_is_undecided_by_its_ellipse() -> None:
    assert colour_at((0.655, 0.338), 0.0014).outcome == "fail"
    assert colour_at((0.655, 0.338), 0.0016).outcome == "undecided"
    assert colour_at((0.655, 0.338), 0.0014).got == pytest.approx(-0.003, rel=1e-3)


def test_scatter_across_the_spectral_locus_leaves_a_colour_decided() -> None:
    """A narrow LED lies next to the locus, and no light lies beyond it."""
    assert colour_at((0.700, 0.2995), 0.004).outcome == "pass"


def spectral_light(nm: ArrayLike, *, between: str = "chords") -> np.ndarray:
    """Return x, y of wavelengths; ``between`` the CIE's values by chords or a smooth curve."""
    table = cie_table("cie-1931-2")
    values = np.stack(list(table.columns.values()), axis=-1)
    smooth = CubicSpline(table.wavelengths_nm, values)
    xyz = smooth(nm) if between == "curve" else colour_matching_functions("cie-1931-2", nm)
    return xyz[:, :2] / xyz.sum(axis=1, keepdims=True)


@pytest.mark.parametrize("between", ["chords", "curve"])
@pytest.mark.parametrize(
    ("name", "low_nm", "high_nm"), [("un-red", 610.0, 780.0), ("un-amber", 588.0, 596.0)]
)
def test_spectral_light_lies_in_the_region_of_its_wavelength(
    name: str, low_nm: float, high_nm: float, between: str
) -> None:
    """Each half nm: the true curve bulges beyond the chords of the table."""
    for xy in spectral_light(np.arange(low_nm, high_nm, 0.5), between=between):
        # Scatter of 10⁻⁵ all round leaves it decided.
        found = region(name).border_distance(xy, 1e-10 * np.eye(2))
        assert found.distance > 0.0
        assert found.sigmas > 2.0


def test_the_leave_at_the_locus_moves_no_edge_and_no_corner() -> None:
    red = region("un-red")
    first, second = spectral_light([640.0, 641.0])
    along = (second - first) / np.hypot(*(second - first))
    beyond = np.array([-along[1], along[0]])
    middle = 0.5 * (first + second)
    assert red.contains(middle + 0.9e-5 * beyond)
    assert not red.contains(middle + 1.1e-5 * beyond)
    assert red.contains((0.655, 0.335 - 1e-7))
    assert not red.contains((0.655, 0.335 + 1e-7))
    # The corner of the locus and y = 0.335, near 610 nm: beyond it the locus goes on, red does not.
    first, second = spectral_light([609.0, 610.0])
    along = (second - first) / np.hypot(*(second - first))
    corner = first + (first[1] - 0.335) / (first[1] - second[1]) * (second - first)
    beyond = np.array([-along[1], along[0]])
    for off in (0.0, 0.5e-5):
        assert red.contains(corner + 1e-7 * along + off * beyond)
        assert not red.contains(corner - 1e-7 * along + off * beyond)


def test_a_lamp_that_is_amber_is_no_stop_lamp() -> None:
    rule = find_rule("un-r148/S1")
    verdict = judge(rule, observe(rule, power_law(100.0, 1.0), xy=(0.58, 0.415)))
    failed = [own for own in verdict.findings if own.outcome == "fail"]
    assert len(failed) == 19 and all(own.unit == "xy" for own in failed)


def test_a_rule_file_can_bring_a_region_of_its_own(
    own_rules: Callable[[str], RuleSet],
) -> None:
    box = """
[colours.box]
title = "box"
clause = "1"
trust = "M"
edges = [
  { line = [1.0, 0.0, 0.3], label = "x ≥ 0.3" },
  { line = [0.0, 1.0, 0.3], label = "y ≥ 0.3" },
  { line = [1.0, 0.0, 0.4], label = "x ≤ 0.4" },
  { line = [0.0, 1.0, 0.4], label = "y ≤ 0.4" },
]
[grids.g]
clause = "1"
trust = "M"
unit = "cd"
h_deg = [0]
v_deg = [0]
rows = [[1.0]]
[entries.x]
title = "x"
colour = { clause = "1", trust = "M", region = "box" }
distribution = [{ clause = "1", trust = "M", grid = "g" }]
"""
    rule = own_rules(box).entry("x")
    for xy, outcome in (((0.35, 0.35), "pass"), ((0.45, 0.35), "fail")):
        assert judge(rule, observe(rule, power_law(2.0, 1.0), xy=xy)).outcome == outcome
    with pytest.raises(RuleError, match="parallel"):
        own_rules(box.replace("[0.0, 1.0, 0.3]", "[2.0, 0.0, 0.3]"))


def test_an_unknown_region_is_named_with_the_nearest() -> None:
    with pytest.raises(RuleError, match="did you mean 'un-amber'"):
        region("un-ambr")

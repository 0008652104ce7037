# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What the plots draw: levels, cuts, ellipses, bands, directions, against closed forms."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import exp

import numpy as np
import pytest

from lamplit.photometry.chromaticity import chromaticity_covariance
from lamplit.photometry.observed import Observed
from lamplit.report.photometry.colour import ellipse_of
from lamplit.report.photometry.cuts import cut_along_h, cut_along_v, suits_logarithm
from lamplit.report.photometry.energy import bands_of, grouped
from lamplit.report.photometry.isocandela import (
    brightest,
    clear_levels,
    contour_levels,
    label_places,
    window,
)
from lamplit.report.photometry.results import EnergyFlow, FunctionResults
from lamplit.report.photometry.solid import solid_points
from lamplit.rules.verdict import Verdict


@pytest.mark.parametrize(
    ("peak", "levels"),
    [
        (260.0, [0.5, 1, 2, 5, 10, 20, 50, 100, 200]),
        (1.0, [0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5]),
        (5.0, [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2]),
        (0.0, []),
        (float("nan"), []),
    ],
)
def test_lines_stand_at_1_2_and_5_times_powers_of_ten_below_the_peak(
    peak: float, levels: list[float]
) -> None:
    assert contour_levels(peak) == levels


def test_a_speck_of_noise_gets_no_label() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 40)
    ring = 8.0 * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    speck = np.array([20.0, 0.0]) + 0.1 * ring
    ((level, place),) = label_places([5.0, 9.0], [[ring, speck], []])
    assert level == 5.0
    assert np.hypot(*place) == pytest.approx(8.0)


def test_a_line_that_noise_would_scatter_is_left_out() -> None:
    cd = np.array([[100.0, 10.0, 1.0]])
    errors = np.array([[1.0, 1.0, 0.5]])
    assert clear_levels([1.0, 10.0, 100.0, 500.0], cd, errors) == [10.0, 100.0]


def test_the_window_holds_spots_fields_and_all_that_is_bright(
    make_observed: Callable[..., Observed],
) -> None:
    seen = plane(np.arange(-90.0, 91.0), np.arange(-90.0, 91.0), make_observed)
    lit = np.zeros_like(seen.grid_xyz)
    lit[100:102, 120:125] = 50.0
    seen = replace(seen, grid_xyz=lit)
    assert window(FunctionResults(seen)) == (-20.0, 35.0, -10.0, 12.0)
    field = ((-45.0, 80.0, -15.0, 15.0),)
    assert window(FunctionResults(seen, fields_deg=field)) == (-45.0, 80.0, -15.0, 15.0)


def plane(h_edges: np.ndarray, v_edges: np.ndarray, make: Callable[..., Observed]) -> Observed:
    """Return an observation whose intensity is 100 + 2 H − 3 V cd, with σ = 1 cd."""
    h, v = np.meshgrid(0.5 * (h_edges[1:] + h_edges[:-1]), 0.5 * (v_edges[1:] + v_edges[:-1]))
    return replace(
        make(),
        grid_h_edges_deg=h_edges,
        grid_v_edges_deg=v_edges,
        grid_xyz=(100.0 + 2.0 * h - 3.0 * v)[..., None] * np.ones(3),
        grid_standard_error_cd=np.ones_like(h),
    )


def test_a_cut_between_cells_is_their_mean_with_the_error_of_a_mean(
    make_observed: Callable[..., Observed],
) -> None:
    seen = plane(np.arange(-4.0, 5.0), np.arange(-3.0, 4.0), make_observed)
    along_h, along_v = cut_along_h(seen), cut_along_v(seen)
    assert np.allclose(along_h.angles_deg, np.arange(-3.5, 4.0))
    assert np.allclose(along_h.intensity_cd, 100.0 + 2.0 * along_h.angles_deg)
    assert np.allclose(along_v.intensity_cd, 100.0 - 3.0 * along_v.angles_deg)
    assert np.allclose(along_h.standard_error_cd, 1.0 / np.sqrt(2.0))


def test_a_cut_through_the_middle_of_cells_is_those_cells(
    make_observed: Callable[..., Observed],
) -> None:
    seen = plane(np.arange(-4.5, 5.0), np.arange(-2.5, 3.0), make_observed)
    cut = cut_along_h(seen)
    assert np.allclose(cut.intensity_cd, 100.0 + 2.0 * np.arange(-4.0, 5.0))
    assert np.allclose(cut.standard_error_cd, 1.0)
    assert np.allclose(cut_along_h(seen, 60.0).intensity_cd, cut.intensity_cd - 6.0)


def test_the_brightest_cell_is_named_by_its_middle(make_observed: Callable[..., Observed]) -> None:
    seen = plane(np.arange(-4.0, 5.0), np.arange(-3.0, 4.0), make_observed)
    assert brightest(seen) == (3.5, -2.5, 100.0 + 7.0 + 7.5)


def test_the_scale_is_logarithmic_where_limits_lie_far_apart(
    make_observed: Callable[..., Observed], make_verdict: Callable[..., Verdict]
) -> None:
    seen = make_observed()
    assert suits_logarithm(FunctionResults(seen, make_verdict(seen)))
    near = make_verdict(seen, maximum_cd=70.0)
    kept = tuple(one for one in near.findings if (one.required or 0.0) > 40.0)
    assert not suits_logarithm(FunctionResults(seen, replace(near, findings=kept)))
    assert not suits_logarithm(FunctionResults(seen))


def test_a_solid_of_one_candela_is_the_unit_sphere_in_the_conventions_frame(
    make_observed: Callable[..., Observed],
) -> None:
    edges = np.array([-1.0, 1.0, 59.0, 61.0])
    seen = plane(edges, np.array([-1.0, 1.0, 29.0, 31.0]), make_observed)
    corners = solid_points(replace(seen, grid_xyz=np.ones((3, 3, 3))))
    assert np.allclose(np.linalg.norm(corners, axis=-1), 1.0)
    assert np.allclose(corners[0, 0], (0.0, 0.0, 1.0))
    root = 3.0**0.5
    assert np.allclose(corners[0, 2], (root / 2.0, 0.0, 0.5))
    assert np.allclose(corners[2, 0], (0.0, 0.5, root / 2.0))


def test_the_covariance_of_x_and_y_is_what_many_lights_drawn_at_random_have() -> None:
    random = np.random.default_rng(3)
    mean = np.array([46.0, 20.0, 0.5])
    root = np.array([[0.30, 0.0, 0.0], [0.12, 0.05, 0.0], [0.002, 0.004, 0.006]])
    drawn = mean + random.standard_normal((400_000, 3)) @ root.T
    expected = np.cov((drawn[:, :2] / drawn.sum(axis=1, keepdims=True)).T)
    xy, covariance = chromaticity_covariance(mean, root @ root.T)
    assert np.allclose(xy, mean[:2] / 66.5)
    assert np.allclose(covariance, expected, rtol=0.02)


def test_a_light_that_only_flickers_has_no_error_of_colour() -> None:
    mean = np.array([46.0, 20.0, 0.5])
    _, covariance = chromaticity_covariance(mean, 0.01 * np.outer(mean, mean))
    assert np.allclose(covariance, 0.0, atol=1e-18)


def test_black_has_no_chromaticity() -> None:
    xy, _ = chromaticity_covariance(np.zeros((2, 3)), np.zeros((2, 3, 3)))
    assert np.isnan(xy).all()


def test_an_ellipse_has_the_axes_and_the_tilt_of_its_covariance() -> None:
    turn = np.radians(30.0)
    axes = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    found = ellipse_of(axes @ np.diag([9e-6, 1e-6]) @ axes.T, sigmas=2.0)
    assert np.allclose(found, (6e-3, 2e-3, 30.0))


def test_a_two_sigma_ellipse_holds_86_percent() -> None:
    covariance = np.array([[4e-6, -1.5e-6], [-1.5e-6, 1e-6]])
    major, minor, tilt = ellipse_of(covariance)
    drawn = np.random.default_rng(5).multivariate_normal((0.0, 0.0), covariance, 200_000)
    turn = np.radians(tilt)
    along = drawn @ (np.cos(turn), np.sin(turn)) / major
    across = drawn @ (-np.sin(turn), np.cos(turn)) / minor
    share = float((along**2 + across**2 < 1.0).mean())
    assert share == pytest.approx(1.0 - exp(-2.0), abs=4e-3)


def test_the_ends_of_the_light_add_up_to_what_was_emitted(
    make_energy: Callable[[], EnergyFlow],
) -> None:
    flow = make_energy()
    ends = grouped(flow)
    assert sum(lm for _, lm in ends) == pytest.approx(460.0, abs=1e-9)
    assert abs(flow.gap_lm) < 1e-9
    assert dict(ends)["in 3 other bodies"] == pytest.approx(2.0)
    assert [name for name, _ in ends[:2]] == ["out of the lamp", "in lens"]


def test_a_missing_lumen_shows_as_a_gap() -> None:
    flow = EnergyFlow({"led": 10.0, "lamp": 5.0}, out_lm=9.0, absorbed_lm={"lens": 5.0})
    assert flow.total_lm == 15.0
    assert flow.gap_lm == pytest.approx(1.0)
    assert flow.efficiency == pytest.approx(0.6)


def test_bands_are_as_wide_as_their_flux_and_do_not_overlap(
    make_energy: Callable[[], EnergyFlow],
) -> None:
    ends = grouped(make_energy())
    bands = bands_of(ends, height=2.0, gap=0.1)
    positive = sum(lm for _, lm in ends if lm > 0.0)
    wide = [2.0 * band.flux_lm / positive for band in bands]
    leaves = [band.leaves for band in bands]
    assert np.allclose(np.diff([*leaves, 2.0]), wide)
    for band, after, width in zip(bands, bands[1:], wide, strict=False):
        assert after.arrives >= band.arrives + width
    assert "chance" not in {band.name for band in bands}


def test_many_bodies_are_added_up_under_one_name() -> None:
    flow = EnergyFlow({"led": 120.0}, 0.0, {f"body {at}": 10.0 for at in range(12)})
    ends = grouped(flow)
    assert len(ends) == 8
    assert ends[-1] == ("in 5 other bodies", 50.0)

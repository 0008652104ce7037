# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The smooth uplift: colours come back, nothing is negative, and no smoother basis exists."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from lamplit.colour.display import Display
from lamplit.colour.observer import colour_matching_functions
from lamplit.colour.uplift import basis
from lamplit.sources import source

ROOT = Path(__file__).resolve().parents[2]

#: The two ways of eq. (1): the middles of the nanometres, as a render sums, and each whole one.
SUMS = {"middles": np.arange(380.5, 780.0), "ends": np.arange(380.0, 781.0)}

#: The basis is made for the first; the second rule differs by its own error at the basis's kinks.
TOLERANCE = {"middles": 1e-6, "ends": 1e-4}


def weights_of_xyz(nm: np.ndarray) -> np.ndarray:
    """Return what XYZ under D65 gives each wavelength, with Y = 1 for D65 itself."""
    seen = source("D65").distribution()(nm)[:, None] * colour_matching_functions("cie-1931-2", nm)
    return seen / seen[:, 1].sum()


def rgb_to_xyz(white: np.ndarray) -> np.ndarray:
    """Return the matrix of IEC 61966-2-1's primaries for a white of one's own."""
    corners = np.array([[0.64, 0.33, 0.03], [0.30, 0.60, 0.10], [0.15, 0.06, 0.79]]).T
    return corners * np.linalg.solve(corners, white)


def generator() -> ModuleType:
    path = ROOT / "tools" / "make_uplift_basis.py"
    spec = importlib.util.spec_from_file_location("make_uplift_basis", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("way", SUMS)
def test_any_rgb_comes_back_as_its_own_xyz_under_d65(way: str) -> None:
    weights = weights_of_xyz(SUMS[way])
    white = weights.sum(axis=0)
    rgb = np.vstack([np.eye(3), np.ones(3), np.random.default_rng(3).uniform(0, 1, (50, 3))])
    seen = (rgb @ basis(SUMS[way]).T) @ weights
    np.testing.assert_allclose(seen, rgb @ rgb_to_xyz(white).T, rtol=0, atol=TOLERANCE[way])


def test_the_white_of_the_uplift_is_the_white_of_srgb() -> None:
    white = weights_of_xyz(SUMS["middles"]).sum(axis=0)
    srgb = Display.named("srgb").rgb_to_xyz.sum(axis=1)
    np.testing.assert_allclose(white, srgb, rtol=0, atol=5e-4)


def test_the_basis_is_nowhere_negative_and_sums_to_one_between_the_nodes_too() -> None:
    values = basis(np.linspace(380.0, 780.0, 4001))
    assert values.min() >= 0.0
    assert values.max() <= 1.0
    np.testing.assert_allclose(values.sum(axis=-1), 1.0, rtol=0, atol=1e-15)


def test_the_ends_go_on_outside_the_table() -> None:
    np.testing.assert_array_equal(basis([300.0, 379.0]), basis([380.0, 380.0]))
    np.testing.assert_array_equal(basis([781.0, 900.0]), basis([780.0, 780.0]))


def test_each_spectrum_shines_where_its_colour_is() -> None:
    assert basis([450.0, 530.0, 650.0]).argmax(axis=1).tolist() == [2, 1, 0]


def test_no_change_that_keeps_the_colours_makes_the_basis_smoother() -> None:
    """First-order optimality by an outside solver: a linear programme finds no way down."""
    from scipy.optimize import linprog

    nodes = np.arange(380.0, 781.0, 5.0)
    values = basis(nodes)
    rates = 2.0 * np.diff(np.eye(81), axis=0).T @ np.diff(values, axis=0)
    joined = np.stack([np.interp(SUMS["middles"], nodes, node) for node in np.eye(81)])
    colour = (joined @ weights_of_xyz(SUMS["middles"])).T
    keep = np.vstack([np.kron(np.eye(3), colour), np.kron(np.ones((1, 3)), np.eye(81))])
    step = 1e-3
    bounds = [(max(-step, -value), step) for value in values.T.ravel()]
    best = linprog(rates.T.ravel(), A_eq=keep, b_eq=np.zeros(len(keep)), bounds=bounds)
    assert best.status == 0
    slope_squared = (np.diff(values, axis=0) ** 2).sum()
    assert -best.fun < 1e-6 * slope_squared
    # So far down a way would lead from a basis that is off by a hundredth of a smooth wave.
    wave = 0.01 * np.sin(nodes / 20.0)[:, None] * [1.0, -1.0, 0.0]
    slopes_of_wave = 2.0 * np.diff(np.eye(81), axis=0).T @ np.diff(values + wave, axis=0)
    assert -linprog(
        slopes_of_wave.T.ravel(), A_eq=keep, b_eq=np.zeros(len(keep)), bounds=bounds
    ).fun > (1e-5 * slope_squared)


def test_the_file_is_what_the_programme_makes() -> None:
    made = generator()
    shipped = (ROOT / "python/lamplit/colour/uplift-d65.csv").read_text(encoding="utf-8")
    fresh = made.text_of(made.solve_basis()).splitlines()
    assert [line.split(",")[0] for line in shipped.splitlines()] == [
        line.split(",")[0] for line in fresh
    ]
    table = np.array([[float(word) for word in line.split(",")] for line in fresh[3:]])
    np.testing.assert_allclose(basis(table[:, 0]), table[:, 1:], rtol=0, atol=1e-7)


def test_another_illuminant_has_another_basis_with_the_same_promises() -> None:
    made = generator()
    values = made.solve_basis("A")
    assert values.min() > -1e-12
    np.testing.assert_allclose(values.sum(axis=1), 1.0, rtol=0, atol=1e-12)
    assert np.abs(values - basis(made.NODES_NM)).max() > 0.01

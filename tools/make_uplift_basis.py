# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Write the basis of the smooth uplift, python/lamplit/colour/uplift-d65.csv.

Run it when the definition below changes: ``.venv/bin/python tools/make_uplift_basis.py``. It takes
a second, and a test holds the file against it.

Wanted are three spectra B_r, B_g, B_b on nodes 5 nm apart, joined by straight lines, that

- minimise Σ_c Σ_i (B_c(λ_i+1) − B_c(λ_i))², so that they are as flat as they can be,
- are nowhere negative, and sum to 1 at each wavelength,
- under D65 have the colours of the sRGB primaries: Σ S B_c (x̄, ȳ, z̄) Δλ is the XYZ of one unit of
  that primary, where (1, 1, 1) is the XYZ of S itself.

The idea is I. Mallett and C. Yuksel's: "Spectral Primary Decomposition for Rendering with sRGB
Reflectance", EGSR 2019; their tables are not used. As B_b = 1 − B_r − B_g, 162 numbers remain: a
convex quadratic programme with six equations and 243 bounds, which a primal-dual interior-point
method with Mehrotra's step solves to rounding (J. Nocedal, S. J. Wright, "Numerical Optimization",
2nd ed., algorithm 16.4).
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from lamplit.colour.display import Display
from lamplit.colour.observer import colour_matching_functions
from lamplit.colour.tristimulus import xyz_of_xy
from lamplit.sources import source

Table: TypeAlias = NDArray[np.float64]

FILE = Path(__file__).resolve().parents[1] / "python" / "lamplit" / "colour" / "uplift-d65.csv"

NODES_NM = np.arange(380.0, 781.0, 5.0)

#: Where colours are summed: the middles of the nanometres, as a render does.
SUMMED_NM = np.arange(380.5, 780.0, 1.0)

#: Digits after the point in the file. The third spectrum is 1 minus the other two as written.
_DIGITS = 9

#: The most that the mean of slack times multiplier, and an equation's error, may be at the end.
_GAP = 1e-12
_MOST_STEPS = 100


def solve_basis(illuminant: str = "D65") -> Table:
    """Return B_r, B_g, B_b (81, 3) on ``NODES_NM`` for a source of the library."""
    count = NODES_NM.size
    weights, wanted = _colour_equations(illuminant)
    none = np.zeros_like(weights)
    equations = np.block([[weights, none], [none, weights]])
    slopes = np.diff(np.eye(count), axis=0)
    bending = slopes.T @ slopes
    # |D r|² + |D g|² + |D (1 − r − g)|², and D 1 = 0.
    curvature = 2.0 * np.block([[2.0 * bending, bending], [bending, 2.0 * bending]])
    # r ≥ 0, g ≥ 0 and −r − g ≥ −1.
    bounds = np.vstack([np.eye(2 * count), -np.hstack([np.eye(count), np.eye(count)])])
    least = np.concatenate([np.zeros(2 * count), -np.ones(count)])
    programme = _Programme(curvature, equations, wanted, bounds, least)
    solved = _solved(programme, np.full(2 * count, 1.0 / 3.0))
    red, green = np.clip(solved.reshape(2, count), 0.0, 1.0)
    return np.stack([red, green, 1.0 - red - green], axis=1)


def _colour_equations(illuminant: str) -> tuple[Table, Table]:
    """Return the matrix from the nodes of a spectrum to its XYZ, and the XYZ of red, then green."""
    power = source(illuminant).distribution()(SUMMED_NM)
    seen = power[:, None] * colour_matching_functions("cie-1931-2", SUMMED_NM)
    seen /= seen[:, 1].sum()
    joined = np.stack([np.interp(SUMMED_NM, NODES_NM, node) for node in np.eye(NODES_NM.size)])
    corners = xyz_of_xy(Display.named("srgb").primaries_xy).T
    white: Table = np.asarray(seen.sum(axis=0), dtype=np.float64)
    primaries = corners * np.asarray(np.linalg.solve(corners, white), dtype=np.float64)
    return (joined @ seen).T, primaries[:, :2].T.ravel()


class _Programme(NamedTuple):
    """Minimise ½ xᵀ G x with A x = b and C x ≥ d."""

    curvature: Table  # G
    equations: Table  # A
    wanted: Table  # b
    bounds: Table  # C
    least: Table  # d


class _Point(NamedTuple):
    """Where the method stands, or a step: x, the multipliers of A and C, and s = C x − d."""

    x: Table
    prices: Table
    multipliers: Table
    slacks: Table

    def moved(self, step: _Point, share: float) -> _Point:
        """Return the point ``share`` of ``step`` further on."""
        return _Point(*(here + share * there for here, there in zip(self, step, strict=True)))


def _solved(programme: _Programme, start: Table) -> Table:
    """Return the best x, by interior points with Mehrotra's predictor and corrector."""
    bounds = programme.least.size
    point = _Point(start, np.zeros(programme.wanted.size), np.ones(bounds), np.ones(bounds))
    for _ in range(_MOST_STEPS):
        gap = float(point.slacks @ point.multipliers) / bounds
        products = point.slacks * point.multipliers
        affine = _newton_step(programme, point, products)
        ahead = point.moved(affine, _share(point, affine))
        centring = (float(ahead.slacks @ ahead.multipliers) / bounds / gap) ** 3
        products = products + affine.slacks * affine.multipliers - centring * gap
        step = _newton_step(programme, point, products)
        point = point.moved(step, min(1.0, 0.995 * _share(point, step)))
        if gap < _GAP and np.abs(programme.equations @ point.x - programme.wanted).max() < _GAP:
            return point.x
    raise ArithmeticError("the programme did not converge")


def _newton_step(programme: _Programme, point: _Point, products: Table) -> _Point:
    """Return the step that clears all residuals to first order and s∘z by ``products``."""
    g, a, b, c, d = programme
    dual = g @ point.x - a.T @ point.prices - c.T @ point.multipliers
    bound = c @ point.x - point.slacks - d
    weights = point.multipliers / point.slacks
    matrix = np.block([[g + c.T @ (weights[:, None] * c), -a.T], [a, np.zeros((b.size, b.size))]])
    right = -dual - c.T @ (products / point.slacks + weights * bound)
    solution: Table = np.asarray(
        np.linalg.solve(matrix, np.concatenate([right, b - a @ point.x])), dtype=np.float64
    )
    x, prices = solution[: point.x.size], solution[point.x.size :]
    slacks = c @ x + bound
    return _Point(x, prices, -(products + point.multipliers * slacks) / point.slacks, slacks)


def _share(point: _Point, step: _Point) -> float:
    """Return how much of ``step`` leaves slacks and multipliers positive, at most all."""
    here = np.concatenate([point.slacks, point.multipliers])
    there = np.concatenate([step.slacks, step.multipliers])
    falling = there < 0.0
    return float(min(1.0, (here[falling] / -there[falling]).min(initial=1.0)))


def text_of(basis: Table) -> str:
    """Return the CSV file of ``basis`` (81, 3); the three numbers of a row sum to 1 as written."""
    one = 10**_DIGITS
    rows: list[str] = []
    for nm, red, green in zip(NODES_NM, basis[:, 0], basis[:, 1], strict=True):
        units = round(float(red) * one), round(float(green) * one)
        rest = max(0, one - sum(units))
        shares = (f"{unit / one:.{_DIGITS}f}" for unit in (*units, rest))
        rows.append(",".join([f"{nm:g}", *shares]))
    head = [
        "# Smooth basis of the uplift from linear sRGB to spectra under D65.",
        "# Made by tools/make_uplift_basis.py, where its definition stands.",
        "wavelength_nm,r,g,b",
    ]
    return "\n".join([*head, *rows, ""])


def main() -> None:
    """Write the file."""
    FILE.write_text(text_of(solve_basis()), encoding="utf-8")


if __name__ == "__main__":
    main()

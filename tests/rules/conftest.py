# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Lamps whose intensity is a formula or a table, as a goniometer would have read them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest

from lamplit.photometry.observed import Observed
from lamplit.rules import Rule, RuleSet, load_rules

#: Intensity in cd at H and V in degrees.
Law = Callable[[np.ndarray, np.ndarray], np.ndarray]
#: A red that lies well inside the region, and an amber, a white.
RED, AMBER, WHITE = (0.690, 0.305), (0.580, 0.415), (0.400, 0.390)


def power_law(axis_cd: float, exponent: float) -> Law:
    """Return I₀ cosⁿθ, with cos θ = cos H cos V; a Lambert disc for n = 1."""

    def law(h_deg: np.ndarray, v_deg: np.ndarray) -> np.ndarray:
        cosine = np.cos(np.radians(h_deg)) * np.cos(np.radians(v_deg))
        return axis_cd * np.clip(cosine, 0.0, None) ** exponent

    return law


def observe(
    rule: Rule,
    law: Law,
    *,
    at: Mapping[tuple[float, float], float] | None = None,
    relative_error: float = 0.0,
    cell_error: float = 0.0,
    xy: tuple[float, float] = RED,
    name: str = "lamp",
    h_deg: tuple[float, float] | None = None,
    v_deg: tuple[float, float] | None = None,
    cell_deg: float | None = None,
) -> Observed:
    """Return what is read of ``law`` for a rule; ``at`` replaces the reading at single spots."""
    h, v = rule.spots()
    need = rule.field()
    cell = cell_deg or need.cell_deg
    h_range, v_range = h_deg or need.h_deg, v_deg or need.v_deg
    h_edges = np.linspace(*h_range, round((h_range[1] - h_range[0]) / cell) + 1)
    v_edges = np.linspace(*v_range, round((v_range[1] - v_range[0]) / cell) + 1)
    middles = np.meshgrid(0.5 * (h_edges[1:] + h_edges[:-1]), 0.5 * (v_edges[1:] + v_edges[:-1]))
    cells = law(*middles)
    spots = np.array(law(h, v), dtype=np.float64)
    for (own_h, own_v), value in (at or {}).items():
        spots[(h == own_h) & (v == own_v)] = value
    colour = np.array([xy[0] / xy[1], 1.0, (1.0 - sum(xy)) / xy[1]])
    # All the error is in the intensity: X, Y and Z scatter together.
    covariance = np.einsum("p,i,j->pij", (relative_error * spots) ** 2, colour, colour)
    return Observed(
        name=name,
        spot_h_deg=h,
        spot_v_deg=v,
        spot_xyz=spots[:, None] * colour,
        spot_xyz_covariance=covariance,
        grid_h_edges_deg=h_edges,
        grid_v_edges_deg=v_edges,
        grid_xyz=cells[..., None] * colour,
        grid_standard_error_cd=cell_error * cells,
        paths=1_000_000,
    )


@pytest.fixture
def own_rules(tmp_path: Path) -> Callable[[str], RuleSet]:
    """Return what reads the text of a rule file, after the keys that every file has."""

    def read(text: str) -> RuleSet:
        file = tmp_path / "own.toml"
        head = 'lamplit_rules = 1\ntitle = "own"\ndocument = "none"\n'
        file.write_text(head + text, encoding="utf-8")
        return load_rules(file)

    return read

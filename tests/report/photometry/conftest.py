# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Analytic lamps: intensities by a formula, judged by hand, that no engine made."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from lamplit.photometry.observed import Observed
from lamplit.report.chromaticity import signal_region
from lamplit.report.photometry.results import (
    ColourRegion,
    EnergyFlow,
    FunctionResults,
    Results,
    Spectrum,
)
from lamplit.rules.verdict import Finding, Outcome, Verdict

#: Figure A3-I of UN R148: H, V and percent of the minimum at HV.
GRID_POINTS = [
    (h * side, v, share)
    for h, v, share in [
        (5, 10, 20), (20, 5, 10), (10, 5, 20), (10, 0, 35), (5, 0, 90),
        (20, -5, 10), (10, -5, 20), (5, -10, 20),
    ]
    for side in (-1, 1)
] + [(0, 5, 70), (0, 0, 100), (0, -5, 70)]  # fmt: skip


def beam(h_deg: Any, v_deg: Any, *, peak_cd: float, width_deg: float) -> np.ndarray:
    """Return an intensity that falls from the axis as a bell, with a foot of cos θ."""
    h, v = np.radians(h_deg), np.radians(v_deg)
    cosine = np.cos(h) * np.cos(v)
    bell = np.exp(-0.5 * (np.asarray(h_deg) ** 2 + 1.6 * np.asarray(v_deg) ** 2) / width_deg**2)
    return np.asarray(peak_cd * (0.97 * bell + 0.03 * cosine))


def observed(
    *,
    name: str = "stop",
    peak_cd: float = 90.0,
    width_deg: float = 9.0,
    xy: tuple[float, float] = (0.697, 0.302),
    relative_error: float = 0.012,
    noise: int | None = 7,
) -> Observed:
    """Return what is seen of `beam` at the points of figure A3-I and over ±45° by ±15°."""
    random = np.random.default_rng(noise)
    h_edges, v_edges = np.arange(-45.0, 45.5, 1.0), np.arange(-15.0, 15.5, 1.0)
    grid_h, grid_v = np.meshgrid(h_edges[:-1] + 0.5, v_edges[:-1] + 0.5)
    grid = beam(grid_h, grid_v, peak_cd=peak_cd, width_deg=width_deg)
    error = 2.0 * relative_error * np.sqrt(grid * peak_cd)
    if noise is not None:
        grid = np.maximum(grid + 0.7 * error * random.standard_normal(grid.shape), 0.0)
    places = np.array([(h, v) for h, v, _ in GRID_POINTS], dtype=np.float64)
    spots = beam(*places.T, peak_cd=peak_cd, width_deg=width_deg)
    shift = 0.0006 * places[:, 0] / 20.0
    x, y = xy[0] + shift, xy[1] - shift
    weights = np.stack([x / y, np.ones_like(x), (1.0 - x - y) / y], axis=-1)
    sigma = relative_error * np.sqrt(spots * peak_cd)
    common = np.array([[1.0, 0.92, 0.3], [0.92, 1.0, 0.35], [0.3, 0.35, 1.0]])
    scaled = weights * sigma[:, None]
    return Observed(
        name=name,
        spot_h_deg=places[:, 0],
        spot_v_deg=places[:, 1],
        spot_xyz=weights * spots[:, None],
        spot_xyz_covariance=scaled[:, :, None] * common * scaled[:, None, :],
        grid_h_edges_deg=h_edges,
        grid_v_edges_deg=v_edges,
        grid_xyz=grid[..., None] * np.array([xy[0] / xy[1], 1.0, (1.0 - sum(xy)) / xy[1]]),
        grid_standard_error_cd=error,
        paths=12_500_000,
    )


def finding(got: float, error: float, required: float, sense: str = "min", **more: Any) -> Finding:
    """Return a finding judged by hand: undecided within 2 σ of the limit."""
    inside = got - required if sense == "min" else required - got
    outcome: Outcome = (
        "pass" if inside > 2 * error else "fail" if inside < -2 * error else "undecided"
    )
    usual: dict[str, Any] = {
        "requirement": "minimum at the test point" if sense == "min" else "maximum in the field",
        "clause": "UN R148, table 3; figure A3-I",
        "trust": "V2",
        "h_deg": None,
        "v_deg": None,
        "sense": sense,
        "required": required,
        "got": got,
        "standard_error": error,
        "unit": "cd",
        "margin_percent": 100.0 * inside / required,
        "outcome": outcome,
        "paths_factor": None,
    }
    if outcome == "undecided":
        usual["paths_factor"] = (2 * error / inside) ** 2 if inside else np.inf
    return Finding(**(usual | more))


def verdict(seen: Observed, *, minimum_cd: float = 60.0, maximum_cd: float = 260.0) -> Verdict:
    """Judge ``seen`` by the points of figure A3-I, a maximum and a colour."""
    found = [
        finding(
            float(seen.spot_cd[at]), float(seen.spot_standard_error_cd[at]),
            minimum_cd * share / 100.0, h_deg=float(h), v_deg=float(v),
        )
        for at, (h, v, share) in enumerate(GRID_POINTS)
    ]  # fmt: skip
    row, column = np.unravel_index(int(seen.grid_cd.argmax()), seen.grid_cd.shape)
    found.append(
        finding(
            float(seen.grid_cd.max()), float(seen.grid_standard_error_cd[row, column]),
            maximum_cd, "max", h_deg=float(seen.grid_h_edges_deg[column]) + 0.5,
            v_deg=float(seen.grid_v_edges_deg[row]) + 0.5,
        )
    )  # fmt: skip
    found.append(
        Finding(
            requirement="colour: red", clause="UN R48, 2.29", trust="V", h_deg=0.0, v_deg=0.0,
            sense=None, required=None, got=0.0, standard_error=0.0, unit="", margin_percent=None,
            outcome="pass", remark="x 0.6970 ± 0.0009, y 0.3020 ± 0.0009; nearest border y ≤ 0.335",
        )
    )  # fmt: skip
    title = "Stop lamp, category S1 (UN R148)"
    return Verdict(rule="un-r148/S1", title=title, function=seen.name, findings=tuple(found))


def energy() -> EnergyFlow:
    """Return where 460 lm of a bulb go."""
    absorbed = {"lens": 168.2, "reflector": 61.4, "bulb glass": 9.3, "housing": 31.0, "base": 0.9}
    absorbed |= {"socket": 0.7, "pin": 0.4}
    rest = 460.0 - sum(absorbed.values()) - 0.8 + 0.3
    return EnergyFlow(
        emitted_lm={"filament": 460.0}, out_lm=rest, absorbed_lm=absorbed, cut_lm=0.8,
        chance_lm=-0.3,
    )  # fmt: skip


def spectra() -> tuple[Spectrum, ...]:
    """Return a black body's spectrum."""
    nm = np.arange(380.0, 781.0, 5.0)
    planck = nm**-5.0 / np.expm1(1.4388e7 / (nm * 2856.0))
    return (Spectrum("filament, 2856 K", nm, planck / planck.max(), "W/nm"),)


def results(**changes: Any) -> Results:
    """Return the results of a lamp with a stop and a position light."""
    nm = np.arange(380.0, 781.0, 5.0)
    red = 0.4 / (1.0 + np.exp(-(nm - 612.0) / 9.0))
    on_axis = Spectrum("light at HV", nm, red, "W/(sr nm)")
    region = ColourRegion("red", signal_region("red"))
    field = ((-45.0, 45.0, -15.0, 15.0),)
    stop = observed(peak_cd=changes.pop("peak_cd", 66.0))
    tail = observed(name="position", peak_cd=7.1, noise=9)
    functions = (
        FunctionResults(stop, verdict(stop), region, field, on_axis),
        FunctionResults(tail, verdict(tail, minimum_cd=4.0, maximum_cd=17.0), region, field),
    )
    usual: dict[str, Any] = {
        "scene": "Rear lamp P21W",
        "scene_hash": "3f0c9a" * 10 + "beef",
        "version": "0.1.0",
        "seed": 1,
        "paths": 12_500_000,
        "functions": functions,
        "energy": energy(),
        "spectra": spectra(),
        "geometry": {"distance": "far field", "receiver": "0.5° full angle"},
        "elapsed_s": 41.2,
        "command": "lamplit measure p21w -o out",
    }
    return Results(**(usual | changes))


@pytest.fixture
def make_observed() -> Callable[..., Observed]:
    """Return the maker of what is observed."""
    return observed


@pytest.fixture
def make_verdict() -> Callable[..., Verdict]:
    """Return the maker of verdicts."""
    return verdict


@pytest.fixture
def make_results() -> Callable[..., Results]:
    """Return the maker of results."""
    return results


@pytest.fixture
def make_finding() -> Callable[..., Finding]:
    """Return the maker of findings."""
    return finding


@pytest.fixture
def make_energy() -> Callable[[], EnergyFlow]:
    """Return the maker of energy flows."""
    return energy

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Cuts through the distribution: along H at V = 0 and along V at H = 0, with limits."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamplit.report.photometry.isocandela import middles, window
from lamplit.report.photometry.style import (
    ACCENT,
    INK,
    MARKS,
    PAPER,
    QUIET,
    dress,
    head,
    new_figure,
    shortened,
)
from lamplit.report.photometry.table import spot_of
from lamplit.report.sheet import FONT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lamplit.photometry.observed import Observed
    from lamplit.report.photometry.results import FunctionResults
    from lamplit.rules.verdict import Finding

Array = NDArray[np.float64]

#: Limits that lie farther apart than this are drawn on a logarithmic scale.
_WIDE = 30.0
#: The least intensity on a logarithmic scale, as a share of the greatest.
_FLOOR = 1e-4


class Cut(NamedTuple):
    """A line through the grid: angles, intensities and their standard errors, (n,)."""

    angles_deg: Array
    intensity_cd: Array
    standard_error_cd: Array


def cut_along_h(observed: Observed, v_deg: float = 0.0) -> Cut:
    """Return the intensity along H at ``v_deg``, between the rows of cells on either side."""
    rows, shares = _between(observed.grid_v_edges_deg, v_deg)
    return _cut(
        middles(observed.grid_h_edges_deg),
        observed.grid_cd[rows], observed.grid_standard_error_cd[rows], shares,
    )  # fmt: skip


def cut_along_v(observed: Observed, h_deg: float = 0.0) -> Cut:
    """Return the intensity along V at ``h_deg``, between the columns of cells on either side."""
    columns, shares = _between(observed.grid_h_edges_deg, h_deg)
    return _cut(
        middles(observed.grid_v_edges_deg),
        observed.grid_cd[:, columns].T, observed.grid_standard_error_cd[:, columns].T, shares,
    )  # fmt: skip


def _cut(angles: Array, values: Array, errors: Array, shares: Array) -> Cut:
    """Weigh rows of cells, whose errors are taken as independent."""
    return Cut(angles, shares @ values, np.sqrt(np.square(shares) @ np.square(errors)))


def _between(edges: Array, at: float) -> tuple[NDArray[np.intp], Array]:
    """Return the one or two cells whose middles lie round ``at``, and their linear shares.

    Outside of the middles it is the cell at the border.
    """
    places = middles(edges)
    after = int(np.searchsorted(places, at))
    if after == 0 or after == len(places):
        return np.array([min(after, len(places) - 1)]), np.ones(1)
    share = (at - places[after - 1]) / (places[after] - places[after - 1])
    if share >= 1.0 - 1e-9:
        return np.array([after]), np.ones(1)
    return np.array([after - 1, after]), np.array([1.0 - share, share])


def suits_logarithm(function: FunctionResults) -> bool:
    """Say whether the limits lie so far apart that a linear scale would hide the small ones."""
    verdict = function.verdict
    limits = [
        finding.required
        for finding in (() if verdict is None else verdict.findings)
        if finding.required and finding.unit == "cd"
    ]
    return bool(limits) and max(limits) > _WIDE * min(limits)


def draw_cuts(function: FunctionResults, *, logarithmic: bool | None = None) -> Figure:
    """Draw both cuts, with bands of 2 σ, the measured spots on them, and the limits.

    A minimum is a mark below which the curve must not fall, a maximum a line it must not cross.
    ``logarithmic`` chooses the scale; left out, it is logarithmic where limits lie far apart.
    """
    observed = function.observed
    log = suits_logarithm(function) if logarithmic is None else logarithmic
    figure = new_figure(9.6, 4.3)
    head(
        figure,
        f"{shortened(observed.name, 40)}: cuts through the axis",
        "line: mean of a cell, with a band of 2 σ; dots: test points with bars of 2 σ; "
        "▂ minimum, line: maximum",
    )
    cuts = {"H": cut_along_h(observed), "V": cut_along_v(observed)}
    drawn: list[Axes] = []
    for place, (name, cut) in enumerate(cuts.items()):
        axes = figure.add_axes((0.075 + 0.485 * place, 0.125, 0.425, 0.68))
        other = "V = 0" if name == "H" else "H = 0"
        dress(axes, x=f"{name} in ° at {other}", y="intensity in cd" if place == 0 else "")
        _draw_cut(axes, cut)
        _draw_limits(axes, function, along_h=name == "H")
        axes.set_xlim(*(window(function)[:2] if name == "H" else window(function)[2:]))
        drawn.append(axes)
    _scale(drawn, function, log=log)
    return figure


def _draw_cut(axes: Axes, cut: Cut) -> None:
    low = cut.intensity_cd - 2.0 * cut.standard_error_cd
    high = cut.intensity_cd + 2.0 * cut.standard_error_cd
    axes.fill_between(cut.angles_deg, np.maximum(low, 1e-9), high, color=ACCENT, alpha=0.22, lw=0)
    axes.plot(cut.angles_deg, cut.intensity_cd, color=ACCENT, linewidth=1.3)


def _draw_limits(axes: Axes, function: FunctionResults, *, along_h: bool) -> None:
    """Draw the spots on this cut, and the limits that hold at them or everywhere."""
    observed, verdict = function.observed, function.verdict
    on_cut = (observed.spot_v_deg if along_h else observed.spot_h_deg) == 0.0
    angles = (observed.spot_h_deg if along_h else observed.spot_v_deg)[on_cut]
    axes.errorbar(
        angles, observed.spot_cd[on_cut], 2.0 * observed.spot_standard_error_cd[on_cut],
        fmt="o", ms=3.6, mfc=PAPER, mec=INK, mew=0.9, ecolor=INK, elinewidth=0.9, zorder=4,
    )  # fmt: skip
    if verdict is None:
        return
    left, right, low, high = window(function)
    span = right - left if along_h else high - low
    for finding in verdict.findings:
        spot = spot_of(finding, observed)
        if finding.unit != "cd" or finding.required is None or finding.sense is None:
            continue
        if finding.sense == "min" and spot is not None and spot[1 if along_h else 0] == 0.0:
            at = spot[0 if along_h else 1]
            reach = 0.018 * span
            ink = MARKS[finding.outcome].ink
            axes.plot([at - reach, at + reach], [finding.required] * 2, color=ink, lw=2.6,
                      solid_capstyle="butt", zorder=3)  # fmt: skip
    for limit, finding in _maxima(verdict.findings).items():
        ink = MARKS[finding.outcome].ink
        axes.axhline(limit, color=ink, linewidth=1.0, linestyle=(0, (6, 2)))
        axes.annotate(f"maximum {limit:g} cd", (0.985, limit), (0, 3), color=ink, fontsize=7.5,
                      xycoords=axes.get_yaxis_transform(), textcoords="offset points",
                      ha="right", family=FONT)  # fmt: skip


def _maxima(findings: tuple[Finding, ...]) -> dict[float, Finding]:
    """Return the maxima in cd, each with one finding."""
    return {
        finding.required: finding
        for finding in findings
        if finding.sense == "max" and finding.unit == "cd" and finding.required is not None
    }


def _scale(drawn: list[Axes], function: FunctionResults, *, log: bool) -> None:
    """Give both cuts one scale that shows curves and limits."""
    limits = [0.0] if function.verdict is None else list(_maxima(function.verdict.findings))
    top = 1.12 * max([float(function.observed.grid_cd.max()), *limits, 1e-6])
    for axes in drawn:
        if log:
            axes.set_yscale("log")
            axes.set_ylim(max(_lowest(function) / 2.0, _FLOOR * top), 1.3 * top)
            axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        else:
            axes.set_ylim(0.0, top)
    drawn[1].tick_params(labelleft=False)
    for axes in drawn:
        axes.spines["left"].set_color(QUIET)


def _lowest(function: FunctionResults) -> float:
    """Return the least limit or intensity above zero on the cuts, in cd."""
    observed, verdict = function.observed, function.verdict
    values = [cut_along_h(observed).intensity_cd, cut_along_v(observed).intensity_cd]
    shown = np.concatenate(values)
    limits = [] if verdict is None else [f.required for f in verdict.findings if f.unit == "cd"]
    return min([*(limit for limit in limits if limit), *shown[shown > 0.0]], default=1.0)

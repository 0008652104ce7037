# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The isocandela plot: lines of equal intensity over H and V, with the test points."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lamplit.report.photometry.style import (
    ACCENT,
    INK,
    MARKS,
    PAPER,
    QUIET,
    cd,
    dress,
    head,
    new_figure,
    outcome_legend,
    shortened,
    write,
)
from lamplit.report.photometry.table import angle, points_of
from lamplit.report.sheet import FONT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lamplit.photometry.observed import Observed
    from lamplit.report.photometry.results import FunctionResults
    from lamplit.rules.verdict import Outcome

Array = NDArray[np.float64]

#: Where the label of the lowest line stands, from the right towards up, and how far on the next.
_FIRST_LABEL_DEG, _NEXT_LABEL_DEG = -20.0, 40.0
#: Lines at 1, 2 and 5 times powers of ten, this many at most, over so many powers.
_MOST_LEVELS, _POWERS = 10, 3.0
#: Cells above this share of the brightest are worth looking at.
_WORTH_A_LOOK = 0.05
#: A line is left out where the cells about its level have a larger relative error, in the median.
_TOO_NOISY, _ABOUT = 0.12, 1.5
_LOW, _HIGH = "#c9ced6", "#8f1d14"


def middles(edges: Array) -> Array:
    """Return the middles of cells from their borders, (n + 1,) to (n,)."""
    return 0.5 * (edges[:-1] + edges[1:])


def contour_levels(peak: float) -> list[float]:
    """Return the intensities of the lines below ``peak``: 1, 2, 5, 10, ... cd, rising.

    >>> contour_levels(260.0)
    [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0]
    >>> contour_levels(0.0)
    []
    """
    if not (peak > 0.0 and math.isfinite(peak)):
        return []
    top = math.floor(math.log10(peak))
    powers = range(top - math.ceil(_POWERS), top + 1)
    steps = [float(f"{digit}e{power}") for power in powers for digit in (1, 2, 5)]
    below = [step for step in steps if peak * 10.0**-_POWERS < step < peak]
    return below[-_MOST_LEVELS:]


def clear_levels(levels: Sequence[float], cd: Array, standard_error: Array) -> list[float]:
    """Return those of ``levels`` that are not lost in noise.

    The line of a level wanders where the cells about it, within a factor of 1.5, are uncertain by
    more than 12 % in the median.
    """
    found: list[float] = []
    for level in levels:
        about = (cd > level / _ABOUT) & (cd < level * _ABOUT)
        if about.any() and float(np.median(standard_error[about] / cd[about])) <= _TOO_NOISY:
            found.append(level)
    return found


def brightest(observed: Observed) -> tuple[float, float, float]:
    """Return H, V in degrees and the intensity in cd of the grid's brightest cell."""
    row, column = np.unravel_index(int(np.argmax(observed.grid_cd)), observed.grid_cd.shape)
    return (
        float(middles(observed.grid_h_edges_deg)[column]),
        float(middles(observed.grid_v_edges_deg)[row]),
        float(observed.grid_cd[row, column]),
    )


def window(function: FunctionResults) -> tuple[float, float, float, float]:
    """Return the part of the grid worth looking at: least and greatest H, then V, in degrees.

    It holds the spots, the fields of visibility, and all cells that are certainly, by 2 σ, above a
    twentieth of the brightest: a single hit near a pole, where cells are small, looks bright.
    """
    observed = function.observed
    h, v = observed.grid_h_edges_deg, observed.grid_v_edges_deg
    certain = observed.grid_cd - 2.0 * observed.grid_standard_error_cd
    bright = certain > _WORTH_A_LOOK * observed.grid_cd.max()
    columns, rows = np.flatnonzero(bright.any(axis=0)), np.flatnonzero(bright.any(axis=1))
    across, along = [*observed.spot_h_deg], [*observed.spot_v_deg]
    across += [h[columns[0]], h[columns[-1] + 1]] if columns.size else [h[0], h[-1]]
    along += [v[rows[0]], v[rows[-1] + 1]] if rows.size else [v[0], v[-1]]
    for left, right, low, high in function.fields_deg:
        across += [left, right]
        along += [low, high]
    return (
        max(float(min(across)), float(h[0])),
        min(float(max(across)), float(h[-1])),
        max(float(min(along)), float(v[0])),
        min(float(max(along)), float(v[-1])),
    )


def draw_isocandela(function: FunctionResults) -> Figure:
    """Draw lines of equal intensity, the field that the rule asks for, and the test points."""
    observed = function.observed
    left, right, low, high = window(function)
    span_h, span_v = right - left, high - low
    width = 9.6
    plot_w = 0.885 * width
    plot_h = float(np.clip(plot_w * span_v / span_h, 2.2, 6.4))
    height = plot_h + 1.45
    figure = new_figure(width, height)
    axes = figure.add_axes((0.075, 0.72 / height, plot_w / width, plot_h / height))
    h_peak, v_peak, peak = brightest(observed)
    head(
        figure,
        f"{shortened(observed.name, 40)}: luminous intensity in cd",
        f"lines of equal intensity; + brightest cell, {cd(peak)} cd at H {angle(h_peak)}°, "
        f"V {angle(v_peak)}°{'; dashed: field of visibility' if function.fields_deg else ''}",
    )
    stretched = not math.isclose(plot_w * span_v / span_h, plot_h, rel_tol=0.02)
    note = "; V is drawn larger than H" if stretched and plot_h == 2.2 else ""
    dress(axes, x=f"H in °, positive to the right of an observer before the lamp{note}",
          y="V in °, positive upwards")  # fmt: skip
    pad_h, pad_v = 0.012 * span_h, 0.03 * span_v
    axes.set(xlim=(left - pad_h, right + pad_h), ylim=(low - pad_v, high + pad_v))
    axes.axhline(0.0, color=QUIET, linewidth=0.6)
    axes.axvline(0.0, color=QUIET, linewidth=0.6)
    left_out = _draw_lines(axes, observed, peak)
    _draw_field(axes, function)
    outcomes = _draw_points(axes, function)
    axes.plot(h_peak, v_peak, "+", color=INK, ms=9, mew=1.2, zorder=5)
    outcome_legend(axes, outcomes, at=(0.0, -0.38 / plot_h))
    noisy = f"lines of {max(left_out):g} cd and less are too uncertain; " if left_out else ""
    write(figure, 0.96, 0.16 / height, f"{noisy}{_count(observed.paths)} paths",
          size=7.5, ink=QUIET, align="right")  # fmt: skip
    return figure


def _draw_lines(axes: Axes, observed: Observed, peak: float) -> list[float]:
    """Draw the lines that noise does not hide; return the levels that it does."""
    from matplotlib.colors import LinearSegmentedColormap, LogNorm
    from matplotlib.patheffects import withStroke

    every = contour_levels(peak)
    levels = clear_levels(every, observed.grid_cd, observed.grid_standard_error_cd)
    if not levels or min(observed.grid_cd.shape) < 2:
        axes.text(0.5, 0.5, _no_lines(observed, every),
                  transform=axes.transAxes, ha="center", color=QUIET, fontsize=9)  # fmt: skip
        return every
    ramp = LinearSegmentedColormap.from_list("intensity", [_LOW, "#d98a7b", _HIGH])
    norm = LogNorm(levels[0], max(levels[-1], 1.001 * levels[0]))
    where = (middles(observed.grid_h_edges_deg), middles(observed.grid_v_edges_deg))
    inks = [ramp(norm(level)) for level in levels]
    lines = axes.contour(*where, observed.grid_cd, levels=levels, colors=inks, linewidths=1.1)
    edge = [withStroke(linewidth=2.4, foreground=PAPER)]
    for level, (x, y) in label_places(levels, lines.allsegs):
        axes.text(x, y, f"{level:g}", fontsize=7.5, color=INK, ha="center", va="center",
                  path_effects=edge, family=FONT, zorder=3.5, clip_on=True)  # fmt: skip
    return [level for level in every if level not in levels]


def _no_lines(observed: Observed, levels: list[float]) -> str:
    """Say why there is no line."""
    if not levels:
        return "no light in the field"
    if min(observed.grid_cd.shape) < 2:
        return "too few cells for lines"
    return "no line is certain to 12 %: more paths show them"


def label_places(
    levels: Sequence[float], segments: Sequence[Sequence[Array]]
) -> list[tuple[float, Array]]:
    """Return a level and the place of its label, for each level that has a line.

    Labels go round from level to level, so that those of near lines do not meet, each on a line
    that is not much shorter than the longest of its level: specks are noise.
    """
    found: list[tuple[float, Array]] = []
    for number, (level, lines) in enumerate(zip(levels, segments, strict=True)):
        lengths = [float(np.hypot(*np.diff(line, axis=0).T).sum()) for line in lines]
        long = [
            line for line, length in zip(lines, lengths, strict=True)
            if length > 0.25 * max(lengths)
        ]  # fmt: skip
        if long:
            places = np.concatenate(long)
            turn = np.radians(_FIRST_LABEL_DEG - _NEXT_LABEL_DEG * number)
            towards = places @ (np.cos(turn), np.sin(turn))
            found.append((float(level), places[int(np.argmax(towards))]))
    return found


def _draw_field(axes: Axes, function: FunctionResults) -> None:
    from matplotlib.patches import Rectangle

    for left, right, low, high in function.fields_deg:
        border = Rectangle((left, low), right - left, high - low, fill=False, edgecolor=ACCENT)
        border.set(linewidth=1.1, linestyle=(0, (5, 3)), zorder=3)
        axes.add_patch(border)


def _draw_points(axes: Axes, function: FunctionResults) -> list[Outcome]:
    """Draw the test points, or bare spots where no rule judges; return the outcomes there are."""
    observed = function.observed
    if function.verdict is None:
        axes.plot(observed.spot_h_deg, observed.spot_v_deg, "o", ms=4, mfc=PAPER, mec=INK, mew=0.9)
        return []
    points = points_of(function.verdict, observed)
    for point in points:
        mark = MARKS[point.outcome]
        size = 7.0 if mark.marker == "X" else 5.0
        axes.plot(point.h_deg, point.v_deg, mark.marker, ms=size, mfc=mark.ink, mec=PAPER,
                  mew=0.8, zorder=4, clip_on=False)  # fmt: skip
    return [point.outcome for point in points]


def _count(paths: int) -> str:
    """Return a count with thin gaps.

    >>> _count(12500000)
    '12 500 000'
    """
    return f"{paths:,}".replace(",", " ")

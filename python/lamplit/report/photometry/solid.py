# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The solid of intensity: each direction drawn as far from the lamp as it has candela."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lamplit.report.photometry.isocandela import brightest, middles, window
from lamplit.report.photometry.style import FAINT, INK, QUIET, cd, head, new_figure, shortened
from lamplit.report.photometry.table import angle
from lamplit.report.sheet import FONT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from lamplit.photometry.observed import Observed
    from lamplit.report.photometry.results import FunctionResults

Array = NDArray[np.float64]

#: A surface of more lines than this, each way, is drawn with every second, third, ... of them.
_MOST_LINES = 90


def solid_points(observed: Observed) -> Array:
    """Return the corners (v, h, 3) of the solid: intensity times direction, in cd.

    Directions are (sin H cos V, sin V, cos H cos V), as in the conventions.
    """
    h, v = np.meshgrid(
        np.radians(middles(observed.grid_h_edges_deg)),
        np.radians(middles(observed.grid_v_edges_deg)),
    )
    directions = np.stack([np.sin(h) * np.cos(v), np.sin(v), np.cos(h) * np.cos(v)], axis=-1)
    return observed.grid_cd[..., None] * directions


def draw_solid(function: FunctionResults) -> Figure | None:
    """Draw the solid as seen from the front, right and above; None of a dark function."""
    observed = function.observed
    h_peak, v_peak, peak = brightest(observed)
    if not peak > 0.0 or min(observed.grid_cd.shape) < 2:
        return None
    figure = new_figure(4.7, 3.5)
    head(
        figure,
        f"{shortened(observed.name, 24)}: solid of intensity",
        f"distance: cd; brightest {cd(peak)} cd at H {angle(h_peak)}°, V {angle(v_peak)}°",
    )
    axes: Any = figure.add_axes((0.0, -0.08, 1.0, 0.98), projection="3d", computed_zorder=False)
    axes.set_axis_off()
    corners = solid_points(observed)
    step_v, step_h = (-(-size // _MOST_LINES) for size in observed.grid_cd.shape)
    corners = corners[::step_v, ::step_h]
    half_deg = float(np.clip(np.abs(window(function)[:2]).max(), 20.0, 60.0))
    _draw_rings(axes, peak, half_deg)
    _draw_surface(axes, corners, peak)
    _set_view(axes, corners, peak, half_deg)
    return figure


def _draw_surface(axes: Any, corners: Array, peak: float) -> None:
    from matplotlib.colors import LightSource, LinearSegmentedColormap

    ramp = LinearSegmentedColormap.from_list("intensity", ["#e9dfd9", "#d98a7b", "#8f1d14"])
    reach = np.linalg.norm(corners, axis=-1) / peak
    x, y, z = np.moveaxis(corners, -1, 0)
    axes.plot_surface(
        z, x, y, facecolors=ramp(reach), rstride=1, cstride=1, linewidth=0.15,
        edgecolor=(1, 1, 1, 0.35), antialiased=True, shade=True, zorder=3,
        lightsource=LightSource(azdeg=315, altdeg=55),
    )  # fmt: skip


def _draw_rings(axes: Any, peak: float, half_deg: float) -> None:
    """Draw the scale in the plane V = 0: arcs of equal intensity, directions, and the axis."""
    power = 10.0 ** np.floor(np.log10(peak))
    step = next(digit * power for digit in (0.2, 0.5, 1.0, 2.0, 5.0) if peak / (digit * power) <= 5)
    turn = np.radians(np.linspace(-half_deg, half_deg, 91))
    for ring in np.arange(step, 1.001 * peak, step):
        axes.plot(ring * np.cos(turn), ring * np.sin(turn), 0.0, color=FAINT, lw=0.8, zorder=1)
        out = ring * np.cos(turn[-1]), ring * np.sin(turn[-1]) + 0.045 * peak
        axes.text(*out, 0.0, f"{ring:g}", color=QUIET, fontsize=7, family=FONT, ha="center",
                  va="center")  # fmt: skip
    for share in (-1.0, -0.5, 0.5, 1.0):
        away = np.radians(share * half_deg)
        axes.plot([0, 1.03 * peak * np.cos(away)], [0, 1.03 * peak * np.sin(away)], [0, 0],
                  color=FAINT, lw=0.6, zorder=1)  # fmt: skip
        axes.text(1.1 * peak * np.cos(away), 1.1 * peak * np.sin(away), 0,
                  f"H {angle(share * half_deg)}°", color=QUIET, fontsize=7, family=FONT,
                  ha="center", va="center")  # fmt: skip
    axes.plot([0, 1.12 * peak], [0, 0], [0, 0], color=INK, lw=0.9, zorder=2)
    axes.text(1.2 * peak, 0, 0, "axis", color=INK, fontsize=8, family=FONT, ha="center",
              va="center", zorder=5)  # fmt: skip


def _set_view(axes: Any, corners: Array, peak: float, half_deg: float) -> None:
    """Look from the front, the right and above, at the same scale along all three axes."""
    axes.view_init(elev=30, azim=35)
    axes.set_proj_type("ortho")
    wide = 1.1 * peak * np.sin(np.radians(half_deg))
    wide = max(wide, 0.45 * peak)
    low, high = float(corners[..., 1].min()), float(corners[..., 1].max())
    half = max(0.5 * (high - low), 0.3 * peak)
    middle = 0.5 * (low + high)
    axes.set(xlim=(0.0, 1.1 * peak), ylim=(-wide, wide), zlim=(middle - half, middle + half))
    axes.set_box_aspect((1.1, 2.0 * wide / peak, 2.0 * half / peak), zoom=1.62)

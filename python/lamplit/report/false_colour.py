# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Luminance in false colours, with a scale in cd/m²."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lamplit.report.sheet import FAINT, FONT, QUIET, TEXT, Sheet, show_pixels

Array = NDArray[np.float64]

#: Perceptually uniform, readable without colour vision, and of colours that no rear lamp has.
_MAP = "viridis"
#: The scale spans these shares of the pixels, and no more decades than that.
_PERCENTS, _DECADES = (1.0, 99.99), 7.0
#: The picture is magnified, whole times, until it is this wide.
_LEAST_WIDTH = 560
_MARGIN, _HEAD, _BAR, _LABELS = 16, 44, 18, 96


def scale_limits(luminance: Array) -> tuple[float, float]:
    """Return the ends of the scale in cd/m²: the 1 and 99.99 % percentiles of what is not black.

    The scale has one decade at least, about the middle of these, and seven at most, below the top.
    That of a black picture ends at 1 cd/m².
    """
    lit = luminance[np.isfinite(luminance) & (luminance > 0.0)]
    if not lit.size:
        return 0.1, 1.0
    low, top = (float(value) for value in np.percentile(lit, _PERCENTS))
    low = max(low, top / 10.0**_DECADES)
    if low < top / 10.0:
        return low, top
    middle = math.sqrt(low * top)
    return middle / math.sqrt(10.0), middle * math.sqrt(10.0)


def draw_false_colour(luminance: Array) -> tuple[Array, tuple[float, float]]:
    """Return a page, sRGB values (rows, columns, 3) in [0, 1], and the ends of its scale in cd/m².

    ``luminance`` (H, W) is in cd/m². The scale is logarithmic; what is beyond it has the colour of
    its end, and what has no light, or no finite luminance, is black.
    """
    from matplotlib import colormaps
    from matplotlib.colors import LogNorm

    low, top = scale_limits(luminance)
    norm = LogNorm(low, top, clip=True)
    colours = colormaps[_MAP].with_extremes(bad="black")
    height, width = luminance.shape
    times = max(1, math.ceil(_LEAST_WIDTH / width))
    shown_width, shown_height = width * times, height * times
    unit = max(1.0, shown_width / 1000.0)
    margin, head, bar, labels = (round(part * unit) for part in (_MARGIN, _HEAD, _BAR, _LABELS))
    bar_height = max(shown_height, round(200 * unit))
    sheet = Sheet(
        margin + shown_width + margin + bar + labels, head + bar_height + margin, unit=unit
    )
    sheet.title(margin, head, "Luminance", _heading(luminance))
    lit = np.isfinite(luminance) & (luminance > 0.0)
    pixels = colours(norm(np.ma.masked_where(~lit, luminance)))[..., :3]
    axes = sheet.axes(margin, head, shown_width, shown_height)
    show_pixels(axes, np.asarray(pixels, dtype=np.float64), (shown_width, shown_height))
    _draw_bar(sheet, (2 * margin + shown_width, head, bar, bar_height), norm, colours)
    return sheet.pixels(), (low, top)


def _heading(luminance: Array) -> str:
    good = luminance[np.isfinite(luminance)]
    mean, most = (float(good.mean()), float(good.max())) if good.size else (0.0, 0.0)
    return f"mean {luminance_label(mean)} cd/m², largest {luminance_label(most)} cd/m²"


def _draw_bar(sheet: Sheet, place: tuple[int, int, int, int], norm: Any, colours: Any) -> None:
    from matplotlib.colorbar import Colorbar
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axes = sheet.axes(*place)
    bar = Colorbar(axes, norm=norm, cmap=colours)
    decades = math.log10(norm.vmax / norm.vmin)
    bar.ax.yaxis.set_major_locator(LogLocator(subs=(1.0,) if decades > 2.5 else (1.0, 2.0, 5.0)))
    bar.ax.yaxis.set_major_formatter(FuncFormatter(luminance_label))
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    ticks: dict[str, Any] = {"color": QUIET, "labelcolor": TEXT, "labelfontfamily": FONT}
    bar.ax.tick_params(which="major", labelsize=10 * sheet.unit, **ticks)
    bar.ax.tick_params(which="minor", color=FAINT)
    bar.outline.set_edgecolor(FAINT)  # pyright: ignore[reportCallIssue]
    right = place[0] + place[2] + round((_LABELS - 4) * sheet.unit)
    sheet.write(right, place[1] - 14 * sheet.unit, "cd/m²", 10.5, ink=QUIET, align="right")


def luminance_label(value: float, _: object = None) -> str:
    """Return three digits of a luminance, thousands apart.

    >>> luminance_label(20000.0), luminance_label(0.05), luminance_label(2714893.0)
    ('20 000', '0.05', '2 710 000')
    """
    shown = float(f"{value:.3g}")
    return f"{shown:,.0f}".replace(",", " ") if shown >= 1000.0 else f"{shown:g}"

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Spectra of the sources, and of the light that leaves the lamp along its axis."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lamplit.report.photometry.style import ACCENT, INK, QUIET, dress, head, new_figure, shortened
from lamplit.report.sheet import FONT

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lamplit.report.photometry.results import Spectrum

Array = NDArray[np.float64]

_INKS = (INK, ACCENT, "#b3261e", "#1b7340", "#a36200", "#6d3b8f", "#6b6a66", "#2a8c9a")


def draw_spectra(spectra: Sequence[Spectrum], *, title: str) -> Figure | None:
    """Draw ``spectra``, each relative to its own greatest value; None if all are dark.

    Measured ones are steps as wide as their bands, with 2 σ to both sides: a line would show shapes
    that nobody measured.
    The band below the wavelengths has their colours, as far as a screen can show them.
    """
    lit = [one for one in spectra if one.values.size and one.values.max() > 0.0]
    if not lit:
        return None
    figure = new_figure(9.6, 3.6)
    head(figure, title, "each relative to its own peak, whose value stands beside it; bands of 2 σ")
    axes = figure.add_axes((0.075, 0.19, 0.62, 0.60))
    dress(axes, x="", y="share of the peak")
    for place, one in enumerate(lit[: len(_INKS)]):
        peak = float(one.values.max())
        height = f"{peak:.3g} {one.unit}" if one.unit else "relative"
        at = float(one.wavelengths_nm[int(one.values.argmax())])
        where = f"peak at {at:.0f} nm"
        if one.band_nm is not None:
            where += f", bands of {one.band_nm:.0f} nm"
        nm, half = one.wavelengths_nm, 0.5 * (one.band_nm or 0.0)
        is_smooth = one.band_nm is None
        edges = nm if is_smooth else np.append(nm - half, nm[-1] + half)
        axes.plot(
            edges, one.values / peak if is_smooth else _to_end(one.values / peak),
            color=_INKS[place], linewidth=1.3, linestyle="-" if place < 4 else (0, (5, 2)),
            drawstyle="default" if is_smooth else "steps-post",
            label=f"{shortened(one.name, 30)}\n{height}\n{where}",
        )  # fmt: skip
        if one.standard_error is not None and not is_smooth:
            low = np.maximum(one.values - 2.0 * one.standard_error, 0.0) / peak
            high = (one.values + 2.0 * one.standard_error) / peak
            axes.fill_between(
                edges, _to_end(low), _to_end(high), step="post",
                color=_INKS[place], alpha=0.22, linewidth=0.0,
            )  # fmt: skip
    axes.set(xlim=(380.0, 780.0), ylim=(0.0, 1.05))
    axes.set_xticks(np.arange(400, 781, 50), [])
    _draw_band(figure.add_axes((0.075, 0.155, 0.62, 0.025)))
    legend = axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1.03), frameon=False, fontsize=8)
    for text in legend.get_texts():
        text.set(color=INK, family=FONT, linespacing=1.35)
    return figure


def _to_end(values: Array) -> Array:
    """Return values of bands once more at the end of the last, as steps after a place have them."""
    return np.append(values, values[-1:])


def _draw_band(axes: Axes) -> None:
    from lamplit.colour.display import Display
    from lamplit.colour.observer import colour_matching_functions

    display = Display.named("srgb")
    xyz = colour_matching_functions("cie-1931-2", np.arange(380.0, 781.0))
    linear = np.maximum(xyz @ np.asarray(display.xyz_to_rgb).T, 0.0)
    bright = np.cbrt(xyz.sum(axis=1, keepdims=True) / xyz.sum(axis=1).max())
    colours = display.encode(linear / linear.max(axis=1, keepdims=True)) * bright + (1.0 - bright)
    axes.imshow(colours[None], aspect="auto", extent=(380, 780, 0, 1), interpolation="bilinear")
    axes.set_yticks([])
    axes.set_xticks(np.arange(400, 781, 50))
    axes.tick_params(length=0, colors=QUIET, labelsize=8)
    axes.set_xlabel("wavelength in nm", color=QUIET, fontsize=8.5, family=FONT)
    for spine in axes.spines.values():
        spine.set_visible(False)

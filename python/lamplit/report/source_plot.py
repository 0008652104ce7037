# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A picture of a source's spectrum, filled with the colours of its wavelengths."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lamplit.colour.display import Display
from lamplit.colour.gamut import map_to_gamut
from lamplit.colour.observer import colour_matching_functions
from lamplit.colour.tristimulus import chromaticity_xy, tristimulus
from lamplit.errors import OutputError
from lamplit.sources import SourceEntry

_RANGE_NM = (380.0, 780.0)
_PAGE = "#16181b"
_INK = "#d9dce0"


def plot_source(entry: SourceEntry, path: Path) -> None:
    """Draw the relative spectral power of ``entry`` from 380 to 780 nm, with a patch of its colour.

    The file's ending chooses the format (png, pdf, svg).

    Raises:
        OutputError: The file cannot be written, or its ending is no format.
    """
    from matplotlib.figure import Figure

    nm = np.arange(_RANGE_NM[0], _RANGE_NM[1] + 0.25, 0.5)
    spd = entry.distribution()
    power = spd(nm)
    power = power / power.max()
    xyz = tristimulus(spd, normalisation="relative") / 100.0

    figure = Figure(figsize=(8.0, 4.2), dpi=150, facecolor=_PAGE, layout="constrained")
    axes = figure.add_subplot(facecolor=_PAGE)
    rainbow = axes.imshow(
        _spectral_colours(nm)[None], extent=(*_RANGE_NM, 0.0, 1.08), aspect="auto", alpha=0.9
    )
    (edge,) = axes.fill(np.r_[nm[0], nm, nm[-1]], np.r_[0.0, power, 0.0], facecolor="none")
    rainbow.set_clip_path(edge)
    axes.plot(nm, power, color=_INK, linewidth=1.3)
    axes.set(xlim=_RANGE_NM, ylim=(0.0, 1.08))
    axes.set_xlabel("wavelength, nm", color=_INK)
    axes.set_ylabel("relative spectral power", color=_INK)
    axes.tick_params(colors=_INK)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(_INK)
    x, y = chromaticity_xy(xyz)
    axes.set_title(f"{entry.name}    x {x:.4f}  y {y:.4f}", color=_INK, loc="left", fontsize=11)
    patch = axes.inset_axes((0.92, 0.9, 0.08, 0.1))
    patch.spines[:].set_visible(False)
    patch.set(facecolor=tuple(_shown(xyz)), xticks=[], yticks=[])
    try:
        figure.savefig(path)
    except (OSError, ValueError) as fault:
        raise OutputError(f"the plot cannot be written: {fault}", file=path) from fault


def _spectral_colours(nm: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return sRGB values (n, 3) of spectral lights, each as pure as the display has it.

    No display has them; this is a picture of the order of the hues, dimmer towards both ends.
    """
    xyz = colour_matching_functions("cie-1931-2", nm)
    display = Display.named("srgb")
    linear = np.maximum(xyz @ display.xyz_to_rgb.T, 0.0)
    strength = xyz.sum(axis=-1, keepdims=True)
    pure = linear / linear.max(axis=-1, keepdims=True)
    return display.encode(0.85 * pure * (strength / strength.max()) ** 0.3)


def _shown(xyz: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return sRGB values (3,) of the colour, as bright as the display has it."""
    display = Display.named("srgb")
    linear = display.xyz_to_rgb @ xyz
    return display.encode(map_to_gamut(0.9 * linear / linear.max(), display)[0])

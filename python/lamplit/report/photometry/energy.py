# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Where the lumens go: bands from the sources to where the light ends, as wide as their flux."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lamplit.report.photometry.style import (
    INK,
    QUIET,
    head,
    new_figure,
    shortened,
    write,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lamplit.report.photometry.results import EnergyFlow

#: Bodies that absorb less than this share are added up under one name, if there are many.
_SMALL, _MOST_BODIES = 0.005, 8
#: What chance did is noise, named below the plot as long as it is no more than this share.
_GAP_IN = 0.16
_OUT_INK, _BODY_INK, _FAULT_INK = "#d9a514", "#9aa5b1", "#b3261e"


@dataclass(frozen=True)
class Band:
    """One end of the light: its name, lm, and where its band leaves and arrives (top edges)."""

    name: str
    flux_lm: float
    ink: str
    leaves: float
    arrives: float


def grouped(flow: EnergyFlow) -> list[tuple[str, float]]:
    """Return the ends of ``flow`` in lm, the smallest bodies added up, zeros left out.

    Their sum is that of ``flow``. What chance took may be negative.
    """
    bodies = sorted(flow.absorbed_lm.items(), key=lambda entry: -entry[1])
    small = [entry for entry in bodies if entry[1] < _SMALL * flow.total_lm]
    kept = [entry for entry in bodies if entry not in small]
    if len(kept) > _MOST_BODIES:
        kept, small = kept[: _MOST_BODIES - 1], [*kept[_MOST_BODIES - 1 :], *small]
    if len(small) == 1:
        kept, small = [*kept, *small], []
    ends = [("out of the lamp", flow.out_lm), *((f"in {name}", lm) for name, lm in kept)]
    if small:
        ends.append((f"in {len(small)} other bodies", sum(lm for _, lm in small)))
    rest = {
        "not followed further": flow.cut_lm,
        "lost at open bodies": flow.lost_lm,
        "chance": flow.chance_lm,
    }
    ends += rest.items()
    return [(name, lm) for name, lm in ends if lm != 0.0]


def bands_of(ends: Sequence[tuple[str, float]], *, height: float, gap: float) -> list[Band]:
    """Place a band for each end with a positive flux, from the top (0) down to ``height``.

    Bands leave the trunk without gaps, and arrive ``gap`` apart; a band is as wide as its share.
    """
    shown = [(name, lm) for name, lm in ends if lm > 0.0]
    total = sum(lm for _, lm in shown)
    placed: list[Band] = []
    leaves = arrives = 0.0
    for place, (name, lm) in enumerate(shown):
        wide = height * lm / total
        fault = name.startswith(("lost", "not followed", "chance"))
        ink = _OUT_INK if name.startswith("out") else _FAULT_INK if fault else _BODY_INK
        placed.append(Band(name, lm, ink, leaves, arrives))
        leaves += wide
        arrives += max(wide, gap * 0.35) + (gap if place + 1 < len(shown) else 0.0)
    return placed


def draw_energy(flow: EnergyFlow) -> Figure | None:
    """Draw where the flux of the sources ends; None of a lamp that emits nothing."""
    total = flow.total_lm
    ends = grouped(flow)
    positive = [lm for _, lm in ends if lm > 0.0]
    if not total > 0.0 or not positive:
        return None
    trunk = 2.3
    bands = bands_of(ends, height=trunk, gap=_GAP_IN)
    scale = trunk / sum(positive)
    deepest = bands[-1].arrives + max(scale * bands[-1].flux_lm, _GAP_IN)
    height = 0.95 + deepest + 0.5
    figure = new_figure(9.6, height)
    head(
        figure,
        "Where the lumens go",
        f"{total:.4g} lm emitted, {flow.out_lm:.4g} lm or {100 * flow.efficiency:.3g} % leave "
        "the lamp",
    )
    axes = figure.add_axes((0.02, 0.5 / height, 0.96, deepest / height))
    axes.set(xlim=(0.0, 0.96 * 9.6), ylim=(deepest, 0.0))
    axes.set_axis_off()
    _draw_sources(axes, flow, trunk)
    for band in bands:
        _draw_band(axes, band, scale * band.flux_lm, total)
    _write_sum(figure, flow, ends, height)
    return figure


def _draw_sources(axes: Axes, flow: EnergyFlow, trunk: float) -> None:
    from matplotlib.patches import Rectangle

    top = 0.0
    total = flow.total_lm
    for name, lm in flow.emitted_lm.items():
        wide = trunk * lm / total
        axes.add_patch(
            Rectangle((1.7, top), 0.9, wide, facecolor=_OUT_INK, edgecolor="white", lw=1.2)
        )
        if wide > 0.09:
            write(axes, 1.6, top + 0.5 * wide - 0.08, shortened(name, 20), size=8.5, bold=True,
                  align="right", middle=True)  # fmt: skip
            write(axes, 1.6, top + 0.5 * wide + 0.08, f"{lm:.4g} lm", size=8, ink=QUIET,
                  align="right", middle=True)  # fmt: skip
        top += wide


def _draw_band(axes: Axes, band: Band, wide: float, total: float) -> None:
    """Draw a band that bends from the trunk at the left to its place at the right."""
    along = np.linspace(0.0, 1.0, 60)
    bend = along * along * (3.0 - 2.0 * along)
    upper = band.leaves + (band.arrives - band.leaves) * bend
    across = 2.6 + 2.9 * along
    axes.fill_between(across, upper, upper + wide, color=band.ink, alpha=0.55, lw=0)
    axes.fill_between([5.5, 5.62], band.arrives, band.arrives + wide, color=band.ink, lw=0)
    middle = band.arrives + 0.5 * wide
    write(axes, 7.35, middle, _lm(band.flux_lm), size=8.5, align="right", middle=True)
    write(axes, 6.62, middle, _percent(band.flux_lm / total), size=8.5, bold=True,
          align="right", middle=True)  # fmt: skip
    write(axes, 7.5, middle, shortened(band.name, 28), size=8.5, ink=INK, middle=True)


def _lm(flux: float) -> str:
    return f"{flux:.4g} lm" if flux >= 1.0 else f"{flux:.2g} lm"


def _percent(share: float) -> str:
    """Return a share in percent, to a tenth.

    >>> _percent(0.408), _percent(3e-4)
    ('40.8 %', '< 0.1 %')
    """
    return f"{100.0 * share:.1f} %" if share >= 0.0005 else "< 0.1 %"


def _write_sum(
    figure: Figure, flow: EnergyFlow, ends: list[tuple[str, float]], height: float
) -> None:
    below = ", ".join(f"{name} −{-lm:.3g} lm" for name, lm in ends if lm < 0.0)
    gap = abs(flow.gap_lm) / flow.total_lm
    exact = "to the last digit" if gap == 0.0 else f"to {gap:.1g} of it"
    closes = f"all ends together are what was emitted, {exact}"
    text = f"{closes}; not drawn: {below} (noise of choices at random)" if below else closes
    write(figure, 0.02, 0.2 / height, text, size=7.5, ink=QUIET)

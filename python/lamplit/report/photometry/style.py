# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How plots of a measurement look: ink on white paper, since they are read in print as well."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from lamplit.printable import printable
from lamplit.report.sheet import FONT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lamplit.rules.verdict import Outcome

PAPER, INK, QUIET, FAINT, GROUND = "#ffffff", "#1d1d1b", "#6b6a66", "#d4d2cc", "#f5f4f1"
#: What is not said by an outcome is said in this colour.
ACCENT = "#23527c"
#: A plot is drawn at so many pixels per inch; on the page it stands at half of its pixels.
DPI = 200


class Mark(NamedTuple):
    """How an outcome is told: by word and sign first, so that nothing rests on colour alone."""

    word: str
    sign: str
    #: The marker of matplotlib that looks like the sign.
    marker: str
    ink: str
    tint: str


MARKS: dict[Outcome, Mark] = {
    "pass": Mark("pass", "✓", "o", "#1b7340", "#e4f1e8"),
    "undecided": Mark("undecided", "?", "D", "#a36200", "#fbefd5"),
    "fail": Mark("fail", "✗", "X", "#b3261e", "#f9e1de"),
}


def new_figure(width: float, height: float) -> Figure:
    """Return a figure of ``width`` by ``height`` inches on white paper."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), dpi=DPI, facecolor=PAPER)
    FigureCanvasAgg(figure)
    return figure


def dress(axes: Axes, *, x: str, y: str, grid: bool = True) -> None:
    """Give ``axes`` their names with units, quiet lines and no box."""
    axes.set_facecolor(PAPER)
    axes.tick_params(colors=QUIET, labelsize=8, length=3, width=0.6, which="major")
    axes.tick_params(which="minor", length=1.5, width=0.4, color=FAINT)
    axes.set_xlabel(x, color=QUIET, fontsize=8.5, family=FONT)
    axes.set_ylabel(y, color=QUIET, fontsize=8.5, family=FONT)
    for name, spine in axes.spines.items():
        spine.set(color=FAINT, linewidth=0.8, visible=name in ("left", "bottom"))
    if grid:
        axes.grid(color=FAINT, linewidth=0.4, alpha=0.7)
        axes.set_axisbelow(True)


def write(
    figure: Figure | Axes,
    x: float,
    y: float,
    text: str,
    *,
    size: float = 8.5,
    ink: str = INK,
    bold: bool = False,
    align: str = "left",
    middle: bool = False,
) -> None:
    """Write one line at a place of the figure, 0 to 1, or of the axes, in their data."""
    figure.text(
        x, y, printable(" ".join(text.split())), color=ink, fontsize=size, family=FONT, ha=align,
        va="center" if middle else "baseline", fontweight="bold" if bold else "normal",
        parse_math=False,
    )  # fmt: skip


def head(figure: Figure, title: str, explanation: str) -> None:
    """Write the heading of a plot at the upper left, with its explanation below."""
    height = figure.get_figheight()
    write(figure, 0.02, 1.0 - 0.24 / height, shortened(title, 70), size=11.5, bold=True)
    write(figure, 0.02, 1.0 - 0.44 / height, explanation, size=8.5, ink=QUIET)


def shortened(text: str, most: int) -> str:
    """Return ``text`` in one line of ``most`` characters at most.

    >>> shortened("a rear lamp", 8)
    'a rear…'
    """
    line = printable(" ".join(text.split()))
    return line if len(line) <= most else line[: most - 1].rstrip() + "…"


def outcome_legend(
    axes: Axes, outcomes: Sequence[Outcome], *, at: tuple[float, float], size: float = 7.5
) -> None:
    """Say below ``axes``, at a place in their own 0 to 1, which sign stands for which outcome."""
    from matplotlib.lines import Line2D

    shown = [mark for name, mark in MARKS.items() if name in outcomes]
    handles = [
        Line2D(
            [], [], linestyle="none", marker=mark.marker, color=mark.ink,
            markersize=5, label=mark.word,
        )
        for mark in shown
    ]  # fmt: skip
    if not handles:
        return
    legend = axes.legend(
        handles=handles, loc="upper left", bbox_to_anchor=at, frameon=False, fontsize=size,
        ncols=len(handles), handletextpad=0.2, columnspacing=1.2, borderaxespad=0.0,
    )  # fmt: skip
    for text in legend.get_texts():
        text.set(color=QUIET, family=FONT)


def png(figure: Figure) -> bytes:
    """Return ``figure`` as a PNG file that says nothing of when it was made."""
    held = io.BytesIO()
    figure.savefig(held, format="png", dpi=DPI, facecolor=PAPER, metadata={"Software": "Lamplit"})
    return held.getvalue()


def spread(two_sigma: float) -> str:
    """Return an uncertainty to two digits.

    >>> spread(0.4812), spread(1.6), spread(163.2)
    ('± 0.48', '± 1.6', '± 163')
    """
    return f"± {two_sigma:.0f}" if two_sigma >= 99.5 else f"± {two_sigma:.2g}"


def cd(value: float) -> str:
    """Return an intensity as a lamp engineer writes it, three digits at least.

    >>> cd(4.0), cd(0.0734), cd(61.27), cd(1234.4), cd(0.0)
    ('4.00', '0.0734', '61.3', '1234', '0')
    """
    if value == 0.0:
        return "0"
    return f"{value:.0f}" if abs(value) >= 1000.0 else f"{value:#.3g}".rstrip(".")

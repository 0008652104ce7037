# SPDX-License-Identifier: Apache-2.0 OR MIT
"""All plots of a measurement, as PNG files in memory, by the names they have in a folder."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from lamplit.report.photometry.chart import draw_chart
from lamplit.report.photometry.colour import draw_chromaticity
from lamplit.report.photometry.cuts import draw_cuts
from lamplit.report.photometry.energy import draw_energy
from lamplit.report.photometry.isocandela import draw_isocandela
from lamplit.report.photometry.solid import draw_solid
from lamplit.report.photometry.spectra import draw_spectra
from lamplit.report.photometry.style import png

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from lamplit.report.photometry.results import FunctionResults, Results


class Plot(NamedTuple):
    """A plot: the kind, the function it belongs to (none of the whole lamp's), and the PNG."""

    kind: str
    function: str | None
    #: Such as "stop-isocandela.png".
    file: str
    content: bytes


#: What each kind of plot shows, in the order in which they are listed.
KINDS = {
    "points": "test points: got, required, margin",
    "isocandela": "lines of equal intensity over H and V, with the test points",
    "cuts": "intensity along H and along V, with limits",
    "colour": "chromaticities with 2 σ ellipses, and the legal region",
    "solid": "the intensity as a solid",
    "spectra": "spectra of the sources and at HV",
    "energy": "where the lumens go",
}


def draw_plots(
    results: Results, progress: Callable[[int, int], object] | None = None
) -> list[Plot]:
    """Return every plot that ``results`` have something for.

    ``progress`` is called with the number of plots that are done, and of all that there may be.
    """
    found: list[Plot] = []
    drawn = [
        *(
            (kind, one, f"{stem}-{kind}.png", partial(draw, one))
            for one, stem in zip(results.functions, stems(results), strict=True)
            for kind, draw in _OF_FUNCTION.items()
        ),
        *((kind, None, f"{kind}.png", partial(draw, results)) for kind, draw in _OF_LAMP.items()),
    ]
    for done, (kind, one, file, draw) in enumerate(drawn, 1):
        figure = draw()
        if figure is not None:
            found.append(Plot(kind, None if one is None else one.name, file, png(figure)))
        if progress is not None:
            progress(done, len(drawn))
    return found


def stems(results: Results) -> list[str]:
    """Return a name for the files of each function: its own, made safe and told apart.

    Letters, digits, dots and hyphens stay; a name that is taken gets a number.
    """
    found: list[str] = []
    for one in results.functions:
        plain = re.sub(r"[^\w.-]+", "-", one.name).strip("-._")[:60] or "function"
        stem, number = plain, 2
        while stem.lower() in (other.lower() for other in found):
            stem, number = f"{plain}-{number}", number + 1
        found.append(stem)
    return found


def _points(one: FunctionResults) -> Figure | None:
    return None if one.verdict is None else draw_chart(one, one.verdict)


def _spectra(results: Results) -> Figure | None:
    own = [one.spectrum for one in results.functions if one.spectrum is not None]
    return draw_spectra([*results.spectra, *own], title="Spectra of the sources and at HV")


def _energy(results: Results) -> Figure | None:
    return None if results.energy is None else draw_energy(results.energy)


#: What is drawn of each function, and of the lamp as a whole, by kind.
_OF_FUNCTION: dict[str, Callable[[FunctionResults], Figure | None]] = {
    "points": _points,
    "isocandela": draw_isocandela,
    "cuts": draw_cuts,
    "colour": draw_chromaticity,
    "solid": draw_solid,
}
_OF_LAMP: dict[str, Callable[[Results], Figure | None]] = {"spectra": _spectra, "energy": _energy}

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Results`: a measurement as it is shown and kept in files, apart from how it was made."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lamplit.photometry.observed import Observed
from lamplit.photometry.reflex import ReflexReading
from lamplit.rules.verdict import Finding, Outcome, Verdict, worst

Array = NDArray[np.float64]

#: From the worst to the best.
OUTCOMES: tuple[Outcome, ...] = ("fail", "undecided", "pass")


@dataclass(frozen=True, eq=False)
class ColourRegion:
    """A legal region of colour in the CIE 1931 x, y diagram."""

    #: "red", "amber", "white", ...
    name: str
    #: (n, 2), the outline, its arc along the spectral locus included.
    outline_xy: Array


@dataclass(frozen=True, eq=False)
class Spectrum:
    """A spectrum to be drawn, such as that of a source or of the light on the lamp's axis."""

    name: str
    #: (n,), rising.
    wavelengths_nm: Array
    #: (n,), in ``unit``.
    values: Array
    unit: str
    #: Width of the bands that ``values`` are means over; None of a spectrum that is known smoothly.
    band_nm: float | None = None
    #: (n,), of ``values``; None of a spectrum that nobody measured.
    standard_error: Array | None = None


@dataclass(frozen=True)
class EnergyFlow:
    """Where the luminous flux went, in lm: all but the first together are what was emitted."""

    #: By light group.
    emitted_lm: Mapping[str, float]
    #: Left the lamp.
    out_lm: float
    #: Stayed in bodies or on their surfaces, by the body's name.
    absorbed_lm: Mapping[str, float]
    #: Was not followed further.
    cut_lm: float = 0.0
    #: Was lost at surfaces that do not enclose what they should.
    lost_lm: float = 0.0
    #: What choices at random took away more than they gave: zero but for noise.
    chance_lm: float = 0.0

    @property
    def total_lm(self) -> float:
        """The flux of all sources."""
        return float(sum(self.emitted_lm.values()))

    @property
    def gap_lm(self) -> float:
        """What is missing of the total: nothing but rounding."""
        return self.total_lm - sum(flux for _, flux in self.ends())

    @property
    def efficiency(self) -> float:
        """The share that leaves the lamp; 0 of a lamp without flux."""
        return self.out_lm / self.total_lm if self.total_lm > 0.0 else 0.0

    def ends(self) -> list[tuple[str, float]]:
        """Return where the flux ended and how much: out, absorbed from the most, and the rest."""
        bodies = sorted(self.absorbed_lm.items(), key=lambda entry: -entry[1])
        return [
            ("out of the lamp", self.out_lm),
            *bodies,
            ("not followed further", self.cut_lm),
            ("lost at open bodies", self.lost_lm),
            ("chance", self.chance_lm),
        ]


@dataclass(frozen=True, eq=False)
class FunctionResults:
    """One function of the lamp: what was observed, and what its rule says of it."""

    observed: Observed
    #: None of a function that has no rule.
    verdict: Verdict | None = None
    #: Where its colour must lie; None where no rule says so.
    region: ColourRegion | None = None
    #: Fields of visibility that the rule asks for: least and greatest H, then V, in degrees.
    fields_deg: tuple[tuple[float, float, float, float], ...] = ()
    #: Of the light in the direction of the reference axis.
    spectrum: Spectrum | None = None

    @property
    def name(self) -> str:
        """Name of the function."""
        return self.observed.name


@dataclass(frozen=True, eq=False)
class ReflectorResults:
    """One retro-reflector: its coefficients of luminous intensity, and what its rule says."""

    name: str
    readings: tuple[ReflexReading, ...]
    paths: int
    #: None of a reflector that has no rule.
    verdict: Verdict | None = None


@dataclass(frozen=True, eq=False)
class Results:
    """All that a measurement says, and all that makes it again."""

    scene: str
    scene_hash: str
    version: str
    seed: int
    paths: int
    functions: tuple[FunctionResults, ...]
    energy: EnergyFlow | None = None
    #: Of the sources, one each.
    spectra: tuple[Spectrum, ...] = ()
    #: How it was measured, in words: receiver, distance, field.
    geometry: Mapping[str, str] = field(default_factory=dict[str, str])
    notices: tuple[str, ...] = ()
    elapsed_s: float = 0.0
    complete: bool = True
    command: str = ""
    reflectors: tuple[ReflectorResults, ...] = ()

    @property
    def outcome(self) -> Outcome | None:
        """The worst of all outcomes; None where no function or reflector has a rule."""
        found: list[Outcome] = [verdict.outcome for _, verdict in self.verdicts()]
        return worst(found) if found else None

    def verdicts(self) -> list[tuple[str, Verdict]]:
        """Return the name and the verdict of each function and reflector that has a rule."""
        named = [*self.functions, *self.reflectors]
        return [(one.name, one.verdict) for one in named if one.verdict is not None]


def worst_finding(findings: Iterable[Finding]) -> Finding | None:
    """Return the finding that decides; None of no findings.

    It has the worst outcome and, of these, the least margin; without margins, as of colours, the
    one that lies least inside.
    """

    def badness(finding: Finding) -> tuple[int, float, float]:
        margin = finding.margin_percent
        return (
            OUTCOMES.index(finding.outcome),
            float("inf") if margin is None else margin,
            finding.got if finding.required is None else 0.0,
        )

    return min(findings, key=badness, default=None)


def tally(verdict: Verdict) -> dict[Outcome, int]:
    """Return how many findings there are of each outcome, the worst first."""
    return {
        outcome: sum(finding.outcome == outcome for finding in verdict.findings)
        for outcome in OUTCOMES
    }

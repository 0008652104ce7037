# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Findings in words and in rows: what the terminal, the chart and the page say alike."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lamplit.printable import printable
from lamplit.report.photometry.results import worst_finding
from lamplit.report.photometry.style import MARKS, cd, spread

if TYPE_CHECKING:
    from rich.table import Table

    from lamplit.photometry.observed import Observed
    from lamplit.report.photometry.results import FunctionResults
    from lamplit.rules.verdict import Finding, Outcome, Verdict

#: A finding belongs to a spot that is no farther away than this, in degrees.
_SAME_PLACE_DEG = 0.01
#: What a test point is about; ratios and colours are told apart from it.
_INTENSITIES = ("cd", "mcd/lx")
#: So many times as many paths are not counted any more.
_MANY_TIMES = 1e6
#: A terminal narrower than this shows what is required in a line of its own below the numbers.
_NARROW = 100


@dataclass(frozen=True)
class Point:
    """A test point, and all that is required there."""

    h_deg: float
    v_deg: float
    findings: tuple[Finding, ...]

    @property
    def outcome(self) -> Outcome:
        """The worst of what is found there."""
        return self.deciding.outcome

    @property
    def deciding(self) -> Finding:
        """The finding with the worst outcome and, of these, the least margin."""
        return worst_finding(self.findings) or self.findings[0]


def at_points(verdict: Verdict, observed: Observed) -> dict[tuple[float, float], list[Finding]]:
    """Return the findings on intensity that stand at a measured spot, by H and V."""
    found: dict[tuple[float, float], list[Finding]] = {}
    for finding in verdict.findings:
        place = spot_of(finding, observed)
        if place is not None and finding.required is not None and finding.unit in _INTENSITIES:
            found.setdefault(place, []).append(finding)
    return found


def points_of(verdict: Verdict, observed: Observed) -> list[Point]:
    """Return the test points of ``verdict``, from the upper left to the lower right."""
    places = at_points(verdict, observed)
    ordered = sorted(places, key=lambda place: (-place[1], place[0]))
    return [Point(*place, tuple(places[place])) for place in ordered]


def elsewhere(verdict: Verdict, observed: Observed) -> list[Finding]:
    """Return what stands at no test point: sums, maxima in the field, ratios, colour."""
    here = {id(finding) for some in at_points(verdict, observed).values() for finding in some}
    return [finding for finding in verdict.findings if id(finding) not in here]


def gathered(findings: Iterable[Finding]) -> list[tuple[Finding, int]]:
    """Return one finding for each requirement, the worst, and how many there are of it.

    Nineteen directions have one colour to keep: the one nearest to the border tells of all.
    """
    by_requirement: dict[tuple[str, str], list[Finding]] = {}
    for finding in findings:
        by_requirement.setdefault((finding.requirement, finding.unit), []).append(finding)
    return [(worst_finding(some) or some[0], len(some)) for some in by_requirement.values()]


def spot_of(finding: Finding, observed: Observed) -> tuple[float, float] | None:
    """Return the place of the measured spot that ``finding`` stands at, if it stands at one."""
    if finding.h_deg is None or finding.v_deg is None:
        return None
    away = np.hypot(observed.spot_h_deg - finding.h_deg, observed.spot_v_deg - finding.v_deg)
    if away.size == 0 or float(away.min()) > _SAME_PLACE_DEG:
        return None
    at = int(away.argmin())
    return float(observed.spot_h_deg[at]), float(observed.spot_v_deg[at])


def place(finding: Finding) -> str:
    """Return where ``finding`` holds, such as "H +5, V −10", or nothing."""
    if finding.h_deg is None or finding.v_deg is None:
        return ""
    if finding.h_deg == 0.0 and finding.v_deg == 0.0:
        return "HV"
    return f"H {angle(finding.h_deg)}, V {angle(finding.v_deg)}"


def angle(degrees: float) -> str:
    """Return an angle with its sign.

    >>> angle(5.0), angle(-2.5), angle(0.0)
    ('+5', '−2.5', '0')
    """
    return "0" if degrees == 0.0 else f"{degrees:+.4g}".replace("-", "−")


def required(finding: Finding) -> str:
    """Return the limit in words, such as "≥ 60 cd", or nothing where it is no number."""
    if finding.required is None:
        return ""
    sign = {"min": "≥ ", "max": "≤ ", None: ""}[finding.sense]
    unit = "" if finding.unit == "1" else finding.unit
    return f"{sign}{finding.required:.4g} {unit}".strip()


def got(finding: Finding) -> str:
    """Return what was measured, with its unit where it has one."""
    if finding.required is None and not finding.unit:
        return ""
    if finding.unit == "xy":
        digits = ".4f" if abs(finding.got) >= 5e-5 else ".1g"
        return f"{finding.got:{digits}} xy".replace("-", "−")
    if finding.unit == "1":
        return f"{finding.got:.3g}"
    return f"{cd(finding.got)} {finding.unit}".strip()


def margin(finding: Finding) -> str:
    """Return the margin in percent with its sign, or nothing.

    A margin below a tenth of a percent is given to its first digit, lest it reads as none.
    """
    if not finding.margin_percent:
        return "" if finding.margin_percent is None else "0 %"
    digits = ".1f" if abs(finding.margin_percent) < 9.95 else ".0f"
    if 0.0 < abs(finding.margin_percent) < 0.05:
        digits = ".1g"
    return f"{finding.margin_percent:+{digits}} %".replace("-", "−")


def two_sigma(finding: Finding) -> str:
    """Return "± 2 σ" of what was measured, or nothing where nothing is uncertain."""
    return spread(2.0 * finding.standard_error) if finding.standard_error > 0.0 else ""


def more_paths(finding: Finding) -> str:
    """Say how many more paths would decide ``finding``; nothing where it is decided."""
    factor = finding.paths_factor
    if finding.outcome != "undecided" or factor is None:
        return ""
    if not np.isfinite(factor):
        return "on the limit: no number of paths decides it"
    if factor > _MANY_TIMES:
        return "more than a million × as many paths would decide it"
    digits = ".2g" if factor < 10.0 else ".0f"
    return f"{factor:{digits}} × as many paths would decide it"


def in_words(verdict: Verdict) -> str:
    """Return the finding that decides in one sentence."""
    finding = worst_finding(verdict.findings)
    if finding is None:
        return "nothing is required"
    where = place(finding)
    words = (
        f"{finding.requirement}{f' ({where})' if where and where != finding.requirement else ''}"
    )
    if finding.required is not None and finding.margin_percent is not None:
        scatter = two_sigma(finding)
        words += f": {got(finding)}{f' {scatter}' if scatter else ''}, required {required(finding)}"
        words += f", margin {margin(finding)}" if margin(finding) else ""
    elif finding.remark:
        words += f": {finding.remark}"
    more = more_paths(finding)
    return f"{words}; {more}" if more else words


def findings_table(function: FunctionResults, *, width: int = 120) -> Table:
    """Return the findings on ``function`` for the terminal: test points first, then the rest.

    On a terminal of less than 100 columns, H and V stand in words, and only where the requirement
    does not name its point.
    """
    from rich.table import Table
    from rich.text import Text

    narrow = width < _NARROW
    angles = () if narrow else ("H °", "V °")
    table = Table(box=None, header_style="bold", pad_edge=False, padding=(0, 1 - narrow, 0, 1))
    for heading in (*angles, "got", "2 σ", "required", "margin", "", "requirement"):
        numeric = heading not in ("", "requirement")
        table.add_column(heading, justify="right" if numeric else "left", no_wrap=numeric)
    verdict = function.verdict
    if verdict is None:
        return table
    points = points_of(verdict, function.observed)
    ordered = [finding for point in points for finding in point.findings]
    others = gathered(elsewhere(verdict, function.observed))
    for finding, count in [*((finding, 1) for finding in ordered), *others]:
        mark = MARKS[finding.outcome]
        many = f"worst of {count} directions" if count > 1 else ""
        where = place(finding) if narrow and " at " not in finding.requirement else ""
        notes = [finding.requirement, where, many, finding.remark, more_paths(finding)]
        h_deg, v_deg = finding.h_deg, finding.v_deg
        directions = ["" if own is None else angle(own) for own in (h_deg, v_deg)]
        table.add_row(
            *([] if narrow else directions),
            Text(got(finding)),
            two_sigma(finding),
            Text(required(finding)),
            margin(finding),
            Text(f"{mark.sign} {mark.word}", style=STYLES[finding.outcome]),
            Text(printable("; ".join(filter(None, notes)))),
        )
    return table


def spots_table(observed: Observed) -> Table:
    """Return the intensities at the spots of a function without a rule, for the terminal."""
    from rich.table import Table

    table = Table(box=None, header_style="bold", pad_edge=False)
    for heading in ("H °", "V °", "cd", "2 σ"):
        table.add_column(heading, justify="right", no_wrap=True)
    columns = (
        observed.spot_h_deg, observed.spot_v_deg, observed.spot_cd, observed.spot_standard_error_cd,
    )  # fmt: skip
    for h, v, intensity, error in zip(*columns, strict=True):
        table.add_row(
            angle(float(h)), angle(float(v)), cd(float(intensity)), spread(2.0 * float(error))
        )
    return table


#: How an outcome looks in a terminal.
STYLES: dict[Outcome, str] = {"pass": "green", "undecided": "bold yellow", "fail": "bold red"}

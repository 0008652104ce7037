# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From what was observed and a rule to what is shown of a function."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from lamplit.report.photometry.results import ColourRegion, FunctionResults
from lamplit.rules import judge
from lamplit.rules.extents import visibility_boxes
from lamplit.rules.judge_colour import colour_region

if TYPE_CHECKING:
    from lamplit.photometry.observed import Observed
    from lamplit.report.photometry.results import Spectrum
    from lamplit.rules import Rule


def judged(
    observed: Observed,
    rule: Rule | None,
    *,
    others: Mapping[str, Observed] | None = None,
    production: bool = False,
    spectrum: Spectrum | None = None,
) -> FunctionResults:
    """Return ``observed`` with the verdict of ``rule``, its region of colour and its field.

    Raises:
        RuleError: A spot of the rule was not measured, or the rule has no value for its options.
    """
    if rule is None:
        return FunctionResults(observed, spectrum=spectrum)
    region = colour_region(rule)
    return FunctionResults(
        observed,
        judge(rule, observed, others=others, production=production),
        None if region is None else ColourRegion(region.title, region.border),
        tuple(_fields(rule)),
        spectrum,
    )


def _fields(rule: Rule) -> Iterator[tuple[float, float, float, float]]:
    """Yield the ranges of H and V in which the lamp must be visible, what lies on top joined."""
    for own in rule.entry.field:
        if not rule.holds(own.when):
            continue
        boxes = visibility_boxes(own, rule).boxes
        sides = {(box.left_deg, box.right_deg) for box in boxes}
        for left, right in sorted(sides):
            stack = [box for box in boxes if (box.left_deg, box.right_deg) == (left, right)]
            yield (
                left,
                right,
                min(box.bottom_deg for box in stack),
                max(box.top_deg for box in stack),
            )

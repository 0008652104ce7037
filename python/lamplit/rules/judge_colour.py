# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The colour in each direction measured, against a region and its border."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamplit.colour.tristimulus import chromaticity_xy
from lamplit.rules.case import Case
from lamplit.rules.choices import chosen_name
from lamplit.rules.colour import Region, build_region, chromaticity_covariance, region
from lamplit.rules.decide import SIGMAS, least_trusted
from lamplit.rules.models import ColourRule
from lamplit.rules.rule import Rule
from lamplit.rules.verdict import Finding


def colour_region(rule: Rule) -> Region | None:
    """Return the region that a rule asks for; None where it asks for none.

    Raises:
        RuleError: The rule gives none for the options chosen.
    """
    own = rule.entry.colour
    if own is None:
        return None
    name = chosen_name(own.region, rule.options)
    written = rule.rules.file.colours.get(name)
    return region(name) if written is None else build_region(name, written)


def judge_colour(case: Case, own: ColourRule) -> Iterator[Finding]:
    """Yield a finding for each spot that light reaches: how far inside the border its colour is.

    ``got`` is the distance to the border in x, y, below 0 outside. Where the ellipse of 2 standard
    errors crosses the border, the finding is undecided. Without light there is no colour.
    """
    wanted = colour_region(case.rule)
    if wanted is None:
        return
    observed = case.observed
    for at, (h, v) in enumerate(zip(observed.spot_h_deg, observed.spot_v_deg, strict=True)):
        xyz = observed.spot_xyz[at]
        if float(xyz.sum()) <= 0.0 or xyz[1] <= 0.0:
            continue
        xy = chromaticity_xy(xyz)
        covariance = chromaticity_covariance(xyz, observed.spot_xyz_covariance[at])
        border = wanted.border_distance(xy, covariance)
        exact = not np.any(covariance)
        near = not exact and border.sigmas <= SIGMAS
        factor = None
        if near:
            factor = (SIGMAS / border.sigmas) ** 2 if border.sigmas > 0.0 else float("inf")
        yield Finding(
            requirement=f"colour: {wanted.title}",
            clause=f"{own.clause}; {wanted.clause}",
            trust=least_trusted(own.trust, wanted.trust),
            h_deg=float(h),
            v_deg=float(v),
            sense=None,
            required=None,
            got=border.distance,
            standard_error=0.0 if exact else border.standard_error,
            unit="xy",
            margin_percent=None,
            outcome="undecided" if near else "pass" if wanted.contains(xy) else "fail",
            paths_factor=factor,
            remark=f"x {xy[0]:.4f}, y {xy[1]:.4f}; nearest border: {border.edge}",
        )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The colour in each direction measured, against a region and its border."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamplit.photometry.observed import COLOUR_SIGMAS
from lamplit.rules.case import Case
from lamplit.rules.choices import chosen_name
from lamplit.rules.colour import Region, build_region, region
from lamplit.rules.decide import SIGMAS, least_trusted
from lamplit.rules.models import ColourRule
from lamplit.rules.rule import Rule
from lamplit.rules.verdict import Finding, Outcome

Array = NDArray[np.float64]


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
    errors crosses the border, the finding is undecided. So it is where the intensity is not known
    to 5 σ, and ``got`` then is that intensity: the colour of a handful of paths says nothing, nor
    does its scatter. Without light there is no colour.
    """
    wanted = colour_region(case.rule)
    if wanted is None:
        return
    observed = case.observed
    colours = observed.spot_colours
    for at in np.flatnonzero(observed.spot_cd > 0.0):
        if colours.is_known[at]:
            found = _by_border(wanted, colours.xy[at], colours.covariance[at])
        else:
            found = _too_dim(observed.spot_cd[at], observed.spot_standard_error_cd[at])
        yield Finding(
            requirement=f"colour: {wanted.title}",
            clause=f"{own.clause}; {wanted.clause}",
            trust=least_trusted(own.trust, wanted.trust),
            h_deg=float(observed.spot_h_deg[at]),
            v_deg=float(observed.spot_v_deg[at]),
            sense=None,
            required=None,
            margin_percent=None,
            **found._asdict(),
        )


class _Found(NamedTuple):
    """What is found of one colour; see `Finding`."""

    got: float
    standard_error: float
    unit: str
    outcome: Outcome
    paths_factor: float | None
    remark: str


def _by_border(wanted: Region, xy: Array, covariance: Array) -> _Found:
    border = wanted.border_distance(xy, covariance)
    exact = not np.any(covariance)
    near = not exact and border.sigmas <= SIGMAS
    factor = None
    if near:
        factor = (SIGMAS / border.sigmas) ** 2 if border.sigmas > 0.0 else float("inf")
    return _Found(
        got=border.distance,
        standard_error=0.0 if exact else border.standard_error,
        unit="xy",
        outcome="undecided" if near else "pass" if wanted.contains(xy) else "fail",
        paths_factor=factor,
        remark=f"x {xy[0]:.4f}, y {xy[1]:.4f}; nearest border: {border.edge}",
    )


def _too_dim(intensity_cd: float, standard_error_cd: float) -> _Found:
    return _Found(
        got=float(intensity_cd),
        standard_error=float(standard_error_cd),
        unit="cd",
        outcome="undecided",
        paths_factor=float((COLOUR_SIGMAS * standard_error_cd / intensity_cd) ** 2),
        remark=f"too few paths for a colour: the intensity is not above {COLOUR_SIGMAS:g} σ",
    )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Whether the tables of a rule file fit each other."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from itertools import pairwise, product
from math import prod

from lamplit.errors import RuleError, nearest_name
from lamplit.rules.choices import (
    NumbersBy,
    choices_within,
    chosen_number,
    chosen_numbers,
    names_within,
)
from lamplit.rules.colour import check_region, region_names
from lamplit.rules.extents import inside, maximum_boxes
from lamplit.rules.models import Distribution, Entry, Grid, Maximum, RuleFile
from lamplit.rules.points import TestPoint, grid_points, point_name
from lamplit.rules.rule import Rule, RuleSet

_MOST_COMBINATIONS = 4096
_BETWEEN = ("no", "cells", "neighbours")


def check_rules(rules: RuleSet) -> None:
    """Refuse a rule file whose names lead nowhere, or whose values contradict each other.

    Raises:
        RuleError: With the key path, what is wrong and what to do.
    """
    file = rules.file
    for name, region in file.colours.items():
        check_region(region, where=f"colours.{name}")
    for name, entry in file.entries.items():
        where = f"entries.{name}"
        _check_options(file, entry, where)
        _check_names(file, entry, where)
        for at, own in enumerate(entry.distribution):
            _check_distribution(file, own, f"{where}.distribution[{at}]")
        _check_ratios(file, entry, where)
        _check_sides(file, entry, where)
        for rule in _combinations(rules.entry(name), where):
            _check_minima(rule, where)


def _named(name: str, known: Collection[str], kind: str, where: str) -> None:
    if name not in known:
        near = nearest_name(name, known) or f"; there are {', '.join(known) or 'none'}"
        raise RuleError(f"there is no {kind} {name[:60]!r}{near}", where=where)


def _check_options(file: RuleFile, entry: Entry, where: str) -> None:
    for path, own in choices_within(entry, where):
        _named(own.by, file.options, "option", f"{path}.by")
        for choice in own.of:
            _named(choice, file.options[own.by].choices, f"choice of {own.by}", f"{path}.of")
    for path, when in _conditions(entry):
        for key, choice in when.items():
            _named(key, file.options, "option", f"{where}.{path}.when")
            _named(choice, file.options[key].choices, f"choice of {key}", f"{where}.{path}.when")


def _conditions(entry: Entry) -> Iterator[tuple[str, Mapping[str, str]]]:
    for key in ("distribution", "maximum", "zone", "field", "ratio"):
        for at, own in enumerate(getattr(entry, key)):
            yield f"{key}[{at}]", own.when


def _check_names(file: RuleFile, entry: Entry, where: str) -> None:
    if entry.colour is not None:
        known = {*region_names(), *file.colours}
        for name in names_within(entry.colour.region):
            _named(name, known, "colour region", f"{where}.colour.region")
    for at, own in enumerate(entry.distribution):
        here = f"{where}.distribution[{at}]"
        for name in names_within(own.grid):
            _named(name, file.grids, "grid", f"{here}.grid")
        for name in names_within(own.between):
            _named(name, _BETWEEN, "rule between points", f"{here}.between")
        if own.groups is not None:
            _named(own.groups, file.groupings, "grouping", f"{here}.groups")
    for at, own in enumerate(entry.ratio):
        for name in () if own.grid is None else names_within(own.grid):
            _named(name, file.grids, "grid", f"{where}.ratio[{at}].grid")


def _check_distribution(file: RuleFile, own: Distribution, where: str) -> None:
    for name in names_within(own.grid):
        grid = file.grids[name]
        if grid.unit == "1" or (grid.unit == "%") != (own.minimum_cd is not None):
            raise RuleError(
                f"grid {name!r} is in {grid.unit}: minimum_cd belongs to a grid in %, which "
                "needs it, and a grid in cd goes without",
                where=f"{where}.minimum_cd",
            )
        if "cells" in names_within(own.between):
            _check_cells(grid, name, where)
        if own.groups is not None:
            _check_groups(file, own, name, where)


def _check_cells(grid: Grid, name: str, where: str) -> None:
    filled = {(h, v) for h, v, _ in grid_points(grid)}
    for left, right in pairwise(grid.h_deg):
        for top, bottom in pairwise(grid.v_deg):
            if not filled & {(h, v) for h in (left, right) for v in (bottom, top)}:
                raise RuleError(
                    f"grid {name!r} shows no value on the lines round the cell of H {left:g} to "
                    f"{right:g}, V {bottom:g} to {top:g}; fill it, or set between = 'neighbours'",
                    where=f"{where}.between",
                )


def _check_groups(file: RuleFile, own: Distribution, grid: str, where: str) -> None:
    grouping = own.groups or ""
    groups = file.groupings[grouping].groups
    names = {point_name(h, v) for h, v, _ in grid_points(file.grids[grid])}
    for at, members in enumerate(groups):
        for member in members:
            _named(member, names, f"point of grid {grid!r}", f"groupings.{grouping}[{at}]")
    listed = [member for members in groups for member in members]
    if len(set(listed)) != len(listed):
        raise RuleError("a point stands in two groups", where=f"groupings.{grouping}")
    for sums in _lists(own.sums_cd):
        if len(sums) != len(groups):
            raise RuleError(
                f"{len(sums)} sums are given for the {len(groups)} groups of {grouping!r}",
                where=f"{where}.sums_cd",
            )


def _lists(value: list[float] | NumbersBy | None) -> Iterator[list[float]]:
    if isinstance(value, NumbersBy):
        for inner in value.of.values():
            yield from _lists(inner)
    elif value is not None:
        yield value


def _check_ratios(file: RuleFile, entry: Entry, where: str) -> None:
    for at, own in enumerate(entry.ratio):
        for name in () if own.grid is None else names_within(own.grid):
            if file.grids[name].unit != "1":
                raise RuleError(
                    f"grid {name!r} is in {file.grids[name].unit}, and ratios have unit '1'",
                    where=f"{where}.ratio[{at}].grid",
                )


def _check_sides(file: RuleFile, entry: Entry, where: str) -> None:
    wanted = any(own.inboard_deg != own.outboard_deg for own in entry.field)
    wanted = wanted or any(own.toward == "outboard" for own in entry.maximum)
    sides = file.options["side"].choices if "side" in file.options else []
    if wanted and not {"left", "right"} <= {*sides}:
        raise RuleError(
            "what differs inboard and outboard needs an option side with the choices "
            "'either', 'left', 'right'",
            where=where,
        )


def _combinations(rule: Rule, where: str) -> Iterator[Rule]:
    """Yield the rule under every combination of the options that it depends on."""
    used = {own.by for _, own in choices_within(rule.entry)}
    used |= {key for _, when in _conditions(rule.entry) for key in when}
    choices = [rule.rules.file.options[key].choices for key in used]
    if prod(len(own) for own in choices) > _MOST_COMBINATIONS:
        raise RuleError(
            f"it depends on {len(used)} options with more than {_MOST_COMBINATIONS} combinations",
            where=where,
        )
    for chosen in product(*choices):
        yield rule.under(**dict(zip(used, chosen, strict=True)))


def _check_minima(rule: Rule, where: str) -> None:
    """Refuse a minimum above a maximum in the same direction."""
    try:
        points = rule.points()
        for own in rule.entry.distribution:
            if own.sums_cd is not None:
                chosen_numbers(own.sums_cd, rule.options)
    except RuleError:
        # What is chosen has no value: `under` lets it be chosen, and judging it says so.
        return
    for at, own in enumerate(rule.entry.maximum):
        if not rule.holds(own.when):
            continue
        for point in points:
            try:
                most = chosen_number(own.cd, rule.options)
            except RuleError:
                break
            if point.minimum_cd > most and _applies(own, point, rule):
                chosen = ", ".join(f"{key} = {value}" for key, value in rule.options.items())
                raise RuleError(
                    f"the minimum of {point.minimum_cd:g} cd at {point.name} is above the maximum "
                    f"of {most:g} cd" + (f" ({chosen})" if chosen else ""),
                    where=f"{where}.maximum[{at}].cd",
                )


def _applies(own: Maximum, point: TestPoint, rule: Rule) -> bool:
    return any(inside(box, point.h_deg, point.v_deg) for box in maximum_boxes(own, rule.side))

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The functions and reflectors that are measured, each with its rule under its options."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import LamplitError, nearest_name
from lamplit.rules import GridNeed, ReflexAngles, Rule, find_rule

if TYPE_CHECKING:
    from lamplit.scene import Scene
    from lamplit.scene.measuring import LampFunction

Array = NDArray[np.float64]

#: What a lamp is called that is measured with all its light and without functions.
ALL_LIGHT = "all light"
#: The grid where no rule asks for one: H and V in degrees, and the size of its cells.
_GRID = GridNeed((-45.0, 45.0), (-15.0, 15.0), 1.0)
#: The function that a rule is named for, before the first "=": RULE has one in its options only.
_FOR_FUNCTION = re.compile(r"([^=/?]+)=(.+)")


@dataclass(frozen=True)
class Asked:
    """A function to be measured."""

    name: str
    #: Weight of each light group; empty: all, once each.
    light: Mapping[str, float]
    rule: Rule | None = None
    #: Name of the function that its rule's ratios are taken to.
    with_position: str | None = None


@dataclass(frozen=True)
class AskedReflector:
    """A retro-reflector to be measured."""

    name: str
    rule: Rule | None
    angles: tuple[ReflexAngles, ...]
    source_deg: float
    receiver_deg: float


def asked_functions(scene: Scene, *, rules: Sequence[str] = ()) -> tuple[Asked, ...]:
    """Return the functions of ``scene``, or all its light as one if it has no reflectors either.

    ``rules`` are RULE, for every function or reflector that it is about, or NAME=RULE; they take
    the place of the scene's.

    Raises:
        LamplitError: A rule, option or function is not known, or a rule measures no lamp.
    """
    settings = scene.measure
    functions = () if settings is None else settings.functions
    named = _named_rules(scene, rules)
    if functions:
        return tuple(
            Asked(
                own.name,
                own.light,
                _rule(scene, named.get(own.name, own.rule), own),
                own.with_position,
            )
            for own in functions
        )
    if settings is not None and settings.reflectors:
        return ()
    return (Asked(ALL_LIGHT, {}, _rule(scene, named.get(ALL_LIGHT), None)),)


def asked_reflectors(scene: Scene, *, rules: Sequence[str] = ()) -> tuple[AskedReflector, ...]:
    """Return the retro-reflectors of ``scene`` with the angles that their rules ask for.

    Raises:
        LamplitError: A rule, option or reflector is not known, or a rule is one for lamps.
    """
    named = _named_rules(scene, rules)
    found: list[AskedReflector] = []
    for own in () if scene.measure is None else scene.measure.reflectors:
        text = named.get(own.name, own.rule)
        rule = None if text is None else find_rule(text, root=scene.root)
        if rule is not None and not rule.reflex():
            raise LamplitError(
                f"{rule.id} is a rule for lamps, and {own.name!r} is a retro-reflector",
                file=scene.path,
            )
        angles = rule.reflex_angles() if rule is not None else tuple(
            ReflexAngles(v, h, observation)
            for observation in own.observation_deg
            for v, h in own.entrance_deg
        )  # fmt: skip
        found.append(AskedReflector(own.name, rule, angles, own.source_deg, own.receiver_deg))
    return tuple(found)


def directions(functions: Sequence[Asked]) -> tuple[Array, tuple[Array, Array]]:
    """Return all that must be measured: H and V of spots (p, 2), and the borders of the grid.

    HV is always among the spots. The grid covers what all rules ask for, with the finest cells
    that one asks for, and 0 is a border of cells.
    """
    spots = [(0.0, 0.0)]
    needs: list[GridNeed] = []
    for one in functions:
        if one.rule is not None:
            spots += zip(*(axis.tolist() for axis in one.rule.spots()), strict=True)
            needs.append(one.rule.field())
    needs = needs or [_GRID]
    cell = min(need.cell_deg for need in needs)
    h = _edges([need.h_deg for need in needs], cell)
    v = _edges([need.v_deg for need in needs], cell)
    return np.array(list(dict.fromkeys(spots))), (h, v)


def _edges(ranges: Sequence[tuple[float, float]], cell: float) -> Array:
    """Return borders that are whole cells away from 0 and cover all ``ranges``, in degrees."""
    first = math.floor(min(low for low, _ in ranges) / cell + 1e-9)
    last = math.ceil(max(high for _, high in ranges) / cell - 1e-9)
    if first == last:
        first, last = first - 1, last + 1
    return np.arange(first, last + 1, dtype=np.float64) * cell


def _named_rules(scene: Scene, rules: Sequence[str]) -> dict[str, str]:
    """Return the rules by the functions and reflectors that they are named for, or are about."""
    functions = [own.name for own in (scene.measure.functions if scene.measure else ())]
    reflectors = [own.name for own in (scene.measure.reflectors if scene.measure else ())]
    if not (functions or reflectors):
        functions = [ALL_LIGHT]
    names = [*functions, *reflectors]
    found: dict[str, str] = {}
    for text in rules:
        match = _FOR_FUNCTION.fullmatch(text.strip())
        if match is None:
            rule = find_rule(text.strip(), root=scene.root)
            about, others = (reflectors, "retro-reflectors") if rule.reflex() else (
                functions, "lit functions",
            )  # fmt: skip
            if not about:
                key = "reflectors" if rule.reflex() else "functions"
                raise LamplitError(
                    f"{rule.id} is a rule for {others}, and the scene has none; "
                    f"add [[measure.{key}]] to it",
                    where="--rule",
                )
            found |= dict.fromkeys(about, text.strip())
            continue
        name = match[1].strip()
        if name not in names:
            near = nearest_name(name, names) or f"; it has {', '.join(names)}"
            raise LamplitError(
                f"the lamp has no function or reflector {name[:60]!r}{near}", where="--rule"
            )
        found[name] = match[2].strip()
    return found


def _rule(scene: Scene, text: str | None, function: LampFunction | None) -> Rule | None:
    """Return the rule under what the scene says of the function.

    Raises:
        LamplitError: There is no such rule, or it is one for retro-reflectors.
    """
    if text is None:
        return None
    rule = find_rule(text, root=scene.root)
    if rule.reflex():
        raise LamplitError(
            f"{rule.id} is a rule for retro-reflectors, which shine by other light; "
            "name it in [[measure.reflectors]]",
            file=scene.path,
        )
    if function is None:
        return rule
    said = {"sections": function.sections, "assembly": function.assembly, "side": function.side}
    options = text.partition("?")[2]
    kept = {key: choice for key, choice in said.items() if f"{key}=" not in options}
    return rule.where_known(**kept)

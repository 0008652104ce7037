# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The luminous flux of signal-lamp bulbs, as their sheets of UN R37 state it at test voltage.

Marks of trust: V, read in the cited sheet; V2, read in a text that cites it; M, from memory. The
official sheets were not at hand.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias, get_args

BulbName: TypeAlias = Literal[
    "p21w",
    "p21-5w-bright",
    "p21-5w-dim",
    "py21w",
    "py21-5w-bright",
    "py21-5w-dim",
    "w5w",
]


@dataclass(frozen=True)
class Bulb:
    """A filament of a bulb: its flux at the test voltage, and how far bulbs differ from it."""

    name: BulbName
    description: str
    flux_lm: float
    #: As a share: 0.15 is ±15 %.
    tolerance: float
    test_voltage_v: float
    #: Where the flux and the tolerance come from, each with its mark of trust.
    reference: str


_SHEET: Final = "97/24/EC annex, sheet P21/5W: flux and tolerance V"
_GRE: Final = "GRE/2012/34, sheet PY21/5W: flux and tolerance V"
_LIST: Final = "list of parts on GitHub: flux V2; tolerance M"
_AMBER: Final = "through its amber glass; a scene gives that colour as source"


def _bulbs() -> tuple[Bulb, ...]:
    return (
        Bulb("p21w", "P21W, 12 V 21 W", 460.0, 0.15, 13.5, "usledbulbs.com: flux V2; tolerance M"),
        Bulb("p21-5w-bright", "P21/5W, filament of 21 W", 440.0, 0.15, 13.5, _SHEET),
        Bulb("p21-5w-dim", "P21/5W, filament of 5 W", 35.0, 0.2, 13.5, _SHEET),
        Bulb("py21w", f"PY21W, 12 V 21 W, {_AMBER}", 280.0, 0.2, 13.5, _LIST),
        Bulb("py21-5w-bright", f"PY21/5W, 21 W, {_AMBER}", 270.0, 0.2, 13.5, _GRE),
        Bulb("py21-5w-dim", f"PY21/5W, 5 W, {_AMBER}", 21.0, 0.2, 13.5, _GRE),
        Bulb("w5w", "W5W, 12 V 5 W", 50.0, 0.2, 13.5, _LIST),
    )


_LIBRARY: Final[dict[str, Bulb]] = {bulb.name: bulb for bulb in _bulbs()}


def bulb_names() -> tuple[BulbName, ...]:
    """Return the names of the bulbs, a filament each.

    >>> bulb_names()[0]
    'p21w'
    """
    return get_args(BulbName)


def bulb(name: str) -> Bulb:
    """Return the bulb's filament of this name, one of `bulb_names`; KeyError for others.

    >>> bulb("p21w").flux_lm
    460.0
    """
    return _LIBRARY[name]

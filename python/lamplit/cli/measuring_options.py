# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The options that `measure` and `report` share, and what they say together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lamplit.cli.options import SeedOption, SetOption, ThreadsOption
from lamplit.errors import LamplitError

if TYPE_CHECKING:
    from lamplit.scene import Scene

#: With --until-decided alone, no more paths than these: what lies on a limit is never decided.
_MOST_UNDECIDED = 1 << 30
#: What --distance says instead of a number.
_FAR = "far"

RuleOption = Annotated[
    list[str] | None,
    typer.Option(
        "--rule",
        metavar="[FUNCTION=]RULE",
        help="What the lamp, or one function of it, has to meet, such as un-r148/S1 or "
        "un-r148/S2?period=night, instead of the scene's; may be repeated.",
    ),
]
PathsOption = Annotated[
    int | None, typer.Option("--paths", min=1, help="Paths of light to walk, at most.")
]
ErrorOption = Annotated[
    float | None,
    typer.Option(
        "--error",
        metavar="SHARE",
        help="Walk until the relative standard error at the bright test points is this: 0.01 is "
        "1 %.",
    ),
]
TimeOption = Annotated[
    float | None, typer.Option("--time", metavar="SECONDS", help="Walk for so long, at most.")
]
UntilDecidedOption = Annotated[
    bool,
    typer.Option(
        "--until-decided",
        help="Walk until no limit lies within 2 sigma of what was measured; --time or --paths "
        "sets an end, else it is a thousand million paths.",
    ),
]
DistanceOption = Annotated[
    str | None,
    typer.Option(
        "--distance",
        metavar="M",
        help="Distance of the receiver in m, or far for the far field, instead of the scene's.",
    ),
]
ReceiverOption = Annotated[
    float | None,
    typer.Option(
        "--receiver",
        metavar="DEG",
        help="Full angle that the receiver subtends, 1/6 to 1, instead of the scene's.",
    ),
]
ProductionOption = Annotated[
    bool,
    typer.Option(
        "--production", help="Judge as a lamp from the line: limits of conformity of production."
    ),
]


@dataclass(frozen=True)
class Budget:
    """How long to walk."""

    paths: int | None = None
    error: float | None = None
    time_s: float | None = None
    until_decided: bool = False

    @property
    def most_paths(self) -> int | None:
        """The most paths to walk; None for no end but the time or the error."""
        from lamplit.engine.measuring_run import USUAL_PATHS

        if self.paths is not None or self.error is not None or self.time_s is not None:
            return self.paths
        return _MOST_UNDECIDED if self.until_decided else USUAL_PATHS


@dataclass(frozen=True)
class Wanted:
    """What is to be measured."""

    place: Path
    rules: Sequence[str] = ()
    distance: str | None = None
    receiver_deg: float | None = None
    production: bool = False
    seed: int | None = None
    assignments: Sequence[str] = ()
    #: Whether both ways, from the light and from the receiver, are to be shown.
    cross_check: bool = False

    def load(self) -> Scene:
        """Return the scene with what the options change in it.

        Raises:
            LamplitError: The scene or an option cannot be used.
        """
        from lamplit.cli.overrides import overrides, scene_file
        from lamplit.engine.looking import check_visible
        from lamplit.scene import load_scene

        changed = overrides(assignments=self.assignments, seed=self.seed)
        scene = load_scene(scene_file(self.place), overrides=changed)
        if self.cross_check:
            check_visible(scene)
        return scene

    @property
    def distance_m(self) -> float | None:
        """The receiver's distance, infinite for the far field; None: as the scene says.

        Raises:
            LamplitError: It is no distance.
        """
        if self.distance is None or self.distance == _FAR:
            return None if self.distance is None else math.inf
        try:
            value = float(self.distance)
        except ValueError:
            value = math.nan
        if not (math.isfinite(value) and value > 0.0):
            raise LamplitError(
                f"{self.distance!r} is no distance; write m such as 10, or far", where="--distance"
            )
        return value

    @property
    def checked_receiver_deg(self) -> float | None:
        """The receiver's full angle in degrees; None: as the scene says.

        Raises:
            LamplitError: No regulation has such a receiver.
        """
        from lamplit.scene.measuring import LARGEST_RECEIVER_DEG, SMALLEST_RECEIVER_DEG

        value = self.receiver_deg
        smallest, largest = SMALLEST_RECEIVER_DEG - 1e-4, LARGEST_RECEIVER_DEG
        if value is not None and not smallest <= value <= largest:
            raise LamplitError(
                f"a receiver subtends 1/6° (0.1667) to 1°, not {value:g}°", where="--receiver"
            )
        return value


@dataclass(frozen=True)
class MeasuringOptions:
    """What the command line says of a measurement: its rules, its budget, its receivers."""

    rule: RuleOption = None
    paths: PathsOption = None
    error: ErrorOption = None
    time: TimeOption = None
    until_decided: UntilDecidedOption = False
    distance: DistanceOption = None
    receiver: ReceiverOption = None
    production: ProductionOption = False
    seed: SeedOption = None
    threads: ThreadsOption = None
    set_: SetOption = None

    @property
    def budget(self) -> Budget:
        """How long to walk."""
        return Budget(self.paths, self.error, self.time, self.until_decided)

    def wanted(self, place: Path, *, cross_check: bool = False) -> Wanted:
        """Return what is to be measured of the scene at ``place``."""
        return Wanted(
            place,
            self.rule or (),
            self.distance,
            self.receiver,
            self.production,
            self.seed,
            self.set_ or (),
            cross_check,
        )

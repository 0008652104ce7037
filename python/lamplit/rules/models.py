# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The tables of a rule file."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import Field, model_validator

from lamplit.rules.choices import (
    NameChoice,
    NotNegative,
    Number,
    NumberChoice,
    NumbersChoice,
    Positive,
    Table,
    Text,
)

#: Read in the cited text; in a transcription that cites the original; computed; from memory.
Trust: TypeAlias = Literal["V", "V2", "N", "M"]
Angle: TypeAlias = Annotated[float, Field(allow_inf_nan=False, ge=-180.0, le=180.0)]
Percent: TypeAlias = Annotated[float, Field(allow_inf_nan=False, ge=0.0, le=100.0)]
Span: TypeAlias = Annotated[tuple[Angle, Angle], Field(strict=False)]
Pair: TypeAlias = Annotated[tuple[Angle, Angle], Field(strict=False)]
When: TypeAlias = Annotated[
    dict[str, str],
    Field(default_factory=dict, description="options and the choices under which this holds"),
]


class Sourced(Table):
    """What comes from a document: its clause, and how far the figure can be trusted."""

    clause: Annotated[Text, Field(description="clause, table or figure of the document")]
    trust: Annotated[Trust, Field(description="V, V2, N or M")]


class Option(Table):
    """Something about the lamp or its mounting that a rule depends on; the first is the default."""

    description: Annotated[Text, Field(description="what is chosen")]
    choices: Annotated[list[Text], Field(min_length=1, description="the first is the default")]


class Grid(Sourced):
    """A table of values over H and V, as a figure prints it; "-" where it is empty."""

    unit: Annotated[Literal["%", "cd", "1"], Field(description="%, cd, or 1 for ratios")]
    h_deg: Annotated[list[Angle], Field(min_length=1, description="columns, ascending")]
    v_deg: Annotated[list[Angle], Field(min_length=1, description="rows, descending")]
    rows: list[list[NotNegative | Literal["-"]]]

    @model_validator(mode="after")
    def _is_whole(self) -> Grid:
        if any(a >= b for a, b in pairwise(self.h_deg)):
            raise ValueError("h_deg must ascend from column to column")
        if any(a <= b for a, b in pairwise(self.v_deg)):
            raise ValueError("v_deg must descend from row to row, as a figure has up on top")
        if len(self.rows) != len(self.v_deg):
            raise ValueError(
                f"there are {len(self.rows)} rows, and v_deg has {len(self.v_deg)} entries"
            )
        for at, row in enumerate(self.rows):
            if len(row) != len(self.h_deg):
                raise ValueError(
                    f"rows[{at}] has {len(row)} values, and h_deg has {len(self.h_deg)}; "
                    "write '-' where the figure is empty"
                )
        if all(value == "-" for row in self.rows for value in row):
            raise ValueError("the grid holds no value")
        return self


class Grouping(Table):
    """Which test points are summed, by names such as H-V, 5U-10L."""

    groups: Annotated[list[Annotated[list[Text], Field(min_length=1)]], Field(min_length=1)]


class Distribution(Sourced):
    """Minima at the points of a grid, and what holds between them."""

    grid: NameChoice
    minimum_cd: Annotated[NumberChoice | None, Field(description="100 % of a grid in %")] = None
    significant_digits: Annotated[
        int | None, Field(ge=1, le=9, description="minima are rounded down to so many digits")
    ] = None
    rule: Literal["each", "floor", "point-or-group"] = "each"
    floor_percent: Percent | None = None
    groups: Annotated[Text | None, Field(description="name of a grouping")] = None
    sums_cd: Annotated[NumbersChoice | None, Field(description="one minimum a group")] = None
    between: Annotated[NameChoice, Field(description="no, cells or neighbours")] = "no"
    between_percent: Percent = 100.0
    down_to_deg: Annotated[
        NumberChoice | None, Field(description="how far below H the points reach, in degrees")
    ] = None
    below_that: Annotated[
        Literal["left-out", "moved-up"], Field(description="what becomes of lower points")
    ] = "left-out"
    when: When

    @model_validator(mode="after")
    def _fits(self) -> Distribution:
        if (self.groups is None) != (self.sums_cd is None):
            raise ValueError("groups and sums_cd belong together")
        if self.rule != "each" and self.groups is None:
            raise ValueError(f"rule = {self.rule!r} needs groups and sums_cd")
        if (self.rule == "floor") != (self.floor_percent is not None):
            raise ValueError("floor_percent belongs to rule = 'floor', and must be there")
        return self


class Maximum(Sourced):
    """What may not be exceeded in a range of directions, or at the grids' points in it."""

    cd: NumberChoice
    where: Literal["everywhere", "points"] = "everywhere"
    h_deg: Span = (-90.0, 90.0)
    v_deg: Span = (-90.0, 90.0)
    toward: Annotated[
        Literal["as-written", "outboard", "both"],
        Field(description="outboard: H counts outwards by the side of the car; both: mirrored too"),
    ] = "as-written"
    spot_radius_deg: Annotated[
        NotNegative, Field(description="a brighter spot smaller than this cone is let through")
    ] = 0.0
    optional: Annotated[bool, Field(description="judged only where the grid reaches")] = False
    when: When


class Zone(Sourced):
    """A minimum in every direction of a polygon."""

    cd: NumberChoice
    polygon_deg: Annotated[list[Pair], Field(min_length=3, description="corners (H, V)")]
    when: When


class VisibilityField(Sourced):
    """A minimum over the field of geometric visibility, inboard and outboard by side of the car."""

    cd: NumberChoice
    inboard_deg: NumberChoice
    outboard_deg: NumberChoice
    up_deg: NumberChoice
    down_deg: NumberChoice
    inboard_below_deg: Annotated[
        NumberChoice | None, Field(description="inboard angle below H, where it is another")
    ] = None
    when: When


class Ratio(Sourced):
    """How many times brighter than another function, in the same direction."""

    to: Annotated[Text, Field(description="the other function")]
    numerator: Annotated[Literal["both", "alone"], Field(description="both: lit together")]
    minimum: Annotated[NumberChoice | None, Field(description="everywhere in h_deg, v_deg")] = None
    grid: Annotated[NameChoice | None, Field(description="ratios point by point")] = None
    h_deg: Span = (-90.0, 90.0)
    v_deg: Span = (-90.0, 90.0)
    when: When

    @model_validator(mode="after")
    def _has_one(self) -> Ratio:
        if (self.minimum is None) == (self.grid is None):
            raise ValueError("either minimum or grid is expected")
        return self


class ColourRule(Sourced):
    """The region that the colour must lie in, in every direction measured."""

    region: Annotated[NameChoice, Field(description="a region of colours.toml, or of this file")]


class Reflex(Sourced):
    """Minima of a retro-reflector for one observation angle."""

    observation_deg: Positive
    unit: Literal["mcd/lx"] = "mcd/lx"
    entrance_deg: Annotated[list[Pair], Field(min_length=1, description="(V, H)")]
    minimum: Annotated[list[NotNegative], Field(min_length=1)]
    factor: NumberChoice = 1.0
    factor_trust: Trust | None = None

    @model_validator(mode="after")
    def _matches(self) -> Reflex:
        if len(self.entrance_deg) != len(self.minimum):
            raise ValueError(
                f"entrance_deg has {len(self.entrance_deg)} entries and minimum {len(self.minimum)}"
            )
        return self


class Entry(Table):
    """What one function of a lamp has to meet."""

    title: Text
    colour: ColourRule | None = None
    distribution: Annotated[list[Distribution], Field(default_factory=list)]
    maximum: Annotated[list[Maximum], Field(default_factory=list)]
    zone: Annotated[list[Zone], Field(default_factory=list)]
    field: Annotated[list[VisibilityField], Field(default_factory=list)]
    ratio: Annotated[list[Ratio], Field(default_factory=list)]
    reflex: Annotated[list[Reflex], Field(default_factory=list)]
    notes: Annotated[
        list[Text], Field(default_factory=list, description="what this file does not judge")
    ]


class Production(Sourced):
    """How far a lamp from the line may fall behind the type-approval limits."""

    deviation_percent: Percent
    field_minima: Annotated[
        list[Pair],
        Field(default_factory=list, description="minima of fields with a value of their own"),
    ]


class Tolerance(Sourced):
    """How far from a test point it may be met when the result is disputed."""

    deg: Positive


class Edge(Table):
    """One piece of a region's border: a line in x and y, the spectral locus, the purple line."""

    line: Annotated[
        Annotated[list[Number], Field(min_length=3, max_length=3)] | None,
        Field(description="[a, b, c] of a x + b y = c"),
    ] = None
    locus_nm: Annotated[tuple[Positive, Positive] | None, Field(strict=False)] = None
    purple_line: bool = False
    label: Text

    @model_validator(mode="after")
    def _has_one(self) -> Edge:
        if (self.line is not None) + (self.locus_nm is not None) + self.purple_line != 1:
            raise ValueError("one of line, locus_nm and purple_line = true is expected")
        if self.line is not None and self.line[0] == self.line[1] == 0.0:
            raise ValueError("a line needs an a or a b other than zero")
        return self


class ColourRegion(Sourced):
    """A region of the CIE 1931 chromaticity diagram, by its border in order."""

    title: Text
    edges: Annotated[list[Edge], Field(min_length=3)]


class RuleFile(Table):
    """A rule file."""

    lamplit_rules: Annotated[Literal[1], Field(description="version of this format: 1")]
    title: Text
    document: Annotated[Text, Field(description="the document that the values come from")]
    notices: Annotated[
        list[Text], Field(default_factory=list, description="what every verdict must say")
    ]
    cell_deg: Annotated[
        Positive, Field(ge=0.05, le=10.0, description="size of the cells to measure")
    ] = 1.0
    options: Annotated[dict[str, Option], Field(default_factory=dict)]
    grids: Annotated[dict[str, Grid], Field(default_factory=dict)]
    groupings: Annotated[dict[str, Grouping], Field(default_factory=dict)]
    colours: Annotated[dict[str, ColourRegion], Field(default_factory=dict)]
    production: Production | None = None
    tolerance: Tolerance | None = None
    entries: Annotated[dict[str, Entry], Field(default_factory=dict)]


@lru_cache(maxsize=1)
def rule_schema() -> dict[str, Any]:
    """Return the JSON Schema of a rule file."""
    return RuleFile.model_json_schema()

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Values of a rule that depend on an option, such as the number of lighted sections."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, TypeAlias, cast

from pydantic import BaseModel, ConfigDict, Field

from lamplit.errors import RuleError


class Table(BaseModel):
    """A table of a rule file: every key known, every value of its own type, none changed later."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


Text: TypeAlias = Annotated[str, Field(min_length=1, max_length=1000)]
Number: TypeAlias = Annotated[float, Field(allow_inf_nan=False)]
Positive: TypeAlias = Annotated[float, Field(allow_inf_nan=False, gt=0.0)]
NotNegative: TypeAlias = Annotated[float, Field(allow_inf_nan=False, ge=0.0)]


class NumberBy(Table):
    """A number for each choice of an option."""

    by: Annotated[Text, Field(description="the option that decides")]
    of: Annotated[
        dict[str, NumberChoice], Field(min_length=1, description="the value for each choice")
    ]


class NumbersBy(Table):
    """A list of numbers for each choice of an option."""

    by: Annotated[Text, Field(description="the option that decides")]
    of: Annotated[
        dict[str, NumbersChoice], Field(min_length=1, description="the values for each choice")
    ]


class NameBy(Table):
    """A name for each choice of an option."""

    by: Annotated[Text, Field(description="the option that decides")]
    of: Annotated[
        dict[str, NameChoice], Field(min_length=1, description="the name for each choice")
    ]


NumberChoice: TypeAlias = NotNegative | NumberBy
NumbersChoice: TypeAlias = list[NotNegative] | NumbersBy
NameChoice: TypeAlias = Text | NameBy

_By: TypeAlias = NumberBy | NumbersBy | NameBy


def chosen_number(value: float | NumberBy, chosen: Mapping[str, str]) -> float:
    """Return the number that holds under the options ``chosen``.

    Raises:
        RuleError: The rule gives none for what is chosen.
    """
    while isinstance(value, NumberBy):
        value = value.of[_choice(value, chosen)]
    return value


def chosen_numbers(value: list[float] | NumbersBy, chosen: Mapping[str, str]) -> list[float]:
    """Return the numbers that hold under the options ``chosen``.

    Raises:
        RuleError: The rule gives none for what is chosen.
    """
    while isinstance(value, NumbersBy):
        value = value.of[_choice(value, chosen)]
    return value


def chosen_name(value: str | NameBy, chosen: Mapping[str, str]) -> str:
    """Return the name that holds under the options ``chosen``.

    Raises:
        RuleError: The rule gives none for what is chosen.
    """
    while isinstance(value, NameBy):
        value = value.of[_choice(value, chosen)]
    return value


def _choice(value: _By, chosen: Mapping[str, str]) -> str:
    wanted = chosen[value.by]
    if wanted not in value.of:
        raise RuleError(
            f"for {value.by} = {wanted!r} the rule has no value; "
            f"choose {value.by} from {', '.join(value.of)}"
        )
    return wanted


def names_within(value: str | NameBy) -> Iterator[str]:
    """Yield every name that may be chosen."""
    if isinstance(value, str):
        yield value
        return
    for inner in value.of.values():
        yield from names_within(inner)


def choices_within(value: object, where: str = "") -> Iterator[tuple[str, _By]]:
    """Yield each ``by`` table inside the model or list ``value``, with its key path."""
    if isinstance(value, (NumberBy, NumbersBy, NameBy)):
        yield where, value
        for choice, inner in value.of.items():
            yield from choices_within(inner, f"{where}.of.{choice}")
    elif isinstance(value, Table):
        for key in type(value).model_fields:
            yield from choices_within(getattr(value, key), f"{where}.{key}" if where else key)
    elif isinstance(value, (list, tuple)):
        for at, inner in enumerate(cast("Sequence[object]", value)):
            yield from choices_within(inner, f"{where}[{at}]")

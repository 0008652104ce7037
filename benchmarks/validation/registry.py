# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What `make validate` holds true: a list of cases, each with an independent source.

To add a case, write a function in a module of this package that returns one or more `Finding`s,
mark it with `case`, and name the module in `MODULES`:

    @case("slab", title="T4: absorbing slab", source="Born & Wolf, 1.5", group="analytic")
    def slab() -> Iterator[Finding]:
        for angle_deg in (0, 40, 80):
            got, sigma = ...
            yield Finding(f"T at {angle_deg}°", expected=..., got=got, sigma=sigma)

`Finding` judges itself: by ``tolerance`` (absolute) where the answer is exact, by three ``sigma``
where it is an estimate, by both where both are given. A case that compares whole pictures gives
its own verdict by ``passed``.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass

#: Modules of this package that register cases, in the order of the page.
MODULES = ("closed_forms", "photometry", "lit_lamps", "against_mitsuba")

#: How many standard errors an estimate may lie from its expected value.
SIGMAS = 3.0


@dataclass(frozen=True)
class Finding:
    """One row of the page: a number that was expected, and the number that came out.

    ``sigma`` is the standard error (1σ) of ``got``; ``tolerance`` the absolute difference that the
    bar allows besides; ``unit`` and ``note`` are printed as they are.
    """

    quantity: str
    expected: float
    got: float
    sigma: float = 0.0
    tolerance: float = 0.0
    unit: str = ""
    note: str = ""
    #: None: the numbers above decide.
    passed: bool | None = None

    @property
    def holds(self) -> bool:
        """Whether the claim holds."""
        if self.passed is not None:
            return self.passed
        return abs(self.got - self.expected) <= self.tolerance + SIGMAS * self.sigma


@dataclass(frozen=True)
class Case:
    """A claim and how it is put to the test; ``key`` names it on the command line."""

    key: str
    title: str
    source: str
    group: str
    run: Callable[[], Iterable[Finding]]


_CASES: list[Case] = []


def case(
    key: str, *, title: str, source: str, group: str
) -> Callable[[Callable[[], Iterable[Finding]]], Callable[[], Iterable[Finding]]]:
    """Register the function below as a case; ``group`` heads its part of the page."""

    def register(run: Callable[[], Iterable[Finding]]) -> Callable[[], Iterable[Finding]]:
        add(Case(key, title, source, group, run))
        return run

    return register


def add(one: Case) -> None:
    """Register a case that was made in a loop.

    Raises:
        ValueError: A case of this key is there already.
    """
    if any(known.key == one.key for known in _CASES):
        raise ValueError(f"two validation cases are called {one.key!r}")
    _CASES.append(one)


def all_cases() -> tuple[Case, ...]:
    """Return every case of every module, in the order of the page."""
    for module in MODULES:
        importlib.import_module(f"validation.{module}")
    return tuple(_CASES)

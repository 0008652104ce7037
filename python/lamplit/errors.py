# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The errors that Lamplit raises for what a user can put right."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from pathlib import Path


class LamplitError(Exception):
    """A fault in what was asked for: the message says what, where, and what to do.

    ``message`` is one line; ``file`` and ``where`` (a key path such as ``lights[0].source``,
    or ``line 12``) say where the fault stands when that is known.
    """

    def __init__(
        self, message: str, *, file: str | Path | None = None, where: str | None = None
    ) -> None:
        super().__init__(message)
        self.message = " ".join(message.split())
        self.file = None if file is None else Path(file)
        self.where = where

    def __str__(self) -> str:
        place = ": ".join(str(part) for part in (self.file, self.where) if part)
        return f"{place}: {self.message}" if place else self.message


class SceneError(LamplitError):
    """A scene file, or something that it names, cannot be used."""


class SpectrumError(LamplitError):
    """A spectral table is malformed, or is asked for values outside its range."""


class GeometryError(LamplitError):
    """A mesh or a primitive cannot be used as it stands."""


class RuleError(LamplitError):
    """A rule file cannot be used, or a rule is asked for what it does not hold."""


class OutputError(LamplitError):
    """A result cannot be written where it was asked for."""


def nearest_name(wrong: str, names: Iterable[str]) -> str:
    """Return ``; did you mean 'x'?`` for the closest of ``names``, or ``''`` when none is close."""
    by_lower = {name.lower(): name for name in names}
    close = difflib.get_close_matches(wrong.lower(), by_lower, n=1, cutoff=0.5)
    return f"; did you mean {by_lower[close[0]]!r}?" if close else ""

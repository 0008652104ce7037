# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The library of light sources: the CIE's illuminants and what burns in rear lamps."""

from __future__ import annotations

from functools import cache

from lamplit.errors import SpectrumError, nearest_name
from lamplit.sources.bulbs import Bulb, BulbName, bulb, bulb_names
from lamplit.sources.cie import cie_entries
from lamplit.sources.entry import SourceEntry
from lamplit.sources.lamps import lamp_entries

__all__ = [
    "Bulb",
    "BulbName",
    "SourceEntry",
    "bulb",
    "bulb_names",
    "source",
    "source_names",
]


@cache
def _library() -> dict[str, SourceEntry]:
    return {entry.name: entry for entry in (*lamp_entries(), *cie_entries())}


def source_names() -> tuple[str, ...]:
    """Return the names of the library's sources."""
    return tuple(_library())


def source(name: str) -> SourceEntry:
    """Return the library's source ``name``.

    >>> float(source("A").distribution()(560))
    100.0

    Raises:
        SpectrumError: There is no such source; the message gives the nearest name.
    """
    try:
        return _library()[name]
    except KeyError:
        raise SpectrumError(
            f"there is no source {name!r}{nearest_name(name, source_names())}; "
            "'lamplit sources' lists them"
        ) from None

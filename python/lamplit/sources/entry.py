# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`SourceEntry`: one light source of the library."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from lamplit.spectrum import SpectralDistribution


@dataclass(frozen=True)
class SourceEntry:
    """A named spectral power distribution, where it comes from, and under what licence.

    The distribution is relative: its scale has no meaning beyond its own entry, and the scene
    gives the light its strength.
    """

    name: str
    description: str
    reference: str
    licence: str
    build: Callable[[], SpectralDistribution] = field(repr=False, compare=False)

    def distribution(self) -> SpectralDistribution:
        """Return the relative spectral power as a function of wavelength."""
        return self.build()

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Transfer functions: what a display's signal means in light."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class PowerTransfer:
    """A power law with a straight part near black, as ICC parametric curves of types 0 and 3.

    A signal v in [0, 1] gives the light (a v + b)^γ where v ≥ d, and c v below.
    Source: ICC.1:2022, 10.18.
    """

    gamma: float
    a: float = 1.0
    b: float = 0.0
    c: float = 0.0
    d: float = 0.0

    def decode(self, signal: ArrayLike) -> NDArray[np.float64]:
        """Return linear light in [0, 1] of ``signal`` in [0, 1], of the same shape."""
        v = _unit(signal)
        return np.where(v >= self.d, np.maximum(self.a * v + self.b, 0.0) ** self.gamma, self.c * v)

    def encode(self, light: ArrayLike) -> NDArray[np.float64]:
        """Return the signal in [0, 1] of linear ``light``, which is first cut to [0, 1]."""
        linear = _unit(light)
        power = _unit((linear ** (1.0 / self.gamma) - self.b) / self.a)
        if self.c <= 0.0:
            return power
        return np.where(linear >= self.c * self.d, power, linear / self.c)


@dataclass(frozen=True)
class TableTransfer:
    """A measured curve: light at evenly spaced signals from 0 to 1, rising, ends 0 and 1."""

    light: tuple[float, ...]

    def decode(self, signal: ArrayLike) -> NDArray[np.float64]:
        """Return linear light in [0, 1] of ``signal`` in [0, 1], of the same shape."""
        return np.interp(_unit(signal), np.linspace(0.0, 1.0, len(self.light)), self.light)

    def encode(self, light: ArrayLike) -> NDArray[np.float64]:
        """Return the signal in [0, 1] of linear ``light``, which is first cut to [0, 1]."""
        return np.interp(_unit(light), self.light, np.linspace(0.0, 1.0, len(self.light)))


Transfer: TypeAlias = PowerTransfer | TableTransfer

#: IEC 61966-2-1, in the form of ICC's sRGB profiles.
SRGB = PowerTransfer(2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045)

#: Rec. ITU-R BT.2020-2, table 4, the OETF read backwards.
REC2020 = PowerTransfer(
    1 / 0.45,
    1 / 1.09929682680944,
    0.09929682680944 / 1.09929682680944,
    1 / 4.5,
    0.08124285829863229,
)


def _unit(values: ArrayLike) -> NDArray[np.float64]:
    return np.minimum(np.maximum(np.asarray(values, dtype=np.float64), 0.0), 1.0)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A round rod with notches across its back, and the bow that it may be bent into."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamplit.lamps.solids import Floats, Solid, swept

#: Depth of the flat band that the notches are cut into, as a share of the rod's radius.
_BAND = 0.08
#: Depth of the notches next to an LED, as a share of the deepest.
_FIRST_NOTCH = 0.35
#: Sides of the rod, about; the more triangles there are, the more rings lie along it.
_AROUND = 96
#: Points on each side between the flat band, which grows at a notch, and the fixed part.
_STRIP = 3


@dataclass(frozen=True)
class NotchedRod:
    """A rod along x about the origin, its back (−z) flat and notched; lengths in mm.

    At every x the section is a circle cut off by the line z = −radius + cut(x). Notches are
    V-shaped, as wide as the flat, their sides at ``angle_deg`` to the axis; the farther from an
    LED, the deeper, which evens out the light.
    """

    length: float
    radius: float
    pitch: float
    depth: float
    angle_deg: float
    fed_from_both_ends: bool

    def notches(self) -> tuple[Floats, Floats]:
        """Return the middles (m,) and the depths (m,) of the notches, along x."""
        count = int((self.length - 2.0 * self.pitch) / self.pitch) + 1
        x: Floats = (np.arange(count, dtype=np.float64) - 0.5 * (count - 1)) * self.pitch
        way: Floats = 0.5 + x / self.length
        if self.fed_from_both_ends:
            way = 1.0 - np.abs(2.0 * way - 1.0)
        return x, self.depth * (_FIRST_NOTCH + (1.0 - _FIRST_NOTCH) * way)

    def profile(self) -> Floats:
        """Return points (k, 2) of x and cut(x): corners, with straight lines between."""
        x, depth = self.notches()
        half = depth / np.tan(np.radians(self.angle_deg))
        corners = np.stack(
            [np.stack([x - half, x, x + half], axis=1), np.stack([0 * x, depth, 0 * x], axis=1)],
            axis=-1,
        ).reshape(-1, 2)
        ends = 0.5 * self.length
        whole = np.concatenate([[(-ends, 0.0)], corners, [(ends, 0.0)]])
        return whole + np.array([0.0, _BAND * self.radius])

    def solid(self, triangles: int) -> Solid:
        """Return the closed rod."""
        corners = self.profile()
        steps = max(1, round(triangles / (2.0 * len(corners) * _AROUND)))
        around = max(24, round(triangles / (2.0 * len(corners) * steps)))
        share = np.arange(steps)[:, None] / steps
        between = corners[:-1, None] + share * np.diff(corners, axis=0)[:, None]
        rings = np.concatenate([between.reshape(-1, 2), corners[-1:]])
        return swept(np.stack([self._section(x, cut, around) for x, cut in rings]))

    def _section(self, x: float, cut: float, around: int) -> Floats:
        """Return the loop (n, 3) at ``x``: along the cut, then round the rest of the circle."""
        deepest = _BAND * self.radius + self.depth
        first = float(np.arccos(1.0 - cut / self.radius))
        fixed = 1.1 * float(np.arccos(1.0 - deepest / self.radius))
        flat = max(3, round(around * fixed / np.pi))
        rest = max(12, around - flat - 2 * _STRIP)
        strip = np.linspace(first, fixed, _STRIP, endpoint=False)
        turn = np.concatenate(
            [
                strip,
                np.linspace(fixed, 2.0 * np.pi - fixed, rest),
                2.0 * np.pi - strip[::-1],
            ]
        )
        y = self.radius * np.sin(first) * np.linspace(-1.0, 1.0, flat + 2)[1:-1]
        yz = np.concatenate(
            [
                np.column_stack([y, np.full(flat, cut - self.radius)]),
                self.radius * np.column_stack([np.sin(turn), -np.cos(turn)]),
            ]
        )
        return np.column_stack([np.full(len(yz), x), yz])


@dataclass(frozen=True)
class Bow:
    """A bend in the plane of x and y: a chord of ``length`` mm becomes an arc, ``sag`` mm high.

    Lengths along the middle line are kept: ``length`` is that of the arc. Half of the sag lies
    above the origin, half below.
    """

    length: float
    sag: float

    def points(self, points: Floats) -> Floats:
        """Return where points (n, 3) of the straight part come to lie."""
        if self.sag == 0.0:
            return points
        radius = self._radius()
        x, y, z = points.T
        turn = x / radius
        return np.column_stack(
            [
                (radius + y) * np.sin(turn),
                (radius + y) * np.cos(turn) - radius + 0.5 * self.sag,
                z,
            ]
        )

    def along(self, x: float) -> Floats:
        """Return the direction (3,) in which the bent part runs at ``x`` of the straight one."""
        turn = 0.0 if self.sag == 0.0 else x / self._radius()
        return np.array([np.cos(turn), -np.sin(turn), 0.0])

    def bent(self, solid: Solid) -> Solid:
        """Return ``solid`` bent."""
        return Solid(self.points(solid.vertices), solid.triangles)

    def _radius(self) -> float:
        """Return the radius whose arc of ``length`` is ``sag`` high: R (1 − cos(l/2R)) = s."""
        radius = self.length**2 / (8.0 * self.sag)
        for _ in range(50):
            half = 0.5 * self.length / radius
            radius *= radius * (1.0 - np.cos(half)) / self.sag
        return float(radius)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A single-filament signal bulb of the P21W kind, its filament across the axis in the origin.

Sizes follow the trade's: envelope 25 mm wide, cap BA15s 15 mm wide, filament coil about 7 mm long
and 1 mm wide (UN R37, category P21W; the inner parts are drawn to look right, not to a sheet).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from lamplit.lamps.solids import Floats, Solid, joined, revolved, tube

CAP_RADIUS_MM = 7.5
FILAMENT_HALF_LENGTH_MM = 3.4
_CAP_TOP_Z, _CAP_BOTTOM_Z = -17.0, -38.0
_NECK_RADIUS, _NECK_END_Z = 6.4, -21.0


@dataclass(frozen=True)
class Bulb:
    """The bulb's parts; lengths in mm. The envelope's middle lies ``forward`` of the filament."""

    diameter: float
    glass: float
    forward: float = 0.8

    @property
    def tip_z(self) -> float:
        """The foremost height of the glass."""
        return self.forward + 0.5 * self.diameter

    def envelope(self, triangles: int) -> Solid:
        """Return the glass: one thin shell, open at the neck, equally thick along its normals."""
        steps = max(8, round(np.sqrt(triangles / 8.0)))
        outer = self._outer_profile(steps)
        along = np.gradient(outer, axis=0)
        along[0] = (1.0, 0.0)
        inner = outer + self.glass * _unit(np.column_stack([along[:, 1], -along[:, 0]]))
        inner[0, 0] = 0.0
        return revolved(np.concatenate([outer, inner[::-1]]), max(16, 2 * steps))

    def _outer_profile(self, steps: int) -> Floats:
        """Points (radius, z) from the tip over the sphere and the shoulder to the neck's end."""
        radius, last = 0.5 * self.diameter, math.radians(118.0)
        turn = np.linspace(0.0, last, round(0.6 * steps) + 1)
        sphere = np.column_stack([radius * np.sin(turn), self.forward + radius * np.cos(turn)])
        start, end = sphere[-1], np.array([_NECK_RADIUS, _CAP_TOP_Z + 2.0])
        ahead = start + 0.45 * radius * np.array([np.cos(last), -np.sin(last)])
        bend = np.array([_NECK_RADIUS, end[1] + 0.35 * radius])
        t = np.linspace(0.0, 1.0, round(0.4 * steps) + 2)[1:, None]
        shoulder = (
            (1 - t) ** 3 * start
            + 3 * t * (1 - t) ** 2 * ahead
            + 3 * t**2 * (1 - t) * bend
            + t**3 * end
        )
        return np.concatenate([sphere, shoulder, [[_NECK_RADIUS, _NECK_END_Z]]])

    def stem(self, triangles: int) -> Solid:
        """Return the glass rod in the neck that carries the wires."""
        around = max(12, round(np.sqrt(triangles)))
        turn = np.linspace(0.0, 0.5 * np.pi, max(3, around // 6))
        tip = np.column_stack([1.9 * np.sin(turn), -9.5 + 1.9 * (np.cos(turn) - 1.0)])
        foot = [(2.4, -16.0), (3.0, -20.0), (0.0, -20.0)]
        return revolved(np.concatenate([tip, foot]), around)

    def cap(self, triangles: int) -> Solid:
        """Return the metal cap: a cup about the neck, with the contact under its base."""
        r = CAP_RADIUS_MM
        profile = [(0.0, -22.0), (6.8, -22.0), (6.8, _CAP_TOP_Z - 0.4), (7.0, _CAP_TOP_Z)]
        profile += [(r - 0.1, _CAP_TOP_Z), (r, _CAP_TOP_Z - 0.3), (r, _CAP_BOTTOM_Z + 1.5)]
        profile += [(r - 1.5, _CAP_BOTTOM_Z), (2.4, _CAP_BOTTOM_Z), (2.0, _CAP_BOTTOM_Z - 1.5)]
        profile += [(0.0, _CAP_BOTTOM_Z - 1.8)]
        return revolved(profile, max(16, round(triangles / (2.0 * len(profile)))))

    def supports(self, triangles: int) -> Solid:
        """Return the two lead wires, from beside the stem to just before the filament's ends."""
        sides = max(6, round(np.sqrt(triangles / 24.0)))
        end = FILAMENT_HALF_LENGTH_MM + 0.3
        corners = np.array([(4.3, -20.6), (4.3, -12.0), (4.0, -6.0), (end + 0.2, -1.0), (end, 0.4)])
        steps = max(8, round(triangles / (4.0 * sides)))
        path = np.column_stack(
            [_smoothed(corners[:, 0], steps), np.zeros(steps), _smoothed(corners[:, 1], steps)]
        )
        wire = tube(path, 0.28, (0.0, 1.0, 0.0), sides)
        mirrored = Solid(wire.vertices * (-1.0, 1.0, 1.0), wire.triangles[:, ::-1])
        return joined(wire, mirrored)

    def filament(self, triangles: int) -> Solid:
        """Return the coil of wire along x."""
        turns, coil_radius, wire_radius = 15, 0.5, 0.11
        sides = max(5, min(16, round(np.sqrt(triangles / 80.0))))
        count = max(8 * turns, round(triangles / (2.0 * sides)))
        angle = np.linspace(0.0, 2.0 * np.pi * turns, count)
        x = np.linspace(-1.0, 1.0, count) * (FILAMENT_HALF_LENGTH_MM - wire_radius - 0.1)
        radial = np.column_stack([np.zeros(count), np.cos(angle), np.sin(angle)])
        return tube(np.column_stack([x, coil_radius * radial[:, 1:]]), wire_radius, radial, sides)


def _unit(vectors: Floats) -> Floats:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _smoothed(values: Floats, count: int) -> Floats:
    """Return ``count`` values of the quartic Bézier curve of five control ``values``."""
    t = np.linspace(0.0, 1.0, count)
    weights = np.array(
        [(1 - t) ** 4, 4 * t * (1 - t) ** 3, 6 * t**2 * (1 - t) ** 2, 4 * t**3 * (1 - t), t**4]
    )
    return values @ weights

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The outline of a lamp: a superellipse, round to nearly rectangular, smooth all the way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamplit.lamps.solids import Floats


@dataclass(frozen=True)
class Superellipse:
    """The curve |x/a|^p + |y/b|^p = 1 about the z axis, lengths in mm.

    p = 2 is an ellipse, large p a rectangle; in between the corners have no jump in curvature,
    which is why stylists like it.
    """

    half_width_mm: float
    half_height_mm: float
    exponent: float

    def level(self, xy: Floats) -> Floats:
        """Return (n,): 0 in the middle, 1 on the curve, proportional to the distance between."""
        return np.sum(np.abs(xy / self._halves) ** self.exponent, axis=-1) ** (1.0 / self.exponent)

    def normals(self, xy: Floats) -> Floats:
        """Return the outward unit normals (n, 2) of the level lines at ``xy`` (n, 2)."""
        share = xy / self._halves
        gradient = np.sign(share) * np.abs(share) ** (self.exponent - 1.0) / self._halves
        return gradient / np.linalg.norm(gradient, axis=-1, keepdims=True)

    def points(self, angles: Floats) -> Floats:
        """Return the points (n, 2) of the curve at polar ``angles`` (n,) in radians."""
        rays = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        return rays / self.level(rays)[:, None]

    def even_angles(self, count: int) -> Floats:
        """Return ``count`` polar angles, spread half by the curve's length, half by its turning."""
        fine = np.linspace(0.0, 2.0 * np.pi, 4096 + 1)
        points = self.points(fine)
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        normals = self.normals(points)
        turns = np.linalg.norm(np.diff(normals, axis=0), axis=1)
        way = np.zeros(len(fine))
        np.cumsum(steps / steps.sum() + turns / turns.sum(), out=way[1:])
        return np.interp(np.linspace(0.0, 2.0, count, endpoint=False), way, fine)

    def ring(self, angles: Floats, offset_mm: float | Floats, z_mm: float | Floats) -> Floats:
        """Return the loop (n, 3) that runs ``offset_mm`` outside the curve at height ``z_mm``."""
        points = self.points(angles)
        xy = points + np.reshape(offset_mm, (-1, 1)) * self.normals(points)
        return np.column_stack([xy, np.broadcast_to(z_mm, len(xy))])

    @property
    def area_mm2(self) -> float:
        """The enclosed area, by the trapezoidal rule in polar coordinates."""
        radii = np.linalg.norm(
            self.points(np.linspace(0.0, 2.0 * np.pi, 1024, endpoint=False)), axis=1
        )
        return float(np.pi * (radii**2).mean())

    @property
    def perimeter_mm(self) -> float:
        """The length of the curve."""
        loop = self.points(np.linspace(0.0, 2.0 * np.pi, 1024, endpoint=False))
        return float(np.linalg.norm(loop - np.roll(loop, 1, axis=0), axis=1).sum())

    @property
    def largest_radius_mm(self) -> float:
        """The distance from the middle to the farthest point."""
        return float(np.linalg.norm(self.points(np.linspace(0.0, 0.5 * np.pi, 512)), axis=1).max())

    @property
    def _halves(self) -> Floats:
        return np.array([self.half_width_mm, self.half_height_mm])

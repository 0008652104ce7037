# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The outer lens of a lamp: a domed cap with a rolled edge and a skirt, optics on its inside."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from lamplit.lamps.outlines import Superellipse
from lamplit.lamps.patterns import Patch, pillow_height, square_patch
from lamplit.lamps.plates import plate
from lamplit.lamps.solids import Floats, Solid

Height: TypeAlias = Callable[[Floats], Floats]

#: Longer steps along the border would cut the corners off, down to what lies behind them.
_COARSEST_MM = 4.0


@dataclass(frozen=True)
class Cover:
    """The shape of a cover, lengths in mm.

    ``optics`` outlines the field of optics. Around it lies a smooth ``band``, then the edge rolls
    over into a skirt that ends at ``skirt_z``. ``apex_z`` is the foremost point of the front,
    a sphere of curvature ``dome_curvature`` = 1/radius, 0 for a flat front. ``pedestal`` is how
    far the optics stand out of the smooth inside.
    """

    optics: Superellipse
    apex_z: float
    thickness: float
    dome_curvature: float
    skirt_z: float
    band: float = 5.0
    inner_radius: float = 3.0
    pedestal: float = 0.3

    @property
    def inner_offset(self) -> float:
        """How far the skirt's inside lies outside ``optics``."""
        return self.band + self.inner_radius

    @property
    def outer_offset(self) -> float:
        """How far the skirt's outside lies outside ``optics``."""
        return self.inner_offset + self.thickness

    def front_z(self, xy: Floats) -> Floats:
        """Return the height (n,) of the front at ``xy`` (n, 2)."""
        return self.apex_z - dome_sag(np.sum(xy**2, axis=-1), self.dome_curvature)

    def back_z(self, xy: Floats) -> Floats:
        """Return the height (n,) of the smooth inside, without optics."""
        return self.front_z(xy) - self.thickness

    def roll_end_z(self) -> float:
        """Return the lowest height at which the rolled edge has become the skirt."""
        ring = self.optics.points(np.linspace(0.0, 0.5 * np.pi, 256))
        arc = self._roll(ring, self.inner_radius + self.thickness, self.front_z, 2)
        return float(arc[-1, :, 2].min())

    def solid(self, patch: Patch, relief: Floats | None, roll_steps: int) -> Solid:
        """Return the closed cover; ``relief`` (n,) >= 0 is the height of the optics on ``patch``.

        Without relief the inside is smooth. ``roll_steps`` segments round the edge.
        """
        border = patch.xy[patch.border]
        offsets = np.linspace(0.0, self.band, 2 + roll_steps // 3)[1:]
        flat = [self._level_ring(border, offset, self.front_z) for offset in offsets]
        outer = self._roll(border, self.inner_radius + self.thickness, self.front_z, roll_steps)
        inner = self._roll(border, self.inner_radius, self.back_z, roll_steps)[::-1]
        skirt = [
            np.column_stack(
                [_moved(self.optics, border, offset), np.full(len(border), self.skirt_z)]
            )
            for offset in (self.outer_offset, self.inner_offset)
        ]
        last = 0 if relief is not None else 1
        inside = [
            self._level_ring(border, offset, self.back_z)
            for offset in np.append(offsets[:-1][::-1], 0.0)[: len(offsets) - last]
        ]
        rim = np.stack([*flat, *outer[1:], *skirt, *inner, *inside])
        back = self.back_z(patch.xy)
        if relief is not None:
            back = back - self.pedestal - relief
        return plate(patch, self.front_z(patch.xy), back, rim)

    def _level_ring(self, border: Floats, offset: float, height: Height) -> Floats:
        xy = _moved(self.optics, border, offset)
        return np.column_stack([xy, height(xy)])

    def _roll(self, border: Floats, reach: float, height: Height, steps: int) -> Floats:
        """Return rings (steps + 1, n, 3) of the arc that rounds the edge.

        It leaves the surface ``height`` along its slope at the end of the band and points
        straight back ``reach`` mm farther out.
        """
        start = self._level_ring(border, self.band, height)
        outward = np.sum(start[:, :2] * self.optics.normals(border), axis=1)
        slope = _dome_slope(np.sum(start[:, :2] ** 2, axis=1), self.dome_curvature) * outward
        first = np.arctan(slope)
        radius = reach / (1.0 - np.sin(first))
        share = np.linspace(0.0, 1.0, steps + 1)[:, None]
        angles = (1.0 - share) * first + share * (0.5 * np.pi)
        across = self.band + radius * (np.sin(angles) - np.sin(first))
        down = radius * (np.cos(first) - np.cos(angles))
        rings = np.stack([_moved(self.optics, border, offset) for offset in across])
        return np.concatenate([rings, (start[:, 2] - down)[..., None]], axis=-1)


def pillow_cover(
    cover: Cover, pitch_mm: float, radius_of_curvature_mm: float, triangles: int
) -> tuple[Solid, float]:
    """Return the cover with pillows inside, about ``triangles`` large, and its crease angle (deg).

    The crease angle keeps the edges between pillows sharp and shades all else smoothly.
    """
    divisions = np.arange(max(2, int(np.ceil(pitch_mm / _COARSEST_MM))), 400)
    steps = pitch_mm / divisions
    total = _estimate(cover, steps)
    best = int(np.argmin(np.abs(np.log(total / triangles))))
    roll = _roll_steps(cover, steps[best])
    patch = square_patch(cover.optics, pitch_mm, int(divisions[best]))
    relief = pillow_height(patch.xy, pitch_mm, radius_of_curvature_mm)
    pillow_deg = float(np.degrees(np.arcsin(0.5 * pitch_mm / radius_of_curvature_mm)))
    return cover.solid(patch, relief, roll), round(max(pillow_deg, 1.4 * 90.0 / roll), 2)


def smooth_cover(cover: Cover, triangles: int) -> Solid:
    """Return the cover without optics, about ``triangles`` large."""
    steps = np.geomspace(0.05, _COARSEST_MM, 400)
    best = float(steps[int(np.argmin(np.abs(np.log(_estimate(cover, steps) / triangles))))])
    patch = square_patch(cover.optics, best, 1)
    return cover.solid(patch, None, _roll_steps(cover, best))


def dome_sag(radius2: Floats, curvature: float) -> Floats:
    """Return how far a sphere lies behind its apex at ``radius2`` (mm²) from the axis."""
    return curvature * radius2 / (1.0 + np.sqrt(1.0 - curvature**2 * radius2))


def _dome_slope(radius2: Floats, curvature: float) -> Floats:
    return curvature / np.sqrt(1.0 - curvature**2 * radius2)


def _moved(outline: Superellipse, border: Floats, offset: float | Floats) -> Floats:
    return border + np.reshape(offset, (-1, 1)) * outline.normals(border)


def _roll_steps(cover: Cover, step: float) -> int:
    quarter = 0.5 * np.pi * (cover.inner_radius + cover.thickness)
    return int(np.clip(round(quarter / step), 6, 40))


def _estimate(cover: Cover, steps: Floats) -> Floats:
    """Return the numbers of triangles at lattice ``steps``: front, back and rim."""
    around = 1.15 * cover.optics.perimeter_mm / steps
    rolls = np.array([_roll_steps(cover, step) for step in steps])
    return 4.0 * cover.optics.area_mm2 / steps**2 + 2.0 * around * (2.7 * rolls + 5.0)

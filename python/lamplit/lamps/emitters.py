# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What shapes the light of a row of LEDs: TIR collimators, and the tray between them or of cups."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamplit.lamps.outlines import Superellipse
from lamplit.lamps.patterns import open_edges
from lamplit.lamps.plates import sheet
from lamplit.lamps.solids import Floats, Indices, Solid, repeated, revolved, strip


def grid_mm(columns: int, rows: int, pitch_mm: float) -> Floats:
    """Return the places (columns·rows, 3) of the dies, in the plane z = 0 about the origin."""
    x = (np.arange(columns, dtype=np.float64) - 0.5 * (columns - 1)) * pitch_mm
    y = (np.arange(rows, dtype=np.float64) - 0.5 * (rows - 1)) * pitch_mm
    x, y = np.meshgrid(x, y, indexing="ij")
    return np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])


@dataclass(frozen=True)
class Collimator:
    """A collimator for a die in the origin; lengths in mm.

    Light near the axis is made parallel by a hyperboloid, the rest enters through a cylinder
    and is turned by total reflection. Both surfaces keep the optical path to the front constant:
    the hyperboloid ρ(ψ) = (n − 1) h / (n cos ψ − 1), and on the outside, for a ray that enters in P
    and runs along d inside, the point P + s d with s = (K − |P| + n P_z) / (n (1 − d_z)).
    """

    radius: float
    index: float

    def profile(self, steps: int) -> Floats:
        """Return points (radius, z) from the lens's apex round to the front's middle."""
        n, bore, apex, foot = self.index, 2.6, 4.5, 3.1
        axial = (n - 1.0) * apex
        root = np.sqrt(axial**2 + (n**2 - 1.0) * bore**2)
        last = float(np.arctan2(bore, (n * axial + root) / (n**2 - 1.0)))
        psi = np.linspace(0.0, last, max(4, steps // 3) + 1)
        reach = axial / (n * np.cos(psi) - 1.0)
        lens = np.column_stack([reach * np.sin(psi), reach * np.cos(psi)])

        psi = np.linspace(0.5 * np.pi, last, max(6, steps) + 1)
        enter = np.column_stack([np.full(len(psi), bore), bore / np.tan(psi)])
        along_z = np.cos(psi) / n
        along = np.column_stack([np.sqrt(1.0 - along_z**2), along_z])
        constant = bore + n * (foot - bore)
        path = constant - np.linalg.norm(enter, axis=1) + n * enter[:, 1]
        outside = enter + (path / (n * (1.0 - along_z)))[:, None] * along
        rim = outside[-1] + (0.0, 1.0)
        points = np.concatenate([lens, [[bore, 0.0]], outside, [rim, (0.0, rim[1])]])
        points *= self.radius / rim[0]
        points[0, 0] = 0.0
        return points

    @property
    def height(self) -> float:
        """The distance from the die to the front."""
        return float(self.profile(6)[-1, 1])

    def solids(self, places_mm: Floats, triangles: int) -> Solid:
        """Return one closed collimator at each of ``places_mm`` (c, 3)."""
        steps = max(6, round(np.sqrt(triangles / len(places_mm) / 7.0)))
        profile = self.profile(steps)
        around = max(16, round(triangles / len(places_mm) / (2.0 * len(profile))))
        return repeated(revolved(profile, around), places_mm)


@dataclass(frozen=True)
class Tray:
    """A plate with a round hole for each die, flared up to a frame at its edge; lengths in mm.

    From ``hole_radius`` to ``cup_radius`` each cup is the paraboloid z = r²/(4 f) − f about its
    die; beyond lies flat land at ``land_z``. Where the two radii are equal there is only land.
    """

    pitch: float
    hole_radius: float
    cup_radius: float
    focal_length: float
    land_z: float
    frame_z: float
    wall: float = 1.2

    def solid(
        self, places_mm: Floats, outline: Superellipse, reach: float, triangles: int
    ) -> Solid:
        """Return the tray, up to ``reach`` mm outside ``outline``."""
        cup_steps = 0 if self.cup_radius == self.hole_radius else 3
        budget = triangles / (4.0 * len(places_mm))
        side = max(4, round(np.sqrt(budget / (4.0 * (1 + cup_steps)))))
        cups = cup_steps * side // 2
        xy, height, loops = self._cell(side, cups)
        count = len(xy)
        all_xy = (places_mm[:, None, :2] + xy).reshape(-1, 2)
        cells = (np.arange(len(places_mm)) * count)[:, None, None] + strip(loops)
        _, first, merged = np.unique(
            np.round(all_xy * 1e5).astype(np.int64) @ np.array([1 << 32, 1]),
            return_index=True,
            return_inverse=True,
        )
        xy, triangles_of_cells = all_xy[first], merged[cells.reshape(-1, 3)]
        z = np.tile(height, len(places_mm))[first]
        xy, z, frame = self._frame(
            xy, z, triangles_of_cells, outline, reach=reach, steps=max(4, side // 2)
        )
        faces = np.concatenate([triangles_of_cells, frame])
        return sheet(xy, faces, z, z - self.wall)

    def _cell(self, side: int, cups: int) -> tuple[Floats, Floats, Indices]:
        """Return one cell about its die: points (n, 2), heights (n,) and loops (k, 4·side)."""
        along = (np.arange(side) / side - 0.5) * self.pitch
        edge = np.full(side, 0.5 * self.pitch)
        square = np.concatenate(
            [
                np.column_stack(p)
                for p in ((edge, along), (-along, edge), (-edge, -along), (along, -edge))
            ]
        )
        rays = square / np.linalg.norm(square, axis=1, keepdims=True)
        radii = np.linspace(self.hole_radius, self.cup_radius, cups + 1)
        rings = [radius * rays for radius in radii] + [square]
        heights = [radius**2 / (4.0 * self.focal_length) - self.focal_length for radius in radii]
        levels = np.array([*heights[:cups], self.land_z, self.land_z])
        loops = np.arange(len(rings) * 4 * side, dtype=np.int64).reshape(len(rings), -1)
        return np.concatenate(rings), np.repeat(levels, 4 * side), loops

    def _frame(
        self,
        xy: Floats,
        z: Floats,
        triangles: Indices,
        outline: Superellipse,
        *,
        reach: float,
        steps: int,
    ) -> tuple[Floats, Floats, Indices]:
        """Extend the cells to the outline: new points and heights, and the added triangles."""
        outside = np.abs(xy).max(axis=0) - 1e-6
        border = np.unique(open_edges(triangles))
        border = border[np.any(np.abs(xy[border]) > outside, axis=1)]
        angles = np.arctan2(xy[border, 1], xy[border, 0])
        border, angles = border[np.argsort(angles)], np.sort(angles)
        inner, edge = xy[border], outline.points(angles)
        rings = [inner + share * (edge - inner) for share in np.linspace(0.0, 1.0, 3)[1:]]
        levels = [np.full(len(border), self.land_z)] * 2
        for share in np.linspace(0.0, 1.0, steps + 1)[1:]:
            rings.append(outline.ring(angles, share * reach, 0.0)[:, :2])
            rise = (1.0 - np.cos(0.5 * np.pi * share)) * (self.frame_z - self.land_z)
            levels.append(np.full(len(border), self.land_z + rise))
        added = np.arange(len(rings) * len(border), dtype=np.int64).reshape(len(rings), -1)
        loops = np.concatenate([border[None], len(xy) + added])
        return (
            np.concatenate([xy, *rings]),
            np.concatenate([z, *levels]),
            strip(loops),
        )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The opaque shells of a lamp: paraboloid reflector, bezel and housing, each closed, with walls."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamplit.lamps.outlines import Superellipse
from lamplit.lamps.solids import Floats, Solid, swept

#: Corners turn by at most 7.5 degrees a step, so that no chord cuts into a neighbour.
_FEWEST_AROUND = 96


@dataclass(frozen=True)
class Paraboloid:
    """The mirror z = r²/(4 f) − f with its focus in the origin, lengths in mm.

    It reaches from a round opening of ``opening_radius`` to ``outline``, seen along z.
    """

    outline: Superellipse
    focal_length: float
    opening_radius: float
    wall: float = 1.5

    def z(self, radius: Floats) -> Floats:
        """Return the height of the mirror at a distance from the axis."""
        return radius**2 / (4.0 * self.focal_length) - self.focal_length

    def rim_z(self, angles: Floats) -> Floats:
        """Return the height (n,) of the arched rim at polar ``angles`` (n,)."""
        return self.z(np.linalg.norm(self.outline.points(angles), axis=1))

    def solid(self, triangles: int) -> Solid:
        """Return the closed shell: mirror in front, ``wall`` thick along the normal."""
        ratio = self.outline.perimeter_mm / (0.6 * self.outline.largest_radius_mm)
        steps = max(4, round(np.sqrt(triangles / (4.0 * ratio))))
        angles = self.outline.even_angles(max(_FEWEST_AROUND, round(ratio * steps)))
        outer = np.linalg.norm(self.outline.points(angles), axis=1)
        share = np.linspace(0.0, 1.0, steps + 1)[:, None]
        radii = self.opening_radius + share * (outer - self.opening_radius)
        slope = radii / (2.0 * self.focal_length)
        length = np.sqrt(1.0 + slope**2)
        front = _around(radii, self.z(radii), angles)
        back = _around(
            radii + self.wall * slope / length, self.z(radii) - self.wall / length, angles
        )
        return swept(np.concatenate([front, back[::-1]]), closed=True)


def bezel(
    outline: Superellipse,
    start_z: Floats,
    angles: Floats,
    *,
    front_z: float,
    offsets: tuple[float, float],
    steps: int,
    wall: float = 1.2,
) -> Solid:
    """Return the flared ring that runs from the reflector's rim to the lens.

    It starts ``offsets[0]`` mm outside ``outline`` at ``start_z`` (n,), leaning outward, and bends
    over an arc of an ellipse to ``offsets[1]`` at ``front_z``, where it lies flat.
    """
    turn = np.linspace(0.7, 0.5 * np.pi, steps + 1)
    outwards = 1.0 - np.cos(turn) / np.cos(turn[0])
    forwards = (np.sin(turn) - np.sin(turn[0])) / (1.0 - np.sin(turn[0]))
    width, rise = offsets[1] - offsets[0], front_z - start_z
    front = [
        outline.ring(angles, offsets[0] + width * out, start_z + rise * ahead)
        for out, ahead in zip(outwards, forwards, strict=True)
    ]
    back = [
        outline.ring(
            angles, offsets[0] + wall + (width - wall) * out, start_z + (rise - wall) * ahead
        )
        for out, ahead in zip(outwards[::-1], forwards[::-1], strict=True)
    ]
    return swept(np.stack([*front, *back]), closed=True)


@dataclass(frozen=True)
class Housing:
    """The moulded cup behind a lamp, lengths in mm; offsets count from ``outline``.

    The cover's skirt stands in a channel between ``channel_offset`` and the lip, above a ledge at
    ``ledge_z``; inside ``cavity_offset`` lies the room for the optics, down to ``floor_z``.
    With ``bore_radius`` the floor has a round hole for the bulb, otherwise it is whole.
    """

    outline: Superellipse
    cavity_offset: float
    channel_offset: float
    ledge_z: float
    lip_z: float
    floor_z: float
    bore_radius: float | None
    wall: float = 2.5

    @property
    def outer_offset(self) -> float:
        """How far the outside of the lip lies outside the outline."""
        return self.channel_offset + self.wall

    @property
    def back_z(self) -> float:
        """The rearmost height."""
        return self.floor_z - self.wall

    def solid(self, triangles: int) -> Solid:
        """Return the closed cup."""
        arc = max(2, min(16, round(np.sqrt(triangles) / 24.0)))
        profile = self._profile(arc)
        around = max(_FEWEST_AROUND, round(triangles / (2.0 * (len(profile) + 2))))
        angles = self.outline.even_angles(around)
        rings = [self.outline.ring(angles, offset, z) for offset, z in profile]
        if self.bore_radius is None:
            return swept(np.stack(rings))
        hole = np.full((1, around), self.bore_radius)
        top, bottom = (
            _around(hole, np.full_like(hole, z), angles) for z in (self.floor_z, self.back_z)
        )
        return swept(np.concatenate([top, np.stack(rings), bottom]), closed=True)

    def _profile(self, arc: int) -> list[tuple[float, float]]:
        """Points (offset, z) from the inner floor over the lip to the outer back."""
        lip, corner = 0.45 * self.wall, 3.0
        turn = np.linspace(0.0, 0.5 * np.pi, arc + 1)
        taper = min(0.06 * (self.ledge_z - self.floor_z), 2.5)
        inside = self.cavity_offset - taper
        back = self.outer_offset - 2.0 * taper
        points = [
            (inside - corner * (1 - np.sin(t)), self.floor_z + corner * (1 - np.cos(t)))
            for t in turn
        ]
        points += [(self.cavity_offset, self.ledge_z), (self.channel_offset, self.ledge_z)]
        points += [
            (self.channel_offset + lip * (1 - np.cos(t)), self.lip_z - lip * (1 - np.sin(t)))
            for t in turn
        ]
        points += [
            (self.outer_offset - lip * (1 - np.sin(t)), self.lip_z - lip * (1 - np.cos(t)))
            for t in turn
        ]
        points += [(self.outer_offset, self.ledge_z - self.wall)]
        points += [
            (back - corner * (1 - np.cos(t)), self.back_z + corner * (1 - np.sin(t))) for t in turn
        ]
        return points


def _around(radii: Floats, z: Floats, angles: Floats) -> Floats:
    return np.stack([radii * np.cos(angles), radii * np.sin(angles), z], axis=-1)

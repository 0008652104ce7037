# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`ReceiverView`: a camera that stands where a goniometer's receiver stands, and sees what it sees.

A receiver reads the mean over its aperture of I = d² ∫ L (n·ω) dω, n along the direction to it. A
thin lens as large as the receiver, sharp at the lamp, draws a point of the aperture and a point of
the lamp: pixel by pixel, I is the sum of the mean luminances times d² (n·ω) Ω of the pixel. What a
flat lens differs from a receiver that faces the lamp's middle everywhere is of second order in the
receiver's half angle: 10⁻⁴ at 1°. A wider receiver is covered by pinholes, each by chance.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lamplit import _core
from lamplit.errors import LamplitError

if TYPE_CHECKING:
    from lamplit.engine.receivers import Goniometer

Array = NDArray[np.float64]

#: The widest receiver, full angle, that one lens stands for.
WIDEST_LENS_DEG = 2.0
#: An infinite distance in sizes of the lamp: directions differ by 10⁻⁴ rad over it, intensities by
#: the square of that.
_FAR = 1e4
#: The picture is larger than the lamp by this share.
_MARGIN = 0.002
_MM_PER_M = 1e3


@dataclass(frozen=True, eq=False)
class ReceiverView:
    """Where a receiver stands, and its picture of the lamp."""

    position_mm: Array
    target_mm: Array
    up: Array
    field_of_view_deg: float
    #: Diameter of the lens, and the distance at which it is sharp; None for a pinhole.
    lens_mm: tuple[float, float] | None
    #: (rows, columns), in m²: the intensity is the sum of luminances times these.
    areas_m2: Array

    def take(self, world: _core.Scene) -> None:
        """Let ``world`` be seen from here."""
        view = (self.position_mm.tolist(), self.target_mm.tolist(), self.up.tolist())
        world.look(*view, field_of_view_deg=self.field_of_view_deg, lens_mm=self.lens_mm)


def corners_of(world: _core.Scene) -> Array:
    """Return the corners (8, 3) of the box round all that is seen, in mm.

    Raises:
        LamplitError: There are endless planes alone.
    """
    bounds = world.bounds_mm
    if bounds is None:
        raise LamplitError("an eye cannot see endless planes whole")
    low, high = np.asarray(bounds[0]), np.asarray(bounds[1])
    share = np.array([[i & 1, i >> 1 & 1, i >> 2 & 1] for i in range(8)], dtype=np.float64)
    return low + share * (high - low)


def receiver_view(
    gonio: Goniometer,
    direction: Array,
    corners: Array,
    pixels: int | tuple[int, int],
    at: Array | None = None,
) -> ReceiverView:
    """Return the view from the receiver along the unit vector ``direction``.

    Its picture has ``pixels`` on the longer side, or as many rows and columns. With ``at``, a point
    of the unit square, a wide receiver looks through a pinhole there, one of its solid angle.

    Raises:
        LamplitError: The lamp reaches up to the receiver, or behind it.
    """
    half = np.radians(gonio.receiver_deg) / 2.0
    towards = direction if at is None else _within(direction, half, at)
    size = float(np.linalg.norm(corners[-1] - corners[0]))
    far = gonio.distance_m is None
    distance = _FAR * size if gonio.distance_m is None else _MM_PER_M * gonio.distance_m
    centre = corners.mean(axis=0) if far else np.asarray(gonio.centre_mm)
    eye = centre + towards * distance
    radius = 0.0 if at is not None else distance * float(np.tan(half))
    rays = corners - eye
    helper = np.eye(3)[int(np.argmin(np.abs(towards)))]
    forward: Array = -towards
    focus = distance
    frame: Array = np.eye(3)
    low, high = np.zeros(2), np.zeros(2)
    # Turned to the middle of what it sees, which the turn itself moves a little.
    for _ in range(3):
        right: Array = np.asarray(np.cross(forward, helper), np.float64)
        right /= np.linalg.norm(right)
        frame = np.array([right, np.cross(right, forward), forward], dtype=np.float64)
        x, y, depth = frame @ rays.T
        if depth.min() <= 0.0:
            raise LamplitError("the lamp reaches up to a receiver, which cannot see all of it")
        focus = float(depth.min() + depth.max()) / 2.0
        # A point off the plane of sharpness is seen from all of the lens, and spread by so much.
        spread = radius * np.abs(1.0 / focus - 1.0 / depth)
        x, y = x / depth, y / depth
        low = np.array([(x - spread).min(), (y - spread).min()])
        high = np.array([(x + spread).max(), (y + spread).max()])
        middle = (low + high) / 2.0
        forward = np.asarray(np.array([*middle, 1.0]) @ frame, np.float64)
        forward /= np.linalg.norm(forward)
    reach = np.maximum(np.abs(low), np.abs(high)) * (1.0 + _MARGIN)
    if isinstance(pixels, int):
        pixels = (_short(pixels, reach[1] / reach[0]), _short(pixels, reach[0] / reach[1]))
    rows, columns = pixels
    half_height = max(float(reach[1]), float(reach[0]) * rows / columns)
    return ReceiverView(
        position_mm=eye,
        target_mm=eye + frame[2] * focus,
        up=frame[1],
        field_of_view_deg=float(np.degrees(2.0 * np.arctan(half_height))),
        lens_mm=(2.0 * radius, focus) if radius > 0.0 else None,
        areas_m2=_areas(frame, -towards, half_height, pixels) * (distance / _MM_PER_M) ** 2,
    )


def _short(pixels: int, share: float) -> int:
    """Return how many pixels a side has that is ``share`` of the other, whose are ``pixels``."""
    return pixels if share >= 1.0 else max(1, int(np.ceil(pixels * share)))


def _areas(frame: Array, inward: Array, half_height: float, shape: tuple[int, int]) -> Array:
    """Return (n·ω) times the solid angle of each pixel, (rows, columns)."""
    rows, columns = shape
    side = 2.0 * half_height / rows
    x = (np.arange(columns) + 0.5 - columns / 2.0) * side
    y = (rows / 2.0 - np.arange(rows) - 0.5) * side
    length2 = 1.0 + x**2 + y[:, None] ** 2
    right, up, ahead = frame @ inward
    cosine = (right * x + up * y[:, None] + ahead) / np.sqrt(length2)
    return np.asarray(side**2 * cosine / length2**1.5, dtype=np.float64)


def _within(direction: Array, half: float, at: Array) -> Array:
    """Return a direction within ``half`` of another, evenly over the solid angle."""
    helper = np.eye(3)[int(np.argmin(np.abs(direction)))]
    right = np.cross(helper, direction)
    right /= np.linalg.norm(right)
    cos = 1.0 - float(at[0]) * (1.0 - np.cos(half))
    sin, phi = np.sqrt(max(0.0, 1.0 - cos * cos)), 2.0 * np.pi * float(at[1])
    aside = right * np.cos(phi) + np.cross(direction, right) * np.sin(phi)
    return np.asarray(direction * cos + aside * sin, dtype=np.float64)

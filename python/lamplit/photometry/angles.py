# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Directions and the angles of goniometers, both ways, with Lamplit's signs.

In the lamp's frame (axis +z, up +y, and +x to the right of an observer whom the axis points at):

    type A   (sin H cos V,  sin V,         cos H cos V)   polar axis ±y: automotive H and V
    type B   (sin H,        cos H sin V,   cos H cos V)   polar axis ±x
    type C   (sin γ sin C,  sin γ cos C,   cos γ)         polar axis ±z: C from +y towards +x

H is positive to the right of the observer, in types A and B. **In IES files H is positive on the
left of the observer**: turn its sign there (`file_horizontal_deg`), as `distribution` does.
Source: CONVENTIONS.md; CIE 121-1996 and ANSI/IESNA LM-63-2002, clause 3.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.photometry.distribution import PhotometricType

Array = NDArray[np.float64]


class Angles(NamedTuple):
    """Horizontal and vertical angles in degrees: H and V, or C and γ."""

    horizontal_deg: Array
    vertical_deg: Array


def directions(
    photometric_type: PhotometricType, horizontal_deg: ArrayLike, vertical_deg: ArrayLike
) -> Array:
    """Return unit vectors (…, 3) at angles (…) in degrees; the shapes broadcast.

    >>> directions("A", 90.0, 0.0).round(12).tolist()
    [1.0, 0.0, 0.0]
    """
    horizontal, vertical = np.broadcast_arrays(
        np.asarray(horizontal_deg, dtype=np.float64), np.asarray(vertical_deg, dtype=np.float64)
    )
    sin_h, cos_h = _sin_cos(horizontal)
    sin_v, cos_v = _sin_cos(vertical)
    if photometric_type == "A":
        parts = (sin_h * cos_v, sin_v, cos_h * cos_v)
    elif photometric_type == "B":
        parts = (sin_h, cos_h * sin_v, cos_h * cos_v)
    else:
        parts = (sin_v * sin_h, sin_v * cos_h, cos_v)
    return np.stack(parts, axis=-1)


def angles(photometric_type: PhotometricType, towards: ArrayLike) -> Angles:
    """Return the angles (…) of directions (…, 3) of any length but 0.

    Type A: H over −180 to 180, V over −90 to 90; type B: H over −90 to 90, V over −180 to 180;
    type C: C from 0 up to 360, γ from 0 to 180. At a pole the angle without a meaning is 0.

    >>> [float(angle) for angle in angles("C", [1.0, 0.0, 0.0])]
    [90.0, 90.0]
    """
    vectors = np.asarray(towards, dtype=np.float64)
    x, y, z = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    if photometric_type == "A":
        return Angles(_turn(x, z), np.degrees(np.arctan2(y, np.hypot(x, z))))
    if photometric_type == "B":
        return Angles(np.degrees(np.arctan2(x, np.hypot(y, z))), _turn(y, z))
    azimuth = np.mod(_turn(x, y), 360.0)
    # A tiny negative angle becomes 360 when it is rounded.
    azimuth = np.where(azimuth == 360.0, 0.0, azimuth)
    return Angles(azimuth, np.degrees(np.arctan2(np.hypot(x, y), z)))


def converted(
    own: PhotometricType,
    other: PhotometricType,
    horizontal_deg: ArrayLike,
    vertical_deg: ArrayLike,
) -> Angles:
    """Return in type ``other`` the angles of the directions that have these in type ``own``.

    >>> h, v = converted("C", "A", 90.0, 10.0)
    >>> round(float(h), 9), round(float(v), 9)
    (10.0, 0.0)
    """
    return angles(other, directions(own, horizontal_deg, vertical_deg))


def file_horizontal_deg(horizontal_deg: ArrayLike) -> Array:
    """Return what an IES file of type A or B calls the angle H, or the reverse: −H."""
    # 0 − H, and not −H, so that 0 stays 0 and is not written as −0.
    return 0.0 - np.asarray(horizontal_deg, dtype=np.float64)


def _turn(along: Array, base: Array) -> Array:
    """Return the angle in degrees from ``base`` towards ``along``; 0 where both are 0."""
    pole = (along == 0.0) & (base == 0.0)
    return np.where(pole, 0.0, np.degrees(np.arctan2(along, base)))


def _sin_cos(degrees: Array) -> tuple[Array, Array]:
    """Return sine and cosine, exact at whole quarters of a turn."""
    quarters = np.round(degrees / 90.0)
    rest = np.radians(degrees - 90.0 * quarters)
    sine, cosine = np.sin(rest), np.cos(rest)
    which = np.mod(quarters, 4.0)
    sines = np.select([which == 0, which == 1, which == 2], [sine, cosine, -sine], -cosine)
    cosines = np.select([which == 0, which == 1, which == 2], [cosine, -sine, -cosine], sine)
    # 0 and not −0, which atan2 would take for half a turn.
    return sines + 0.0, cosines + 0.0

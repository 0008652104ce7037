# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Display`: the colours that red, green and blue numbers stand for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.colour import icc
from lamplit.colour.transfer import REC2020, SRGB, PowerTransfer, Transfer
from lamplit.colour.tristimulus import xyz_of_xy
from lamplit.errors import LamplitError, nearest_name

Chromaticity: TypeAlias = tuple[float, float]

_D65: Chromaticity = (0.3127, 0.3290)

#: Triangles smaller than this, in x and y, hold no colours worth the name.
_LEAST_AREA = 1e-4


@dataclass(frozen=True)
class Display:
    """An RGB display: three primaries, a white, and a transfer function per channel.

    Tristimulus values are relative here: the display's white has Y = 1 and RGB = (1, 1, 1).

    >>> Display.named("srgb").xyz_to_rgb.round(3).tolist()[0]
    [3.241, -1.537, -0.499]
    """

    name: str
    #: x, y of red, green and blue.
    primaries_xy: tuple[Chromaticity, Chromaticity, Chromaticity]
    white_xy: Chromaticity
    transfer: tuple[Transfer, Transfer, Transfer]
    #: The four code points of ITU-T H.273 for PNG's cICP chunk: primaries, transfer, matrix, range.
    cicp: tuple[int, int, int, int] | None = None

    def __post_init__(self) -> None:
        """Refuse primaries and a white that make no display."""
        corners = np.array([*self.primaries_xy, self.white_xy], dtype=np.float64)
        if corners.shape != (4, 2) or not np.isfinite(corners).all():
            raise LamplitError(f"display {self.name}: x and y must be two finite numbers each")
        if abs(_doubled_area(corners[:3])) < 2.0 * _LEAST_AREA:
            raise LamplitError(
                f"display {self.name}: the three primaries span no triangle of colours"
            )
        if (corners[:, 1] <= 0.0).any() or (self._gains() <= 0.0).any():
            x, y = self.white_xy
            raise LamplitError(
                f"display {self.name}: every y must be above 0, and the white x = {x:g}, y = {y:g} "
                "must lie between the three primaries"
            )

    @staticmethod
    def named(name: str) -> Display:
        """Return ``srgb``, ``display-p3`` or ``rec2020``.

        Source: IEC 61966-2-1:1999; SMPTE EG 432-1:2010 with the sRGB transfer function and D65;
        Rec. ITU-R BT.2020-2.

        Raises:
            LamplitError: There is no such display.
        """
        try:
            return _NAMED[name]
        except KeyError:
            raise LamplitError(
                f"there is no display {name!r}{nearest_name(name, _NAMED)}; "
                f"choose one of {', '.join(_NAMED)}, or give primaries or an ICC profile"
            ) from None

    @staticmethod
    def from_primaries(
        primaries_xy: ArrayLike, white_xy: ArrayLike, gamma: float, *, name: str = "custom"
    ) -> Display:
        """Return a display with ``primaries_xy`` (3, 2), ``white_xy`` (2,) and a pure power law.

        Raises:
            LamplitError: The white does not lie inside the triangle, or γ is not positive.
        """
        corners = np.asarray(primaries_xy, dtype=np.float64)
        white = np.asarray(white_xy, dtype=np.float64)
        if corners.shape != (3, 2) or white.shape != (2,):
            raise LamplitError("a display needs three primaries and a white, each as [x, y]")
        if not (np.isfinite(gamma) and gamma > 0):
            raise LamplitError(f"a display's gamma must be above 0, and {gamma:g} is given")
        red, green, blue = ((float(x), float(y)) for x, y in corners)
        curve = PowerTransfer(float(gamma))
        return Display(
            name, (red, green, blue), (float(white[0]), float(white[1])), (curve, curve, curve)
        )

    @staticmethod
    def from_icc(path: Path) -> Display:
        """Return the display of an ICC profile that has three colorants and three curves.

        Raises:
            LamplitError: The file is no such profile; a profile with look-up tables only is not
                enough.
        """
        profile = icc.read_matrix_profile(path)
        red, green, blue = (_xy(column) for column in profile.colorants.T)
        white = _xy(profile.colorants.sum(axis=1))
        try:
            return Display(path.stem, (red, green, blue), white, profile.transfer)
        except LamplitError as fault:
            raise LamplitError(fault.message, file=path) from fault

    @cached_property
    def rgb_to_xyz(self) -> NDArray[np.float64]:
        """The 3×3 matrix from linear RGB to XYZ with Y = 1 for white."""
        return self._primaries_xyz() * self._gains()

    @cached_property
    def xyz_to_rgb(self) -> NDArray[np.float64]:
        """The 3×3 matrix from XYZ with Y = 1 for white to linear RGB."""
        return np.asarray(np.linalg.inv(self.rgb_to_xyz), dtype=np.float64)

    def encode(self, linear: ArrayLike) -> NDArray[np.float64]:
        """Return the signal (…, 3) in [0, 1] of linear RGB (…, 3), which is cut to [0, 1]."""
        rgb = np.asarray(linear, dtype=np.float64)
        return np.stack([t.encode(rgb[..., i]) for i, t in enumerate(self.transfer)], axis=-1)

    def decode(self, encoded: ArrayLike) -> NDArray[np.float64]:
        """Return linear RGB (…, 3) of the signal (…, 3) in [0, 1]."""
        rgb = np.asarray(encoded, dtype=np.float64)
        return np.stack([t.decode(rgb[..., i]) for i, t in enumerate(self.transfer)], axis=-1)

    def icc_profile(self) -> bytes:
        """Return an ICC v4 profile of this display, to embed in a picture."""
        return icc.write_matrix_profile(self.name, self.rgb_to_xyz, self.white_xy, self.transfer)

    def _primaries_xyz(self) -> NDArray[np.float64]:
        x, y = np.array(self.primaries_xy, dtype=np.float64).T
        return np.stack([x, y, 1.0 - x - y])

    def _gains(self) -> NDArray[np.float64]:
        """Return how much of each primary, at X + Y + Z = 1, makes white with Y = 1."""
        gains = np.linalg.solve(self._primaries_xyz(), xyz_of_xy(self.white_xy))
        return np.asarray(gains, dtype=np.float64)


def _xy(xyz: NDArray[np.float64]) -> Chromaticity:
    total = float(xyz.sum())
    return (float(xyz[0]) / total, float(xyz[1]) / total)


def _doubled_area(corners: NDArray[np.float64]) -> float:
    (ax, ay), (bx, by) = corners[1] - corners[0], corners[2] - corners[0]
    return float(ax * by - ay * bx)


_P3 = ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060))
_NAMED = {
    "srgb": Display(
        "srgb", ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06)), _D65, (SRGB, SRGB, SRGB), (1, 13, 0, 1)
    ),
    "display-p3": Display("display-p3", _P3, _D65, (SRGB, SRGB, SRGB), (12, 13, 0, 1)),
    "rec2020": Display(
        "rec2020",
        ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046)),
        _D65,
        (REC2020, REC2020, REC2020),
        (9, 14, 0, 1),
    ),
}

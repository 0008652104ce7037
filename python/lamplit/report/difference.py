# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How far the RGB picture of a scene is from its spectral one, in numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import LamplitError
from lamplit.report.develop import Developed, develop
from lamplit.report.summary import chromaticity

if TYPE_CHECKING:
    from lamplit.engine.image import Image

Array = NDArray[np.float64]

_MARKS = 5
#: Marks keep this share of the picture's smaller side between them.
_APART = 0.18
#: Pixels along the smaller side among which marks are looked for.
_SEARCHED = 200
#: A mark's surroundings, places along a side, and how far its ΔE00 is from theirs: by this share,
#: and by this ΔE00 besides.
_AROUND, _ALIKE, _UNSEEN = 5, 0.25, 0.5
#: Below this share of white a pixel is too dark for its colour to be worth a mark.
_DARK = 0.02


@dataclass(frozen=True, eq=False)
class Mark:
    """A pixel that is looked at more closely."""

    label: str
    row: int
    column: int
    delta_e: float
    #: XYZ (3,) in cd/m², and what the display shows for it (3,) in [0, 1].
    rgb_xyz: Array
    spectral_xyz: Array
    rgb_encoded: Array
    spectral_encoded: Array

    def as_json(self) -> dict[str, Any]:
        """Return the mark as plain JSON values."""
        return {
            "label": self.label,
            "row": self.row,
            "column": self.column,
            "delta_e_2000": self.delta_e,
            "rgb": _colour(self.rgb_xyz),
            "spectral": _colour(self.spectral_xyz),
        }


@dataclass(frozen=True, eq=False)
class Difference:
    """The two pictures under one white, and CIEDE2000 between their pixels."""

    rgb: Developed
    spectral: Developed
    #: ΔE00 per pixel, (H, W), from XYZ before any gamut mapping.
    delta_e: Array
    marks: tuple[Mark, ...]

    @property
    def mean(self) -> float:
        """Mean ΔE00 of the picture."""
        return float(self.delta_e.mean())

    @property
    def percentile_95(self) -> float:
        """The ΔE00 that 95 % of the pixels stay below."""
        return float(np.percentile(self.delta_e, 95))

    @property
    def largest(self) -> float:
        """The largest ΔE00."""
        return float(self.delta_e.max())


def measure_difference(
    spectral: Image, rgb: Image, *, marks: Sequence[tuple[int, int]] | None = None
) -> Difference:
    """Compare two renders of one scene pixel by pixel with CIEDE2000 (CIE 142-2001).

    Both are seen under the scene's white at the exposure of the spectral picture.
    ``marks`` are (column, row) of pixels to look at; without them, the places that differ most.

    Raises:
        LamplitError: The pictures differ in size, or `check_marks` refuses the marks.
    """
    from lamplit.colour.difference import delta_e_2000

    if spectral.xyz.shape != rgb.xyz.shape:
        raise LamplitError("the RGB and the spectral picture differ in size; render both alike")
    developed = develop(spectral)
    developed_rgb = develop(rgb, exposure=developed.exposure)
    delta_e = delta_e_2000(rgb.xyz, spectral.xyz, white_xyz=developed.white_xyz)
    if marks is None:
        seen = _seen(spectral, developed) & _seen(rgb, developed_rgb)
        places = _telling_places(delta_e, seen)
    else:
        check_marks(marks, width=spectral.width, height=spectral.height)
        places = [(row, column) for column, row in marks]
    found = tuple(
        Mark(
            label=str(number),
            row=row,
            column=column,
            delta_e=float(delta_e[row, column]),
            rgb_xyz=rgb.xyz[row, column],
            spectral_xyz=spectral.xyz[row, column],
            rgb_encoded=developed_rgb.picture.encoded[row, column],
            spectral_encoded=developed.picture.encoded[row, column],
        )
        for number, (row, column) in enumerate(places, start=1)
    )
    return Difference(developed_rgb, developed, delta_e, found)


def _seen(image: Image, developed: Developed) -> NDArray[np.bool_]:
    """Return where (H, W) a colour is neither nearly black nor paled by the display's limit."""
    dark = image.luminance_cd_m2 < _DARK * developed.white_luminance_cd_m2
    return ~dark & (developed.picture.linear.max(axis=-1) <= 1.0)


def _telling_places(difference: Array, seen: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return (row, column) of places apart that differ much and alike, the largest ΔE00 first.

    They are looked for where ``seen`` (H, W).
    """
    step = max(1, round(min(difference.shape) / _SEARCHED))
    left = _worth(difference[::step, ::step], seen[::step, ::step])
    rows, columns = np.ogrid[: left.shape[0], : left.shape[1]]
    apart = max(2.0, _APART * min(left.shape))
    places: list[tuple[int, int]] = []
    while len(places) < _MARKS and left.max() >= 0.0:
        row, column = (int(index) for index in np.unravel_index(left.argmax(), left.shape))
        places.append((row * step, column * step))
        left[np.hypot(rows - row, columns - column) < apart] = -1.0
    return sorted(places, key=lambda place: -difference[place])


def _worth(difference: Array, seen: NDArray[np.bool_]) -> Array:
    """Return how much a mark (H, W) would tell of its surroundings; -1 for nothing.

    That is the ΔE00 that three quarters of the surroundings exceed, where the place itself is
    like them: a thin rim, an edge or a noisy pixel is not.
    """
    from scipy.ndimage import percentile_filter

    around = percentile_filter(np.where(seen, difference, 0.0), 25, size=_AROUND)
    like = np.abs(difference - around) <= _ALIKE * around + _UNSEEN
    return np.where(seen & like, around, -1.0)


def check_marks(marks: Sequence[tuple[int, int]], *, width: int, height: int) -> None:
    """Find out before a render that ``marks`` (column, row) lie in the picture and fit the page.

    Raises:
        LamplitError: One does not, or there are more than five.
    """
    if len(marks) > _MARKS:
        raise LamplitError(f"{_MARKS} marks fit the page; {len(marks)} are given", where="--mark")
    for column, row in marks:
        if not (0 <= row < height and 0 <= column < width):
            raise LamplitError(
                f"the mark {column},{row} lies outside the picture of {width} x {height} pixels",
                where="--mark",
            )


def _colour(xyz: Array) -> dict[str, Any]:
    return {
        "luminance_cd_m2": float(xyz[1]),
        "xyz": [float(value) for value in xyz],
        "chromaticity_xy": chromaticity(xyz),
    }

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From tristimulus values to the picture that a display shows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.colour.adaptation import Adaptation, adaptation_matrix
from lamplit.colour.display import Display
from lamplit.colour.gamut import map_to_gamut, outside_gamut
from lamplit.colour.tone import photographic
from lamplit.errors import LamplitError

GamutMapping = Literal["map", "clip"]


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture for one display, and how much of it the display cannot show as it is."""

    #: Display values (H, W, 3) in [0, 1].
    encoded: NDArray[np.float64]
    #: Linear RGB (H, W, 3) before any tone curve and mapping, 1 at the white luminance.
    linear: NDArray[np.float64]
    #: Where the chromaticity lies outside the display's gamut, (H, W).
    out_of_gamut: NDArray[np.bool_]
    #: Share of the pixels that are out of gamut.
    gamut_share: float
    #: Share of the pixels that, without a tone curve, are brighter than the display can show
    #: their chromaticity.
    over_white_share: float


def linear_rgb(
    xyz: ArrayLike, *, display: Display, white_xy: ArrayLike, adaptation: Adaptation = "cat16"
) -> NDArray[np.float64]:
    """Return the display's linear RGB (…, 3) of XYZ (…, 3), in the unit of XYZ: white has Y = R.

    ``white_xy`` is brought to the display's white by ``adaptation``.
    """
    adapt = adaptation_matrix(white_xy, display.white_xy, method=adaptation)
    return np.asarray(xyz, dtype=np.float64) @ (display.xyz_to_rgb @ adapt).T


def to_picture(
    xyz_cd_m2: ArrayLike,
    *,
    display: Display,
    white_luminance_cd_m2: float,
    white_xy: ArrayLike,
    adaptation: Adaptation = "cat16",
    gamut: GamutMapping = "map",
    brightest_luminance_cd_m2: float | None = None,
) -> Picture:
    """Return the picture of XYZ in cd/m² (H, W, 3) on ``display``.

    ``white_luminance_cd_m2`` becomes the display's white, and ``white_xy``, the white that the eye
    in the scene is adapted to, is brought to the display's white by ``adaptation``. With a
    ``brightest_luminance_cd_m2``, the `photographic` tone curve bends all up to it into what the
    display can show. Colours that the display lacks are mapped with their hue (``map``) or cut off
    per channel (``clip``, which shifts hues).

    Raises:
        LamplitError: The white luminance is not positive, or XYZ holds numbers that are not
            finite.
    """
    xyz = np.asarray(xyz_cd_m2, dtype=np.float64)
    if not (np.isfinite(white_luminance_cd_m2) and white_luminance_cd_m2 > 0):
        raise LamplitError(
            f"the luminance of display white must be above 0, not {white_luminance_cd_m2:g} cd/m²"
        )
    if not np.isfinite(xyz).all():
        at = np.argwhere(~np.isfinite(xyz))[0].tolist()
        raise LamplitError(f"XYZ is not finite, first at {at}; a picture needs finite numbers")
    linear = linear_rgb(xyz, display=display, white_xy=white_xy, adaptation=adaptation)
    linear /= white_luminance_cd_m2
    shown = linear
    if brightest_luminance_cd_m2 is not None:
        reach = brightest_luminance_cd_m2 / white_luminance_cd_m2
        shown = photographic(shown, reach, display)
    if gamut == "map":
        shown = map_to_gamut(shown, display)[0]
    outside = outside_gamut(linear)
    return Picture(
        encoded=display.encode(shown),
        linear=linear,
        out_of_gamut=outside,
        gamut_share=float(outside.mean()),
        over_white_share=float((linear.max(axis=-1) > 1.0).mean()),
    )

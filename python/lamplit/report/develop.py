# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From tristimulus values to a picture on the scene's display."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lamplit.report.view import View

if TYPE_CHECKING:
    from lamplit.colour.display import Display
    from lamplit.colour.glare import Glare
    from lamplit.colour.picture import Picture
    from lamplit.engine.image import Image

Array = NDArray[np.float64]

#: With ``white_luminance_cd_m2 = "auto"`` the display can show this share of the pixels' colours
#: as bright as they are.
_AUTO_SHOWN_PERCENT = 99.0
#: With ``brightest_luminance_cd_m2 = "auto"`` the tone curve reaches this share of the pixels: a
#: few dots of noise do not darken all the rest.
_AUTO_REACHED_PERCENT = 99.99
_LABELS = {"srgb": "sRGB", "display-p3": "Display P3", "rec2020": "Rec. 2020"}


@dataclass(frozen=True)
class Exposure:
    """Which luminances, in cd/m², the display's white stands for."""

    white_luminance_cd_m2: float
    #: Where the photographic tone curve ends; None without one.
    brightest_luminance_cd_m2: float | None


@dataclass(frozen=True, eq=False)
class Developed:
    """A picture with the view it is for, and the white (scene's own) it is seen under."""

    picture: Picture
    view: View
    exposure: Exposure
    #: XYZ (3,) of the scene's white that the eye is adapted to, at the white luminance.
    white_xyz: Array

    @property
    def display(self) -> Display:
        """What the picture is shown on."""
        return self.view.display

    @property
    def white_luminance_cd_m2(self) -> float:
        """The luminance, in cd/m², that becomes the display's white."""
        return self.exposure.white_luminance_cd_m2

    @property
    def display_label(self) -> str:
        """The display's name as people write it."""
        return _LABELS.get(self.display.name, self.display.name)


def develop(image: Image, *, exposure: Exposure | None = None) -> Developed:
    """Return ``image`` as its scene's ``[display]`` shows it.

    ``exposure`` stands in for the scene's own, so that two pictures can share one.

    Raises:
        LamplitError: The display or the white of the scene cannot be used.
    """
    return develop_xyz(image.xyz, View.of(image.scene), exposure=exposure)


def develop_xyz(xyz: Array, view: View, *, exposure: Exposure | None = None) -> Developed:
    """Return tristimulus values (H, W, 3), in cd/m², as they are seen in ``view``."""
    from lamplit.colour.picture import to_picture
    from lamplit.colour.tristimulus import xyz_of_xy

    taken = automatic_exposure(xyz, view) if exposure is None else exposure
    picture = to_picture(
        _countable(xyz),
        display=view.display,
        white_luminance_cd_m2=taken.white_luminance_cd_m2,
        white_xy=view.white_xy,
        adaptation=view.settings.adaptation,
        gamut=view.settings.gamut,
        brightest_luminance_cd_m2=taken.brightest_luminance_cd_m2,
    )
    white_xyz = xyz_of_xy(view.white_xy, taken.white_luminance_cd_m2)
    return Developed(picture, view, taken, white_xyz)


def automatic_exposure(xyz: Array, view: View) -> Exposure:
    """Return the exposure that the view asks for, with every "auto" in it found from the picture.

    What counts is the largest of linear R, G and B, in cd/m² of white: of a saturated red it is
    far above the luminance, and no channel may be cut off, which would turn the red pink.

    - White, linear tone: the 99 % percentile of that over the pixels.
    - White, photographic tone: the geometric mean of the luminances that are not black becomes
      18 % of white.
    - Brightest, photographic tone: the 99.99 % percentile, and no less than white.

    A black picture has a white of 1 cd/m².
    """
    from lamplit.colour.picture import linear_rgb
    from lamplit.colour.tone import MIDDLE_GREY, key_luminance

    settings = view.settings
    white, brightest = settings.white_luminance_cd_m2, settings.brightest_luminance_cd_m2
    good = xyz[np.isfinite(xyz).all(axis=-1)]
    linear = linear_rgb(
        good, display=view.display, white_xy=view.white_xy, adaptation=settings.adaptation
    )
    largest = linear.max(axis=-1)
    photographic = settings.tone == "photographic"
    if white == "auto":
        key = key_luminance(good[..., 1]) / MIDDLE_GREY
        found = key if photographic else _percentile(largest, _AUTO_SHOWN_PERCENT)
        white = found if found > 0.0 else 1.0
    if not photographic:
        return Exposure(white, None)
    if brightest == "auto":
        brightest = _percentile(largest, _AUTO_REACHED_PERCENT)
    return Exposure(white, max(brightest, white))


def eye_glare(xyz: Array, view: View) -> Glare:
    """Return a copy of XYZ (H, W, 3), in cd/m², with the glare of the view's eye.

    Raises:
        LamplitError: The picture is not in perspective, and so has no angles.
    """
    from lamplit.colour.eye import Eye, pupil_diameter_mm
    from lamplit.colour.glare import field_deg2, with_glare

    own = view.settings.eye
    rows, columns = xyz.shape[:2]
    pitch = view.pixel_pitch(rows)
    light = _countable(xyz)
    pupil = own.pupil_mm
    if pupil == "auto":
        mean = max(float(light[..., 1].mean()), 0.0)
        pupil = pupil_diameter_mm(mean, field_deg2(rows, columns, pitch), own.age)
    return with_glare(light, Eye(own.age, pupil, own.pigmentation), pitch)


def _countable(xyz: Array) -> Array:
    """Return ``xyz`` with 0 where it is not finite; `summary` counts those."""
    return np.where(np.isfinite(xyz), xyz, 0.0)


def _percentile(values: Array, percent: float) -> float:
    return float(np.percentile(values, percent)) if values.size else 0.0

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From tristimulus values to a picture on the scene's display."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from lamplit.colour.display import Display
    from lamplit.colour.picture import Picture
    from lamplit.engine.image import Image
    from lamplit.scene import Scene

#: With ``white_luminance_cd_m2 = "auto"`` the display can show this share of the pixels' colours
#: as bright as they are.
_AUTO_SHOWN_PERCENT = 99.0
_LABELS = {"srgb": "sRGB", "display-p3": "Display P3", "rec2020": "Rec. 2020"}


@dataclass(frozen=True, eq=False)
class Developed:
    """A picture with the display it is for, and the white (scene's own) it is seen under."""

    picture: Picture
    display: Display
    #: The luminance, in cd/m², that becomes the display's white.
    white_luminance_cd_m2: float
    #: XYZ (3,) of the scene's white that the eye is adapted to, at that luminance.
    white_xyz: NDArray[np.float64]

    @property
    def display_label(self) -> str:
        """The display's name as people write it."""
        return _LABELS.get(self.display.name, self.display.name)


def develop(image: Image, *, white_luminance_cd_m2: float | None = None) -> Developed:
    """Return ``image`` as its scene's ``[display]`` shows it.

    ``white_luminance_cd_m2`` stands in for the scene's own, so that two pictures can share one
    white. ``auto`` takes that of `automatic_white`.

    Raises:
        LamplitError: The display or the white of the scene cannot be used.
    """
    from lamplit.colour.picture import to_picture
    from lamplit.colour.tristimulus import xyz_of_xy

    settings = image.scene.display
    white = white_luminance_cd_m2
    if white is None:
        asked = settings.white_luminance_cd_m2
        white = automatic_white(image) if asked == "auto" else float(asked)
    display = scene_display(image.scene)
    white_xy = scene_white_xy(image.scene)
    shown = np.where(np.isfinite(image.xyz), image.xyz, 0.0)  # `summary` counts what is not
    picture = to_picture(
        shown,
        display=display,
        white_luminance_cd_m2=white,
        white_xy=white_xy,
        adaptation=settings.adaptation,
        gamut=settings.gamut,
    )
    return Developed(picture, display, white, xyz_of_xy(white_xy, white))


def automatic_white(image: Image) -> float:
    """Return the luminance in cd/m² of display white that suits ``image``; 1 for a black picture.

    It is the 99 % percentile, over the pixels, of the largest of linear R, G and B per cd/m² of
    white: no channel of a saturated red is cut off, which would turn it pink.

    Raises:
        LamplitError: The display or the white of the scene cannot be used.
    """
    from lamplit.colour.picture import linear_rgb

    linear = linear_rgb(
        image.xyz[np.isfinite(image.xyz).all(axis=-1)],
        display=scene_display(image.scene),
        white_xy=scene_white_xy(image.scene),
        adaptation=image.scene.display.adaptation,
    )
    largest = linear.max(axis=-1)
    white = float(np.percentile(largest, _AUTO_SHOWN_PERCENT)) if largest.size else 0.0
    return white if white > 0.0 else 1.0


def check_display(scene: Scene) -> None:
    """Find out before a render that the scene's display and white can be used.

    Raises:
        LamplitError: They cannot.
    """
    scene_display(scene)
    scene_white_xy(scene)


def scene_display(scene: Scene) -> Display:
    """Return the display of the scene's ``display.space``: a name, primaries, or an ICC file."""
    from lamplit.colour.display import Display
    from lamplit.files import resolve_inside
    from lamplit.scene.camera import IccDisplay

    space = scene.display.space
    if isinstance(space, str):
        return Display.named(space)
    if isinstance(space, IccDisplay):
        return Display.from_icc(resolve_inside(scene.root, space.icc, where="display.space.icc"))
    return Display.from_primaries(space.primaries_xy, space.white_xy, space.gamma)


def scene_white_xy(scene: Scene) -> NDArray[np.float64]:
    """Return the chromaticity (2,) of the scene's white for its observer and wavelength range."""
    from lamplit.colour.tristimulus import chromaticity_xy, tristimulus

    white = scene.resolve_source(scene.display.white)
    xyz = tristimulus(
        white,
        observer=scene.image.observer,
        normalisation="relative",
        range_nm=scene.image.wavelength_range_nm,
    )
    return chromaticity_xy(xyz)

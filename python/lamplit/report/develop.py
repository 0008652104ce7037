# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From tristimulus values to a picture on the scene's display."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from pathlib import Path

    from lamplit.colour.display import Display
    from lamplit.colour.picture import Picture
    from lamplit.engine.image import Image
    from lamplit.scene import Scene
    from lamplit.scene.camera import DisplaySpace

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


@dataclass(frozen=True, eq=False)
class View:
    """How tristimulus values become a picture: what it is shown on, and the eye's white."""

    display: Display
    #: Chromaticity (2,) of the scene's white.
    white_xy: NDArray[np.float64]
    #: What becomes the display's white, in cd/m²; ``auto`` takes that of `automatic_white`.
    white_luminance_cd_m2: float | Literal["auto"]
    adaptation: Literal["cat16", "bradford", "none"]
    gamut: Literal["map", "clip"]

    @staticmethod
    def of(scene: Scene) -> View:
        """Return what the scene's ``[display]`` says.

        Raises:
            LamplitError: The display or the white of the scene cannot be used.
        """
        settings = scene.display
        return View(
            scene_display(scene),
            scene_white_xy(scene),
            settings.white_luminance_cd_m2,
            settings.adaptation,
            settings.gamut,
        )


def develop(image: Image, *, white_luminance_cd_m2: float | None = None) -> Developed:
    """Return ``image`` as its scene's ``[display]`` shows it.

    ``white_luminance_cd_m2`` stands in for the scene's own, so that two pictures can share one
    white.

    Raises:
        LamplitError: The display or the white of the scene cannot be used.
    """
    view = View.of(image.scene)
    if white_luminance_cd_m2 is not None:
        view = replace(view, white_luminance_cd_m2=white_luminance_cd_m2)
    return develop_xyz(image.xyz, view)


def develop_xyz(xyz: NDArray[np.float64], view: View) -> Developed:
    """Return tristimulus values (H, W, 3), in cd/m², as they are seen in ``view``."""
    from lamplit.colour.picture import to_picture
    from lamplit.colour.tristimulus import xyz_of_xy

    asked = view.white_luminance_cd_m2
    white = automatic_white(xyz, view) if asked == "auto" else asked
    shown = np.where(np.isfinite(xyz), xyz, 0.0)  # `summary` counts what is not
    picture = to_picture(
        shown,
        display=view.display,
        white_luminance_cd_m2=white,
        white_xy=view.white_xy,
        adaptation=view.adaptation,
        gamut=view.gamut,
    )
    return Developed(picture, view.display, white, xyz_of_xy(view.white_xy, white))


def automatic_white(xyz: NDArray[np.float64], view: View) -> float:
    """Return the luminance in cd/m² of display white that suits a picture; 1 for a black one.

    It is the 99 % percentile, over the pixels, of the largest of linear R, G and B per cd/m² of
    white: no channel of a saturated red is cut off, which would turn it pink.
    """
    from lamplit.colour.picture import linear_rgb

    linear = linear_rgb(
        xyz[np.isfinite(xyz).all(axis=-1)],
        display=view.display,
        white_xy=view.white_xy,
        adaptation=view.adaptation,
    )
    largest = linear.max(axis=-1)
    white = float(np.percentile(largest, _AUTO_SHOWN_PERCENT)) if largest.size else 0.0
    return white if white > 0.0 else 1.0


def check_display(scene: Scene) -> None:
    """Find out before a render that the scene's display and white can be used.

    Raises:
        LamplitError: They cannot.
    """
    View.of(scene)


def scene_display(scene: Scene) -> Display:
    """Return the display of the scene's ``display.space``: a name, primaries, or an ICC file."""
    return display_of(scene.display.space, root=scene.root)


def display_of(space: DisplaySpace, *, root: Path | None) -> Display:
    """Return the display that ``space`` describes; the file of an ICC profile lies below ``root``.

    Raises:
        LamplitError: It cannot be used, or is a profile and there is no root.
    """
    from lamplit.colour.display import Display
    from lamplit.errors import LamplitError
    from lamplit.files import resolve_inside
    from lamplit.scene.camera import IccDisplay

    if isinstance(space, str):
        return Display.named(space)
    if isinstance(space, IccDisplay):
        if root is None:
            raise LamplitError(
                "its display was the ICC profile of a file that is not at hand; name a --display"
            )
        return Display.from_icc(resolve_inside(root, space.icc, where="display.space.icc"))
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

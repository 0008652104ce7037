# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`View`: how tristimulus values are to be seen, in a scene and in the header of a picture."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter

from lamplit.errors import LamplitError
from lamplit.scene.camera import DisplaySettings

if TYPE_CHECKING:
    from pathlib import Path

    from lamplit.colour.display import Display
    from lamplit.scene import Scene
    from lamplit.scene.camera import DisplaySpace


@dataclass(frozen=True, eq=False)
class View:
    """How tristimulus values become a picture: what it is shown on, and whose eye looks."""

    display: Display
    #: Chromaticity (2,) of the scene's white.
    white_xy: NDArray[np.float64]
    #: The scene's ``[display]``; ``display`` and ``white_xy`` are what its space and white are.
    settings: DisplaySettings
    #: From the bottom to the top of the picture; None where it is no picture in perspective.
    field_of_view_deg: float | None

    def __post_init__(self) -> None:
        """Refuse glare where no angle is known."""
        if self.settings.glare and self.field_of_view_deg is None:
            raise LamplitError(
                "glare spreads light over angles, and an orthographic picture has none; "
                "take a pinhole or thin-lens camera",
                where="display.glare",
            )

    @staticmethod
    def of(scene: Scene) -> View:
        """Return what the scene's ``[display]`` and ``[camera]`` say.

        Raises:
            LamplitError: The display or the white of the scene cannot be used, or glare is asked
                for with an orthographic camera.
        """
        return View(
            display_of(scene.display.space, root=scene.root),
            scene_white_xy(scene),
            scene.display,
            getattr(scene.camera, "field_of_view_deg", None),
        )

    @staticmethod
    def read(written: Mapping[str, Any], changed: Mapping[str, object]) -> View:
        """Return the view that `facts` has ``written``, with values by key, "display.eye.age".

        Raises:
            LamplitError: The display was an ICC profile, or glare is asked for without angles.
            ValueError, KeyError, TypeError: These are no facts of a view.
        """
        from lamplit.scene.load import set_value

        settings = dict(written)
        tables = {"display": settings}
        white = TypeAdapter(tuple[float, float]).validate_python(settings.pop("white_xy"))
        field_deg = settings.pop("field_of_view_deg")
        for key, value in changed.items():
            set_value(tables, key, value)
        asked = DisplaySettings.model_validate(settings)
        display = display_of(asked.space, root=None)
        return View(
            display, np.array(white), asked, None if field_deg is None else float(field_deg)
        )

    def facts(self) -> dict[str, Any]:
        """Return the view as plain JSON values."""
        settings = self.settings.model_dump(mode="json", exclude={"white"})
        own = {"white_xy": self.white_xy.tolist(), "field_of_view_deg": self.field_of_view_deg}
        return settings | own

    def pixel_pitch(self, rows: int) -> float:
        """Return the tangent of the angle that a pixel in the middle of ``rows`` spans.

        Raises:
            LamplitError: The picture has no angles.
        """
        if self.field_of_view_deg is None:
            raise LamplitError("an orthographic picture has no angle per pixel")
        return 2.0 * math.tan(math.radians(self.field_of_view_deg) / 2.0) / rows


def check_display(scene: Scene) -> None:
    """Find out before a render that the scene's display, white and glare can be used.

    Raises:
        LamplitError: They cannot.
    """
    View.of(scene)


def display_of(space: DisplaySpace, *, root: Path | None) -> Display:
    """Return the display that ``space`` describes; the file of an ICC profile lies below ``root``.

    Raises:
        LamplitError: It cannot be used, or is a profile and there is no root.
    """
    from lamplit.colour.display import Display
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

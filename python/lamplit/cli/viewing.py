# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How a picture is to be seen: exposure, tone, false colours and glare, instead of the scene's."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Annotated, Any, Literal

import typer

from lamplit.cli.options import DisplayOption
from lamplit.errors import LamplitError


class ToneName(str, Enum):
    """The tone curves."""

    linear = "linear"
    photographic = "photographic"


@dataclass(frozen=True)
class ExposureOptions:
    """How light becomes a picture; what is not named is as the scene says."""

    display: DisplayOption = None
    white: Annotated[
        str | None,
        typer.Option(
            "--white", metavar="CD_M2", help="Exposure: this luminance is shown as white; or auto."
        ),
    ] = None
    tone: Annotated[
        ToneName | None,
        typer.Option(
            "--tone", help="Light above white: cut off, or bent into what the display can show."
        ),
    ] = None
    brightest: Annotated[
        str | None,
        typer.Option(
            "--brightest",
            metavar="CD_M2",
            help="This luminance is the brightest that --tone photographic shows; or auto.",
        ),
    ] = None

    def overrides(self) -> dict[str, Any]:
        """Return what the options say as values by key, such as ``{"display.tone": "linear"}``.

        Raises:
            LamplitError: A luminance cannot be read.
        """
        return _named(
            {
                "display.space": None if self.display is None else self.display.value,
                "display.white_luminance_cd_m2": _luminance(self.white, "--white"),
                "display.tone": None if self.tone is None else self.tone.value,
                "display.brightest_luminance_cd_m2": _luminance(self.brightest, "--brightest"),
            }
        )


@dataclass(frozen=True)
class ViewOptions(ExposureOptions):
    """The exposure, and what else is drawn beside the picture."""

    false_colour: Annotated[
        bool, typer.Option("--false-colour", help="Also draw the luminance, with a scale in cd/m².")
    ] = False
    glare: Annotated[
        bool, typer.Option("--glare", help="Also draw the picture with the glare of the eye.")
    ] = False
    age: Annotated[
        float | None,
        typer.Option("--age", min=20, max=80, metavar="YEARS", help="Glare of an eye so old."),
    ] = None
    pupil_mm: Annotated[
        float | None,
        typer.Option(
            "--pupil-mm",
            min=2,
            max=8,
            metavar="MM",
            help="Glare of an eye with such a pupil; else it follows from the picture.",
        ),
    ] = None

    def overrides(self) -> dict[str, Any]:
        """Return what the options say as values by key; who names an eye wants its glare.

        Raises:
            LamplitError: A luminance cannot be read.
        """
        glare = self.glare or self.age is not None or self.pupil_mm is not None
        return super().overrides() | _named(
            {
                "display.false_colour": self.false_colour or None,
                "display.glare": glare or None,
                "display.eye.age": self.age,
                "display.eye.pupil_mm": self.pupil_mm,
            }
        )


def _named(values: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in values.items() if value is not None}


def _luminance(text: str | None, option: str) -> float | Literal["auto"] | None:
    if text is None:
        return None
    if text == "auto":
        return "auto"
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value > 0.0):
        raise LamplitError(
            f"{text!r} is no luminance; write cd/m² such as 500, or auto", where=option
        )
    return value

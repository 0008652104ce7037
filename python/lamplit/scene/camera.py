# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The camera, the image that it takes, and the display that will show it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal, TypeAlias

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from lamplit.scene.fields import Direction, FileName, Length, Number, Point, Positive, Table
from lamplit.spectra_spec import NamedSource, SourceSpec

#: The most pixels one picture may have.
MOST_PIXELS = 100_000_000
#: The most samples one pixel may have: the core knows this many points of the Sobol sequence.
MOST_SAMPLES = 65_536

Chromaticity: TypeAlias = Annotated[tuple[Number, Number], Field(strict=False)]


class _Camera(Table):
    position_mm: Point = Field(description="where the camera stands")
    target_mm: Point = Field(description="the point in the middle of the picture")
    up: Direction = Field(default=(0.0, 1.0, 0.0), description="this way is up in the picture")

    @model_validator(mode="after")
    def _looks_somewhere(self) -> _Camera:
        view = np.subtract(self.target_mm, self.position_mm)
        distance = float(np.linalg.norm(view))
        if distance < 1e-9:
            raise PydanticCustomError(
                "looks_nowhere",
                "the camera looks nowhere: position_mm and target_mm are the same point",
            )
        up = np.divide(self.up, np.linalg.norm(self.up))
        if float(np.linalg.norm(np.cross(view / distance, up))) < 1e-6:
            raise PydanticCustomError(
                "up_along_view",
                "up is parallel to the view from position_mm to target_mm; choose another up",
            )
        return self


class PinholeCamera(_Camera):
    """A camera that sees in perspective from one point."""

    kind: Literal["pinhole"]
    field_of_view_deg: Annotated[Number, Field(gt=0.0, lt=180.0)] = Field(
        default=30.0, description="from the bottom to the top of the picture"
    )


class OrthographicCamera(_Camera):
    """A camera that looks along parallel rays."""

    kind: Literal["orthographic"]
    height_mm: Length = Field(description="from the bottom to the top of the picture")


class ThinLensCamera(_Camera):
    """A camera that sees in perspective through an ideal lens: what is not in focus is blurred."""

    kind: Literal["thin-lens"]
    field_of_view_deg: Annotated[Number, Field(gt=0.0, lt=180.0)] = Field(
        default=30.0, description="from the bottom to the top of the picture"
    )
    aperture_mm: Length = Field(description="diameter of the lens's opening")
    focus_mm: Length | None = Field(
        default=None,
        description="from the lens to the plane in focus; left out: through target_mm",
    )

    @property
    def focus_distance_mm(self) -> float:
        """The distance of the plane in focus, along the view."""
        if self.focus_mm is not None:
            return self.focus_mm
        return float(np.linalg.norm(np.subtract(self.target_mm, self.position_mm)))


Camera: TypeAlias = Annotated[
    PinholeCamera | ThinLensCamera | OrthographicCamera, Field(discriminator="kind")
]


class ImageSettings(Table):
    """Method, size, sampling, and the wavelengths that are followed."""

    method: Literal["auto", "path", "lit", "hall"] = Field(
        default="auto",
        description="physical light transport: path, or lit, which looks for small lights behind "
        "optics; auto: lit where an object shines; hall: the founding method",
    )
    width: int = Field(default=640, ge=1, le=16384, description="pixels")
    height: int = Field(default=400, ge=1, le=16384, description="pixels")
    samples: int = Field(
        default=16,
        ge=1,
        le=MOST_SAMPLES,
        description="rays from the camera per pixel; a grid needs a square number",
    )
    error: Annotated[Positive, Field(le=1.0)] | None = Field(
        default=None,
        description="path, lit: standard error of a pixel's luminance, as a share, to sample down to",
    )
    sampling: Literal["grid", "sobol"] = Field(
        default="grid",
        description="hall: an even grid in each pixel, or scrambled Sobol points: no moiré; "
        "others: always Sobol",
    )
    filter: Literal["box", "tent", "gaussian"] = Field(
        default="gaussian",
        description="how samples spread about the pixel's middle",
    )
    seed: int = Field(
        default=1, ge=0, lt=2**63, description="of all random numbers: the same, the same picture"
    )
    observer: Literal["cie-1931-2", "cie-1964-10", "cie-2015-2"] = Field(
        default="cie-1931-2", description="whose colour-matching functions give X, Y and Z"
    )
    wavelength_range_nm: Annotated[tuple[Number, Number], Field(strict=False)] = Field(
        default=(380.0, 780.0), description="the lowest and the highest wavelength that is followed"
    )

    @model_validator(mode="after")
    def _hangs_together(self) -> ImageSettings:
        if self.width * self.height > MOST_PIXELS:
            raise PydanticCustomError(
                "too_many_pixels",
                "{pixels} pixels are asked for, and at most {most} can be rendered",
                {"pixels": self.width * self.height, "most": MOST_PIXELS},
            )
        side = round(self.samples**0.5)
        on_a_grid = self.method == "hall" and self.sampling == "grid"
        if on_a_grid and side * side != self.samples:
            raise PydanticCustomError(
                "not_square",
                'samples: a grid needs a square number, such as {near}; or say sampling = "sobol"',
                {"near": side * side},
            )
        low, high = self.wavelength_range_nm
        if not (200.0 <= low < high <= 2500.0 and high - low >= 10.0):
            raise PydanticCustomError(
                "wavelength_range",
                "wavelength_range_nm: from a lower to a higher wavelength, "
                "10 nm apart at least, between 200 and 2500 nm",
            )
        return self


class CustomDisplay(Table):
    """A display by its primaries, its white and its gamma."""

    primaries_xy: Annotated[
        tuple[Chromaticity, Chromaticity, Chromaticity], Field(strict=False)
    ] = Field(description="chromaticities x, y of red, green and blue")
    white_xy: Chromaticity = Field(description="chromaticity x, y of its white")
    gamma: Annotated[Positive, Field(le=10.0)] = Field(
        description="light is the display value to this power"
    )


class IccDisplay(Table):
    """A display by its ICC profile."""

    icc: FileName = Field(description="profile file below the scene's folder")


def _display_form(value: object) -> str:
    if isinstance(value, IccDisplay) or (isinstance(value, Mapping) and "icc" in value):
        return "<icc>"
    return "<custom>" if isinstance(value, (Mapping, CustomDisplay)) else "<name>"


DisplaySpace: TypeAlias = Annotated[
    Annotated[Literal["srgb", "display-p3", "rec2020"], Tag("<name>")]
    | Annotated[CustomDisplay, Tag("<custom>")]
    | Annotated[IccDisplay, Tag("<icc>")],
    Discriminator(_display_form),
]


class EyeSettings(Table):
    """Whose eye the glare is that of."""

    age: Annotated[Number, Field(ge=20.0, le=80.0)] = Field(
        default=35.0, description="years: an older eye scatters more"
    )
    pupil_mm: Annotated[Number, Field(ge=2.0, le=8.0)] | Literal["auto"] = Field(
        default="auto",
        description="diameter; auto: that of an eye adapted to the picture's mean luminance",
    )
    pigmentation: Annotated[Number, Field(ge=0.0, le=1.2)] = Field(
        default=0.5, description="0 for black eyes, 0.5 brown, 1 green, 1.2 light blue"
    )


class DisplaySettings(Table):
    """How the tristimulus values become a picture on a display."""

    space: DisplaySpace = Field(default="srgb", description="the display that the picture is for")
    white_luminance_cd_m2: Positive | Literal["auto"] = Field(
        default="auto",
        description="this luminance becomes the display's white; auto: 99 % of the pixels fit, or "
        "with the photographic tone, the picture's middle becomes middle grey",
    )
    tone: Literal["linear", "photographic"] = Field(
        default="linear",
        description="light above white is cut off, or bent into what the display can show",
    )
    brightest_luminance_cd_m2: Positive | Literal["auto"] = Field(
        default="auto",
        description="photographic: this luminance is shown as bright as the display can; auto: "
        "that of the picture's brightest pixels",
    )
    white: SourceSpec = Field(
        default=NamedSource("D65"), description="the white that the eye is adapted to"
    )
    adaptation: Literal["cat16", "bradford", "none"] = Field(
        default="cat16", description="how colours move from the scene's white to the display's"
    )
    gamut: Literal["map", "clip"] = Field(
        default="map",
        description="colours that the display lacks: map keeps their hue, clip shifts it",
    )
    false_colour: bool = Field(
        default=False, description="also draw the luminance, with a scale in cd/m²"
    )
    glare: bool = Field(
        default=False, description="also draw the picture with the glare of the eye"
    )
    eye: EyeSettings = Field(default_factory=EyeSettings, description="whose glare it is")

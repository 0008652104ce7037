# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What shines from an object's surface: a spectrum, a strength, and where it goes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from lamplit.scene.fields import (
    Amount,
    Direction,
    FileName,
    GroupName,
    NotNegative,
    Positive,
    Table,
)
from lamplit.sources import BulbName
from lamplit.spectra_spec import FractionSpec, SourceSpec
from lamplit.spectrum import SpectralDistribution

if TYPE_CHECKING:
    from lamplit.photometry import Photometry

#: The keys of which a source needs exactly one.
_STRENGTHS = ("flux_lm", "flux_lm_at_25_celsius", "bulb", "radiant_flux_w", "luminance_cd_m2")

#: What `ResolvedEmission.amount` counts.
Quantity: TypeAlias = Literal["flux_lm", "radiant_flux_w", "luminance_cd_m2", "spectral_radiance"]


class CosineDistribution(Table):
    """A flat face has the intensity cosⁿ θ, θ from its normal; n = 1 is Lambert's law."""

    cosine_exponent: Annotated[NotNegative, Field(le=10_000.0)] = Field(
        description="n: 0 is the same to all sides, the larger the narrower"
    )


class FileDistribution(Table):
    """The intensities of a photometric file; its own flux is not used."""

    file: FileName = Field(description="IES LM-63 (.ies) or EULUMDAT (.ldt) file")
    axis: Direction = Field(
        default=(0.0, 0.0, 1.0),
        description="where γ = 0 (or H = V = 0) points, before the object's transform",
    )
    up: Direction = Field(
        default=(0.0, 1.0, 0.0), description="the side of C = 0 (or of V > 0); square to the axis"
    )

    @model_validator(mode="after")
    def _has_a_side(self) -> FileDistribution:
        axis, up = (np.divide(way, np.linalg.norm(way)) for way in (self.axis, self.up))
        if float(np.linalg.norm(np.cross(axis, up))) < 1e-6:
            raise PydanticCustomError(
                "up_along_axis", "up is parallel to axis; choose another up, such as [1, 0, 0]"
            )
        return self

    def frame(self) -> NDArray[np.float64]:
        """Return rows x, y, z (3, 3): y is up, made square to the axis z; right-handed."""
        z = np.divide(self.axis, np.linalg.norm(self.axis))
        x = np.cross(self.up, z)
        x /= np.linalg.norm(x)
        return np.stack([x, np.cross(z, x), z])


def _distribution_form(value: object) -> str:
    if isinstance(value, Mapping):
        return "<file>" if {"file", "axis", "up"} & {*value} else "<cosine>"
    if isinstance(value, CosineDistribution):
        return "<cosine>"
    return "<file>" if isinstance(value, FileDistribution) else "<name>"


Distribution: TypeAlias = Annotated[
    Annotated[Literal["lambert"], Tag("<name>")]
    | Annotated[CosineDistribution, Tag("<cosine>")]
    | Annotated[FileDistribution, Tag("<file>")],
    Discriminator(_distribution_form),
]


class Emission(Table):
    """Light from the outward side of the object's surface."""

    source: SourceSpec | None = Field(
        default=None, description="the shape of the spectrum; its scale has no meaning"
    )
    flux_lm: Amount | None = Field(default=None, description="luminous flux of the object")
    flux_lm_at_25_celsius: Amount | None = Field(
        default=None,
        description="that of its LED when cold, as in data sheets; its heat is counted",
    )
    bulb: BulbName | None = Field(
        default=None, description="the flux of a bulb; `lamplit sources` lists them"
    )
    radiant_flux_w: Amount | None = Field(
        default=None, description="radiant flux of the object within image.wavelength_range_nm"
    )
    luminance_cd_m2: NotNegative | None = Field(
        default=None, description="luminance along the normal"
    )
    temperature_kelvin: Annotated[Positive, Field(ge=100, le=1e5)] | None = Field(
        default=None, description="instead of source and strength: Planck's law"
    )
    emissivity: FractionSpec | None = Field(
        default=None, description="with temperature_kelvin: share of Planck's radiance; default 1"
    )
    distribution: Distribution = Field(
        default="lambert", description="how the light spreads over directions"
    )
    group: GroupName | None = Field(
        default=None, description="light group; default: the object's name"
    )

    @model_validator(mode="after")
    def _has_one_strength(self) -> Emission:
        given = [name for name in _STRENGTHS if getattr(self, name) is not None]
        if self.source is not None and self.temperature_kelvin is not None:
            raise _fault(
                "source and temperature_kelvin are both given; "
                "keep source with a strength, or temperature_kelvin alone"
            )
        if self.source is None and self.temperature_kelvin is None:
            raise _fault("a source with a strength is needed, or temperature_kelvin")
        if self.temperature_kelvin is None:
            self._check_source(given)
        elif given:
            raise _fault(
                f"temperature_kelvin sets the strength, and {given[0]} is given too; for another "
                f"strength say source = {{ temperature_kelvin = {self.temperature_kelvin:g} }}"
            )
        elif self.distribution != "lambert":
            raise _fault(
                "what glows by temperature_kelvin follows Lambert's law; for a distribution "
                "give a source with flux_lm"
            )
        return self

    def _check_source(self, given: list[str]) -> None:
        if len(given) != 1:
            found = " and ".join(given) + " are" if given else "none is"
            raise _fault(f"exactly one of {', '.join(_STRENGTHS)} is needed, and {found} given")
        if self.emissivity is not None:
            raise _fault("emissivity belongs to temperature_kelvin, and a source is given")
        if isinstance(self.distribution, FileDistribution) and given == ["luminance_cd_m2"]:
            raise _fault(
                "a photometric file spreads a flux, not a luminance; give flux_lm or radiant_flux_w"
            )


def _fault(message: str) -> PydanticCustomError:
    return PydanticCustomError("emission", "{message}", {"message": message})


@dataclass(frozen=True, eq=False)
class ResolvedEmission:
    """An object's emission with its source and its photometric file looked up.

    ``spectrum`` has a shape alone, and ``amount`` of ``quantity`` is what the whole object gives
    (lm; W within the picture's wavelengths) or its luminance along the normal (cd/m²). For the
    quantity "spectral_radiance" ``spectrum`` is it, in W·m⁻²·sr⁻¹·nm⁻¹, and ``amount`` is 1.

    ``photometry`` has its axis along +z and its reference along +y of ``frame``, whose rows (3, 3)
    are x, y, z of the luminaire in the scene; without it, a flat face has the intensity
    cos θ to the power of ``cosine_exponent``.
    """

    group: str
    spectrum: SpectralDistribution
    quantity: Quantity
    amount: float
    cosine_exponent: float
    photometry: Photometry | None
    frame: NDArray[np.float64]

    @property
    def shines(self) -> bool:
        """Whether any light comes of it."""
        return self.amount > 0.0

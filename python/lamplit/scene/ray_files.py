# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`[[ray_files]]`: sources that a maker measured ray by ray, for forward transport."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from lamplit.scene.fields import FileName, GroupName, Name, Positive, Table
from lamplit.scene.objects import Transform
from lamplit.spectra_spec import SourceSpec
from lamplit.spectrum import SpectralDistribution


class RayFile(Table):
    """A source as rays; nothing stands where they start, unless an object does."""

    name: Name = Field(description="a name of its own, for messages")
    file: FileName = Field(description="IES TM-25 (.tm25ray) or Zemax binary (.dat, .sdf) file")
    unit: Literal["mm", "cm", "m", "in"] | None = Field(
        default=None, description="of its lengths; default: what the file says, for TM-25 mm"
    )
    source: SourceSpec | None = Field(
        default=None, description="spectrum of all rays; needed where the file has none"
    )
    flux_lm: Annotated[Positive, Field(le=1e9)] | None = Field(
        default=None, description="luminous flux of all rays; default: the sum of theirs"
    )
    transform: Transform = Field(default=Transform(), description="moves it into the scene")
    group: GroupName | None = Field(default=None, description="light group; default: its name")


@dataclass(frozen=True, eq=False)
class ResolvedRays:
    """Rays in the scene's coordinates, n of them, with one spectrum or a wavelength each.

    With a ``spectrum``, which has a shape alone, ``flux`` is in lm. With ``wavelengths_nm``, which
    all lie within the picture's, it is in W.
    """

    name: str
    group: str
    #: (n, 3), in mm.
    positions_mm: NDArray[np.float64]
    #: (n, 3), of length 1.
    directions: NDArray[np.float64]
    #: (n,), 0 and above, in lm or W.
    flux: NDArray[np.float64]
    spectrum: SpectralDistribution | None
    #: (n,), in nm.
    wavelengths_nm: NDArray[np.float64] | None
    #: What was noticed about the file, one line each.
    notices: tuple[str, ...]

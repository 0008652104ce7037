# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Observed`: luminous intensity and colour of one function of a lamp, with their uncertainty."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamplit.photometry.chromaticity import Chromaticities, chromaticity_covariance

Array = NDArray[np.float64]

#: A colour is known where the intensity is above so many of its standard errors. That takes some
#: thirty hits. Of one hit X, Y and Z scatter together, so that x and y do not seem to scatter.
COLOUR_SIGMAS = 5.0


@dataclass(frozen=True, eq=False)
class Observed:
    """What a goniometer reads of one function of a lamp: at spots, and over an H–V grid.

    Directions are (sin H cos V, sin V, cos H cos V) in the lamp's frame, whose axis is +z with +y
    up: H > 0 is to the right of an observer before the lamp. Every σ is one standard error, and an
    upper bound where few walks or none arrived (`lamplit.photometry.chance`).
    """

    #: Name of the function, such as "stop".
    name: str
    #: (p,), where the receiver stood.
    spot_h_deg: Array
    spot_v_deg: Array
    #: (p, 3), the intensity as X, Y, Z; Y is the luminous intensity in cd.
    spot_xyz: Array
    #: (p, 3, 3), the covariance of those three, cd².
    spot_xyz_covariance: Array
    #: (h + 1,) and (v + 1,), the borders of the cells of the grid.
    grid_h_edges_deg: Array
    grid_v_edges_deg: Array
    #: (v, h, 3), the mean intensity in each cell as X, Y, Z, in cd.
    grid_xyz: Array
    #: (v, h), the standard error of its Y, in cd.
    grid_standard_error_cd: Array
    #: Paths walked: σ falls as 1/√paths.
    paths: int

    @property
    def spot_cd(self) -> Array:
        """Return the luminous intensity at the spots, (p,), in cd."""
        return self.spot_xyz[:, 1]

    @property
    def spot_standard_error_cd(self) -> Array:
        """Return the standard error of `spot_cd`, (p,), in cd."""
        return np.sqrt(self.spot_xyz_covariance[:, 1, 1])

    @property
    def spot_colours(self) -> Chromaticities:
        """Return the chromaticities at the spots, known where Y is above 5 σ."""
        xy, covariance = chromaticity_covariance(self.spot_xyz, self.spot_xyz_covariance)
        cd = self.spot_cd
        is_known = (cd > 0.0) & (cd >= COLOUR_SIGMAS * self.spot_standard_error_cd)
        return Chromaticities(xy, np.where(is_known[:, None, None], covariance, np.nan), is_known)

    @property
    def grid_cd(self) -> Array:
        """Return the luminous intensity of the grid's cells, (v, h), in cd."""
        return self.grid_xyz[..., 1]

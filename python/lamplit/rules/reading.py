# SPDX-License-Identifier: Apache-2.0 OR MIT
"""What an `Observed` says in one direction or in cells."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import RuleError
from lamplit.photometry.observed import Observed
from lamplit.rules.extents import Box

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

#: Two directions closer than this are the same.
_SAME_DEG = 0.01
_DARK = "no light arrives here, below any minimum; σ is an upper bound"


class Reading(NamedTuple):
    """A luminous intensity and its standard error, in cd."""

    cd: float
    standard_error: float
    remark: str = ""


@dataclass(frozen=True, eq=False)
class CellReadings:
    """The cells of a grid: (v, h) intensities and standard errors in cd, and their middles."""

    cd: Array
    standard_error: Array
    h_deg: Array
    v_deg: Array
    h_edges_deg: Array
    v_edges_deg: Array

    def inside(self, box: Box) -> Mask:
        """Return (v, h), which cells have their middle in a range."""
        h = (self.h_deg > box.left_deg) & (self.h_deg < box.right_deg)
        v = (self.v_deg > box.bottom_deg) & (self.v_deg < box.top_deg)
        return v[:, None] & h[None, :]

    def covers(self, box: Box) -> bool:
        """Return whether the grid reaches to the borders of a range."""
        return bool(
            self.h_edges_deg[0] <= box.left_deg + _SAME_DEG
            and self.h_edges_deg[-1] >= box.right_deg - _SAME_DEG
            and self.v_edges_deg[0] <= box.bottom_deg + _SAME_DEG
            and self.v_edges_deg[-1] >= box.top_deg - _SAME_DEG
        )

    @property
    def size_deg(self) -> float:
        """Return the longest side of a cell."""
        widths = np.concatenate([np.diff(self.h_edges_deg), np.diff(self.v_edges_deg)])
        return float(widths.max())


def spot_readings(observed: Observed) -> tuple[Reading, ...]:
    """Return the reading of each spot, (p,)."""
    pairs = zip(observed.spot_cd, observed.spot_standard_error_cd, strict=True)
    return tuple(Reading(float(cd), float(error), "" if cd > 0.0 else _DARK) for cd, error in pairs)


def cell_readings(observed: Observed) -> CellReadings:
    """Return the grid of ``observed``."""
    h_edges, v_edges = observed.grid_h_edges_deg, observed.grid_v_edges_deg
    v = 0.5 * (v_edges[:-1] + v_edges[1:])
    h = 0.5 * (h_edges[:-1] + h_edges[1:])
    return CellReadings(observed.grid_cd, observed.grid_standard_error_cd, h, v, h_edges, v_edges)


def spot_index(observed: Observed, h_deg: float, v_deg: float, rule: str) -> int:
    """Return which spot stands in a direction.

    Raises:
        RuleError: None does.
    """
    distance = _distances(observed, h_deg, v_deg)
    if len(distance) == 0 or distance.min() > _SAME_DEG:
        raise RuleError(
            f"{rule} needs the direction H {h_deg:g}, V {v_deg:g}, which was not measured; "
            "measure all of rule.spots()"
        )
    return int(np.argmin(distance))


def spots_within(observed: Observed, h_deg: float, v_deg: float, radius_deg: float) -> list[int]:
    """Return which spots lie within ``radius_deg`` of a direction."""
    near = _distances(observed, h_deg, v_deg) <= radius_deg + 1e-6
    return [int(at) for at in np.flatnonzero(near)]


def _distances(observed: Observed, h_deg: float, v_deg: float) -> Array:
    return np.hypot(observed.spot_h_deg - h_deg, observed.spot_v_deg - v_deg)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Where a lamp's light is caught: the goniometer's frame, its receivers, and their solid angles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit import _core
from lamplit.errors import LamplitError, SceneError
from lamplit.scene import Scene
from lamplit.scene.measuring import MeasureSettings

Array = NDArray[np.float64]

_MM_PER_M = 1e3
#: Cells of a grid, at most: each takes some 800 bytes for each light group.
_MOST_CELLS = 1_000_000
#: Borders of the grid's cells where nothing else is asked for: 1° over the front half space.
_EDGES_DEG = np.arange(-90.0, 90.5)


@dataclass(frozen=True, eq=False, kw_only=True)
class Plane:
    """A rectangle whose front catches light, in ``columns`` by ``rows`` pixels from the top."""

    centre_mm: Sequence[float]
    #: The front's outward direction, towards the lamp.
    normal: Sequence[float]
    width_mm: float
    height_mm: float
    columns: int
    rows: int
    up: Sequence[float] = (0.0, 1.0, 0.0)

    @property
    def pixel_m2(self) -> float:
        """The area of one pixel in m²."""
        return self.width_mm * self.height_mm * 1e-6 / (self.columns * self.rows)

    def for_core(self) -> tuple[Sequence[float], Sequence[float], Sequence[float], list[int]]:
        """Return the middle, half the width and half the height as vectors, columns and rows.

        Raises:
            LamplitError: The rectangle has no area, no pixels, or ``up`` is along its normal.
        """
        if min(self.width_mm, self.height_mm, self.columns, self.rows) <= 0:
            raise LamplitError(
                "a plane to measure needs a width, a height, columns and rows above 0"
            )
        normal = np.asarray(self.normal, float)
        right = np.cross(self.up, normal)
        if not np.linalg.norm(right) > 1e-9 * np.linalg.norm(normal) > 0.0:
            raise LamplitError("a plane to measure needs a normal, and an up that is not along it")
        right /= np.linalg.norm(right)
        upright = np.cross(normal, right) / np.linalg.norm(normal)
        half_width, half_height = right * self.width_mm / 2.0, upright * self.height_mm / 2.0
        size = [self.columns, self.rows]
        return list(self.centre_mm), half_width.tolist(), half_height.tolist(), size


@dataclass(frozen=True, eq=False, kw_only=True)
class Goniometer:
    """Receivers round a lamp: round spots of ``receiver_deg``, and the cells of an H–V grid."""

    axis: tuple[float, float, float]
    up: tuple[float, float, float]
    centre_mm: tuple[float, float, float]
    #: None is the far field.
    distance_m: float | None
    receiver_deg: float
    #: (p,) and (p,).
    spot_h_deg: Array
    spot_v_deg: Array
    #: (h + 1,) and (v + 1,), rising.
    h_edges_deg: Array
    v_edges_deg: Array
    plane: Plane | None = None
    #: Spectral bands per lane of spots, and of cells.
    spot_bands: int = 0
    cell_bands: int = 0
    #: Where the receiver's distance was said, for errors.
    where: str = field(default="measure.distance_m")

    @property
    def spot_sr(self) -> float:
        """The solid angle of a spot."""
        return float(4.0 * np.pi * np.sin(np.radians(self.receiver_deg) / 4.0) ** 2)

    @property
    def cell_sr(self) -> Array:
        """The solid angles of the cells, (v, h): ΔH (sin V₂ − sin V₁)."""
        width = np.diff(np.radians(self.h_edges_deg))
        height = np.diff(np.sin(np.radians(self.v_edges_deg)))
        return height[:, None] * width[None, :]

    def directions(self) -> Array:
        """Return the unit vectors to the spots in the scene, (p, 3)."""
        h, v = np.radians(self.spot_h_deg), np.radians(self.spot_v_deg)
        local = np.stack([np.sin(h) * np.cos(v), np.sin(v), np.cos(h) * np.cos(v)], axis=-1)
        return local @ self.frame()

    def frame(self) -> Array:
        """Return rows (3, 3): to the right as an observer before the lamp sees it, up, the axis."""
        z = np.divide(self.axis, np.linalg.norm(self.axis))
        x = np.cross(self.up, z)
        x /= np.linalg.norm(x)
        return np.stack([x, np.cross(z, x), z])

    def for_core(self) -> _core.Receivers:
        """Return it as the compiled core takes it."""
        half = np.full(self.spot_h_deg.shape, self.receiver_deg / 2.0)
        spots = np.radians(np.stack([self.spot_h_deg, self.spot_v_deg, half], axis=-1))
        edges = (np.radians(self.h_edges_deg), np.radians(self.v_edges_deg))
        return _core.Receivers(
            self.axis,
            self.up,
            self.centre_mm,
            distance_mm=None if self.distance_m is None else self.distance_m * _MM_PER_M,
            spots=np.ascontiguousarray(spots),
            cell_edges=edges if self.h_edges_deg.size else None,
            map=None if self.plane is None else self.plane.for_core(),
            spot_bands=self.spot_bands,
            cell_bands=self.cell_bands,
        )


def measure_settings(scene: Scene) -> MeasureSettings:
    """Return the scene's [measure].

    Raises:
        SceneError: It has none, and so no axis.
    """
    if scene.measure is None:
        raise SceneError(
            "the lamp's axis is not given; add a table [measure] with axis = [0, 0, 1] "
            "(towards the observer)",
            file=scene.path,
            where="measure.axis",
        )
    return scene.measure


def checked_spots(spots: ArrayLike | None) -> tuple[Array, Array]:
    """Return H and V, (p,) each, of pairs in degrees; none for None.

    Raises:
        LamplitError: They are not pairs of H within ±180° and V within ±90°.
    """
    pairs = np.empty((0, 2)) if spots is None else np.asarray(spots, dtype=np.float64)
    pairs = pairs.reshape(0, 2) if pairs.size == 0 else pairs
    if pairs.ndim != 2 or pairs.shape[1] != 2 or not np.isfinite(pairs).all():
        raise LamplitError(f"spots are pairs of H and V in degrees, (n, 2), not {pairs.shape}")
    if (np.abs(pairs) > (180.0, 90.0)).any():
        raise LamplitError("a spot's H lies within ±180° and its V within ±90°")
    return np.ascontiguousarray(pairs[:, 0]), np.ascontiguousarray(pairs[:, 1])


def checked_edges(grid: tuple[ArrayLike, ArrayLike] | None) -> tuple[Array, Array]:
    """Return the borders of the cells along H and V in degrees; for None, 1° over ±90°.

    Raises:
        LamplitError: They do not rise, leave ±180° and ±90°, or make more cells than memory holds.
    """
    if grid is None:
        return _EDGES_DEG.copy(), _EDGES_DEG.copy()
    h, v = (np.ascontiguousarray(edges, dtype=np.float64) for edges in grid)
    for name, edges, most in (("H", h, 180.0), ("V", v, 90.0)):
        rises = edges.ndim == 1 and edges.size > 1 and bool((np.diff(edges) > 0.0).all())
        if not (rises and np.abs(edges).max() <= most):
            raise LamplitError(
                f"the borders of a grid's cells along {name} rise, within ±{most:g}°; "
                "two are needed at least"
            )
    if (h.size - 1) * (v.size - 1) > _MOST_CELLS:
        raise LamplitError(
            f"a grid of {h.size - 1} times {v.size - 1} cells is more than the {_MOST_CELLS} "
            "that a measurement keeps; take larger cells (cell_deg of a rule file)"
        )
    return h, v

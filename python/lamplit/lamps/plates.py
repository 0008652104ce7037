# SPDX-License-Identifier: Apache-2.0 OR MIT
"""Solids with a flat layout: a patch with a front, a back and a rim between them."""

from __future__ import annotations

import numpy as np

from lamplit.lamps.patterns import Patch, open_edges
from lamplit.lamps.solids import Floats, Indices, Solid, outward, strip


def plate(patch: Patch, front_z_mm: Floats, back_z_mm: Floats, rim: Floats) -> Solid:
    """Return the solid between two heights (n,) over ``patch``, closed by the loops of ``rim``.

    ``rim`` (k, b, 3): loops over the border's b vertices, from the front's border to the back's.
    """
    count, size = len(patch.xy), len(patch.border)
    loops = np.concatenate(
        [
            patch.border[None],
            2 * count + np.arange(len(rim) * size, dtype=np.int64).reshape(len(rim), size),
            count + patch.border[None],
        ]
    )
    vertices = np.concatenate(
        [
            np.column_stack([patch.xy, front_z_mm]),
            np.column_stack([patch.xy, back_z_mm]),
            rim.reshape(-1, 3),
        ]
    )
    sheets = [patch.triangles, patch.triangles[:, ::-1] + count, strip(loops)[:, ::-1]]
    return outward(vertices, np.concatenate(sheets))


def sheet(xy: Floats, triangles: Indices, front_z_mm: Floats, back_z_mm: Floats) -> Solid:
    """Return the solid between two heights (n,) over a flat triangulation that may have holes."""
    count = len(xy)
    a, b = open_edges(triangles).T
    walls = [np.stack([a, a + count, b + count], axis=1), np.stack([a, b + count, b], axis=1)]
    vertices = np.concatenate([np.column_stack([xy, front_z_mm]), np.column_stack([xy, back_z_mm])])
    return outward(vertices, np.concatenate([triangles, triangles[:, ::-1] + count, *walls]))

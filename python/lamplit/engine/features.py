# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Features`: what each pixel looks at, besides its light."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamplit import _core
from lamplit.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, kw_only=True)
class Features:
    """Depth, normal, body, albedo and interfaces of H rows by W columns of pixels.

    All but the body are means over nine rays of the pixel, those that meet something.
    """

    #: Distance to the first surface along the ray, (H, W), in mm; infinite where there is none.
    depth_mm: Array
    #: Its shading normal, towards the eye, (H, W, 3); shorter than 1 where it changes in the pixel.
    normal: Array
    #: The place in ``body_names`` of what the middle of the pixel shows, (H, W); −1 for none.
    body: NDArray[np.int32]
    #: The names of the scene's objects, in its order.
    body_names: tuple[str, ...]
    #: X, Y, Z of the first surface's albedo under equal-energy light, (H, W, 3): Y = 1 is white.
    albedo: Array
    #: Boundaries of transparent bodies that a ray crosses until it meets what is opaque, (H, W).
    interfaces: Array


def features_of(scene: Scene, world: _core.Scene, *, threads: int | None) -> Features:
    """Return the features of ``scene``, which ``world`` was assembled from."""
    found = world.features(scene.image.width, scene.image.height, threads=threads or 0)
    return Features(
        depth_mm=found[..., 0],
        normal=found[..., 1:4],
        body=found[..., 8].astype(np.int32),
        body_names=tuple(thing.name for thing in scene.objects_as_read),
        albedo=found[..., 4:7],
        interfaces=found[..., 7],
    )

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`compare`: the same scene along the same rays, once with spectra and once with RGB."""

from __future__ import annotations

from dataclasses import dataclass

from lamplit.engine.image import Image
from lamplit.engine.render import ProgressCallback, render
from lamplit.scene import Scene


@dataclass(frozen=True, eq=False)
class Comparison:
    """Two pictures of one scene that differ in nothing but what a ray carries."""

    spectral: Image
    rgb: Image


def compare(
    scene: Scene,
    *,
    method: str = "hall",
    samples: int | None = None,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> Comparison:
    """Render ``scene`` with spectra and with three numbers per light and material.

    Both go through the same code and draw the same random numbers. All lanes share the direction
    of n_d in both, since RGB refracts all light alike. ``method`` is ``hall``, whatever the scene
    says, unless it is asked for. ``progress`` counts both pictures.

    Raises:
        LamplitError: The scene or an argument cannot be used.
        RenderInterrupted: Ctrl-C.
    """
    steered_alike = scene.changed(hall=scene.hall.model_copy(update={"dispersion_groups": 1}))
    spectral, rgb = (
        render(
            steered_alike,
            method=method,
            colour=colour,
            samples=samples,
            adaptive=False,
            threads=threads,
            progress=None if progress is None else _half_of(progress, half),
        )
        for half, colour in enumerate(("spectral", "rgb"))
    )
    return Comparison(spectral, rgb)


def _half_of(progress: ProgressCallback, half: int) -> ProgressCallback:
    """Return what tells ``progress`` of the first (0) or the second (1) of two equal pictures."""
    return lambda done, total: progress(half * total + done, 2 * total)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`render`: the picture of a scene."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import Literal

import numpy as np
from pydantic import ValidationError

from lamplit import _core
from lamplit.engine.assembly import assemble
from lamplit.engine.carrier import Array, Carrier, RgbCarrier, SpectralCarrier
from lamplit.engine.image import Image
from lamplit.errors import LamplitError, SceneError, nearest_name
from lamplit.scene import Scene
from lamplit.scene.camera import ImageSettings

#: Called with the samples done and to do, over all pixels, a few times a second.
ProgressCallback = Callable[[int, int], object]

METHODS = ("path", "hall")

#: Into how many bands a lane of the spectral picture is cut at most: over 380–780 nm and with 25
#: samples or more these are 80 bands of 5 nm.
_FINEST_BANDS = 5


class RenderInterrupted(KeyboardInterrupt):
    """Ctrl-C during a render; ``image`` holds what was done."""

    def __init__(self, image: Image) -> None:
        super().__init__(f"stopped with {image.samples} of {image.samples_asked} samples per pixel")
        self.image = image


def render(
    scene: Scene,
    *,
    method: str = "hall",
    colour: Literal["spectral", "rgb"] = "spectral",
    samples: int | None = None,
    threads: int | None = None,
    spectral_bands: bool = False,
    progress: ProgressCallback | None = None,
) -> Image:
    """Render ``scene`` and return tristimulus values in cd/m² with their standard errors.

    ``method`` is ``hall``, the founding method. ``colour`` is ``rgb`` for the RGB half of a
    comparison. ``samples`` per pixel stand in for the scene's own. ``threads`` of None takes one
    per core; the result does not depend on it. ``spectral_bands`` keeps each pixel's spectrum.

    Raises:
        LamplitError: The scene or an argument cannot be used.
        RenderInterrupted: Ctrl-C; its ``image`` has the samples that were done.
    """
    if method not in METHODS:
        raise LamplitError(
            f"there is no method {method!r}{nearest_name(method, METHODS)}; "
            f"choose one of {', '.join(METHODS)}"
        )
    if samples is not None:
        scene = _with_samples(scene, samples)
    spectral = SpectralCarrier(scene.image.wavelength_range_nm, scene.image.observer)
    carrier: Carrier = spectral
    if colour == "rgb":
        carrier = RgbCarrier(spectral, scene.resolve_source(scene.display.white))
    keeps_bands = spectral_bands and colour == "spectral"
    bands = _bands_per_lane(scene.image.samples, spectral.phases) if keeps_bands else 0
    start = time.perf_counter()
    world = assemble(scene, carrier)
    scene_hash = scene.scene_hash  # of the files as they were read, whatever becomes of them
    built = time.perf_counter()
    outcome = _trace(scene, world, method=method, bands=bands, threads=threads, progress=progress)
    timings = {"build_s": built - start, "trace_s": time.perf_counter() - built}
    image = Image(
        xyz=outcome.xyz(),
        xyz_standard_error=outcome.xyz_standard_error(),
        spectral_radiance=outcome.spectral_radiance() if bands else None,
        band_centres_nm=_band_centres(scene, bands),
        samples=int(outcome.samples().min()) if outcome.interrupted else scene.image.samples,
        samples_asked=scene.image.samples,
        seed=scene.image.seed,
        scene=scene,
        method=method,
        colour=colour,
        statistics=outcome.statistics() | timings | {"geometry_bytes": world.memory_bytes},
        elapsed_s=time.perf_counter() - start,
        complete=not outcome.interrupted,
        interrupted=outcome.interrupted,
        version=_core.__version__,
        command=f"lamplit.render(scene, method={method!r}, colour={colour!r}) of {scene_hash}",
    )
    if image.interrupted:
        raise RenderInterrupted(image)
    return image


def _trace(
    scene: Scene,
    world: _core.Scene,
    *,
    method: str,
    bands: int,
    threads: int | None,
    progress: ProgressCallback | None,
) -> _core.Render:
    image = scene.image
    try:
        return world.render(
            image.width,
            image.height,
            image.samples,
            _method(scene, method),
            sampling=image.sampling if method == "hall" else "sobol",
            filter=image.filter,
            seed=image.seed,
            bands_per_lane=bands,
            threads=threads or 0,
            progress=progress,
        )
    except ValueError as fault:
        raise SceneError(str(fault), file=scene.path) from fault


def _method(scene: Scene, method: str) -> _core.HallMethod | _core.PathMethod:
    if method == "path":
        return _core.PathMethod(
            max_depth=64,
            split_depth=int(os.environ.get("SPLIT", "4")),
            roulette_below=float(os.environ.get("ROUL", "0.05")),
        )
    hall = scene.hall
    return _core.HallMethod(
        max_depth=hall.max_depth,
        contribution_limit=hall.contribution_limit,
        dispersion_groups=hall.dispersion_groups,
        shadows=hall.shadows,
    )


def _with_samples(scene: Scene, samples: int) -> Scene:
    """Return ``scene`` with another number of samples, checked as the loader checks it."""
    written = scene.image.model_dump() | {"samples": samples}
    try:
        return scene.changed(image=ImageSettings.model_validate(written))
    except ValidationError as fault:
        reason = fault.errors()[0]["msg"]
        raise LamplitError(f"{samples} samples per pixel: {reason}") from fault


def _bands_per_lane(samples: int, phases: int) -> int:
    """Return the finest cut of a lane in which every band gets samples."""
    if samples < phases:
        return 1
    return max(cut for cut in range(1, _FINEST_BANDS + 1) if phases % cut == 0)


def _band_centres(scene: Scene, bands_per_lane: int) -> Array:
    low, high = scene.image.wavelength_range_nm
    count = bands_per_lane * _core.LANES
    return low + (high - low) * (np.arange(count) + 0.5) / max(count, 1)

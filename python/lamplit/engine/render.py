# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`render`: the picture of a scene."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lamplit import _core
from lamplit.engine.assembly import assemble
from lamplit.engine.carrier import Array, Carrier, RgbCarrier, SpectralCarrier
from lamplit.engine.features import features_of
from lamplit.engine.image import Image
from lamplit.engine.ledger import Ledger
from lamplit.engine.plan import Plan, plan
from lamplit.engine.snapshot import PreviewCallback, Snapshot
from lamplit.errors import SceneError
from lamplit.scene import Scene
from lamplit.scene.shining import light_notices, path_notices

#: Called with the samples done and to do, over all pixels, a few times a second.
ProgressCallback = Callable[[int, int], object]

#: Into how many bands a lane of the spectral picture is cut at most: over 380–780 nm and with 25
#: samples or more in every pixel these are 80 bands of 5 nm.
_FINEST_BANDS = 5


class RenderInterrupted(KeyboardInterrupt):
    """Ctrl-C during a render; ``image`` holds what was done."""

    def __init__(self, image: Image) -> None:
        super().__init__(f"stopped with {image.samples} of {image.samples_asked} samples per pixel")
        self.image = image


def render(
    scene: Scene,
    *,
    method: str | None = None,
    colour: Literal["spectral", "rgb"] = "spectral",
    samples: int | None = None,
    error: float | None = None,
    time_s: float | None = None,
    adaptive: bool | None = None,
    threads: int | None = None,
    spectral_bands: bool = False,
    layers: bool = False,
    features: bool = False,
    progress: ProgressCallback | None = None,
    preview: PreviewCallback | None = None,
) -> Image:
    """Render ``scene`` and return tristimulus values in cd/m² with their standard errors.

    ``method`` is ``path``, physical transport; ``lit``, the same for small lights behind optics,
    which it learns to find; ``hall``, the founding method; or ``auto``: ``lit`` where an object
    shines, else ``path``. None takes the scene's. ``colour`` is ``rgb`` for the RGB half of a
    comparison.

    ``samples`` per pixel stand in for the scene's own. ``error`` is the `Image.relative_error` to
    sample down to, and ``time_s`` the seconds to trace for; with either, ``samples`` is the most
    that a pixel takes on average, and None sets no limit of its own. ``adaptive`` allots samples to
    pixels by how noisy and costly a first round found their neighbours, so that no pixel is biased
    by its own samples; None does so for ``lit``, and where there is an error or a time.

    ``threads`` of None takes one per core; the result does not depend on it, but for how far it
    comes in ``time_s``. ``spectral_bands`` keeps each pixel's spectrum, ``layers`` a picture for
    each light group, ``features`` what each pixel looks at. ``progress`` is called with the samples
    done and to do, ``preview`` every two seconds or more with the picture so far: its ``xyz``,
    ``xyz_standard_error``, ``samples`` over all pixels, ``relative_error`` and, where it is known,
    ``relative_error_at_end``.

    Raises:
        LamplitError: The scene or an argument cannot be used, or arguments contradict each other.
        RenderInterrupted: Ctrl-C; its ``image`` has the samples that were done.
    """
    settled = plan(
        scene,
        method=method,
        samples=samples,
        error=error,
        time_s=time_s,
        adaptive=adaptive,
        layers=layers,
    )
    start = time.perf_counter()
    stage = set_stage(settled, colour)
    keeps_bands = spectral_bands and colour == "spectral"
    return expose(
        stage,
        started=start,
        bands=_bands_per_lane(settled, stage.phases) if keeps_bands else 0,
        layers=layers,
        features=features,
        threads=threads,
        progress=progress,
        preview=preview,
    )


@dataclass(frozen=True, eq=False)
class Stage:
    """A scene that is assembled and ready to be seen by its camera."""

    settled: Plan
    colour: Literal["spectral", "rgb"]
    world: _core.Scene
    #: How many wavelengths each lane takes in turn.
    phases: int
    #: Of the files as they were read, whatever becomes of them.
    scene_hash: str
    build_s: float
    notices: tuple[str, ...]
    #: Where light comes from, where that serves more than one picture.
    guide: _core.LightGuide | None = None


def set_stage(settled: Plan, colour: Literal["spectral", "rgb"] = "spectral") -> Stage:
    """Assemble the scene of ``settled``.

    Raises:
        LamplitError: Something in the scene cannot be used.
    """
    scene = settled.scene
    notices = light_notices(scene)
    if settled.method != "hall":
        notices += path_notices(scene)
    spectral = SpectralCarrier(scene.image.wavelength_range_nm, scene.image.observer)
    carrier: Carrier = spectral
    if colour == "rgb":
        carrier = RgbCarrier(spectral, scene.resolve_source(scene.display.white))
    start = time.perf_counter()
    world = assemble(scene, carrier)
    build_s = time.perf_counter() - start
    return Stage(settled, colour, world, spectral.phases, scene.scene_hash, build_s, notices)


def expose(
    stage: Stage,
    *,
    started: float,
    bands: int = 0,
    layers: bool = False,
    features: bool = False,
    threads: int | None,
    progress: ProgressCallback | None,
    preview: PreviewCallback | None = None,
) -> Image:
    """Take the picture of ``stage``; ``started`` is when `time.perf_counter` saw the work begin.

    Raises:
        RenderInterrupted: Ctrl-C.
    """
    settled, world = stage.settled, stage.world
    scene = settled.scene
    seen = features_of(scene, world, threads=threads) if features else None
    built = time.perf_counter()
    outcome = _trace(
        stage,
        bands=bands,
        layers=layers,
        threads=threads,
        progress=progress,
        preview=preview,
    )
    timings = {"build_s": stage.build_s, "trace_s": time.perf_counter() - built}
    counts = outcome.samples()
    by_group, by_group_error = _by_group(outcome)
    has_bands = bands > 0 and outcome.spectral_radiance().size > 0
    image = Image(
        xyz=outcome.xyz(),
        xyz_standard_error=outcome.xyz_standard_error(),
        spectral_radiance=outcome.spectral_radiance() if has_bands else None,
        band_centres_nm=_band_centres(scene, bands if has_bands else 0),
        layers=by_group,
        layers_standard_error=by_group_error,
        features=seen,
        samples=_samples(settled, outcome, counts),
        samples_asked=settled.samples,
        samples_per_pixel=counts,
        error_asked=settled.error,
        ledger=Ledger.of(outcome),
        seed=scene.image.seed,
        scene=scene,
        method=settled.method,
        colour=stage.colour,
        statistics=outcome.statistics()
        | timings
        | {"geometry_bytes": world.memory_bytes, "found_cd_m2": outcome.found()},
        elapsed_s=time.perf_counter() - started,
        notices=stage.notices,
        complete=not outcome.interrupted,
        interrupted=outcome.interrupted,
        version=_core.__version__,
        command=_call(settled, stage.colour, stage.scene_hash),
    )
    if image.interrupted:
        raise RenderInterrupted(image)
    return image


def _trace(
    stage: Stage,
    *,
    bands: int,
    layers: bool,
    threads: int | None,
    progress: ProgressCallback | None,
    preview: PreviewCallback | None,
) -> _core.Render:
    settled, scene = stage.settled, stage.settled.scene
    image = scene.image

    def show(
        xyz: Array, standard_error: Array, samples: int, outlook: tuple[float, Array] | None
    ) -> None:
        if preview is not None:
            preview(Snapshot(scene, xyz, standard_error, samples, outlook))

    if progress is not None:
        progress(0, image.width * image.height * image.samples)
    try:
        return stage.world.render(
            image.width,
            image.height,
            image.samples,
            _method(scene, stage.guide),
            adaptive=settled.adaptive,
            target_error=settled.error,
            time_budget_s=settled.time_s,
            sampling=image.sampling if settled.method == "hall" else "sobol",
            filter=image.filter,
            seed=image.seed,
            bands_per_lane=bands,
            layers=layers,
            threads=threads or 0,
            progress=progress,
            preview=None if preview is None else show,
        )
    except ValueError as fault:
        raise SceneError(str(fault), file=scene.path) from fault


def with_guide(stage: Stage, *, threads: int | None) -> Stage:
    """Return ``stage`` with what the method lit learns of its light, for more than one picture."""
    scene = stage.settled.scene
    if stage.settled.method != "lit":
        return stage
    walks, seed = _walks(scene), scene.image.seed
    try:
        guide = _core.LightGuide(stage.world, walks, seed=seed, threads=threads or 0)
    except ValueError:  # nothing shines that an eye sees: there is nothing to learn
        return stage
    return replace(stage, guide=guide)


def _walks(scene: Scene) -> _core.PathMethod:
    path = scene.path_settings
    return _core.PathMethod(
        max_depth=path.max_depth,
        split_depth=path.split_depth,
        roulette_below=path.roulette_below,
    )


def _method(
    scene: Scene, guide: _core.LightGuide | None
) -> _core.HallMethod | _core.PathMethod | _core.LitMethod:
    if scene.image.method == "lit":
        return _core.LitMethod(_walks(scene), guide)
    if scene.image.method == "path":
        return _walks(scene)
    hall = scene.hall
    return _core.HallMethod(
        max_depth=hall.max_depth,
        contribution_limit=hall.contribution_limit,
        dispersion_groups=hall.dispersion_groups,
        shadows=hall.shadows,
    )


def _by_group(outcome: _core.Render) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return the layers by the names of their light groups, and their standard errors."""
    names = outcome.groups
    values, errors = outcome.layers(), outcome.layers_standard_error()
    return dict(zip(names, values, strict=True)), dict(zip(names, errors, strict=True))


def _samples(settled: Plan, outcome: _core.Render, counts: NDArray[np.uint32]) -> int:
    """Return the samples per pixel: those asked for, or the mean of those that were taken."""
    is_open = settled.adaptive or settled.time_s is not None or outcome.interrupted
    return round(float(counts.mean())) if is_open else settled.samples


def _call(settled: Plan, colour: str, scene_hash: str) -> str:
    asked = {
        "method": settled.method,
        "colour": colour,
        "error": settled.error,
        "time_s": settled.time_s,
        "adaptive": settled.adaptive or None,
    }
    words = "".join(f", {name}={value!r}" for name, value in asked.items() if value is not None)
    return f"lamplit.render(scene{words}) of {scene_hash}"


def _bands_per_lane(settled: Plan, phases: int) -> int:
    """Return the finest cut of a lane in which every band of every pixel gets samples."""
    is_open = settled.adaptive or settled.time_s is not None
    if is_open or settled.samples < phases:
        return 1
    return max(cut for cut in range(1, _FINEST_BANDS + 1) if phases % cut == 0)


def _band_centres(scene: Scene, bands_per_lane: int) -> Array:
    low, high = scene.image.wavelength_range_nm
    count = bands_per_lane * _core.LANES
    return low + (high - low) * (np.arange(count) + 0.5) / max(count, 1)

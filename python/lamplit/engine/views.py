# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`render_views`: one scene from many places, assembled once."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from lamplit.engine.assembly import aim
from lamplit.engine.image import Image
from lamplit.engine.plan import Plan, plan
from lamplit.engine.render import expose, set_stage, with_guide
from lamplit.engine.snapshot import PreviewCallback
from lamplit.errors import LamplitError
from lamplit.scene import Scene
from lamplit.scene.eyes import (
    FULL_CIRCLE_DEG,
    USUAL_SWEEP_DEG,
    Eye,
    eye_at,
    seen_from,
    turntable_eyes,
)
from lamplit.scene.fields import Vector
from lamplit.scene.identity import share_hashes
from lamplit.scene.view import views_fault

#: Called with the number of the frame, from 0, and the samples done and to do of it.
ViewsProgressCallback = Callable[[int, int, int], object]


@dataclass(frozen=True, eq=False)
class Views:
    """Places to see a scene from, each found usable, and how it is rendered from there."""

    settled: Plan
    #: The scene as each eye sees it.
    scenes: tuple[Scene, ...]
    #: Whether the last place is one step before the first.
    circle: bool

    def __len__(self) -> int:
        """Return how many pictures there will be."""
        return len(self.scenes)

    def images(
        self,
        *,
        threads: int | None = None,
        progress: ViewsProgressCallback | None = None,
        preview: PreviewCallback | None = None,
    ) -> Iterator[Image]:
        """Render one picture after the other, with the same seed, as `lamplit.render` would.

        Raises:
            RenderInterrupted: Ctrl-C; its ``image`` is the one that was begun.
        """
        started = time.perf_counter()
        stage = set_stage(replace(self.settled, scene=self.scenes[0]))
        stage = with_guide(stage, threads=threads)
        share_hashes(self.scenes)
        for at, scene in enumerate(self.scenes):
            aim(stage.world.look, scene.camera)
            settled = replace(self.settled, scene=scene)
            yield expose(
                replace(stage, settled=settled, scene_hash=scene.scene_hash),
                started=started,
                threads=threads,
                progress=None if progress is None else _of_frame(progress, at),
                preview=preview,
            )
            started = time.perf_counter()


def plan_views(
    scene: Scene,
    *,
    turntable: int | None = None,
    sweep_deg: float = USUAL_SWEEP_DEG,
    eyes: Sequence[Eye | Vector] | None = None,
    method: str | None = None,
    samples: int | None = None,
    error: float | None = None,
    time_s: float | None = None,
    adaptive: bool | None = None,
) -> Views:
    """Settle what `render_views` is asked, and find out that every eye sees something.

    Raises:
        LamplitError: As for `render_views`.
    """
    settled = plan(
        scene,
        method=method,
        samples=samples,
        error=error,
        time_s=time_s,
        adaptive=adaptive,
        layers=False,
    )
    if turntable is not None and eyes is not None:
        raise LamplitError("a turntable and a list of eye points exclude each other; choose one")
    where = "eyes" if turntable is None else "turntable"
    if turntable is not None:
        places = turntable_eyes(scene.camera, turntable, sweep_deg)
    elif eyes is not None:
        places = [
            eye if isinstance(eye, Eye) else eye_at(eye, where=f"eyes[{at}]")
            for at, eye in enumerate(eyes)
        ]
    else:
        places = list(scene.eyes)
    scenes = seen_from(settled.scene, places, where=where)
    if (fault := views_fault(scenes, where=where)) is not None:
        raise fault
    if time_s is not None:
        settled = replace(settled, time_s=time_s / len(scenes))
    circle = turntable is not None and sweep_deg == FULL_CIRCLE_DEG
    return Views(settled, tuple(scenes), circle)


def render_views(
    scene: Scene,
    *,
    turntable: int | None = None,
    sweep_deg: float = USUAL_SWEEP_DEG,
    eyes: Sequence[Eye | Vector] | None = None,
    method: str | None = None,
    samples: int | None = None,
    error: float | None = None,
    time_s: float | None = None,
    adaptive: bool | None = None,
    threads: int | None = None,
    progress: ViewsProgressCallback | None = None,
    preview: PreviewCallback | None = None,
) -> Iterator[Image]:
    """Render ``scene`` from many places and return an iterator over the pictures.

    ``turntable`` is the number of frames on a circle round the camera's target, about its ``up``:
    over ``sweep_deg`` with the camera's place in the middle, or round the whole circle with 360.
    ``eyes`` are places instead, (x, y, z) in mm; with neither, the scene's own ``[[eyes]]`` are.
    ``time_s`` is for all pictures together, everything else for each, as `render` has it.

    The scene is assembled once. Each picture is the one that `render` makes of the scene with its
    camera there, bit by bit. ``progress`` is called with the number of the frame, from 0, and
    its samples done and to do, ``preview`` as that of `render`.

    Raises:
        LamplitError: The scene or an argument cannot be used, there is no eye, or one sees nothing
            or is inside an opaque body. All of it is known before the first picture is begun.
        RenderInterrupted: Ctrl-C; its ``image`` is the picture that was begun.
    """
    views = plan_views(
        scene,
        turntable=turntable,
        sweep_deg=sweep_deg,
        eyes=eyes,
        method=method,
        samples=samples,
        error=error,
        time_s=time_s,
        adaptive=adaptive,
    )
    return views.images(threads=threads, progress=progress, preview=preview)


def _of_frame(progress: ViewsProgressCallback, at: int) -> Callable[[int, int], object]:
    return lambda done, total: progress(at, done, total)

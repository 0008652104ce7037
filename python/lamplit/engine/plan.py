# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Plan`: by which method and how finely a scene is rendered, from the scene and what was asked."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pydantic import ValidationError

from lamplit.errors import LamplitError, nearest_name
from lamplit.scene import Scene
from lamplit.scene.camera import MOST_SAMPLES, ImageSettings
from lamplit.scene.methods import physical_method

METHODS = ("path", "lit", "hall")
#: Of these the plan takes what suits the scene.
_AUTO = "auto"

#: What the core takes of each pixel before it can tell how many samples an error or a time needs.
FIRST_ROUND_SAMPLES = 16


@dataclass(frozen=True)
class Plan:
    """What was settled; ``scene`` says of method and samples what is done."""

    scene: Scene
    #: Whether samples are allotted to pixels by their noise.
    adaptive: bool
    #: The relative error to sample down to; None takes all samples.
    error: float | None
    time_s: float | None

    @property
    def method(self) -> str:
        """``path``, ``lit`` or ``hall``."""
        return self.scene.image.method

    @property
    def samples(self) -> int:
        """The samples per pixel that are taken, or the most."""
        return self.scene.image.samples


def plan(
    scene: Scene,
    *,
    method: str | None,
    samples: int | None,
    error: float | None,
    time_s: float | None,
    adaptive: bool | None,
    layers: bool,
) -> Plan:
    """Settle what was asked (None: nothing) with what the scene says.

    Raises:
        LamplitError: A value cannot be used, or two of them contradict each other.
    """
    known = (_AUTO, *METHODS)
    if method is not None and method not in known:
        raise LamplitError(
            f"there is no method {method!r}{nearest_name(method, known)}; "
            f"choose one of {', '.join(known)}"
        )
    chosen = method or scene.image.method
    if chosen == _AUTO:
        chosen = physical_method(scene)
    _check(chosen, error=error, time_s=time_s, adaptive=adaptive, layers=layers)
    target = None if chosen == "hall" else error
    if error is None and chosen != "hall" and adaptive is not False:
        target = scene.image.error
    by_noise = adaptive
    if by_noise is None:
        by_noise = chosen == "lit" or (target or time_s) is not None
    most = samples
    if most is None:
        is_open = error is not None or time_s is not None or _leaves_samples_open(scene, target)
        most = MOST_SAMPLES if is_open else scene.image.samples
    planned = _with(scene, method=chosen, samples=most, error=target)
    return Plan(planned, by_noise, target, time_s)


def _leaves_samples_open(scene: Scene, target: float | None) -> bool:
    return target is not None and "samples" not in scene.image.model_fields_set


def _check(
    method: str,
    *,
    error: float | None,
    time_s: float | None,
    adaptive: bool | None,
    layers: bool,
) -> None:
    of_path = {
        "a target error": error is not None,
        "a time budget": time_s is not None,
        "adaptive sampling": adaptive is True,
        "a layer per light group": layers,
    }
    for what, is_asked in of_path.items():
        if is_asked and method == "hall":
            raise LamplitError(
                f"{what} needs the method path or lit, and this is hall; leave it out, "
                "or choose another"
            )
    if error is not None and not 0.0 < error <= 1.0:
        raise LamplitError(
            f"a target error is a share above 0 and at most 1, such as 0.01, not {error:g}"
        )
    if time_s is not None and not (math.isfinite(time_s) and time_s > 0.0):
        raise LamplitError(f"a time budget is a number of seconds above 0, not {time_s:g}")
    if error is not None and adaptive is False:
        raise LamplitError(
            "uniform sampling cannot reach a target error; leave one of the two out, "
            "or say how many samples"
        )


def _with(scene: Scene, **values: object) -> Scene:
    """Return ``scene`` with values of [image], checked as the loader checks them."""
    before = scene.image.model_dump()
    written = before | values
    if written == before:
        return scene
    try:
        return scene.changed(image=ImageSettings.model_validate(written))
    except ValidationError as fault:
        reason = fault.errors()[0]["msg"]
        raise LamplitError(f"{written['samples']} samples per pixel: {reason}") from fault

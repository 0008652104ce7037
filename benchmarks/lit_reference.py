# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The converged picture of a lit lamp: long runs of all programs, kept from bench to bench.

Each program's parts lie in ``build/lit-references/`` under a hash of what the scene shows, so that
they are made once, also where the program has changed since: delete the file of a method whose
pictures were wrong.
"""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from errors import Array
from lit_errors import Estimate, tone, tone_variance, trim
from lit_runners import MITSUBA, Runner
from mitsuba_scene import write_scene

import lamplit as ll
from lamplit import _core

FOLDER = Path(__file__).resolve().parent.parent / "build" / "lit-references"
_FIRST_SEED = 1001


@dataclass(frozen=True, eq=False)
class Reference:
    """The converged picture (H, W, 3) of Lamplit's methods, and all programs' long runs.

    Methods are weighted by the inverse of one variance each, that of their tones, so
    that no pixel's weight depends on its noise. Mitsuba is left out: it is what checks the rest.
    """

    xyz: Array
    weights: Mapping[str, float]
    #: Of each program, independent pictures (k, H, W, 3) of equal length.
    parts: Mapping[str, Array]
    #: Core seconds of each part, and the core that made them, by program.
    made: Mapping[str, tuple[float, str]]
    #: What the picture is multiplied by where a program is held against it, if not 1. Mitsuba's
    #: rough glass loses the light that meets more than one facet (13 % of a plate's at α = 0.3),
    #: and has its own long run's flux to meet there, so that what is told is noise.
    scales: Mapping[str, float]

    def picture_for(self, program: str) -> Array:
        """Return the picture (H, W, 3) that ``program`` converges to."""
        return self.xyz * self.scales.get(program, 1.0)

    def estimate_for(self, program: str) -> Estimate:
        """Return blocks and flux of that picture, with their variances."""
        scale = self.scales.get(program, 1.0)
        own = [(w, Estimate.of(scale * self.parts[name])) for name, w in self.weights.items()]
        return Estimate.weighted(own)

    def seen(self, change: Any) -> Reference:
        """Return the reference with ``change`` done to each picture."""
        parts = {name: change(own) for name, own in self.parts.items()}
        return Reference(change(self.xyz), self.weights, parts, self.made, self.scales)

    def own_errors(self) -> dict[str, float]:
        """Return the tone and trim errors that it still has, from half the difference of halves."""
        one, other = (_mean(self.weights, self.parts, slice(at, None, 2)) for at in (0, 1))
        shifted = self.xyz + 0.5 * (one - other)
        return {"tone": tone(shifted, self.xyz), "trim": trim(shifted, self.xyz)}

    def long_runs(self) -> dict[str, dict[str, float]]:
        """Return how each program's long run agrees with that of the weightiest method."""
        best = max(self.weights, key=lambda name: self.weights[name])
        wanted = Estimate.of(self.parts[best])
        told: dict[str, dict[str, float]] = {}
        for name, own in self.parts.items():
            if name != best:
                told[name] = Estimate.of(own).against(wanted)
        return told


def reference(
    scene: ll.Scene, runners: Mapping[str, Runner], *, parts: int, core_s: float
) -> Reference:
    """Return the converged picture by ``parts`` runs of ``core_s`` of each program."""
    key = _key(scene)
    kept = {name: _kept(runner, name, key, parts, core_s) for name, runner in runners.items()}
    own = {name: one[0] for name, one in kept.items() if name != MITSUBA}
    inverse = {name: 1.0 / tone_variance(one) for name, one in own.items()}
    weights = {name: one / sum(inverse.values()) for name, one in inverse.items()}
    xyz = _mean(weights, own, slice(None))
    scales = {
        name: float(one[0][..., 1].mean() / xyz[..., 1].mean())
        for name, one in kept.items()
        if name == MITSUBA and _has_rough_glass(scene)
    }
    return Reference(
        xyz,
        weights,
        {name: one[0] for name, one in kept.items()},
        {name: (core_s, one[1]) for name, one in kept.items()},
        scales,
    )


def _has_rough_glass(scene: ll.Scene) -> bool:
    materials = (thing.material for thing in scene.resolved_objects())
    return any(own.kind == "dielectric" and own.roughness > 0.0 for own in materials)


def _mean(weights: Mapping[str, float], parts: Mapping[str, Array], which: slice) -> Array:
    means = [w * parts[name][which].mean(axis=0) for name, w in weights.items()]
    return np.sum(means, axis=0)


def _kept(runner: Runner, name: str, key: str, parts: int, core_s: float) -> tuple[Array, str]:
    """Return a program's pictures (parts, H, W, 3) and which core made them."""
    path = FOLDER / f"{key}-{name}-{parts}x{core_s:g}s.npz"
    if not path.exists():
        print(f"making {path.name}: {parts * core_s:g} core seconds, once", flush=True)
        made = [
            runner.shots([core_s], _FIRST_SEED + at)[0].xyz.astype(np.float32)
            for at in range(parts)
        ]
        FOLDER.mkdir(parents=True, exist_ok=True)
        partial = path.with_suffix(".part")
        with partial.open("wb") as file:
            np.savez_compressed(file, xyz=np.stack(made), core=_core_hash())
        partial.replace(path)
    with np.load(path) as file:
        return file["xyz"].astype(np.float64), str(file["core"])


def _key(scene: ll.Scene) -> str:
    """Return a hash of what Mitsuba is given: shapes, matter, light and camera, by their values."""
    total = hashlib.sha256()
    with tempfile.TemporaryDirectory(prefix="lamplit-bench-") as name:
        write_scene(scene, Path(name))
        for path in sorted(Path(name).iterdir()):
            total.update(path.name.encode() + b"\0" + path.read_bytes())
    return f"{scene.image.width}x{scene.image.height}-{total.hexdigest()[:16]}"


def _core_hash() -> str:
    return hashlib.sha256(Path(str(_core.__file__)).read_bytes()).hexdigest()[:12]

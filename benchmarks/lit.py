# SPDX-License-Identifier: Apache-2.0 OR MIT
"""S2: lit lamps, Lamplit's methods against each other at equal time, and against Mitsuba 3.

The lamps L1 to L4 of `lit_scene`, lit and in the dark. Each method of Lamplit and Mitsuba's faster
spectral variant render the same pictures for the same core seconds, in turn, with several seeds;
errors are those of `lit_errors` against long runs (`lit_reference`), which are kept in ``build/``.
At half the size Lamplit's methods run alone. Writes ``lit.json``, ``.md``, ``.png`` and the
pictures into the results. Once the long runs are there it takes about a quarter of an hour:

    python benchmarks/run.py --parts lit
    python benchmarks/run.py --parts lit --short --lamps L1 L3 L4
    python benchmarks/run.py --parts lit --quick --lamps L1 --methods path
"""

from __future__ import annotations

import contextlib
import dataclasses
import json
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from comparison_scenes import picture
from errors import Array
from lit_errors import Estimate, dots, halved, tone, trim
from lit_pictures import Sheet
from lit_reference import Reference, reference
from lit_report import as_markdown, draw
from lit_runners import MITSUBA, Lamplit, MitsubaVariant, Runner, Shot
from lit_scene import HEIGHT, WIDTH, lit_scene
from machine import machine
from peers.mitsuba_process import Mitsuba, variants

import lamplit as ll
from lamplit.engine.plan import METHODS as KNOWN

#: Lamplit's methods that trace light physically; the first is what others are held against.
METHODS = ("path", "lit")
#: The lamps that are measured unless others are asked for.
USUAL = ("L1", "L2", "L3", "L4")


@dataclass(frozen=True)
class Settings:
    """How much is measured."""

    width: int = WIDTH
    height: int = HEIGHT
    triangles: int = 200_000
    seeds: int = 5
    #: Core seconds at which programs are compared, at full size and at half of it.
    judged_core_s: float = 20.0
    half_core_s: float = 10.0
    #: Core seconds of the second column of pictures; 0 takes the mean over seeds.
    long_core_s: float = 0.0
    #: The long runs of each program: independent parts, and core seconds of each.
    reference_parts: int = 8
    reference_core_s: float = 30.0


#: Half an hour for three lamps, long runs included; `path` still has dots in its own.
SHORT = Settings(
    width=200,
    height=100,
    judged_core_s=20.0,
    half_core_s=5.0,
    reference_parts=4,
    reference_core_s=40.0,
)

#: To see that all works, not to measure.
QUICK = Settings(
    width=200,
    height=100,
    triangles=30_000,
    seeds=3,
    judged_core_s=3.0,
    half_core_s=1.5,
    reference_parts=4,
    reference_core_s=4.0,
)


def measure(
    results: Path,
    settings: Settings = Settings(),
    *,
    lamps: Sequence[str] = USUAL,
    methods: Sequence[str] = METHODS,
) -> None:
    """Measure ``lamps`` by ``methods`` and write what came out into the folder ``results``."""
    known = [name for name in methods if name in KNOWN]
    for name in sorted(set(methods) - set(known)):
        print(f"this Lamplit has no method {name!r}: left out")
    rows: list[dict[str, Any]] = []
    sheet = Sheet()
    about = {
        "machine": machine(),
        "version": ll.__version__,
        "settings": dataclasses.asdict(settings),
    }
    page = ""
    with tempfile.TemporaryDirectory(prefix="lamplit-bench-") as folder:
        for lamp in lamps:
            scene = lit_scene(lamp, Path(folder), triangles=settings.triangles)
            scene = picture(scene, width=settings.width, height=settings.height)
            rows.append({"lamp": lamp, **_measure_lamp(scene, lamp, known, settings, sheet)})
            page = _write(results, {**about, "rows": rows})
            print(f"measured: lit, {lamp}", flush=True)
    sheet.write(results / "lit-pictures.png")
    print(page)


def _write(results: Path, found: dict[str, Any]) -> str:
    """Write what was found so far, and return the page."""
    results.mkdir(parents=True, exist_ok=True)
    (results / "lit.json").write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    page = as_markdown(found)
    (results / "lit.md").write_text(page, encoding="utf-8")
    draw(found, results / "lit.png")
    return page


def _measure_lamp(
    scene: ll.Scene, lamp: str, methods: Sequence[str], settings: Settings, sheet: Sheet
) -> dict[str, Any]:
    row: dict[str, Any] = {
        "triangles": sum(len(t.mesh.triangles) for t in scene.resolved_objects() if t.mesh)
    }
    with contextlib.ExitStack() as stack:
        runners: dict[str, Runner] = {name: Lamplit(scene, name) for name in methods}
        peer = _faster_peer(scene, stack, row)
        if peer is not None:
            runners[MITSUBA] = peer
        wanted = reference(
            scene,
            runners,
            parts=settings.reference_parts,
            core_s=settings.reference_core_s,
        )
        row["reference"] = {
            "weights": dict(wanted.weights),
            "made": {name: list(made) for name, made in wanted.made.items()},
            "scales": dict(wanted.scales),
            "own_errors": wanted.own_errors(),
            "long_runs": wanted.long_runs(),
        }
        ladders, shots = _climb(runners, settings.judged_core_s, settings.seeds, wanted)
        row["full"] = _view(scene, settings.judged_core_s, ladders, shots, wanted)
        longer = {
            name: runner.shots([settings.long_core_s], 1)[0]
            for name, runner in runners.items()
            if settings.long_core_s > 0.0
        }
    sheet.add(lamp, scene, shots, longer=longer, reference=wanted.xyz)
    half = picture(scene, width=settings.width // 2, height=settings.height // 2)
    small = {name: Lamplit(half, name) for name in methods}
    wanted = wanted.seen(halved)
    ladders, shots = _climb(small, settings.half_core_s, settings.seeds, wanted, rungs=1)
    row["half"] = _view(half, settings.half_core_s, ladders, shots, wanted)
    return row


def _faster_peer(
    scene: ll.Scene, stack: contextlib.ExitStack, row: dict[str, Any]
) -> MitsubaVariant | None:
    """Return the variant of Mitsuba that takes more samples in a core second, if any is there."""
    found: dict[str, tuple[MitsubaVariant, Mitsuba]] = {}
    for name in variants():
        peer = stack.enter_context(Mitsuba(scene, name))
        found[name] = (MitsubaVariant(peer), peer)
    speeds = {name: one.samples_per_core_s for name, (one, _) in found.items()}
    row["mitsuba_samples_per_core_s"] = speeds
    if not found:
        return None
    best = max(speeds, key=lambda name: speeds[name])
    row["mitsuba"] = {"variant": best, "version": found[best][1].version}
    return found[best][0]


def _climb(
    runners: Mapping[str, Runner],
    judged_core_s: float,
    seeds: int,
    wanted: Reference,
    *,
    rungs: int = 5,
) -> tuple[dict[str, list[list[dict[str, float]]]], dict[str, list[Shot]]]:
    """Return each program's errors by seed and time, and its last pictures by seed.

    Programs take turns. Rungs halve downwards from the judged time; Lamplit, which renders each
    anew, climbs them with the first seed alone.
    """
    ladder = [judged_core_s / 2.0**at for at in reversed(range(rungs))]
    told: dict[str, list[list[dict[str, float]]]] = {name: [] for name in runners}
    last: dict[str, list[Shot]] = {name: [] for name in runners}
    for seed in range(1, seeds + 1):
        for name, runner in runners.items():
            whole = seed == 1 or name == MITSUBA
            shots = runner.shots(ladder if whole else ladder[-1:], seed)
            told[name].append([_told(shot, wanted.picture_for(name)) for shot in shots])
            last[name].append(shots[-1])
    return told, last


def _told(shot: Shot, reference_xyz: Array) -> dict[str, float]:
    return {
        "core_s": round(shot.core_s, 4),
        "samples": shot.samples,
        "tone": tone(shot.xyz, reference_xyz),
        "trim": trim(shot.xyz, reference_xyz),
        "dots": dots(shot.xyz, reference_xyz),
    }


def _view(
    scene: ll.Scene,
    judged_core_s: float,
    ladders: Mapping[str, Any],
    shots: Mapping[str, list[Shot]],
    wanted: Reference,
) -> dict[str, Any]:
    return {
        "size": [scene.image.width, scene.image.height],
        "judged_core_s": judged_core_s,
        "ladders": ladders,
        "agreement": {
            name: Estimate.of(np.stack([shot.xyz for shot in own])).against(
                wanted.estimate_for(name)
            )
            for name, own in shots.items()
        },
    }

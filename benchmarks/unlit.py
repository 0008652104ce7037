# SPDX-License-Identifier: Apache-2.0 OR MIT
"""S1: time to the same error on unlit lamps, Lamplit's `path` against Mitsuba 3.

Both programs get the same meshes with the same normals, the same spectra, camera and box filter;
Mitsuba runs its `volpathmis` in both spectral variants, and the better one is the peer. The
converged picture is Lamplit's, of two long renders whose difference tells its own error, and
Mitsuba's passes all together are held against it. Writes ``unlit.json``, ``.md``, ``.png`` and the
pictures at equal time into the results. Takes about nine minutes:

    python benchmarks/run.py --parts unlit
"""

from __future__ import annotations

import contextlib
import json
import tempfile
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
from comparison_scenes import Light, unlit_lamp
from errors import Array, dark_scale, mean_delta_e, relative_mse
from ladder import Climber, LamplitClimber, MitsubaClimber, Rung
from machine import machine
from peers.mitsuba_process import Mitsuba, variants
from unlit_report import as_markdown, draw, write_pictures

import lamplit as ll
from lamplit.colour.tristimulus import xyz_of_xy
from lamplit.report.view import scene_white_xy

LAMPS = ("p21w", "led-array")
LIGHTS: tuple[Light, ...] = ("surround", "studio")
TRIANGLES = 150_000
#: Seconds that each program renders, for each seed; pictures are shown of the first.
BUDGETS_S = (10.0, 5.0, 5.0)
#: Ratios are taken here: the longest time that all seeds have.
JUDGED_S = min(BUDGETS_S)
SHORTEST_S = 0.15
#: Seconds of each of the two renders that make the converged picture.
REFERENCE_S = 20.0
FIRST_REFERENCE_SEED = 1001


def measure(results: Path) -> None:
    """Measure all lamps in all lights and write what came out into the folder ``results``."""
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory(prefix="lamplit-bench-") as folder:
        for lamp in LAMPS:
            for light in LIGHTS:
                scene = unlit_lamp(lamp, Path(folder), triangles=TRIANGLES, light=light)
                rows.append({"lamp": lamp, "light": light, **_measure_scene(scene, results)})
                print(f"measured: {lamp}, {light}")
    found = {"machine": machine(), "version": ll.__version__, "rows": rows}
    (results / "unlit.json").write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    page = as_markdown(found)
    (results / "unlit.md").write_text(page, encoding="utf-8")
    draw(found, results / "unlit.png")
    print(page)


def _measure_scene(scene: ll.Scene, results: Path) -> dict[str, Any]:
    reference, noise = _reference(scene)
    white = xyz_of_xy(scene_white_xy(scene), float(scene.display.white_luminance_cd_m2))
    ladders: dict[str, list[list[dict[str, float]]]] = defaultdict(list)
    passes: list[tuple[float, int]] = []
    shown: dict[str, Rung] = {}
    with contextlib.ExitStack() as stack:
        peers = {name: stack.enter_context(Mitsuba(scene, name)) for name in variants()}
        for peer in peers.values():
            MitsubaClimber.warm(peer)
        for seed, budget_s in enumerate(BUDGETS_S, start=1):
            mitsuba = {name: MitsubaClimber(peer, seed) for name, peer in peers.items()}
            climbers: dict[str, Climber] = {"lamplit": LamplitClimber(scene, seed), **mitsuba}
            rungs = _climb(climbers, budget_s)
            for name, ladder in rungs.items():
                told = [_told(rung, reference, noise, white) for rung in ladder]
                ladders[name].append(told)
            shown = shown or {name: ladder[-1] for name, ladder in rungs.items()}
            for climber in mitsuba.values():
                passes += climber.passes
        loaded = {name: peer.load_s for name, peer in peers.items()}
        versions = {peer.version for peer in peers.values()}
    write_pictures(scene, shown, results)
    return {
        "triangles": sum(len(t.mesh.triangles) for t in scene.resolved_objects() if t.mesh),
        "mitsuba": sorted(versions),
        "load_s": loaded,
        "reference_noise": noise,
        "cross_check": _cross_check(passes, reference),
        "judged_s": JUDGED_S,
        "ladders": ladders,
    }


def _reference(scene: ll.Scene) -> tuple[Array, float]:
    """Return the converged picture and the mean squared relative error that it still has."""
    climber = LamplitClimber(scene, FIRST_REFERENCE_SEED)
    climber.climb(0.0)
    pair = [climber.climb(REFERENCE_S).xyz]
    other = LamplitClimber(scene, FIRST_REFERENCE_SEED + 1)
    other.climb(0.0)
    pair.append(other.climb(REFERENCE_S).xyz)
    mean = 0.5 * (pair[0] + pair[1])
    half = 0.5 * (pair[0] - pair[1])[..., 1]
    return mean, float(((half / dark_scale(mean)) ** 2).mean())


def _climb(climbers: dict[str, Climber], budget_s: float) -> dict[str, list[Rung]]:
    """Let the programs climb in turn, each rung twice as long as the one before."""
    rungs: dict[str, list[Rung]] = {name: [] for name in climbers}
    times = [budget_s]
    while times[-1] / 2.0 > SHORTEST_S:
        times.append(times[-1] / 2.0)
    for until_s in reversed(times):
        for name, climber in climbers.items():
            rungs[name].append(climber.climb(until_s))
    return rungs


def _told(rung: Rung, reference: Array, noise: float, white: Array) -> dict[str, float]:
    """Return a rung's errors, without the part that the reference's own noise adds."""
    return {
        "seconds": round(rung.seconds, 4),
        "samples": rung.samples,
        "relative_mse": max(relative_mse(rung.xyz, reference) - noise, 0.0),
        "delta_e": mean_delta_e(rung.xyz, reference, white),
    }


def _cross_check(passes: list[tuple[float, int]], reference: Array) -> dict[str, float]:
    """Return Mitsuba's mean luminance over Lamplit's, less 1, and its standard error."""
    if not passes:
        return {}
    values, weights = np.array(passes).T
    mean = float(np.average(values, weights=weights))
    spread = ((values - mean) ** 2 * weights).sum() / (len(values) - 1)
    sigma = float(np.sqrt(spread / weights.sum()))
    expected = float(reference[..., 1].mean())
    return {"difference": mean / expected - 1.0, "sigma": sigma / expected}

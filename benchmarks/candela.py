# SPDX-License-Identifier: Apache-2.0 OR MIT
"""S8: time to 1 % standard error at every test point of a lit stop lamp, against Mitsuba 3.

Three ways to the candela at the points of un-r148/S1, on the same flat meshes, materials and
sources: Lamplit's walk from the light, which serves all points at once; Lamplit's walk from the
eye of each receiver (`lamplit.engine.looking`), which learns anew in each round; and Mitsuba's
`volpathmis` with a sensor at each receiver. Its particle tracer is asked too: it connects to
sensors in straight lines, and so sees nothing through a smooth cover. Standard errors come from
independent repetitions; what was not waited for is told by σ ∝ 1/√time. Time is the processor's,
of all threads, so that what else the machine does counts little. Writes ``candela.json``, ``.md``
and ``.png`` into the results:

    python benchmarks/run.py --parts candela
"""

from __future__ import annotations

import contextlib
import json
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from candela_report import WANTED, Round, as_markdown, draw, summary
from candela_scene import Array, corners_mm, lit_lamp, receiver
from machine import machine
from peers.mitsuba_process import Mitsuba, variants

import lamplit as ll
from lamplit.engine.assembly import assemble
from lamplit.engine.carrier import SpectralCarrier
from lamplit.engine.looking import Looking, eye_method
from lamplit.engine.measurement import Measurement
from lamplit.rules import find_rule

LAMP, RULE = "led-array", "un-r148/S1"
TRIANGLES = 150_000
DISTANCE_M = 10.0
#: Rounds go on until so many seconds have passed; two there are at least.
BUDGET_S, MOST_ROUNDS = 240.0, 64
#: Light paths of a round.
PATHS = 1 << 19
#: Looks of an eye from each receiver at most; it ends before where it says 1 %.
LOOKS = 1 << 21
#: Passes of Mitsuba for each receiver in a round, and samples per pixel of a pass. With fewer, none
#: of them may meet what a dim point has, and its σ says nothing.
PASSES = 16
SAMPLES = {"llvm_ad_spectral": 48, "scalar_spectral": 12}
#: Whoever is not the best variant is timed at this receiver alone: the axis.
_AXIS = (0.0, 0.0)
_ALL = np.array([-90.0, 90.0])


def measure(results: Path) -> None:
    """Measure the three ways in turn and write what came out into the folder ``results``."""
    about, h, v = machine(), *find_rule(RULE).spots()
    spots = np.stack([h, v], axis=1)
    with tempfile.TemporaryDirectory(prefix="lamplit-bench-") as folder:
        scene = lit_lamp(LAMP, Path(folder), triangles=TRIANGLES, distance_m=DISTANCE_M)
        with contextlib.ExitStack() as stack:
            peers = {name: stack.enter_context(Mitsuba(scene, name)) for name in variants()}
            rounds, extra = _rounds(scene, spots, peers)
    raw = {name: [one.kept() for one in done] for name, done in rounds.items()}
    found: dict[str, Any] = {
        "machine": about,
        "version": ll.__version__,
        "mitsuba": sorted({peer.version for peer in peers.values()}),
        "lamp": LAMP,
        "rule": RULE,
        "h_deg": h.tolist(),
        "v_deg": v.tolist(),
        **extra,
        **summary(spots, rounds),
        "rounds": raw,
    }
    (results / "candela.json").write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    page = as_markdown(found)
    (results / "candela.md").write_text(page, encoding="utf-8")
    draw(found, results / "candela.png")
    print(page)


def _rounds(
    scene: ll.Scene, spots: Array, peers: dict[str, Mitsuba]
) -> tuple[dict[str, list[Round]], dict[str, Any]]:
    rounds: dict[str, list[Round]] = {"light walk": [], "eye walk": []}
    first = _light(scene, spots, seed=1, paths=1)[1]
    gonio, corners = first.goniometer, corners_mm(scene)
    sensors = [receiver(gonio, way, corners) for way in gonio.directions()]
    axis = int(np.flatnonzero((spots == _AXIS).all(axis=1))[0])
    speeds = {name: _speed(peer, name, sensors[axis][0]) for name, peer in peers.items()}
    best = max(speeds, key=lambda name: speeds[name], default=None)
    extra: dict[str, Any] = {
        "receiver_deg": gonio.receiver_deg,
        "distance_m": gonio.distance_m,
        "paths_per_core_s": speeds,
        "peer": best,
    }
    if best is not None:
        node, factor = sensors[axis]
        done = peers[best].render(SAMPLES[best], 1, sensor=node, integrator={"type": "ptracer"})
        extra["ptracer_axis_cd"] = float(done.xyz[..., 1].mean() * factor)
        rounds["Mitsuba"] = []
    started = time.perf_counter()
    for turn in range(MOST_ROUNDS):
        own, light = _light(scene, spots, seed=turn + 1, paths=PATHS)
        rounds["light walk"].append(own)
        rounds["eye walk"].append(_eye(scene, light, turn + 1))
        if best is not None:
            rounds["Mitsuba"].append(_peer(peers[best], best, sensors, turn))
        spent = time.perf_counter() - started
        print(f"round {turn + 1}: {spent:.0f} s", flush=True)
        if turn > 0 and spent * (turn + 2) / (turn + 1) > BUDGET_S:
            break
    return rounds, extra


def _light(scene: ll.Scene, spots: Array, *, seed: int, paths: int) -> tuple[Round, Measurement]:
    core = time.process_time()
    done = ll.measure(scene, spots=spots, grid=(_ALL, _ALL), paths=paths, seed=seed, eye=False)
    core = time.process_time() - core
    # Of the batches as they are, zeros included: without the upper bound that `observed` gives to
    # what no path met, so that the mean over points and rounds is that of the variance.
    batches = done.spot_xyz[..., 1].sum(axis=1)
    whole = np.full(len(spots), 1.0)
    return Round(
        cd=batches.mean(axis=0),
        sigma=batches.std(axis=0, ddof=1) / len(batches) ** 0.5,
        core_s=whole * core,
        wall_s=whole * done.elapsed_s,
        paths=float(done.paths),
    ), done


def _eye(scene: ll.Scene, light: Measurement, seed: int) -> Round:
    world = assemble(scene, SpectralCarrier(scene.image.wavelength_range_nm, scene.image.observer))
    gonio = light.goniometer
    cd, sigma, core, wall = (np.zeros(gonio.spot_h_deg.size) for _ in range(4))
    for at in range(gonio.spot_h_deg.size):
        start, before = time.perf_counter(), time.process_time()
        looking = Looking(
            world, gonio, eye_method(scene), groups=len(light.groups), seed=seed, spots=[at]
        )
        looking.until(LOOKS, error=WANTED)
        core[at], wall[at] = time.process_time() - before, time.perf_counter() - start
        # Of the repetitions as they are, as for the light.
        readings = looking.reading().xyz[..., 0, 1].sum(axis=1)
        cd[at], sigma[at] = readings.mean(), readings.std(ddof=1) / len(readings) ** 0.5
    return Round(cd=cd, sigma=sigma, core_s=core, wall_s=wall)


def _peer(
    peer: Mitsuba, variant: str, sensors: list[tuple[dict[str, Any], float]], turn: int
) -> Round:
    cd, core, wall = (np.zeros((len(sensors), PASSES)) for _ in range(3))
    for at, (node, factor) in enumerate(sensors):
        for own in range(PASSES):
            seed = 1 + own + PASSES * (at + len(sensors) * turn)
            done = peer.render(SAMPLES[variant], seed, sensor=node)
            cd[at, own] = done.xyz[..., 1].mean() * factor
            core[at, own], wall[at, own] = done.core_s, done.seconds
    return Round(
        cd=cd.mean(axis=1),
        sigma=cd.std(axis=1, ddof=1) / PASSES**0.5,
        core_s=core.sum(axis=1),
        wall_s=wall.sum(axis=1),
    )


def _speed(peer: Mitsuba, variant: str, sensor: dict[str, Any]) -> float:
    """Return paths per second of the processor; the first render compiles and does not count."""
    peer.render(SAMPLES[variant], 0, sensor=sensor)
    done = peer.render(SAMPLES[variant], 1, sensor=sensor)
    rows, columns = done.xyz.shape[:2]
    return rows * columns * SAMPLES[variant] / done.core_s

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The same numbers every time: whatever the threads and tiles, and kept when a run is stopped."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lamplit as ll
from lamplit import _core
from lamplit.engine import RenderInterrupted

Maker = Callable[[], Any]


def lit_glass(lane_scene: Maker) -> Any:
    """Return a scene in which every sample draws random numbers, before a checkered floor."""
    scene = lane_scene()
    scene.gradient(2.0, 1.0)
    scene.checker(0.8, 0.1, 3.0)
    scene.body("plane", [0, -6, 0, 0, 1, 0], 0)
    scene.body("sphere", [0, 0, 0, 5], scene.glass(np.linspace(1.48, 1.52, 16), 0.05))
    scene.builder.add_sphere_light(scene.spectrum(3.0), (20.0, 30.0, 10.0), 8.0)
    scene.look((5, 9, 30), (0, -1, 0), field_of_view_deg=30.0)
    return scene.build(1.0)


HALL = _core.HallMethod(max_depth=12, contribution_limit=1e-4, dispersion_groups=4, shadows=True)


def fingerprint(world: Any, **settings: Any) -> str:
    render = world.render(33, 21, 9, HALL, **({"bands_per_lane": 1} | settings))
    buffers = (render.xyz(), render.xyz_standard_error(), render.spectral_radiance())
    digest = sha256(b"".join(buffer.tobytes() for buffer in buffers))
    counts = {name: count for name, count in render.statistics().items() if name != "trace_s"}
    return digest.hexdigest() + repr(sorted(counts.items()))


def test_threads_and_tiles_change_no_bit(lane_scene: Maker) -> None:
    world = lit_glass(lane_scene)
    prints = {
        fingerprint(world, threads=threads, tile=tile)
        for threads in (1, 2, 7, 16)
        for tile in (1, 13, 64, 10_000)
    }
    assert len(prints) == 1


@pytest.mark.parametrize("sampling", ["grid", "sobol"])
def test_another_seed_gives_another_picture_of_the_same_mean(
    lane_scene: Maker, sampling: str
) -> None:
    world = lit_glass(lane_scene)
    assert fingerprint(world, sampling=sampling, seed=1) == fingerprint(
        world, sampling=sampling, seed=1
    )
    assert fingerprint(world, sampling=sampling, seed=1) != fingerprint(
        world, sampling=sampling, seed=2
    )
    one, two = (world.render(33, 21, 64, HALL, seed=seed) for seed in (1, 2))
    difference = (one.xyz() - two.xyz())[..., 1].mean()
    error = np.sqrt((one.xyz_standard_error() ** 2 + two.xyz_standard_error() ** 2)[..., 1].sum())
    assert abs(difference) < 4 * error / (33 * 21)


PATH = _core.PathMethod(max_depth=64, split_depth=4, roulette_below=0.05)


@pytest.mark.parametrize(
    "settings", [{"adaptive": False}, {"adaptive": True}, {"adaptive": True, "target_error": 0.02}]
)
def test_a_walk_and_its_allotment_depend_on_no_thread_and_no_tile(
    lane_scene: Maker, settings: dict[str, Any]
) -> None:
    world = lit_glass(lane_scene)
    found: set[str] = set()
    for threads, tile in ((1, 64), (2, 64), (7, 64), (2, 3)):
        render = world.render(
            24, 16, 40, PATH, layers=True, threads=threads, tile=tile, seed=3, **settings
        )
        parts = (render.xyz(), render.xyz_standard_error(), render.layers(), render.samples())
        ledger, counts = render.ledger(), render.statistics()
        digest = sha256(b"".join(part.tobytes() for part in parts)).hexdigest()
        found.add(f"{digest} {ledger} {sorted(counts.items())}")
        spread = np.ptp(render.samples())
        assert (spread > 0) == settings["adaptive"]
    assert len(found) == 1


def test_ranges_of_samples_add_up_to_the_whole(lane_scene: Maker) -> None:
    world = lit_glass(lane_scene)
    whole = world.render(17, 9, 16, HALL).xyz()
    parts = [
        world.render(17, 9, n, HALL, first_sample=at).xyz() * n
        for at, n in ((0, 5), (5, 1), (6, 10))
    ]
    np.testing.assert_allclose(sum(parts) / 16, whole, rtol=1e-13)


def test_a_scene_renders_to_the_same_bits_on_any_threads(scene_of: Callable[..., Any]) -> None:
    scene = scene_of(
        image={"samples": 4, "filter": "gaussian"},
        lights=[
            {
                "kind": "sphere",
                "centre_mm": [30, 40, 50],
                "radius_mm": 9.0,
                "source": "D65",
                "luminance_cd_m2": 500.0,
            }
        ],
        objects=[
            {
                "name": "ball",
                "kind": "sphere",
                "centre_mm": [0, 0, 0],
                "radius_mm": 7,
                "material": "red-pmma",
            }
        ],
    )
    pictures = [ll.render(scene, threads=threads).xyz for threads in (1, 2, 7, 16)]
    assert len({sha256(xyz.tobytes()).hexdigest() for xyz in pictures}) == 1
    other = scene.changed(image=scene.image.model_copy(update={"seed": 2}))
    assert not np.array_equal(ll.render(other).xyz, pictures[0])


STOPPED = """
import os, signal, sys, threading, time
import numpy as np
import lamplit as ll
from lamplit import _core
from lamplit.engine import RenderInterrupted

def main() -> None:
    # Background jobs of a shell inherit a SIGINT that is ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    scene = ll.load_scene(sys.argv[1])
    sent = []
    def stop():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)
    def watch(done, total):
        if done > 24 * 64 * 48 and not sent:
            threading.Thread(target=stop).start()
    try:
        ll.render(scene, progress=watch, **OPTIONS)
    except RenderInterrupted as stopped:
        late = time.monotonic() - sent[0]
        image = stopped.image
        assert isinstance(stopped, KeyboardInterrupt)
        assert not image.complete and image.interrupted
        assert 2 <= image.samples < image.samples_asked
        y = image.luminance_cd_m2
        assert np.isfinite(y).all() and (y > 0).all(), y
        if image.layers:
            np.testing.assert_allclose(sum(image.layers.values()), image.xyz, rtol=1e-12)
        assert bool(image.layers) == ("layers" in OPTIONS)
        # Samples of a pixel are far from even over all wavelengths yet, and right on average.
        assert abs(y[:, :8].mean() / 100.0 - 1.0) < 0.02, y[:, :8].mean()
        print("stopped after", late)

main()
"""

LONG = """
lamplit = 1
[camera]
kind = "orthographic"
position_mm = [0.0, 0.0, 100.0]
target_mm = [0.0, 0.0, 0.0]
height_mm = 20.0
[image]
width = 64
height = 48
samples = 1000000
[background]
kind = "constant"
source = "E"
luminance_cd_m2 = 100.0
[[objects]]
name = "ball"
kind = "sphere"
centre_mm = [0.0, 0.0, 0.0]
radius_mm = 8.0
material = "pmma-clear"
"""


@pytest.mark.parametrize(
    "options",
    [{"method": "hall"}, {"method": "path", "layers": True}, {"adaptive": True, "layers": True}],
    ids=["hall", "path", "adaptive"],
)
def test_ctrl_c_stops_within_2_seconds_and_keeps_what_is_done(
    tmp_path: Path, options: dict[str, Any]
) -> None:
    (tmp_path / "long.toml").write_text(LONG.replace("1000000", "65536"))
    (tmp_path / "stopped.py").write_text(f"OPTIONS = {options!r}\n{STOPPED}")
    words = [
        sys.executable,
        "-W",
        "error",
        str(tmp_path / "stopped.py"),
        str(tmp_path / "long.toml"),
    ]
    run = subprocess.run(words, capture_output=True, text=True, timeout=60, check=False)
    assert run.returncode == 0, run.stderr
    assert float(run.stdout.removeprefix("stopped after ")) < 2.0


def test_a_fault_in_the_callers_progress_comes_back_to_the_caller(
    scene_of: Callable[..., Any],
) -> None:
    scene = scene_of(
        image={"width": 64, "height": 64, "samples": 40_000},
        objects=[
            {
                "name": "ball",
                "kind": "sphere",
                "centre_mm": [0, 0, 0],
                "radius_mm": 7,
                "material": "red-pmma",
            }
        ],
    )

    def progress(done: int, total: int) -> None:
        assert 0 <= done <= total == 64 * 64 * 40_000
        raise ZeroDivisionError("the caller's own")

    with pytest.raises(ZeroDivisionError, match="the caller's own"):
        ll.render(scene, progress=progress)
    assert issubclass(RenderInterrupted, KeyboardInterrupt)

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""S3, S6, S7: what the `path` method costs by wavelengths, by threads, and in memory.

The engine with 4 wavelengths is this one, compiled once more in ``build/four-lanes`` with another
`LANES`: the same paths, the same code. Writes ``path.json`` and ``path.md`` into the results.
"""

from __future__ import annotations

import json
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from machine import machine, machine_line
from peers.child import Child

import lamplit as ll

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent
FOUR_LANES = REPOSITORY / "build" / "four-lanes"
ROUNDS = 7
TRIANGLES = 150_000
PIXELS = 400 * 200
LAMP_LIGHTS = (("p21w", "surround"), ("led-array", "studio"))
_LANES = "pub const LANES: usize = 16;"


def worker(lamp: str, light: str, folder: str, package: Path) -> Child:
    """Return a process of `path_worker` with one lamp; `lamplit` is taken from ``package``."""
    command = [sys.executable, HERE / "path_worker.py", lamp, light, str(TRIANGLES), folder]
    return Child(command, PYTHONPATH=str(package))


def render(child: Child, samples: int, *, seed: int, threads: int) -> dict[str, Any]:
    """Return seconds, rays and memory of one render."""
    return child.ask({"samples": samples, "seed": seed, "threads": threads})


def measure(results: Path) -> None:
    """Measure both lamps and write what came out."""
    own, four = REPOSITORY / "python", compile_four_lanes()
    rows: list[dict[str, Any]] = []
    for lamp, light in LAMP_LIGHTS:
        with tempfile.TemporaryDirectory(prefix="lamplit-bench-") as folder:
            row: dict[str, Any] = {"lamp": lamp, "light": light}
            row |= _lanes_and_threads(lamp, light, folder, own, four)
            row |= _memory(lamp, light, folder, own)
            rows.append(row)
            print(f"measured: path, {lamp}, {light}")
    found = {"machine": machine(), "version": ll.__version__, "rows": rows}
    (results / "path.json").write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    page = as_markdown(found)
    (results / "path.md").write_text(page, encoding="utf-8")
    print(page)


def compile_four_lanes() -> Path:
    """Compile the engine with four wavelengths and return the folder of its package."""
    sources, package = FOUR_LANES / "crates", FOUR_LANES / "python"
    for old in (sources, package):
        shutil.rmtree(old, ignore_errors=True)
    shutil.copytree(REPOSITORY / "crates", sources)
    for name in ("Cargo.toml", "Cargo.lock"):
        shutil.copy2(REPOSITORY / name, FOUR_LANES / name)
    lanes = sources / "core" / "src" / "spectrum" / "lanes.rs"
    written = lanes.read_text(encoding="utf-8")
    if _LANES not in written:
        sys.exit(f"error: {lanes} no longer says {_LANES!r}; bench S3 rests on it")
    lanes.write_text(written.replace(_LANES, _LANES.replace("16", "4")), encoding="utf-8")
    build = "cargo build --release --locked --quiet --package lamplit-python"
    subprocess.run(
        [*build.split(), "--features", "pyo3/extension-module"], cwd=FOUR_LANES, check=True
    )
    shutil.copytree(REPOSITORY / "python", package)
    built = FOUR_LANES / "target" / "release" / "lib_core.so"
    shutil.copy2(built, package / "lamplit" / "_core.abi3.so")
    return package


def _lanes_and_threads(
    lamp: str, light: str, folder: str, own: Path, four: Path
) -> dict[str, float]:
    """Return the medians over rounds of ratios measured in turn, and the speed of all threads."""
    lanes: list[float] = []
    threads: list[float] = []
    done: dict[str, Any] = {}
    few: dict[str, Any] = {}
    with worker(lamp, light, folder, own) as full, worker(lamp, light, folder, four) as narrow:
        for seed in range(ROUNDS):
            done = render(full, 2, seed=seed, threads=2)
            one = render(full, 2, seed=seed, threads=1)
            few = render(narrow, 2, seed=seed, threads=1)
            lanes.append(one["seconds"] / few["seconds"])
            threads.append(one["seconds"] / done["seconds"])
    return {
        "paths_per_s": 2 * PIXELS / done["seconds"],
        "rays_per_s": done["rays"] / done["seconds"],
        "rays_per_path": done["rays"] / (2 * PIXELS),
        "rays_per_path_four": few["rays"] / (2 * PIXELS),
        "build_s": done["build_s"],
        "sixteen_over_four": statistics.median(lanes),
        "speed_up_of_two_threads": statistics.median(threads),
    }


def _memory(lamp: str, light: str, folder: str, own: Path) -> dict[str, float]:
    """Return the most memory of fresh processes by samples, and what was foretold, in MiB."""
    peaks: dict[str, float] = {}
    for samples in (2, 32):
        with worker(lamp, light, folder, own) as fresh:
            peak = render(fresh, samples, seed=1, threads=2)["peak_bytes"]
            peaks[f"peak_mib_{samples}_samples"] = peak / 2**20
            peaks["foretold_mib"] = fresh.greeting["foretold_bytes"] / 2**20
    return peaks


def as_markdown(found: dict[str, Any]) -> str:
    """Return the results as a table."""
    rows = found["rows"]
    told = (
        ("paths per second, two threads (millions)", "paths_per_s", 1e-6),
        ("rays per second, two threads (millions)", "rays_per_s", 1e-6),
        ("rays per path", "rays_per_path", 1),
        ("rays per path with 4 wavelengths", "rays_per_path_four", 1),
        ("time per path, 16 wavelengths over 4 (S3, ×)", "sixteen_over_four", 1),
        ("speed-up of two threads (S6, ×)", "speed_up_of_two_threads", 1),
        ("building the scene, s", "build_s", 1),
        ("memory at most, 2 samples, MiB (S7)", "peak_mib_2_samples", 1),
        ("memory at most, 32 samples, MiB", "peak_mib_32_samples", 1),
        ("memory foretold, MiB", "foretold_mib", 1),
    )
    lines = [
        "# The path method",
        "",
        f"`make bench PARTS=path` on {machine_line(found['machine'])}; {TRIANGLES} triangles asked",
        "for, 400 × 200 pixels; medians of ratios measured in turn.",
        "",
        "| what | " + " | ".join(f"{row['lamp']}, {row['light']}" for row in rows) + " |",
        "|---|" + "---|" * len(rows),
    ]
    for name, key, factor in told:
        values = " | ".join(f"{row[key] * factor:.4g}" for row in rows)
        lines.append(f"| {name} | {values} |")
    return "\n".join([*lines, ""])

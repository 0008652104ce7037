# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`make bench`: how fast Lamplit is, in ratios measured side by side in one run.

Leave the machine alone meanwhile. Each part writes a JSON file, a table and pictures into
``benchmarks/results/``, with the machine's name:

    unlit    time to the same error on unlit lamps, against Mitsuba 3 (nine minutes): ``unlit.*``
    lit      lit lamps, methods at equal time, against Mitsuba 3 (a quarter of an hour): ``lit.*``
    candela  time to 1 % candela at test points, against Mitsuba 3 (six minutes): ``candela.*``
    walks    what splitting, roulette and allotting bring, in rays (four minutes): ``walks.*``
    path     what the `path` method costs by wavelengths, threads, memory (four minutes): ``path.*``
    kernel   rays against Embree, the Hall method, the start of the program: ``bench.*``
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

import candela
import kernel
import lit
import numpy as np
import numpy.typing as npt
import path_method
import unlit
import walks
from lit_scene import LAMPS
from machine import machine, machine_line

import lamplit as ll
from lamplit.lamps import write_lamp

HERE = Path(__file__).resolve().parent
RESULTS = HERE / "results"
ROUNDS = 5
PARTS = ("unlit", "lit", "candela", "walks", "path", "kernel")


def main() -> None:
    """Run the measurements that were asked for and write the results."""
    parser = argparse.ArgumentParser(description="how fast Lamplit is")
    parser.add_argument("--parts", nargs="*", choices=PARTS, default=PARTS, help="all by default")
    parser.add_argument("--triangles", type=int, nargs="*", default=[100_000, 1_000_000, 5_000_000])
    own = parser.add_argument_group("lit")
    own.add_argument("--quick", action="store_true", help="small and short, into build/lit-quick/")
    own.add_argument("--short", action="store_true", help="half the size, shorter long runs")
    own.add_argument("--lamps", nargs="*", choices=tuple(LAMPS), default=lit.USUAL)
    own.add_argument("--methods", nargs="*", default=lit.METHODS, help="of Lamplit; path first")
    own.add_argument("--long", type=float, help="core seconds of the pictures' second line")
    options = parser.parse_args()
    results = HERE.parent / "build" / "lit-quick" if options.quick else RESULTS
    results.mkdir(parents=True, exist_ok=True)
    if "unlit" in options.parts:
        unlit.measure(results)
    if "lit" in options.parts:
        settings = lit.SHORT if options.short else lit.Settings()
        settings = lit.QUICK if options.quick else settings
        if options.long:
            settings = dataclasses.replace(settings, long_core_s=options.long)
        lit.measure(results, settings, lamps=options.lamps, methods=options.methods)
    if "candela" in options.parts:
        candela.measure(results)
    if "walks" in options.parts:
        walks.measure(results)
    if "path" in options.parts:
        path_method.measure(results)
    if "kernel" in options.parts:
        measure_founding(options.triangles, results)
    print(f"written to {results}")


def measure_founding(triangles: list[int], folder: Path) -> None:
    """Measure the kernel at these numbers of triangles, the Hall method and the start-up."""
    build = "cargo build --release --locked --quiet --package lamplit-core --example ray_kernel"
    subprocess.run(build.split(), check=True)
    results: dict[str, Any] = {"machine": machine(), "version": ll.__version__}
    results["kernel"] = [measure_kernel(count) for count in triangles]
    results["hall"] = measure_hall()
    results["help_s"] = measure_help()
    (folder / "bench.json").write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")
    page = as_markdown(results)
    (folder / "bench.md").write_text(page, encoding="utf-8")
    draw_kernel(results["kernel"], folder / "kernel.png")
    print(page)


def lamp_scene(folder: Path, triangles: int) -> ll.Scene:
    """Return the p21w lamp at about this many triangles."""
    return ll.load_scene(write_lamp("p21w", folder, {"triangles": triangles}))


def whole_lamp(scene: ll.Scene) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.uint32]]:
    """Return the meshes of a scene as one: vertices (n, 3) in mm and triangles (m, 3)."""
    vertices: list[npt.NDArray[np.float64]] = []
    triangles: list[npt.NDArray[np.uint32]] = []
    count = 0
    for thing in scene.resolved_objects():
        if thing.mesh is not None:
            vertices.append(thing.mesh.vertices_mm)
            triangles.append(thing.mesh.triangles + np.uint32(count))
            count += len(thing.mesh.vertices_mm)
    return np.concatenate(vertices), np.concatenate(triangles)


def measure_kernel(triangles: int) -> dict[str, Any]:
    """Compare the BVH with Embree on rays recorded in the p21w lamp, one thread (S4, S5)."""
    options = argparse.Namespace(
        rays=300_000,
        rounds=3,
        ray_kernel=HERE.parent / "target" / "release" / "examples" / "ray_kernel",
    )
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        mesh = whole_lamp(lamp_scene(folder / "lamp", triangles))
        return kernel.measure(f"p21w, {len(mesh[1])} triangles", mesh, options, folder)


def measure_hall() -> dict[str, Any]:
    """Time the founding method on the p21w lamp: rays/s, spectra against RGB, two threads."""
    with tempfile.TemporaryDirectory() as name:
        scene = lamp_scene(Path(name) / "lamp", 400_000)
        small = scene.changed(image=scene.image.model_copy(update={"width": 160, "height": 100}))

        def trace_s(colour: Literal["spectral", "rgb"], threads: int) -> tuple[float, int]:
            done = ll.render(
                small, method="hall", colour=colour, samples=4, threads=threads
            ).statistics
            return done["trace_s"], done["eye_rays"] + done["shadow_rays"]

        spectral = alternate(lambda: trace_s("spectral", 1), lambda: trace_s("rgb", 1))
        threads = alternate(lambda: trace_s("spectral", 1), lambda: trace_s("spectral", 2))
        seconds, rays = trace_s("spectral", 2)
    return {
        "rays_per_s": round(rays / seconds),
        "spectral_over_rgb_time_per_ray": round(spectral, 3),
        "speed_up_of_two_threads": round(threads, 3),
    }


def alternate(
    one: Callable[[], tuple[float, int]], other: Callable[[], tuple[float, int]]
) -> float:
    """Return the median over rounds of one's time per ray over the other's, run in turn."""
    ratios: list[float] = []
    for _ in range(ROUNDS):
        (time_one, rays_one), (time_other, rays_other) = one(), other()
        ratios.append((time_one / rays_one) / (time_other / rays_other))
    return statistics.median(ratios)


def measure_help() -> float:
    """Return the median time of `lamplit --help` in seconds (S9)."""
    times: list[float] = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        command = [sys.executable, "-m", "lamplit.cli", "--help"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        times.append(time.perf_counter() - start)
    return round(statistics.median(times), 3)


def as_markdown(results: dict[str, Any]) -> str:
    """Return the results as tables."""
    hall = results["hall"]
    lines = [
        "# Benchmarks",
        "",
        f"`make bench` on {machine_line(results['machine'])}.",
        "",
        "## The triangle kernel against Embree 4 (robust mode)",
        "",
        "Rays recorded in the p21w lamp, one thread, interleaved; medians. Above 1 is faster.",
        "",
        "| mesh | build, s (Embree) | B/triangle | order | query | kernel | M rays/s | ratio |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for result in results["kernel"]:
        embree_s = result["embree_build_s"]["robust"]
        head = (
            f"| {result['mesh']} | {result['build_s']:.2f} ({embree_s:.2f}) "
            f"| {result['bytes_per_triangle']:.0f} "
        )
        for order in ("path", "shuffled"):
            for query, kernels in result[order].items():
                for name, numbers in kernels.items():
                    rate = numbers["rays_per_s"] / 1e6
                    ratio = numbers["ratio"]
                    lines.append(f"{head}| {order} | {query} | {name} | {rate:.2f} | {ratio:.2f} |")
    against_rgb, two_threads = (
        hall["spectral_over_rgb_time_per_ray"],
        hall["speed_up_of_two_threads"],
    )
    lines += [
        "",
        "## The founding method on the p21w lamp",
        "",
        "| what | value |",
        "|---|---|",
        f"| rays per second, two threads | {hall['rays_per_s'] / 1e6:.2f} million |",
        f"| time per ray, 16 wavelengths against RGB | {against_rgb:.2f} × |",
        f"| speed-up of two threads | {two_threads:.2f} × |",
        f"| `lamplit --help` | {results['help_s']:.2f} s |",
        "",
    ]
    return "\n".join(lines)


def draw_kernel(results: list[dict[str, Any]], path: Path) -> None:
    """Draw the ratios to robust Embree against the number of triangles."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7.0, 4.2), layout="constrained")
    sizes = [result["triangles"] for result in results]
    best = next(name for name in results[0]["path"]["closest"] if "embree" not in name)
    for order, dash in (("path", "-"), ("shuffled", "--")):
        for query, colour in (("closest", "#c1121f"), ("any", "#33658a")):
            ratios = [result[order][query][best]["ratio"] for result in results]
            label = f"{query} hit, {order} order"
            axes.plot(sizes, ratios, dash, color=colour, marker="o", label=label)
    axes.axhline(1.0, color="0.4", linewidth=1)
    axes.annotate("Embree 4, robust", (sizes[0], 1.0), (0, 4), textcoords="offset points")
    axes.set(xscale="log", xlabel="triangles", ylabel="rays per second, ratio", ylim=(0, None))
    axes.set_title(f"Lamplit's {best} kernel on rays of the p21w lamp, one thread")
    axes.legend(frameon=False)
    figure.savefig(path, dpi=120)
    pyplot.close(figure)


if __name__ == "__main__":
    main()

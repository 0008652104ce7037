# SPDX-License-Identifier: Apache-2.0 OR MIT
"""The triangle kernel against Embree 4 on the same meshes and the same rays, one thread.

Rays are recorded: camera rays followed through up to 12 surfaces of a lens shell with pillow optics
(or of a mesh file), so most start on the mesh. For any hit, each ends at a random length. Both
sides run the same loop over the same rays in turn, a slice of some milliseconds at a time, so that
whatever else the machine does slows both; the ratio is the median over the slices. Embree comes
from the PyPI wheel `embreex`: its robust mode is the peer; its default mode, which is not
watertight, is shown too. Needs a C compiler and the example `ray_kernel`:

    cargo build --release -p lamplit-core --example ray_kernel
    python benchmarks/kernel.py --triangles 100000 1000000 --output kernel.json
"""

from __future__ import annotations

import argparse
import ctypes
import importlib.util
import json
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

REPOSITORY = Path(__file__).resolve().parent.parent

SLICE = 20_000
"""Rays traced before the other side has its turn; `--rays` must be a multiple."""


def pillow_shell(triangles: int) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.uint32]]:
    """Return a closed lens shell, 120 x 80 mm and 2.5 mm thick, with 4 mm pillows inside.

    Vertices (n, 3) in mm, triangles (m, 3) with m close to `triangles`; normals point outward.
    """
    columns = max(8, round((triangles / 4 * 1.5) ** 0.5))
    rows = max(8, round(triangles / 4 / columns))
    x, y = np.meshgrid(np.linspace(-60, 60, columns + 1), np.linspace(-40, 40, rows + 1))
    bulge = -0.002 * (x**2 + y**2)
    pillow = 0.4 * np.cos(np.pi * x / 4) ** 2 * np.cos(np.pi * y / 4) ** 2
    front = np.stack([x, y, bulge], axis=-1).reshape(-1, 3)
    back = np.stack([x, y, bulge - 2.5 - pillow], axis=-1).reshape(-1, 3)

    index = np.arange(len(front)).reshape(rows + 1, columns + 1)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    face = np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)
    rim = np.concatenate([index[0], index[1:, -1], index[-1, -2::-1], index[-2:0:-1, 0]])
    following = np.roll(rim, -1)
    far = len(front)
    sides = [
        np.stack([rim, rim + far, following + far], -1),
        np.stack([rim, following + far, following], -1),
    ]
    faces = np.concatenate([face, face[:, ::-1] + far, *sides])
    return np.concatenate([front, back]), faces.astype(np.uint32)


def read_mesh(path: Path) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.uint32]]:
    """Return vertices and triangles of any mesh file that trimesh reads."""
    import trimesh

    mesh = trimesh.load_mesh(path)
    return np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.uint32)


def write_mesh(
    path: Path, vertices: npt.NDArray[np.float64], triangles: npt.NDArray[np.uint32]
) -> None:
    """Write the binary layout that `ray_kernel` reads."""
    with path.open("wb") as file:
        file.write(np.array([len(vertices), len(triangles)], "<u8").tobytes())
        file.write(vertices.astype("<f8").tobytes())
        file.write(triangles.astype("<u4").tobytes())


def embree_library() -> Path:
    """Return the shared library inside the installed wheel."""
    package = importlib.util.find_spec("embreex")
    if package is None or package.origin is None:
        sys.exit("error: the PyPI package 'embreex' is not installed")
    return next((Path(package.origin).parent.parent / "embreex.libs").glob("libembree4*"))


class Embree:
    """One Embree scene, traced by the C loop in embree_peer.c."""

    def __init__(
        self,
        peer: ctypes.CDLL,
        vertices: npt.NDArray[np.float64],
        triangles: npt.NDArray[np.uint32],
        *,
        robust: bool,
    ) -> None:
        self._peer = peer
        points = np.ascontiguousarray(vertices, np.float32)
        corners = np.ascontiguousarray(triangles, np.uint32)
        build_s = ctypes.c_double()
        peer.peer_build.restype = ctypes.c_void_p
        scene = peer.peer_build(
            str(embree_library()).encode(),
            b"",
            points.ctypes.data_as(ctypes.c_void_p),
            ctypes.c_size_t(len(points)),
            corners.ctypes.data_as(ctypes.c_void_p),
            ctypes.c_size_t(len(corners)),
            int(robust),
            ctypes.byref(build_s),
        )
        if not scene:
            sys.exit("error: Embree's library cannot be used")
        self._scene = ctypes.c_void_p(scene)
        self.build_s = build_s.value

    def rays_per_second(self, rays: npt.NDArray[np.float64], *, query: str) -> tuple[float, int]:
        """Return rays/s and the number of hits of rays (n, 7), for `query` "closest" or "any"."""
        trace = getattr(self._peer, f"peer_{query}")
        trace.restype = ctypes.c_double
        hits = ctypes.c_size_t()
        elapsed = trace(
            self._scene,
            rays.ctypes.data_as(ctypes.c_void_p),
            ctypes.c_size_t(len(rays)),
            ctypes.byref(hits),
        )
        return len(rays) / elapsed, hits.value


def compile_peer(directory: Path) -> ctypes.CDLL:
    """Compile embree_peer.c into `directory` and load it."""
    library = directory / "embree_peer.so"
    source = Path(__file__).with_name("embree_peer.c")
    compiler = shutil.which("cc") or sys.exit("error: no C compiler 'cc' found")
    subprocess.run(
        [compiler, "-O3", "-march=native", "-shared", "-fPIC", source, "-o", library, "-ldl"],
        check=True,
    )
    return ctypes.CDLL(str(library))


def measure(
    name: str,
    mesh: tuple[npt.NDArray[np.float64], npt.NDArray[np.uint32]],
    options: argparse.Namespace,
    directory: Path,
) -> dict[str, Any]:
    """Compare all kernels and both of Embree's modes on one mesh, in path order and shuffled."""
    write_mesh(directory / "mesh", *mesh)
    recorded = directory / "rays"
    subprocess.run(
        [options.ray_kernel, "record", directory / "mesh", recorded, str(options.rays)], check=True
    )
    rays = np.fromfile(recorded, "<f8", offset=8).reshape(-1, 7)
    peer = compile_peer(directory)
    embree = {
        "robust": Embree(peer, *mesh, robust=True),
        "default": Embree(peer, *mesh, robust=False),
    }
    result: dict[str, Any] = {"mesh": name, "triangles": len(mesh[1]), "rays": len(rays)}
    result["embree_build_s"] = {mode: scene.build_s for mode, scene in embree.items()}
    for order in ("path", "shuffled"):
        if order == "shuffled":
            rays = np.random.default_rng(1).permutation(rays)
            count = np.array([len(rays)], "<u8").tobytes()
            recorded.write_bytes(count + rays.astype("<f8").tobytes())
        with subprocess.Popen(
            [options.ray_kernel, "trace", directory / "mesh", recorded, str(SLICE)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        ) as kernel:
            assert kernel.stdin is not None
            assert kernel.stdout is not None
            slices = np.array_split(rays, len(rays) // SLICE)
            assert all(len(part) == SLICE for part in slices)
            result[order] = alternate(
                kernel.stdin, kernel.stdout, embree, slices * options.rounds, result
            )
            kernel.stdin.close()
    return result


def alternate(
    ask: IO[str],
    answer: IO[str],
    embree: dict[str, Embree],
    slices: list[npt.NDArray[np.float64]],
    result: dict[str, Any],
) -> dict[str, Any]:
    """Let both sides trace in turn; return medians of rays/s and of the ratio to robust Embree."""
    table: dict[str, Any] = {}
    rates: dict[tuple[str, str], list[float]] = {}
    hits: dict[tuple[str, str], int] = {}
    for part in slices:
        own = json.loads(answer.readline())
        result |= {key: own[key] for key in ("build_s", "bytes_per_triangle")}
        for query in ("closest", "any"):
            numbers = {kernel: own["kernels"][kernel][query] for kernel in own["kernels"]}
            for mode, scene in embree.items():
                rate, hit = scene.rays_per_second(part, query=query)
                numbers[f"embree {mode}"] = {"rays_per_s": rate, "hits": hit}
            for kernel, number in numbers.items():
                rates.setdefault((query, kernel), []).append(number["rays_per_s"])
                hits[query, kernel] = hits.get((query, kernel), 0) + number["hits"]
        ask.write("\n")
        ask.flush()
    answer.readline()
    for (query, kernel), values in rates.items():
        peer = rates[query, "embree robust"]
        ratios = [value / other for value, other in zip(values, peer, strict=True)]
        table.setdefault(query, {})[kernel] = {
            "rays_per_s": round(statistics.median(values)),
            "ratio": round(statistics.median(ratios), 3),
            "hits": hits[query, kernel],
        }
    return table


def print_result(result: dict[str, Any]) -> None:
    """Print one mesh's comparison as a table."""
    print(
        f"{result['mesh']}: {result['triangles']} triangles, {result['rays']} rays; "
        f"build {result['build_s']:.2f} s (Embree {result['embree_build_s']['robust']:.2f} s), "
        f"{result['bytes_per_triangle']:.0f} bytes per triangle"
    )
    for order in ("path", "shuffled"):
        for query, kernels in result[order].items():
            for kernel, numbers in kernels.items():
                print(
                    f"  {order:9s} {query:8s} {kernel:15s} {numbers['rays_per_s'] / 1e6:7.3f} M/s "
                    f"{numbers['ratio']:6.3f} x  {numbers['hits']} hits"
                )


def main() -> None:
    """Run the comparison from the command line."""
    parser = argparse.ArgumentParser(description="The triangle kernel against Embree 4.")
    parser.add_argument("--triangles", type=int, nargs="*", default=[100_000, 1_000_000])
    parser.add_argument("--mesh", type=Path, nargs="*", default=[], help="mesh files, in mm")
    parser.add_argument("--rays", type=int, default=300_000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--output", type=Path, help="JSON file for the numbers")
    parser.add_argument(
        "--ray-kernel", default=REPOSITORY / "target/release/examples/ray_kernel", type=Path
    )
    options = parser.parse_args()
    if options.rays <= 0 or options.rays % SLICE:
        parser.error(f"--rays must be a multiple of {SLICE}")
    meshes = {f"pillow shell {count}": pillow_shell(count) for count in options.triangles}
    meshes |= {path.name: read_mesh(path) for path in options.mesh}
    results: list[dict[str, Any]] = []
    for name, mesh in meshes.items():
        with tempfile.TemporaryDirectory() as directory:
            results.append(measure(name, mesh, options, Path(directory)))
        print_result(results[-1])
    if options.output:
        options.output.write_text(json.dumps(results, indent=2) + "\n")


if __name__ == "__main__":
    main()

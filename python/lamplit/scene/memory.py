# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How much memory a picture will take, said before it is begun."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from lamplit.errors import LamplitError
from lamplit.scene.methods import physical_method
from lamplit.scene.models import Scene

#: What reading the largest mesh takes for a while: its topology, and its normals' repair.
_READING_BYTES_PER_TRIANGLE = 520
#: The tracer's triangles, vertices and boxes of its tree, and the building of it.
_TRACER_BYTES_PER_TRIANGLE = 100
#: A mesh as it is kept: float64 vertices, half as many as triangles, and 32-bit indices.
_MESH_BYTES_PER_TRIANGLE = 3 * 4
_MESH_BYTES_PER_VERTEX = 3 * 8
#: Sums of X, Y and Z and what their errors need, counts, and means and errors as handed back.
_FILM_BYTES_PER_PIXEL = 88 + 8 + 2 * 24
_BAND_BYTES_PER_PIXEL = 16
_LAYER_BYTES_PER_PIXEL = 88 + 2 * 24
#: A picture's spectra on twice its width and height, while glare is laid on it.
_GLARE_BYTES_PER_PIXEL = 210
#: Light that landed, twice while it is sorted, and its places: so much of it at most, and about so
#: much per pixel, of as many samples as share it.
_LANDED_BYTES = 2 * 256 + 24
_MOST_LANDED, _LANDED_PER_PIXEL = 2**18, 8 * 12
#: Spectral bands of a pixel, at most.
MOST_BANDS = 80
#: The interpreter with its libraries, and spectral tables.
_BASE_BYTES = 90 * 2**20


@dataclass(frozen=True)
class MemoryEstimate:
    """Bytes, by what they are for; ``triangles`` counts each placed mesh."""

    triangles: int
    meshes_bytes: int
    #: For a while, before the tracer and the film are there.
    reading_bytes: int
    tracer_bytes: int
    film_bytes: int
    base_bytes: int

    @property
    def total_bytes(self) -> int:
        """The most that is held at one time."""
        rendering = self.tracer_bytes + self.film_bytes
        return self.base_bytes + self.meshes_bytes + max(self.reading_bytes, rendering)


def memory_estimate(scene: Scene, *, bands: int = 0, layers: int = 0) -> MemoryEstimate:
    """Return the memory that rendering takes, with spectral ``bands`` and ``layers`` kept.

    It does not depend on the number of samples.

    Raises:
        LamplitError: A mesh cannot be read.
    """
    placed = [thing.mesh for thing in scene.objects_as_read if thing.mesh is not None]
    triangles = sum(len(mesh.triangles) for mesh in placed)
    own = {id(mesh): mesh for mesh in placed}.values()
    meshes = sum(
        _MESH_BYTES_PER_TRIANGLE * len(mesh.triangles)
        + _MESH_BYTES_PER_VERTEX * len(mesh.vertices_mm) * (1 if mesh.normals is None else 2)
        for mesh in own
    )
    pixels = scene.image.width * scene.image.height
    per_pixel = _FILM_BYTES_PER_PIXEL + _BAND_BYTES_PER_PIXEL * bands
    per_pixel += _LAYER_BYTES_PER_PIXEL * layers
    if _is_lit(scene):
        # A film each for the sharp and the soft part.
        per_pixel *= 2
    per_pixel += _GLARE_BYTES_PER_PIXEL if scene.display.glare else 0
    landed = min(_MOST_LANDED, _LANDED_PER_PIXEL * pixels) if _is_lit(scene) else 0
    return MemoryEstimate(
        triangles,
        meshes,
        _READING_BYTES_PER_TRIANGLE * max((len(mesh.triangles) for mesh in placed), default=0),
        _TRACER_BYTES_PER_TRIANGLE * triangles,
        pixels * per_pixel + _LANDED_BYTES * landed,
        _BASE_BYTES,
    )


def _is_lit(scene: Scene) -> bool:
    method = scene.image.method
    return (physical_method(scene) if method == "auto" else method) == "lit"


def check_memory(estimate: MemoryEstimate, most_bytes: float | None) -> None:
    """Refuse a picture that would not fit; None takes what the machine has to give now.

    Raises:
        LamplitError: It would take more.
    """
    limit = _available_bytes() if most_bytes is None else most_bytes
    if estimate.total_bytes > limit:
        raise LamplitError(
            f"this picture takes about {estimate.total_bytes / 2**30:.3g} GiB, and "
            f"{limit / 2**30:.3g} GiB may be used: make it smaller, keep fewer bands or layers, "
            "or raise --max-memory"
        )


def _available_bytes() -> float:
    """Return what can be had without swapping; no limit where the system does not say."""
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
    except OSError:
        return float("inf")
    found = [line.split() for line in lines if line.startswith("MemAvailable:")]
    return 1024.0 * float(found[0][1]) if found else float("inf")

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""How much memory a picture will take, said before it is begun."""

from __future__ import annotations

from dataclasses import dataclass

from lamplit.scene.models import Scene

#: The tracer's triangles, vertices and boxes of its tree: the bar that the kernel keeps.
_TRACER_BYTES_PER_TRIANGLE = 120
#: A mesh as it is read: float64 vertices, half as many as triangles, and 32-bit indices.
_MESH_BYTES_PER_TRIANGLE = 3 * 4
_MESH_BYTES_PER_VERTEX = 3 * 8
#: X, Y, Z and the sums of their squares in float64, once in the film and once handed back.
_FILM_BYTES_PER_PIXEL = 2 * 6 * 8
_BAND_BYTES_PER_PIXEL = 8
#: The interpreter with its libraries, and spectral tables.
_BASE_BYTES = 160 * 2**20


@dataclass(frozen=True)
class MemoryEstimate:
    """Bytes, by what they are for; ``triangles`` counts each placed mesh."""

    triangles: int
    meshes_bytes: int
    tracer_bytes: int
    film_bytes: int
    base_bytes: int

    @property
    def total_bytes(self) -> int:
        """Everything together."""
        return self.meshes_bytes + self.tracer_bytes + self.film_bytes + self.base_bytes


def memory_estimate(scene: Scene, *, bands: int = 0) -> MemoryEstimate:
    """Return the memory that rendering ``scene`` takes, with ``bands`` spectral channels kept.

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
    return MemoryEstimate(
        triangles,
        meshes,
        _TRACER_BYTES_PER_TRIANGLE * triangles,
        pixels * (_FILM_BYTES_PER_PIXEL + _BAND_BYTES_PER_PIXEL * bands),
        _BASE_BYTES,
    )

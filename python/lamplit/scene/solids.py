# SPDX-License-Identifier: Apache-2.0 OR MIT
"""`Body`: where an object is, which points lie inside it, and points on its surface."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lamplit.scene.meshes import Mesh
from lamplit.scene.meshes.probe import Probe
from lamplit.scene.models import Scene
from lamplit.scene.objects import Disc, MeshObject, Plane, Primitive, Sphere
from lamplit.scene.primitives import outline, signed_distances, surface_points, unit
from lamplit.scene.resolve import ResolvedObject

Array = NDArray[np.float64]


class Body(ABC):
    """An object in the scene's coordinates, in mm; ``solid`` says whether it has an inside."""

    solid: bool

    def __init__(self, thing: ResolvedObject) -> None:
        """Take the object where its transform puts it."""
        self.thing = thing
        self._matrix = thing.transform
        self._scale = float(np.cbrt(np.linalg.det(thing.transform[:3, :3])))

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """The corners of a box along the axes around the object."""
        points = self._world(self._outline())
        if len(points) == 0:
            return np.full(3, -np.inf), np.full(3, np.inf)
        return points.min(axis=0), points.max(axis=0)

    @property
    def ball(self) -> tuple[Array, float] | None:
        """The centre and radius of a sphere, None for everything else."""
        return None

    @property
    def plane(self) -> tuple[Array, Array] | None:
        """A point and the unit normal of a plane, None for everything else."""
        return None

    def contains(self, point: Array) -> bool:
        """Return whether ``point`` (3,) lies inside."""
        low, high = self.bounds
        in_box = self.solid and bool(((point > low) & (point < high)).all())
        return in_box and float(self.distances(point[None, :])[0]) < 0.0

    def distances(self, points: Array) -> Array:
        """Return for ``points`` (p, 3) a distance in mm to the surface, negative inside.

        The sign is right everywhere, the number close to the surface; farther away it may be too
        small. Of what is no solid, the sign means nothing.
        """
        local = (points - self._matrix[:3, 3]) @ self._matrix[:3, :3] / self._scale**2
        return self._scale * self._local_distances(local)

    def surface_points(self, low: Array, high: Array, count: int) -> Array:
        """Return up to ``count`` points of the surface within the box from ``low`` to ``high``."""
        points = self._world(self._local_points(4 * count))
        near = points[((points >= low) & (points <= high)).all(axis=1)]
        if len(near) <= count:
            return near
        return near[np.linspace(0, len(near) - 1, count).astype(np.int64)]

    def _world(self, points: Array) -> Array:
        return points @ self._matrix[:3, :3].T + self._matrix[:3, 3]

    @abstractmethod
    def _outline(self) -> Array: ...

    @abstractmethod
    def _local_points(self, count: int) -> Array: ...

    @abstractmethod
    def _local_distances(self, points: Array) -> Array: ...


class PrimitiveBody(Body):
    """A body by its equation."""

    def __init__(self, thing: ResolvedObject, shape: Primitive) -> None:
        """Take the shape where its transform puts it."""
        super().__init__(thing)
        self._shape = shape
        self.solid = not isinstance(shape, (Plane, Disc))

    @property
    def ball(self) -> tuple[Array, float] | None:
        """See `Body.ball`."""
        if not isinstance(self._shape, Sphere):
            return None
        return self._world(np.array(self._shape.centre_mm)), self._scale * self._shape.radius_mm

    @property
    def plane(self) -> tuple[Array, Array] | None:
        """See `Body.plane`."""
        if not isinstance(self._shape, Plane):
            return None
        normal = self._matrix[:3, :3] @ unit(self._shape.normal) / self._scale
        return self._world(np.array(self._shape.point_mm)), normal

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """See `Body.bounds`."""
        if self.ball is None:
            return super().bounds
        centre, radius = self.ball
        return centre - radius, centre + radius

    def _outline(self) -> Array:
        return outline(self._shape)

    def _local_points(self, count: int) -> Array:
        return surface_points(self._shape, count)

    def _local_distances(self, points: Array) -> Array:
        return signed_distances(self._shape, points)


class MeshBody(Body):
    """A body by its triangles."""

    def __init__(self, thing: ResolvedObject, mesh: Mesh) -> None:
        """Take the mesh where its object's transform puts it."""
        super().__init__(thing)
        self._mesh = mesh
        self.solid = mesh.closed

    @cached_property
    def _probe(self) -> Probe:
        return Probe(self._mesh.vertices_mm, self._mesh.triangles.astype(np.int64))

    def _outline(self) -> Array:
        return self._mesh.vertices_mm

    def _local_points(self, count: int) -> Array:
        """Return every vertex and every triangle's centre, whatever ``count`` says."""
        del count
        centres = self._mesh.vertices_mm[self._mesh.triangles].mean(axis=1)
        return np.concatenate([self._mesh.vertices_mm, centres])

    def _local_distances(self, points: Array) -> Array:
        return self._probe.distances(points)


def bodies(scene: Scene) -> tuple[Body, ...]:
    """Return the bodies of the scene's objects, in their order."""
    return tuple(_body(thing) for thing in scene.objects_as_read)


def _body(thing: ResolvedObject) -> Body:
    if thing.mesh is not None:
        return MeshBody(thing, thing.mesh)
    if isinstance(thing.shape, MeshObject):
        raise TypeError(f"{thing.name!r} is a mesh object without its mesh")
    return PrimitiveBody(thing, thing.shape)

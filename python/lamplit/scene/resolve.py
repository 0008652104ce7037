# SPDX-License-Identifier: Apache-2.0 OR MIT
"""From names to things: the objects of a scene with their materials, meshes and transforms."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamplit.errors import GeometryError, LamplitError, SceneError
from lamplit.files import resolve_inside
from lamplit.materials import Material
from lamplit.scene.emission import ResolvedEmission
from lamplit.scene.emitters import resolve_emission
from lamplit.scene.meshes import Mesh, load_mesh
from lamplit.scene.models import Scene
from lamplit.scene.objects import UNITS_MM, MeshObject, Object
from lamplit.scene.references import resolve_material


@dataclass(frozen=True, eq=False)
class ResolvedObject:
    """An object that is ready to be traced.

    ``shape`` holds the equation's numbers in mm; ``mesh`` is there for ``kind`` "mesh" alone;
    ``transform`` (4, 4) takes column vectors of both to the scene. ``notices`` say what was put
    right in the mesh. ``emission`` is there for what shines.
    """

    name: str
    kind: str
    material: Material
    material_name: str
    priority: int
    transform: NDArray[np.float64]
    shape: Object
    mesh: Mesh | None
    notices: tuple[str, ...]
    emission: ResolvedEmission | None

    @property
    def transparent(self) -> bool:
        """Whether light goes through the body, so that it must have an inside."""
        return self.material.kind == "dielectric"


def read_objects(scene: Scene) -> tuple[ResolvedObject, ...]:
    """Return the objects of ``scene``, sound or not; each mesh file is read once.

    Raises:
        GeometryError: A mesh cannot be read.
        SceneError: A file is missing, outside the scene's folder, or not what it is to be; or a
            name is unknown.
    """
    meshes: dict[tuple[object, ...], Mesh] = {}
    resolved: list[ResolvedObject] = []
    for at, shape in enumerate(scene.objects):
        mesh = None
        if isinstance(shape, MeshObject):
            key = (shape.file, shape.unit, shape.scale, shape.smooth, shape.crease_deg)
            mesh = meshes[key] = meshes.get(key) or _mesh(scene, shape, at)
        resolved.append(
            ResolvedObject(
                shape.name,
                shape.kind,
                resolve_material(scene, shape.material),
                shape.material,
                shape.priority,
                shape.transform.matrix(),
                shape,
                mesh,
                () if mesh is None else mesh.notices,
                resolve_emission(scene, shape, at),
            )
        )
    return tuple(resolved)


def _mesh(scene: Scene, shape: MeshObject, at: int) -> Mesh:
    path = resolve_inside(scene.root, shape.file, where=f"objects[{at}].file")
    try:
        return load_mesh(
            path,
            unit_mm=UNITS_MM[shape.unit] * shape.scale,
            smooth_shading=shape.smooth,
            crease_deg=shape.crease_deg,
            root=scene.root,
        )
    except GeometryError as fault:
        raise GeometryError(
            f"{shape.file}: {fault.message}", file=scene.path, where=f"objects[{at}].file"
        ) from fault


def solid_faults(scene: Scene) -> list[LamplitError]:
    """Return an error for each object that its material asks more of than its shape can give."""
    faults: list[LamplitError] = []
    for at, thing in enumerate(scene.objects_as_read):
        if not thing.transparent:
            continue
        where = f"objects[{at}]"
        if thing.kind in ("plane", "disc"):
            faults.append(
                SceneError(
                    f"{thing.name!r} is transparent, and a {thing.kind} has no inside; "
                    "use a box or a cylinder, or an opaque material",
                    file=scene.path,
                    where=where,
                )
            )
        elif thing.mesh is not None and not thing.mesh.closed:
            message = _open_mesh(thing.name, thing.mesh)
            faults.append(GeometryError(message, file=scene.path, where=where))
    return faults


def _open_mesh(name: str, mesh: Mesh) -> str:
    advice = "a transparent body must be closed: close the mesh, or give it an opaque material"
    if mesh.open_at_mm is None:
        return f"the mesh of {name!r} has no inside, as a Möbius strip has none; {advice}"
    x, y, z = mesh.open_at_mm
    return (
        f"the mesh of {name!r} is open: {mesh.open_edges} edges lack a triangle, "
        f"one at ({x:.4g}, {y:.4g}, {z:.4g}) mm; {advice}"
    )


def resolve_objects(scene: Scene) -> tuple[ResolvedObject, ...]:
    """See `Scene.resolved_objects`."""
    from lamplit.scene.shining import light_faults
    from lamplit.scene.spectra import spectral_faults
    from lamplit.scene.view import view_fault

    faults: list[LamplitError] = [
        *spectral_faults(scene),
        *solid_faults(scene),
        *light_faults(scene),
    ]
    if not faults and (fault := view_fault(scene)) is not None:
        faults.append(fault)
    if faults:
        raise faults[0]
    return scene.objects_as_read

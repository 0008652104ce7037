# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A scene as the compiled core takes it: numbered materials, bodies, lights, arrays."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from lamplit import _core
from lamplit.engine.carrier import Array, Carrier
from lamplit.engine.lighting import core_background, core_emission, radiance
from lamplit.engine.matter import core_matter
from lamplit.errors import SceneError
from lamplit.materials.models import (
    Conductor,
    Dielectric,
    Glossy,
    HallTerms,
    Material,
    Mirror,
)
from lamplit.scene import ResolvedObject, Scene
from lamplit.scene.camera import Camera
from lamplit.scene.fields import Vector
from lamplit.scene.lighting import DirectionalLight, PointLight, SphereLight
from lamplit.scene.objects import (
    Box,
    Cone,
    Cylinder,
    Disc,
    MeshObject,
    Object,
    Plane,
    Sphere,
    Tetrahedron,
)
from lamplit.scene.shining import light_groups
from lamplit.spectra_spec import FractionSpec


def assemble(scene: Scene, carrier: Carrier) -> _core.Scene:
    """Return ``scene`` ready to be traced, its spectra as ``carrier`` carries them.

    Raises:
        LamplitError: Something in the scene cannot be used.
    """
    return _Assembly(scene, carrier).build()


class _TakesCamera(Protocol):
    """What the core is told of a camera by."""

    def __call__(
        self,
        position_mm: Vector,
        target_mm: Vector,
        up: Vector,
        *,
        field_of_view_deg: float | None = None,
        height_mm: float | None = None,
        lens_mm: tuple[float, float] | None = None,
    ) -> None: ...


def aim(take: _TakesCamera, camera: Camera) -> None:
    """Tell the core of ``camera``: ``take`` is `set_camera` of a builder, or `look` of a scene."""
    view = (camera.position_mm, camera.target_mm, camera.up)
    match camera.kind:
        case "pinhole":
            take(*view, field_of_view_deg=camera.field_of_view_deg)
        case "thin-lens":
            lens = (camera.aperture_mm, camera.focus_distance_mm)
            take(*view, field_of_view_deg=camera.field_of_view_deg, lens_mm=lens)
        case "orthographic":
            take(*view, height_mm=camera.height_mm)


class _Assembly:
    def __init__(self, scene: Scene, carrier: Carrier) -> None:
        self._scene = scene
        self._carrier = carrier
        self._builder = _core.SceneBuilder(carrier.count)
        self._materials: dict[str, int] = {}
        self._groups = light_groups(scene)

    def build(self) -> _core.Scene:
        try:
            for thing in self._scene.resolved_objects():
                self._add_object(thing)
            aim(self._builder.set_camera, self._scene.camera)
            self._add_lights()
            surround = core_background(self._scene, self._carrier, self._groups)
            self._builder.set_background(surround)
            return self._builder.build(self._carrier.colour_matching(), self._groups)
        except SceneError as fault:
            if fault.file is None:
                raise SceneError(fault.message, file=self._scene.path, where=fault.where) from fault
            raise
        except ValueError as fault:
            raise SceneError(str(fault), file=self._scene.path) from fault

    def _add_object(self, thing: ResolvedObject) -> None:
        if thing.material_name not in self._materials:
            self._materials[thing.material_name] = self._add_material(thing.material)
        owner = (thing.name, self._materials[thing.material_name], thing.priority)
        if thing.mesh is None:
            kind, numbers = thing.shape.kind, _defining_numbers(thing.shape)
            body = self._builder.add_primitive(owner, kind, numbers, thing.transform.tolist())
            self._shine(body, thing)
            return
        mesh, matrix = thing.mesh, thing.transform
        vertices = mesh.vertices_mm @ matrix[:3, :3].T + matrix[:3, 3]
        normals = None
        if mesh.normals is not None:
            normals = np.ascontiguousarray(mesh.normals @ np.linalg.inv(matrix[:3, :3]))
        corners = np.ascontiguousarray(vertices)
        body = self._builder.add_mesh(owner, corners, mesh.triangles, normals)
        self._shine(body, thing)

    def _shine(self, body: int, thing: ResolvedObject) -> None:
        if thing.emission is not None:
            emission = core_emission(thing.emission, self._carrier, where=f"{thing.name}.emission")
            self._builder.add_emission(body, emission, self._groups.index(thing.emission.group))

    def _add_material(self, material: Material) -> int:
        matter, hall = core_matter(material, self._carrier), self._hall(material)
        if not isinstance(material, (Dielectric, Conductor, Mirror, Glossy)):
            return self._builder.add_material(matter, hall)
        texture = material.texture
        patch = None
        if texture is not None:
            patch = (texture.facing, float(np.cos(np.radians(texture.within_deg))))
        return self._builder.add_material(matter, hall, roughness=material.roughness, texture=patch)

    def _hall(self, material: Material) -> _core.HallTerms:
        terms: HallTerms = material.hall_terms()
        exponent = terms.highlight_exponent or material.default_highlight_exponent
        return _core.HallTerms(
            k_sr=terms.k_sr,
            k_st=terms.k_st,
            k_sa=terms.k_sa,
            highlight_exponent=exponent,
            f_sr=self._fraction(terms.specular_reflectance),
            f_st=self._fraction(terms.specular_transmittance),
            f_sa=self._fraction(terms.ambient_reflectance),
        )

    def _fraction(self, spec: FractionSpec | None) -> Array | None:
        return None if spec is None else self._carrier.reflectance(spec.distribution())

    def _add_lights(self) -> None:
        for at, light in enumerate(self._scene.lights):
            strength = radiance(self._scene, self._carrier, light, f"lights[{at}]")
            match light:
                case PointLight():
                    self._builder.add_point_light(strength, light.position_mm)
                case DirectionalLight():
                    self._builder.add_directional_light(strength, light.direction)
                case SphereLight():
                    self._builder.add_sphere_light(strength, light.centre_mm, light.radius_mm)
        if self._scene.ambient is not None:
            ambient = radiance(self._scene, self._carrier, self._scene.ambient, "ambient")
            self._builder.set_ambient(ambient)


def _defining_numbers(shape: Object) -> list[float]:
    """Return a primitive's points, then its lengths, in the order the core takes them."""
    match shape:
        case Sphere():
            return [*shape.centre_mm, shape.radius_mm]
        case Tetrahedron():
            return [number for point in shape.points_mm for number in point]
        case Box():
            return [*shape.min_mm, *shape.max_mm]
        case Plane():
            return [*shape.point_mm, *shape.normal]
        case Disc():
            return [*shape.centre_mm, *shape.normal, shape.radius_mm]
        case Cylinder() | Cone():
            return [*shape.base_mm, *shape.axis, shape.radius_mm, shape.height_mm]
        case MeshObject():
            raise TypeError("a mesh has no equation")

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A scene as the compiled core takes it: numbered materials, bodies, lights, arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamplit import _core
from lamplit.engine.carrier import Array, Carrier
from lamplit.errors import SceneError
from lamplit.materials.models import Dielectric, HallTerms, Material
from lamplit.materials.optics import LINE_D_NM
from lamplit.scene import ResolvedObject, Scene
from lamplit.scene.lighting import (
    ConstantBackground,
    DirectionalLight,
    GradientBackground,
    PointLight,
    Radiator,
    SoftBox,
    SphereLight,
    StudioBackground,
)
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
from lamplit.spectra_spec import FractionSpec


def assemble(scene: Scene, carrier: Carrier) -> _core.Scene:
    """Return ``scene`` ready to be traced, its spectra as ``carrier`` carries them.

    Raises:
        LamplitError: Something in the scene cannot be used.
    """
    return _Assembly(scene, carrier).build()


class _Assembly:
    def __init__(self, scene: Scene, carrier: Carrier) -> None:
        self._scene = scene
        self._carrier = carrier
        self._builder = _core.SceneBuilder(carrier.count)
        self._materials: dict[str, int] = {}

    def build(self) -> _core.Scene:
        try:
            for thing in self._scene.resolved_objects():
                self._add_object(thing)
            self._set_camera()
            self._add_lights()
            self._set_background()
            return self._builder.build(self._carrier.colour_matching(), ["background"])
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
            self._builder.add_primitive(owner, kind, numbers, thing.transform.tolist())
            return
        mesh, matrix = thing.mesh, thing.transform
        vertices = mesh.vertices_mm @ matrix[:3, :3].T + matrix[:3, 3]
        normals = None
        if mesh.normals is not None:
            normals = np.ascontiguousarray(mesh.normals @ np.linalg.inv(matrix[:3, :3]))
        self._builder.add_mesh(owner, np.ascontiguousarray(vertices), mesh.triangles, normals)

    def _add_material(self, material: Material) -> int:
        return self._builder.add_material(self._matter(material), self._hall(material))

    def _matter(self, material: Material) -> _core.Matter:
        carrier, matter = self._carrier, _core.Matter
        match material.kind:
            case "dielectric":
                absorption = carrier.absorption_per_mm(material.absorption_per_mm)
                index = carrier.index(material.index)
                return matter.dielectric(index, _index_d(material), absorption)
            case "conductor":
                n, k = carrier.metal(material.index), carrier.metal(material.extinction)
                return matter.conductor(n, k, material.factor)
            case "mirror":
                return matter.mirror(carrier.reflectance(material.reflectance_at))
            case "diffuse":
                return matter.diffuse(carrier.reflectance(material.reflectance_at))
            case "checker":
                first = carrier.reflectance(material.reflectance_a_at)
                second = carrier.reflectance(material.reflectance_b_at)
                return matter.checker(first, second, material.square_mm)
            case "glossy":
                index = carrier.index(material.index)
                return matter.glossy(index, carrier.reflectance(material.reflectance_at))

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

    def _radiance(self, radiator: Radiator, where: str) -> Array:
        spectrum = self._scene.resolve_source(radiator.source)
        return self._carrier.light(spectrum, radiator.luminance_cd_m2, where=f"{where}.source")

    def _set_camera(self) -> None:
        camera = self._scene.camera
        view = (camera.position_mm, camera.target_mm, camera.up)
        if camera.kind == "pinhole":
            self._builder.set_camera(*view, field_of_view_deg=camera.field_of_view_deg)
        else:
            self._builder.set_camera(*view, height_mm=camera.height_mm)

    def _add_lights(self) -> None:
        for at, light in enumerate(self._scene.lights):
            strength = self._radiance(light, f"lights[{at}]")
            match light:
                case PointLight():
                    self._builder.add_point_light(strength, light.position_mm)
                case DirectionalLight():
                    self._builder.add_directional_light(strength, light.direction)
                case SphereLight():
                    self._builder.add_sphere_light(strength, light.centre_mm, light.radius_mm)
        if self._scene.ambient is not None:
            self._builder.set_ambient(self._radiance(self._scene.ambient, "ambient"))

    def _set_background(self) -> None:
        background = self._scene.background
        base = background.base if isinstance(background, StudioBackground) else background
        surround = self._surround(base)
        if isinstance(background, StudioBackground):
            for at, soft_box in enumerate(background.soft_boxes):
                radiance = self._radiance(soft_box, f"background.soft_boxes[{at}]")
                half_width, half_height = _half_axes(soft_box)
                surround.add_soft_box(
                    radiance, soft_box.centre_mm, half_width, half_height, soft_box.edge_softness, 0
                )
        self._builder.set_background(surround)

    def _surround(self, base: ConstantBackground | GradientBackground) -> _core.Background:
        match base:
            case ConstantBackground():
                return _core.Background.constant(self._radiance(base, "background"), 0)
            case GradientBackground():
                zenith = self._radiance(base.zenith, "background.zenith")
                nadir = self._radiance(base.nadir, "background.nadir")
                return _core.Background.gradient(zenith, nadir, 0)


def _index_d(material: Dielectric) -> float:
    """Return the index that steers rays: n_d, or that of the nearest end of the data."""
    spectrum = material.refractive_index.index()
    low, high = spectrum.domain_nm
    return float(spectrum(np.array([np.clip(LINE_D_NM, low, high)]))[0])


def _half_axes(soft_box: SoftBox) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return half the width and half the height as vectors whose product points to the front."""
    normal = np.subtract(soft_box.facing_mm, soft_box.centre_mm)
    right = np.cross(soft_box.up, normal)
    right /= np.linalg.norm(right)
    upright = np.cross(normal, right)
    upright /= np.linalg.norm(upright)
    half_width: NDArray[np.float64] = right * (soft_box.width_mm / 2.0)
    half_height: NDArray[np.float64] = upright * (soft_box.height_mm / 2.0)
    return tuple(half_width.tolist()), tuple(half_height.tolist())


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

# SPDX-License-Identifier: Apache-2.0 OR MIT
"""A Lamplit scene as Mitsuba 3 reads it, for its ``*_spectral`` variants.

Written are ``scene.json``, the dictionary of `mitsuba.load_dict` as plain values, and one binary
PLY per mesh, with the vertex normals that Lamplit shades with. Spectra stand at every nm from 380
to 780 nm; light is nothing beyond, as in Lamplit's pictures. The unit of length is the mm.

What Mitsuba has no equal for is refused, not approximated: an index that depends on wavelength, a
graded background, soft edges, a moulded texture, lacquer, a rough coat, cylinders and cones.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lamplit.colour.observer import colour_matching_functions
from lamplit.colour.tristimulus import K_M
from lamplit.engine.carrier import SpectralCarrier
from lamplit.materials import Material
from lamplit.scene import ResolvedObject, Scene
from lamplit.scene.emission import ResolvedEmission
from lamplit.scene.lighting import ConstantBackground, Radiator, SoftBox, StudioBackground
from lamplit.scene.objects import Box, Disc, Plane, Sphere
from lamplit.spectrum import SpectralDistribution

Array = NDArray[np.float64]
Node = dict[str, Any]

#: Every nm of the picture, and the ends of what Mitsuba samples: n and k must be there too.
_NM = np.arange(380.0, 780.5)
_MITSUBA_RANGE_NM = (360.0, 830.0)
#: Mitsuba's film divides by the integral of its ȳ.
_MITSUBA_Y_INTEGRAL = 106.7502593994140625
#: Half the side of the square that stands for a plane without end, in mm.
_ENDLESS_MM = 1e5
_SMOOTH = 0.0
_LAMBERT = 1.0


class NotInMitsubaError(ValueError):
    """The scene holds something that Mitsuba cannot show as Lamplit does."""


def write_scene(
    scene: Scene, folder: Path, *, film: str = "xyz", integrator: Mapping[str, Any] | None = None
) -> float:
    """Write ``scene`` into ``folder`` and return the factor from film values to cd/m².

    ``film`` "xyz" is Mitsuba's colour film; "observer" has Lamplit's colour-matching functions at
    every nm as sensors. ``integrator`` replaces the choice between `path`, where no body absorbs
    or scatters, and `volpathmis`.

    Raises:
        NotInMitsubaError: The scene holds something without an equal in Mitsuba.
    """
    export = _Export(scene, folder)
    for at, thing in enumerate(scene.resolved_objects()):
        export.add_object(at, thing)
    export.add_background()
    world: Node = {"type": "scene", **export.nodes}
    world["integrator"] = {
        "type": "volpathmis" if export.has_media else "path",
        **(integrator or {}),
    }
    world["sensor"] = _sensor(scene, film)
    (folder / "scene.json").write_text(json.dumps(world), encoding="utf-8")
    return K_M * (_MITSUBA_Y_INTEGRAL if film == "xyz" else 1.0)


def _sensor(scene: Scene, film: str) -> Node:
    camera, image = scene.camera, scene.image
    if camera.kind != "pinhole":
        raise NotInMitsubaError(f"a {camera.kind} camera is not exported")
    if image.filter != "box":
        raise NotInMitsubaError('pictures are compared with image.filter = "box" on both sides')
    node: Node = {
        "width": image.width,
        "height": image.height,
        "component_format": "float32",
        "rfilter": {"type": "box"},
    }
    if film == "xyz":
        node |= {"type": "hdrfilm", "pixel_format": "xyz"}
    else:
        nm = np.arange(_MITSUBA_RANGE_NM[0], _MITSUBA_RANGE_NM[1] + 0.5)
        functions = colour_matching_functions(image.observer, nm)
        bands = zip("xyz", functions.T, strict=True)
        node |= {"type": "specfilm", **{name: _table(nm, band) for name, band in bands}}
    return {
        "type": "perspective",
        "fov": camera.field_of_view_deg,
        "fov_axis": "y",
        "near_clip": 1.0,
        "far_clip": 1e6,
        "to_world": _matrix(_look_at(camera.position_mm, camera.target_mm, camera.up)),
        "film": node,
        "sampler": {"type": "independent"},
    }


class _Export:
    def __init__(self, scene: Scene, folder: Path) -> None:
        self.nodes: Node = {}
        self.has_media = False
        self._scene = scene
        self._folder = folder
        self._carrier = SpectralCarrier(scene.image.wavelength_range_nm, scene.image.observer)

    def add_object(self, at: int, thing: ResolvedObject) -> None:
        """Add a body with its surface, and with its medium where it absorbs or scatters."""
        node = self._shape(at, thing)
        node["bsdf"] = _surface(thing.material)
        medium = _medium(thing.material)
        if medium is not None:
            node["interior"] = medium
            self.has_media = True
        if thing.emission is not None:
            node["emitter"] = {"type": "area", "radiance": self._emitted(thing.emission)}
        self.nodes[f"object-{at}"] = node

    def add_background(self) -> None:
        """Add the even surround and the soft boxes."""
        background = self._scene.background
        base = background.base if isinstance(background, StudioBackground) else background
        if not isinstance(base, ConstantBackground):
            raise NotInMitsubaError(f"a {base.kind} background has no equal in Mitsuba")
        if base.luminance_cd_m2 > 0.0:
            self.nodes["surround"] = {"type": "constant", "radiance": self._light(base)}
        if background.suns:
            raise NotInMitsubaError("suns are not exported")
        if isinstance(background, StudioBackground):
            for at, soft_box in enumerate(background.soft_boxes):
                self.nodes[f"soft-box-{at}"] = self._soft_box(soft_box)

    def _soft_box(self, soft_box: SoftBox) -> Node:
        """Return a rectangle that shines from its front and swallows what falls on it."""
        if soft_box.edge_softness != _SMOOTH:
            raise NotInMitsubaError("soft boxes need edge_softness = 0")
        normal = np.subtract(soft_box.facing_mm, soft_box.centre_mm)
        right = _unit(np.cross(soft_box.up, normal))
        upright = _unit(np.cross(normal, right))
        frame = np.eye(4)
        frame[:3, 0] = right * soft_box.width_mm / 2.0
        frame[:3, 1] = upright * soft_box.height_mm / 2.0
        frame[:3, 2] = _unit(normal)
        frame[:3, 3] = soft_box.centre_mm
        return {
            "type": "rectangle",
            "to_world": _matrix(frame),
            "bsdf": {"type": "diffuse", "reflectance": _even(0.0)},
            "emitter": {"type": "area", "radiance": self._light(soft_box)},
        }

    def _emitted(self, emission: ResolvedEmission) -> Node:
        if emission.photometry is not None or emission.cosine_exponent != _LAMBERT:
            raise NotInMitsubaError("Mitsuba's area lights follow Lambert's law")
        if emission.quantity == "spectral_radiance":
            return _table(_NM, emission.spectrum(_NM))
        if emission.quantity != "luminance_cd_m2":
            raise NotInMitsubaError("give an emission by its luminance_cd_m2")
        return self._scaled(emission.spectrum, emission.amount)

    def _light(self, radiator: Radiator) -> Node:
        return self._scaled(self._scene.resolve_source(radiator.source), radiator.luminance_cd_m2)

    def _scaled(self, spectrum: SpectralDistribution, luminance_cd_m2: float) -> Node:
        """Return spectral radiance in W·m⁻²·sr⁻¹·nm⁻¹, nothing outside of the picture's range."""
        shape = self._carrier.tristimulus(spectrum(self._carrier.wavelengths_nm))
        return _table(_NM, spectrum(_NM) * (luminance_cd_m2 / shape[1]))

    def _shape(self, at: int, thing: ResolvedObject) -> Node:
        shape = thing.shape
        if thing.mesh is not None:
            name = f"object-{at}.ply"
            _write_mesh(self._folder / name, thing)
            flat = thing.mesh.normals is None
            return {"type": "ply", "filename": {"file": name}, "face_normals": flat}
        match shape:
            case Sphere():
                local, kind = _placed(np.eye(3) * shape.radius_mm, shape.centre_mm), "sphere"
            case Box():
                low, high = np.array(shape.min_mm), np.array(shape.max_mm)
                local, kind = _placed(np.diag((high - low) / 2.0), (low + high) / 2.0), "cube"
            case Disc():
                frame = _frame(shape.normal) * shape.radius_mm
                local, kind = _placed(frame, shape.centre_mm), "disk"
            case Plane():
                frame = _frame(shape.normal) * _ENDLESS_MM
                local, kind = _placed(frame, shape.point_mm), "rectangle"
            case _:
                raise NotInMitsubaError(f"{thing.name!r}: a {shape.kind} is not exported")
        return {"type": kind, "to_world": _matrix(thing.transform @ local)}


def _surface(material: Material) -> Node:
    rough = _roughness(material)
    match material.kind:
        case "dielectric":
            ratio = {"int_ior": _constant_index(material.index(_NM)), "ext_ior": 1.0}
            return {"type": _name("dielectric", rough), **ratio, **rough}
        case "conductor":
            if material.lacquer is not None:
                raise NotInMitsubaError("a lacquered metal has no equal in Mitsuba")
            metal = {"eta": _held(material.index(_NM)), "k": _held(material.extinction(_NM))}
            share = {"specular_reflectance": _even(material.factor)}
            return _both_sides({"type": _name("conductor", rough), **metal, **share, **rough})
        case "mirror":
            share = {"specular_reflectance": _held(material.reflectance_at(_NM))}
            return _both_sides(
                {"type": _name("conductor", rough), "material": "none", **share, **rough}
            )
        case "diffuse":
            return _both_sides(
                {"type": "diffuse", "reflectance": _held(material.reflectance_at(_NM))}
            )
        case "glossy":
            if rough:
                raise NotInMitsubaError("Mitsuba's rough plastic is an approximation")
            coat = {"int_ior": _constant_index(material.index(_NM)), "ext_ior": 1.0}
            base = {"diffuse_reflectance": _held(material.reflectance_at(_NM)), "nonlinear": True}
            return _both_sides({"type": "plastic", **coat, **base})
        case _:
            raise NotInMitsubaError(f"matter of kind {material.kind!r} is not exported")


def _roughness(material: Material) -> Node:
    """Return what makes a surface of Mitsuba rough; nothing for a smooth one."""
    match material.kind:
        case "dielectric" | "conductor" | "mirror" | "glossy":
            if material.texture is not None:
                raise NotInMitsubaError("a moulded texture has no equal in Mitsuba")
            smooth = material.roughness == _SMOOTH
            return {} if smooth else {"distribution": "ggx", "alpha": material.roughness}
        case _:
            return {}


def _medium(material: Material) -> Node | None:
    if material.kind != "dielectric":
        return None
    absorption = material.absorption_per_mm(_NM)
    scattering, anisotropy = np.zeros_like(absorption), 0.0
    if material.scattering is not None:
        scattering = material.scattering.per_mm(_NM)
        anisotropy = material.scattering.anisotropy
    extinction = absorption + scattering
    if not extinction.any():
        return None
    share = np.divide(scattering, extinction, out=np.zeros_like(extinction), where=extinction > 0)
    return {
        "type": "homogeneous",
        "sigma_t": {"type": "constvolume", "value": _held(extinction)},
        "albedo": {"type": "constvolume", "value": _held(share)},
        "phase": {"type": "hg", "g": anisotropy},
    }


def _name(smooth: str, rough: Node) -> str:
    return f"rough{smooth}" if rough else smooth


def _both_sides(bsdf: Node) -> Node:
    return {"type": "twosided", "nested": bsdf}


def _constant_index(index: Array) -> float:
    if np.ptp(index) > 1e-9:
        raise NotInMitsubaError("Mitsuba has no dispersion: give the material a constant index")
    return float(index[0])


def _even(value: float) -> Node:
    return {"type": "uniform", "value": value}


def _held(values: Array) -> Node:
    """Return a spectrum on 380–780 nm whose end values go on to the ends of Mitsuba's range."""
    if np.ptp(values) == 0.0:
        return _even(float(values[0]))
    low, high = _MITSUBA_RANGE_NM
    nm = np.arange(low, high + 0.5)
    return _table(nm, np.interp(nm, _NM, values))


def _table(nm: Array, values: Array) -> Node:
    """Return a spectrum of straight lines between values at equal steps, zero outside."""
    written = ",".join(repr(float(value)) for value in values)
    ends = {"wavelength_min": float(nm[0]), "wavelength_max": float(nm[-1])}
    return {"type": "regular", **ends, "values": written}


def _matrix(values: Array) -> Node:
    return {"matrix": values.tolist()}


def _unit(vector: ArrayLike) -> Array:
    array = np.asarray(vector, dtype=np.float64)
    return array / np.linalg.norm(array)


def _placed(linear: Array, shift: ArrayLike) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    matrix[:3, 3] = shift
    return matrix


def _frame(normal: ArrayLike) -> Array:
    """Return a rotation whose third column is ``normal``."""
    third = _unit(normal)
    aside = np.eye(3)[int(np.argmin(np.abs(third)))]
    first = _unit(np.cross(aside, third))
    return np.stack([first, np.cross(third, first), third], axis=1)


def _look_at(origin: ArrayLike, target: ArrayLike, up: ArrayLike) -> Array:
    """Return a camera frame as Mitsuba means it: +z to the target, +x to the left."""
    forward = _unit(np.subtract(target, origin))
    left = _unit(np.cross(np.asarray(up, dtype=np.float64), forward))
    return _placed(np.stack([left, np.cross(forward, left), forward], axis=1), origin)


def _write_mesh(path: Path, thing: ResolvedObject) -> None:
    mesh, matrix = thing.mesh, thing.transform
    assert mesh is not None
    columns = [mesh.vertices_mm @ matrix[:3, :3].T + matrix[:3, 3]]
    names = ["x", "y", "z"]
    if mesh.normals is not None:
        turned = mesh.normals @ np.linalg.inv(matrix[:3, :3])
        columns.append(turned / np.linalg.norm(turned, axis=1, keepdims=True))
        names += ["nx", "ny", "nz"]
    vertices = np.concatenate(columns, axis=1).astype("<f4")
    faces = np.zeros(len(mesh.triangles), np.dtype([("count", "u1"), ("corners", "<i4", (3,))]))
    faces["count"], faces["corners"] = 3, mesh.triangles
    header = [
        "ply",
        "format binary_little_endian 1.0",
        f"element vertex {len(vertices)}",
        *(f"property float {name}" for name in names),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    with path.open("wb") as file:
        file.write(("\n".join(header) + "\n").encode())
        file.write(vertices.tobytes())
        file.write(faces.tobytes())

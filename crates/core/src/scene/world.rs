// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Scene`]: all that is traced, and the closest hit among it.

use super::body::{Body, BodyId};
use super::camera::Camera;
use super::contact::Contacts;
use super::emitters::Emitters;
use super::interior::Interior;
use crate::geometry::{Primitive, SurfacePoint, TriangleHit, Triangles};
use crate::light::{Background, Light};
use crate::math::{DVec3, Ray};
use crate::matter::{Dielectric, Material};
use crate::spectrum::{SampledSpectrum, SampledWavelengths, SpectralTable};

/// Where a ray meets the scene.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceHit {
    /// The place, with the surface's own normal.
    pub point: SurfacePoint,
    /// The normal that shading sees: interpolated on smooth meshes, else the surface's own.
    pub shading_normal: DVec3,
    /// Whose surface it is.
    pub body: BodyId,
    /// Whether a face of another body may be in the same place.
    pub(super) touches: bool,
}

/// The corners of every triangle, and the normals of all vertices (zero where a mesh is flat).
pub(super) type CornerNormals = (Vec<[u32; 3]>, Vec<[f32; 3]>);

/// All that is traced.
pub struct Scene {
    /// The materials that bodies name.
    pub materials: Vec<Material>,
    /// The bodies, in the order of the scene file.
    pub bodies: Vec<Body>,
    pub(super) primitives: Vec<(Primitive, BodyId)>,
    pub(super) triangles: Option<Triangles>,
    pub(super) triangle_bodies: Vec<BodyId>,
    pub(super) corner_normals: Option<CornerNormals>,
    pub(super) contacts: Contacts,
    /// The eye.
    pub camera: Camera,
    /// The lights that shade.
    pub lights: Vec<Light>,
    /// `I_a`(λ), the spectral radiance of a perfect reflector under the ambient light.
    pub ambient: SpectralTable,
    /// The bodies that shine.
    pub emitters: Emitters,
    /// What rays see that leave the scene.
    pub background: Background,
    /// How many light groups there are.
    pub groups: usize,
    /// The tables whose inner products with a spectral radiance are X, Y and Z in cd/m².
    pub colour_matching: [SpectralTable; 3],
    /// How much each lane matters to the eye: never nothing, and together 1 in each phase.
    pub visibility: SpectralTable,
}

impl Scene {
    /// How many samples visit every wavelength once.
    pub fn phases(&self) -> usize {
        self.ambient.phases()
    }

    /// The first surface that `ray` meets; of several in one place any of them.
    pub(super) fn closest_hit(&self, ray: &Ray) -> Option<SurfaceHit> {
        let mut nearest = *ray;
        let mut found = None;
        if let Some(hit) = self.triangles.as_ref().and_then(|set| set.closest_hit(ray)) {
            nearest.t_max = hit.t;
            found = Some(self.on_triangle(&hit));
        }
        let inverse = ray.direction.recip();
        for (at, (primitive, _)) in self.primitives.iter().enumerate() {
            if !primitive.may_be_met(ray.origin, inverse, nearest.t_max) {
                continue;
            }
            if let Some(point) = primitive.closest_hit(&nearest) {
                nearest.t_max = point.t;
                found = Some(self.on_primitive(at, point));
            }
        }
        found
    }

    /// All triangles, and of every primitive that touches others the first point, that `ray` meets.
    pub(super) fn hits_between(&self, ray: &Ray) -> Vec<SurfaceHit> {
        let mut triangles = Vec::new();
        if let Some(set) = &self.triangles {
            set.all_hits(ray, &mut triangles);
        }
        let mut found: Vec<SurfaceHit> =
            triangles.iter().map(|hit| self.on_triangle(hit)).collect();
        let touching = |at: &usize| self.contacts.has_primitive(*at);
        found.extend((0..self.primitives.len()).filter(touching).filter_map(|at| {
            let point = self.primitives[at].0.closest_hit(ray)?;
            Some(self.on_primitive(at, point))
        }));
        found
    }

    fn on_triangle(&self, hit: &TriangleHit) -> SurfaceHit {
        let shading_normal = self
            .smooth_normal(hit.triangle, hit.barycentric)
            .filter(|smooth| smooth.dot(hit.normal) > 0.0)
            .unwrap_or(hit.normal);
        SurfaceHit {
            point: SurfacePoint {
                t: hit.t,
                position: hit.position,
                normal: hit.normal,
                error: hit.error,
            },
            shading_normal,
            body: self.triangle_bodies[hit.triangle as usize],
            touches: self.contacts.has_triangle(hit.triangle),
        }
    }

    fn on_primitive(&self, at: usize, point: SurfacePoint) -> SurfaceHit {
        let (shading_normal, body) = (point.normal, self.primitives[at].1);
        SurfaceHit { point, shading_normal, body, touches: self.contacts.has_primitive(at) }
    }

    fn smooth_normal(&self, triangle: u32, [u, v]: [f64; 2]) -> Option<DVec3> {
        let (triangles, normals) = self.corner_normals.as_ref()?;
        let [a, b, c] = triangles[triangle as usize].map(|vertex| {
            let [x, y, z] = normals[vertex as usize];
            DVec3::new(f64::from(x), f64::from(y), f64::from(z))
        });
        (a * (1.0 - u - v) + b * u + c * v).try_normalize()
    }

    /// The material of a body.
    pub fn material_of(&self, body: BodyId) -> &Material {
        &self.materials[self.bodies[body as usize].material]
    }

    /// Whether there is transparent matter with a rough surface.
    pub fn has_rough_glass(&self) -> bool {
        let is_it = |own: &Material| own.dielectric().is_some() && own.finish.is_rough();
        self.materials.iter().any(is_it)
    }

    /// The share of the light that a surface, met from `interior`, sends back or on when it arrives
    /// against wi; 1 for a boundary of transparent media.
    pub fn albedo(
        &self,
        hit: &SurfaceHit,
        wi: DVec3,
        interior: &Interior,
        wavelengths: SampledWavelengths,
    ) -> SampledSpectrum {
        let material = self.material_of(hit.body);
        if material.dielectric().is_some() {
            return SampledSpectrum::ONE;
        }
        let around = self.medium(interior).map(|medium| medium.index.at(wavelengths));
        let index = around.unwrap_or(SampledSpectrum::ONE);
        let bsdf = material.bsdf(hit.point.position, hit.point.normal, index, wavelengths);
        let cos_i = hit.shading_normal.dot(wi).abs();
        let local = DVec3::new((1.0 - cos_i * cos_i).max(0.0).sqrt(), 0.0, cos_i);
        bsdf.albedo(local) + bsdf.mirror(cos_i).unwrap_or(SampledSpectrum::ZERO)
    }

    /// The transparent matter at a place: `None` is air.
    pub fn medium(&self, interior: &Interior) -> Option<&Dielectric> {
        interior.filling(&self.bodies).and_then(|body| self.material_of(body).dielectric())
    }

    /// X, Y and Z of a spectral radiance, in cd/m²: eq. (1).
    pub fn tristimulus(
        &self,
        radiance: SampledSpectrum,
        wavelengths: SampledWavelengths,
    ) -> [f64; 3] {
        [0, 1, 2].map(|i| self.colour_matching[i].at(wavelengths).dot(radiance))
    }

    /// The transparent bodies that hold `point`, or the name of an opaque one that does.
    ///
    /// Looks along one direction: a body is round the point when its first surface on the way is
    /// met from inside.
    ///
    /// # Errors
    /// The point is inside the opaque body of the returned number.
    pub fn bodies_round(&self, point: DVec3) -> Result<Interior, BodyId> {
        // A direction without symmetry, so that it passes no edge of an axis-aligned model.
        let direction = DVec3::new(0.268_431, 0.713_907, 0.646_731).normalize();
        let mut ray = Ray::endless(point, direction);
        if let Some(body) = self.opaque_round(&ray) {
            return Err(body);
        }
        let mut seen: Vec<BodyId> = Vec::new();
        let mut interior = Interior::OUTSIDE;
        while let Some(place) = self.first_place(&ray) {
            ray.origin = place.hit.point.leave_along(direction);
            for face in place.faces() {
                if seen.contains(&face.body) {
                    continue;
                }
                seen.push(face.body);
                let is_transparent = self.material_of(face.body).dielectric().is_some();
                if !face.is_entered && is_transparent {
                    interior = interior.cross(face.body, true).unwrap_or(interior);
                }
            }
        }
        Ok(interior)
    }

    /// The opaque body that the ray starts in: one of those that enclose a volume. An opaque mesh may
    /// be a sheet, and counts as one.
    pub fn opaque_round(&self, ray: &Ray) -> Option<BodyId> {
        let leaves = |primitive: &Primitive| {
            let met = primitive.closest_hit(ray);
            met.is_some_and(|point| point.normal.dot(ray.direction) > 0.0)
        };
        let mut closed = self.primitives.iter().filter(|(primitive, body)| {
            primitive.is_closed() && self.material_of(*body).dielectric().is_none()
        });
        closed.find(|(primitive, _)| leaves(primitive)).map(|(_, body)| *body)
    }

    /// The box round all bodies but endless planes; `None` without any.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let meshes = self.triangles.as_ref().and_then(Triangles::bounds);
        let primitives = self.primitives.iter().filter_map(|(primitive, _)| primitive.bounds());
        let all = meshes.into_iter().chain(primitives.map(|(lo, hi)| [lo, hi]));
        all.reduce(|[lo, hi], [from, to]| [lo.min(from), hi.max(to)])
    }

    /// The memory that the triangles and their BVH hold, in bytes.
    pub fn memory_bytes(&self) -> usize {
        let normals = self
            .corner_normals
            .as_ref()
            .map_or(0, |(triangles, normals)| 12 * (triangles.len() + normals.len()));
        self.triangles.as_ref().map_or(0, Triangles::memory_bytes)
            + 4 * self.triangle_bodies.len()
            + self.contacts.memory_bytes()
            + normals
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Scene`]: all that is traced, and the closest hit among it.

use thiserror::Error;

use super::body::{Body, BodyId};
use super::camera::Camera;
use super::interior::Interior;
use crate::geometry::{Primitive, SurfacePoint, Triangles, TrianglesError};
use crate::light::{Background, Light};
use crate::math::{DVec3, Ray};
use crate::matter::{Dielectric, Material};
use crate::spectrum::{SampledSpectrum, SampledWavelengths, SpectralTable};

/// Why a scene cannot be built.
#[derive(Debug, Error)]
pub enum SceneError {
    /// A mesh cannot be used.
    #[error("mesh: {0}")]
    Triangles(#[from] TrianglesError),
    /// A number of something that the scene does not have.
    #[error("body {body:?} names material {material}, and the scene has {count}")]
    NoMaterial {
        /// The body's name.
        body: String,
        /// What it asked for.
        material: usize,
        /// How many there are.
        count: usize,
    },
    /// The normals of a mesh are not as many as its vertices.
    #[error("body {body:?} has {normals} normals for {vertices} vertices")]
    Normals {
        /// The body's name.
        body: String,
        /// How many normals.
        normals: usize,
        /// How many vertices.
        vertices: usize,
    },
}

/// Where a ray meets the scene.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceHit {
    /// The place, with the surface's own normal.
    pub point: SurfacePoint,
    /// The normal that shading sees: interpolated on smooth meshes, else the surface's own.
    pub shading_normal: DVec3,
    /// Whose surface it is.
    pub body: BodyId,
}

/// The corners of every triangle, and the normals of all vertices (zero where a mesh is flat).
type CornerNormals = (Vec<[u32; 3]>, Vec<[f32; 3]>);

/// A scene under construction.
#[derive(Default)]
pub struct SceneBuilder {
    materials: Vec<Material>,
    bodies: Vec<Body>,
    primitives: Vec<(Primitive, BodyId)>,
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    triangle_bodies: Vec<BodyId>,
    /// One normal per vertex; zero where the mesh is flat.
    normals: Vec<[f32; 3]>,
}

impl SceneBuilder {
    /// Add a material and return its number.
    pub fn add_material(&mut self, material: Material) -> usize {
        self.materials.push(material);
        self.materials.len() - 1
    }

    fn add_body(&mut self, body: Body) -> Result<BodyId, SceneError> {
        if body.material >= self.materials.len() {
            let (material, count) = (body.material, self.materials.len());
            return Err(SceneError::NoMaterial { body: body.name, material, count });
        }
        self.bodies.push(body);
        Ok(self.bodies.len() as BodyId - 1)
    }

    /// Add a body bounded by a primitive.
    ///
    /// # Errors
    /// The body's material does not exist.
    pub fn add_primitive(&mut self, body: Body, primitive: Primitive) -> Result<(), SceneError> {
        let id = self.add_body(body)?;
        self.primitives.push((primitive, id));
        Ok(())
    }

    /// Add a body bounded by triangles; `normals`, one per vertex, make it smooth.
    ///
    /// # Errors
    /// The body's material does not exist, or there are not as many normals as vertices.
    pub fn add_mesh(
        &mut self,
        body: Body,
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        normals: Option<&[[f64; 3]]>,
    ) -> Result<(), SceneError> {
        if let Some(normals) = normals.filter(|normals| normals.len() != vertices.len()) {
            let (normals, vertices) = (normals.len(), vertices.len());
            return Err(SceneError::Normals { body: body.name, normals, vertices });
        }
        let id = self.add_body(body)?;
        let first = self.vertices.len() as u32;
        self.vertices.extend_from_slice(vertices);
        self.triangles.extend(triangles.iter().map(|t| t.map(|v| v.saturating_add(first))));
        self.triangle_bodies.resize(self.triangles.len(), id);
        let smooth = normals.unwrap_or_default().iter().map(|n| n.map(|c| c as f32));
        self.normals.extend(smooth);
        self.normals.resize(self.vertices.len(), [0.0; 3]);
        Ok(())
    }

    /// Build what rays need. `colour_matching` are the three tables whose inner products with a
    /// path's spectral radiance are X, Y and Z, in cd/m².
    ///
    /// # Errors
    /// A mesh cannot be used.
    pub fn build(
        self,
        camera: Camera,
        lights: Vec<Light>,
        ambient: SpectralTable,
        background: Background,
        colour_matching: [SpectralTable; 3],
    ) -> Result<Scene, SceneError> {
        let is_smooth = self.normals.iter().any(|n| *n != [0.0; 3]);
        let triangles = if self.triangles.is_empty() {
            None
        } else {
            Some(Triangles::build(&self.vertices, &self.triangles)?)
        };
        Ok(Scene {
            materials: self.materials,
            bodies: self.bodies,
            primitives: self.primitives,
            triangles,
            triangle_bodies: self.triangle_bodies,
            corner_normals: is_smooth.then_some((self.triangles, self.normals)),
            camera,
            lights,
            ambient,
            background,
            colour_matching,
        })
    }
}

/// All that is traced.
pub struct Scene {
    /// The materials that bodies name.
    pub materials: Vec<Material>,
    /// The bodies, in the order of the scene file.
    pub bodies: Vec<Body>,
    primitives: Vec<(Primitive, BodyId)>,
    triangles: Option<Triangles>,
    triangle_bodies: Vec<BodyId>,
    corner_normals: Option<CornerNormals>,
    /// The eye.
    pub camera: Camera,
    /// The lights that shade.
    pub lights: Vec<Light>,
    /// `I_a`(λ), the spectral radiance of a perfect reflector under the ambient light.
    pub ambient: SpectralTable,
    /// What rays see that leave the scene.
    pub background: Background,
    /// The tables whose inner products with a spectral radiance are X, Y and Z in cd/m².
    pub colour_matching: [SpectralTable; 3],
}

impl Scene {
    /// How many samples visit every wavelength once.
    pub fn phases(&self) -> usize {
        self.ambient.phases()
    }

    /// The first surface that `ray` meets.
    pub fn closest_hit(&self, ray: &Ray) -> Option<SurfaceHit> {
        let mut nearest = *ray;
        let mut found = None;
        if let Some(hit) = self.triangles.as_ref().and_then(|set| set.closest_hit(ray)) {
            nearest.t_max = hit.t;
            let body = self.triangle_bodies[hit.triangle as usize];
            let point = SurfacePoint {
                t: hit.t,
                position: hit.position,
                normal: hit.normal,
                error: hit.error,
            };
            let shading_normal = self
                .smooth_normal(hit.triangle, hit.barycentric)
                .filter(|smooth| smooth.dot(hit.normal) > 0.0)
                .unwrap_or(hit.normal);
            found = Some(SurfaceHit { point, shading_normal, body });
        }
        for (primitive, body) in &self.primitives {
            if let Some(point) = primitive.closest_hit(&nearest) {
                nearest.t_max = point.t;
                found = Some(SurfaceHit { point, shading_normal: point.normal, body: *body });
            }
        }
        found
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
        let mut seen: Vec<BodyId> = Vec::new();
        let mut interior = Interior::OUTSIDE;
        // A direction without symmetry, so that it passes no edge of an axis-aligned model.
        let direction = DVec3::new(0.268_431, 0.713_907, 0.646_731).normalize();
        let mut ray = Ray::endless(point, direction);
        while let Some(hit) = self.closest_hit(&ray) {
            ray.origin = hit.point.leave_along(direction);
            if seen.contains(&hit.body) {
                continue;
            }
            seen.push(hit.body);
            let from_inside = hit.point.normal.dot(direction) > 0.0;
            let is_transparent = self.material_of(hit.body).dielectric().is_some();
            if from_inside && is_transparent {
                interior = interior.cross(hit.body, true).unwrap_or(interior);
            } else if from_inside && self.is_closed(hit.body) {
                return Err(hit.body);
            }
        }
        Ok(interior)
    }

    /// Whether a body encloses a volume; an opaque mesh may be a sheet, and counts as one.
    fn is_closed(&self, body: BodyId) -> bool {
        self.primitives.iter().any(|(primitive, id)| *id == body && primitive.is_closed())
    }

    /// The memory that the triangles and their BVH hold, in bytes.
    pub fn memory_bytes(&self) -> usize {
        let normals = self
            .corner_normals
            .as_ref()
            .map_or(0, |(triangles, normals)| 12 * (triangles.len() + normals.len()));
        self.triangles.as_ref().map_or(0, Triangles::memory_bytes)
            + 4 * self.triangle_bodies.len()
            + normals
    }
}

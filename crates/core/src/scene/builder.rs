// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`SceneBuilder`]: a scene under construction.

use thiserror::Error;

use super::body::{Body, BodyId};
use super::camera::Camera;
use super::contact::Contacts;
use super::emission::Emission;
use super::emitters::Emitters;
use super::world::Scene;
use crate::geometry::{Primitive, SampledSurface, Triangles, TrianglesError};
use crate::light::{Background, Emitter, IntensityError, Light};
use crate::math::DVec3;
use crate::matter::Material;
use crate::spectrum::{SampledSpectrum, SpectralTable, LANES};

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
    /// A body that shines has no surface to shine from, or an endless one.
    #[error("body {body:?} shines, and has no finite area to shine from")]
    NoArea {
        /// The body's name.
        body: String,
    },
    /// A body cannot shine as a table says.
    #[error("body {body:?}: {fault}")]
    Intensity {
        /// The body's name.
        body: String,
        /// Why.
        fault: IntensityError,
    },
}

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
    emissions: Vec<(BodyId, Emission)>,
    /// How many light groups there are.
    pub groups: usize,
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

    /// Add a body bounded by a primitive, and return its number.
    ///
    /// # Errors
    /// The body's material does not exist.
    pub fn add_primitive(
        &mut self,
        body: Body,
        primitive: Primitive,
    ) -> Result<BodyId, SceneError> {
        let id = self.add_body(body)?;
        self.primitives.push((primitive, id));
        Ok(id)
    }

    /// Add a body bounded by triangles, and return its number; `normals`, one per vertex, make it
    /// smooth.
    ///
    /// # Errors
    /// The body's material does not exist, or there are not as many normals as vertices.
    pub fn add_mesh(
        &mut self,
        body: Body,
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        normals: Option<&[[f64; 3]]>,
    ) -> Result<BodyId, SceneError> {
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
        Ok(id)
    }

    /// Let a body shine, which no other call has made shine.
    pub fn shine(&mut self, body: BodyId, emission: Emission) {
        self.emissions.push((body, emission));
    }

    /// Build what rays need. `colour_matching` are the three tables whose inner products with a
    /// path's spectral radiance are X, Y and Z, in cd/m².
    ///
    /// # Errors
    /// A mesh cannot be used, or a body cannot shine as it should.
    pub fn build(
        mut self,
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
        let contacts = Contacts::find(
            triangles.as_ref(),
            &self.triangle_bodies,
            &self.mesh_boxes(),
            &self.primitives,
            |body| {
                let material = self.bodies[body as usize].material;
                self.materials[material].dielectric().is_some()
            },
        );
        let emitters = self.emitters(triangles.as_ref())?;
        Ok(Scene {
            contacts,
            materials: self.materials,
            bodies: self.bodies,
            primitives: self.primitives,
            triangles,
            triangle_bodies: self.triangle_bodies,
            corner_normals: is_smooth.then_some((self.triangles, self.normals)),
            camera,
            lights,
            ambient,
            emitters: Emitters::new(emitters, &colour_matching[1]),
            background,
            groups: self.groups,
            visibility: visibility(&colour_matching),
            colour_matching,
        })
    }

    /// The bodies that shine, with their surfaces.
    fn emitters(
        &mut self,
        triangles: Option<&Triangles>,
    ) -> Result<Vec<(Emitter, SampledSurface)>, SceneError> {
        let emissions = std::mem::take(&mut self.emissions);
        let on_body = |(body, emission): (BodyId, Emission)| {
            let name = || self.bodies[body as usize].name.clone();
            let surface =
                self.surface(body, triangles).ok_or_else(|| SceneError::NoArea { body: name() })?;
            let emitter = emission.on(body, &surface);
            let fault = |fault| SceneError::Intensity { body: name(), fault };
            Ok((emitter.map_err(fault)?, surface))
        };
        emissions.into_iter().map(on_body).collect()
    }

    /// The surface of a body as rays see it; `None` without a finite area.
    fn surface(&self, body: BodyId, triangles: Option<&Triangles>) -> Option<SampledSurface> {
        if let Some((primitive, _)) = self.primitives.iter().find(|(_, id)| *id == body) {
            return SampledSurface::primitive(primitive);
        }
        let traced = triangles?;
        let mut error = 0.0_f64;
        let mut corner = |vertex: u32| {
            let (position, bound) = traced.as_traced(self.vertices[vertex as usize]);
            error = error.max(bound);
            position
        };
        // Bodies are numbered as they come, so the triangles of each lie together.
        let first = self.triangle_bodies.partition_point(|id| *id < body);
        let end = self.triangle_bodies.partition_point(|id| *id <= body);
        let own = &self.triangles[first..end];
        let corners = own.iter().map(|triangle| triangle.map(&mut corner)).collect();
        SampledSurface::triangles(corners, error)
    }

    /// The boxes of the bodies that have triangles.
    fn mesh_boxes(&self) -> Vec<(BodyId, [DVec3; 2])> {
        let mut boxes: Vec<(BodyId, [DVec3; 2])> = Vec::new();
        for (corners, &body) in self.triangles.iter().zip(&self.triangle_bodies) {
            if boxes.last().is_none_or(|(last, _)| *last != body) {
                boxes.push((body, [DVec3::INFINITY, DVec3::NEG_INFINITY]));
            }
            if let Some((_, [lo, hi])) = boxes.last_mut() {
                for &vertex in corners {
                    let point = DVec3::from_array(self.vertices[vertex as usize]);
                    (*lo, *hi) = (lo.min(point), hi.max(point));
                }
            }
        }
        boxes
    }
}

/// How much each lane matters to the eye: X + Y + Z of the lane, and a hundredth of their mean so
/// that no lane is nothing; together 1 in each phase.
fn visibility(colour_matching: &[SpectralTable; 3]) -> SpectralTable {
    SpectralTable::combine(colour_matching, |[x, y, z]| {
        let seen = x + y + z;
        let sum = seen.dot(SampledSpectrum::ONE).max(f64::MIN_POSITIVE);
        let least = 0.01 * sum / LANES as f64;
        seen.map(|value| (value + least) / (1.01 * sum))
    })
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`SceneBuilder`]: a scene under construction.

use thiserror::Error;

use super::body::{Body, BodyId};
use super::camera::Camera;
use super::contact::Contacts;
use super::world::Scene;
use crate::geometry::{Primitive, Triangles, TrianglesError};
use crate::light::{Background, Emitters, Light};
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
        let contacts = Contacts::find(
            triangles.as_ref(),
            &self.triangle_bodies,
            &self.mesh_boxes(),
            &self.primitives,
        );
        let emitter_numbers = vec![None; self.bodies.len()];
        let groups = 1;
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
            background,
            emitters: Emitters::default(),
            emitter_numbers,
            groups,
            visibility: visibility(&colour_matching),
            colour_matching,
        })
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

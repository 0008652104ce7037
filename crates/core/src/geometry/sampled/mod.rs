// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`SampledSurface`]: a body's surface, to choose points on it.

mod ellipsoid;
mod mesh;
mod pieces;

use self::ellipsoid::Ellipsoid;
use self::mesh::Mesh;
use self::pieces::Pieces;
use super::primitive::{Patch, Primitive};
use crate::math::DVec3;

/// A point chosen on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceSample {
    /// The point, in mm.
    pub position: DVec3,
    /// The surface's own outward unit normal there.
    pub normal: DVec3,
    /// The density with which it was chosen, per mm².
    pub pdf: f64,
}

/// A point chosen on a surface, as seen from a place that its front faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceDirection {
    /// The point, in mm.
    pub position: DVec3,
    /// The surface's own outward unit normal there.
    pub normal: DVec3,
    /// The unit vector from the place to the point.
    pub direction: DVec3,
    /// How far it is, in mm.
    pub distance: f64,
    /// The density with which the direction was chosen, per sr at the place.
    pub pdf: f64,
    /// How far, in mm, the point may be from where the intersection routines see the surface: moved
    /// by as much along its normal, it is before the surface.
    pub error: f64,
}

/// A body's surface, to choose points on it by area, or directions in which its front is seen.
///
/// Triangles and other flat pieces are uniform by area, among primitives' only by those that face the
/// place that looks. Spheres, stretched ones too, are uniform by the solid angle of the visible
/// cone. The sides of cylinders and cones are uniform by area before they are stretched.
#[derive(Clone, Debug)]
pub struct SampledSurface {
    form: Form,
    error: f64,
}

#[derive(Clone, Debug)]
enum Form {
    Mesh(Mesh),
    Pieces(Pieces),
    Ellipsoid(Box<Ellipsoid>),
}

impl SampledSurface {
    /// The surface made of triangles, whose corners are counter-clockwise seen from outside. `error`
    /// is [`SurfaceDirection::error`]. `None` without area.
    pub fn triangles(corners: Vec<[DVec3; 3]>, error: f64) -> Option<Self> {
        Some(Self { form: Form::Mesh(Mesh::new(corners)?), error })
    }

    /// The surface of a primitive; `None` for an endless plane.
    pub fn primitive(primitive: &Primitive) -> Option<Self> {
        let (patches, to_world) = (primitive.patches()?, primitive.placement());
        let form = match patches.as_slice() {
            [Patch::Sphere { centre, radius }] => {
                Form::Ellipsoid(Box::new(Ellipsoid::new(*centre, *radius, to_world)))
            }
            _ => Form::Pieces(Pieces::new(&patches, to_world)?),
        };
        Some(Self { form, error: primitive.largest_error() })
    }

    /// How far, in mm, its points may be from where the intersection routines see the surface.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Its area, in mm².
    pub fn area(&self) -> f64 {
        match &self.form {
            Form::Mesh(mesh) => mesh.area(),
            Form::Pieces(pieces) => pieces.area(),
            Form::Ellipsoid(ellipsoid) => ellipsoid.area(),
        }
    }

    /// Vectors n·dA in mm², outward, whose sums stand for integrals over the surface's orientations:
    /// exact for flat faces, else to 1e-3 or better.
    pub fn area_vectors(&self) -> Vec<DVec3> {
        match &self.form {
            Form::Mesh(mesh) => mesh.area_vectors(),
            Form::Pieces(pieces) => pieces.area_vectors(),
            Form::Ellipsoid(ellipsoid) => ellipsoid.area_vectors(),
        }
    }

    /// A point of the surface, for `u` uniform in the unit cube.
    pub fn sample(&self, u: [f64; 3]) -> SurfaceSample {
        match &self.form {
            Form::Mesh(mesh) => mesh.sample(u),
            Form::Pieces(pieces) => pieces.sample(u),
            Form::Ellipsoid(ellipsoid) => ellipsoid.sample(u),
        }
    }

    /// A point whose front is seen from `from`, were there nothing in between, for `u` uniform in
    /// the unit cube; `None` where the point that was chosen faces away.
    pub fn sample_from(&self, from: DVec3, u: [f64; 3]) -> Option<SurfaceDirection> {
        let chosen = match &self.form {
            Form::Mesh(mesh) => mesh.sample(u),
            Form::Pieces(pieces) => pieces.sample_from(from, u)?,
            Form::Ellipsoid(ellipsoid) => return ellipsoid.sample_from(from, u, self.error),
        };
        let way = chosen.position - from;
        let distance = way.length();
        let direction = way / distance;
        let cos = -chosen.normal.dot(direction);
        // A NaN, of a point in the place itself, is no direction either.
        (cos > 0.0).then(|| SurfaceDirection {
            position: chosen.position,
            normal: chosen.normal,
            direction,
            distance,
            pdf: chosen.pdf * distance * distance / cos,
            error: self.error,
        })
    }

    /// The density, per sr, with which [`sample_from`](Self::sample_from) chooses the unit
    /// `direction` from `from` to the point `position` of the surface with the unit `normal`.
    pub fn pdf_from(&self, from: DVec3, position: DVec3, normal: DVec3, direction: DVec3) -> f64 {
        let cos = -normal.dot(direction);
        if cos <= 0.0 {
            return 0.0;
        }
        let per_mm2 = match &self.form {
            Form::Mesh(mesh) => 1.0 / mesh.area(),
            Form::Pieces(pieces) => pieces.density_from(from, normal),
            Form::Ellipsoid(ellipsoid) => return ellipsoid.density_from(from, direction),
        };
        per_mm2 * position.distance_squared(from) / cos
    }
}

#[cfg(test)]
mod tests;

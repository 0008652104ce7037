// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Contacts`]: which surfaces may share a place with another body's.

use super::body::BodyId;
use crate::geometry::{overlap, Primitive, Triangles};
use crate::math::{gamma, largest_component, DVec3};

/// Which triangles and primitives may share a place with a face of another body, one of both
/// transparent: of two opaque ones either ends the ray. A ray that meets one of them asks for the
/// others; all others are spared the question.
#[derive(Default)]
pub(super) struct Contacts {
    /// One per triangle, or empty where none touches.
    triangles: Vec<bool>,
    primitives: Vec<bool>,
    /// Faces no farther apart than this, in mm, are in one place: as far as rounding takes two
    /// descriptions of the same face.
    pub(super) reach: f64,
}

impl Contacts {
    /// Find them, by boxes, and between triangles by planes as well. `mesh_boxes` are the boxes of
    /// the bodies that have triangles, and `is_transparent` is asked of bodies.
    pub(super) fn find(
        triangles: Option<&Triangles>,
        triangle_bodies: &[BodyId],
        mesh_boxes: &[(BodyId, [DVec3; 2])],
        primitives: &[(Primitive, BodyId)],
        is_transparent: impl Fn(BodyId) -> bool + Sync,
    ) -> Self {
        let reach = reach(triangles, mesh_boxes, primitives);
        let matters = |a: BodyId, b: BodyId| a != b && (is_transparent(a) || is_transparent(b));
        let mut touched = triangles
            .map(|set| set.touching(triangle_bodies, reach, candidates(mesh_boxes, reach), matters))
            .unwrap_or_default();
        let mut touching_primitives = Vec::with_capacity(primitives.len());
        for (at, (primitive, body)) in primitives.iter().enumerate() {
            let mut close = triangles
                .map(|set| set.in_boxes(|triangle| primitive.may_touch(triangle, reach)))
                .unwrap_or_default();
            close.retain(|triangle| matters(*body, triangle_bodies[*triangle as usize]));
            let touches = |(other_at, (other, other_body)): (usize, &(Primitive, BodyId))| {
                at != other_at && matters(*body, *other_body) && may_touch(primitive, other, reach)
            };
            let touches_primitive = primitives.iter().enumerate().any(touches);
            touching_primitives.push(touches_primitive || !close.is_empty());
            touched.extend(close);
        }
        let mut flags = Vec::new();
        if !touched.is_empty() {
            flags.resize(triangle_bodies.len(), false);
            for triangle in touched {
                flags[triangle as usize] = true;
            }
        }
        Self { triangles: flags, primitives: touching_primitives, reach }
    }

    pub(super) fn has_triangle(&self, triangle: u32) -> bool {
        self.triangles.get(triangle as usize).copied().unwrap_or(false)
    }

    pub(super) fn has_primitive(&self, at: usize) -> bool {
        self.primitives.get(at).copied().unwrap_or(false)
    }

    pub(super) fn memory_bytes(&self) -> usize {
        self.triangles.len() + self.primitives.len()
    }
}

/// The rounding of triangles to single precision, and the error bounds of two points of primitives
/// (`Primitive::position_error`: 8 γ₁₆ of up to four times the largest coordinate, each).
fn reach(
    triangles: Option<&Triangles>,
    mesh_boxes: &[(BodyId, [DVec3; 2])],
    primitives: &[(Primitive, BodyId)],
) -> f64 {
    let solids = primitives.iter().filter_map(|(primitive, _)| primitive.bounds());
    let boxes = mesh_boxes.iter().map(|(_, [lo, hi])| (*lo, *hi)).chain(solids);
    let size =
        boxes.map(|(lo, hi)| largest_component(lo).max(largest_component(hi))).fold(0.0, f64::max);
    triangles.map_or(0.0, Triangles::rounding) + 64.0 * gamma(16) * size
}

/// Whether a triangle of a body, given by its box, is in the box of another body with triangles.
fn candidates(
    mesh_boxes: &[(BodyId, [DVec3; 2])],
    reach: f64,
) -> impl Fn(BodyId, [DVec3; 2]) -> bool + Sync + '_ {
    // Both the box and the triangle may be off by the rounding of their vertices.
    let grown = move |[lo, hi]: [DVec3; 2]| {
        [lo - DVec3::splat(2.0 * reach), hi + DVec3::splat(2.0 * reach)]
    };
    move |body, triangle| {
        mesh_boxes.iter().any(|(other, bounds)| *other != body && overlap(grown(*bounds), triangle))
    }
}

fn may_touch(a: &Primitive, b: &Primitive, reach: f64) -> bool {
    let of = |a: &Primitive, b: &Primitive| b.bounds().map(|(lo, hi)| a.may_touch([lo, hi], reach));
    // Two endless planes bound no matter that a ray could cross.
    let both = [of(a, b), of(b, a)];
    both.iter().any(Option::is_some) && both.into_iter().flatten().all(|touches| touches)
}

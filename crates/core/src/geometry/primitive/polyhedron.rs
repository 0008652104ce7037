// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Convex polyhedra with up to six faces: the triangular pyramid and the box.

use super::{positive, Crossing, Patch, PrimitiveError};
use crate::math::{orthonormal_pair, DMat3, DVec3};

/// The points x with nᵢ·x ≤ dᵢ for every face i.
#[derive(Clone, Debug)]
pub struct ConvexPolyhedron {
    faces: Vec<(DVec3, f64)>,
    centre: DVec3,
    radius: f64,
}

impl ConvexPolyhedron {
    /// The triangular pyramid with the four corners `points`, in any order.
    ///
    /// # Errors
    /// The points lie in one plane.
    pub fn tetrahedron(points: [DVec3; 4]) -> Result<Self, PrimitiveError> {
        let centre = points.iter().sum::<DVec3>() / 4.0;
        let radius = points.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
        let face = |a: DVec3, b: DVec3, c: DVec3, opposite: DVec3| {
            let normal = (b - a).cross(c - a).try_normalize()?;
            let height = normal.dot(a - opposite);
            let outward = normal * height.signum();
            (height.abs() > 1e-9 * radius).then(|| (outward, outward.dot(a)))
        };
        let [a, b, c, d] = points;
        let faces = [face(a, b, c, d), face(a, b, d, c), face(a, c, d, b), face(b, c, d, a)];
        let faces: Option<Vec<_>> = faces.into_iter().collect();
        Ok(Self { faces: faces.ok_or(PrimitiveError::Flat)?, centre, radius })
    }

    /// The box between the corners `low` and `high`.
    ///
    /// # Errors
    /// It has no extent along some axis.
    pub fn cuboid(low: DVec3, high: DVec3) -> Result<Self, PrimitiveError> {
        for extent in (high - low).to_array() {
            positive("each side of a box (max - min)", extent)?;
        }
        let faces = DVec3::AXES
            .into_iter()
            .flat_map(|axis| [(axis, axis.dot(high)), (-axis, -axis.dot(low))])
            .collect();
        Ok(Self { faces, centre: (low + high) / 2.0, radius: (high - low).length() / 2.0 })
    }

    /// Where a line enters and leaves: the last half-space entered and the first left.
    pub(super) fn crossings(&self, origin: DVec3, direction: DVec3) -> Option<[Crossing; 2]> {
        let mut enter = Crossing { t: f64::NEG_INFINITY, normal: DVec3::ZERO };
        let mut leave = Crossing { t: f64::INFINITY, normal: DVec3::ZERO };
        for &(normal, offset) in &self.faces {
            let along = normal.dot(direction);
            let depth = offset - normal.dot(origin);
            let t = depth / along;
            if along == 0.0 {
                if depth < 0.0 {
                    return None;
                }
            } else if along < 0.0 && t > enter.t {
                enter = Crossing { t, normal };
            } else if along > 0.0 && t < leave.t {
                leave = Crossing { t, normal };
            }
        }
        (enter.t < leave.t).then_some([enter, leave])
    }

    pub(super) fn patches(&self) -> Vec<Patch> {
        (0..self.faces.len()).map(|at| Patch::Polygon(self.corners(at))).collect()
    }

    /// The corners of a face: where its plane meets those of two others, and no half-space cuts that
    /// point off.
    fn corners(&self, face: usize) -> Vec<DVec3> {
        let tolerance = 1e-9 * self.radius;
        let (normal, offset) = self.faces[face];
        let mut corners: Vec<DVec3> = Vec::new();
        for (i, (second, second_offset)) in self.faces.iter().enumerate() {
            for (third, third_offset) in &self.faces[..i] {
                let planes = DMat3::from_cols(normal, *second, *third).transpose();
                let point = planes.inverse() * DVec3::new(offset, *second_offset, *third_offset);
                let is_inside = |(n, d): &(DVec3, f64)| n.dot(point) <= d + tolerance;
                if point.is_finite()
                    && self.faces.iter().all(is_inside)
                    && corners.iter().all(|known| known.distance(point) > tolerance)
                {
                    corners.push(point);
                }
            }
        }
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let (x, y) = orthonormal_pair(normal);
        let angle = |p: &DVec3| (*p - middle).dot(y).atan2((*p - middle).dot(x));
        corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        corners
    }

    pub(super) fn bounding_sphere(&self) -> (DVec3, f64) {
        (self.centre, self.radius)
    }
}

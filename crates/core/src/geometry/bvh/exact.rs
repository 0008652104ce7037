// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Does the ray cross this triangle, and where? Decided in double precision.

use glam::DVec3;

use super::Probe;

/// A point of a triangle on a ray.
pub(super) struct Point {
    /// Distance from the origin of the probe.
    pub t: f64,
    /// Weights of the corners: their sum is not one.
    pub weights: [f64; 3],
}

/// The point where the probe crosses the triangle, for t > 0; both sides of the triangle count.
/// The corners' coordinates are in the order of the probe's axes.
///
/// *Inside or outside* is Woop, Benthin and Wald's test (Watertight Ray/Triangle Intersection, JCGT
/// 2(1), 2013). A corner is sheared to the same two coordinates whichever triangle it belongs to,
/// and an edge function compares two rounded products, so its sign is never wrong: at worst it is
/// zero, and zero counts as inside. Two triangles that share an edge leave no gap. (A fused
/// multiply-add would break this: only one product would be rounded.)
///
/// *Where* is the ray against the triangle's plane, t = n·a / n·d with a corner a seen from the
/// origin, kept between the corners' own distances, so that an almost edge-on triangle is hit on
/// itself. The sign of n·a says on which side the origin lies. If n·a is smaller than its rounding
/// error the origin is on the triangle, and there is no hit. That error: each component of n = e₁ ×
/// e₂ is off by at most 4u(|e₁ᵢe₂ⱼ| + |e₁ⱼe₂ᵢ|) =: 4u mₖ (edges, products, difference; u = 2⁻⁵³),
/// and the dot product adds at most 4u |nₖ||aₖ| per term: 8u Σ mₖ|aₖ| in all.
#[inline(always)]
pub(super) fn cross(probe: &Probe, corners: &[DVec3; 3]) -> Option<Point> {
    let seen = corners[0] - probe.origin;
    let a = shear(seen, probe.shear);
    let b = shear(corners[1] - probe.origin, probe.shear);
    let c = shear(corners[2] - probe.origin, probe.shear);
    let weights = [c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x];
    let negative = weights[0] < 0.0 || weights[1] < 0.0 || weights[2] < 0.0;
    let positive = weights[0] > 0.0 || weights[1] > 0.0 || weights[2] > 0.0;
    if negative == positive {
        return None;
    }

    let (e1, e2) = (corners[1] - corners[0], corners[2] - corners[0]);
    let normal = e1.cross(e2);
    let height = normal.dot(seen);
    let magnitude = DVec3::new(
        (e1.y * e2.z).abs() + (e1.z * e2.y).abs(),
        (e1.z * e2.x).abs() + (e1.x * e2.z).abs(),
        (e1.x * e2.y).abs() + (e1.y * e2.x).abs(),
    );
    if height.abs() <= 4.0 * f64::EPSILON * magnitude.dot(seen.abs()) {
        return None;
    }
    let nearest = a.z.min(b.z).min(c.z);
    let farthest = a.z.max(b.z).max(c.z);
    let t = (height / normal.dot(probe.direction)).max(nearest).min(farthest);
    (t > 0.0).then_some(Point { t, weights })
}

/// Turns the ray into the z axis, with z the distance t at which the ray is level with the point.
#[inline(always)]
fn shear(point: DVec3, shear: DVec3) -> DVec3 {
    DVec3::new(point.x - shear.x * point.z, point.y - shear.y * point.z, shear.z * point.z)
}

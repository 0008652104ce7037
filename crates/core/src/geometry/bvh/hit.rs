// SPDX-License-Identifier: Apache-2.0 OR MIT
//! What is known of the point where a ray meets a triangle.

use glam::DVec3;

use super::probe::Frame;

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance along the ray.
    pub t: f64,
    /// Index of the triangle in the list that was given to
    /// [`Triangles::build`](crate::geometry::Triangles::build).
    pub triangle: u32,
    /// Weights u of the second and v of the third corner; that of the first is 1 − u − v.
    pub barycentric: [f64; 2],
    /// The point on the triangle.
    pub position: DVec3,
    /// Unit normal of the triangle, (p₁ − p₀) × (p₂ − p₀) in the order of its corners, whichever
    /// side is hit. A triangle without area faces the ray.
    pub normal: DVec3,
    /// A ray that goes on from here must start this far from `position` along the normal, on its
    /// side.
    pub error: f64,
}

impl TriangleHit {
    /// Completes a hit from the corners relative to the centre, and their weights, which need not sum
    /// to one.
    #[inline(always)]
    pub(super) fn new(
        (t, triangle): (f64, u32),
        direction: DVec3,
        [a, b, c]: [DVec3; 3],
        weights: [f64; 3],
        frame: &Frame,
    ) -> Self {
        let scale = 1.0 / (weights[0] + weights[1] + weights[2]);
        let (u, v) = (weights[1] * scale, weights[2] * scale);
        let (ab, ac) = (b - a, c - a);
        let position = frame.centre + (a + (u * ab + v * ac));
        Self {
            t,
            triangle,
            barycentric: [u, v],
            position,
            normal: ab.cross(ac).try_normalize().unwrap_or(-direction),
            error: position_error(position, frame.half_extent),
        }
    }
}

/// How far a ray that starts at `position` must be moved along the normal to be on its side of the
/// triangle.
///
/// Let u = 2⁻⁵³, V the largest coordinate relative to the centre, P the largest of the position.
/// The point a + (u(b − a) + v(c − a)) lies in the triangle's plane whatever the rounding of u and
/// v; its own roundings add up to 6uV per coordinate. Then come the addition of the centre (uP),
/// the move itself (uP), and the subtraction of the centre (uV) before the next test: 7uV + 2uP per
/// coordinate, √3 times that as a distance. Twice the sum, rounded up, is 32uV + 8uP. The rounding
/// within the next test is dealt with there: a ray that starts on a triangle, as far as the test
/// can tell, does not cross it.
#[inline(always)]
pub(super) fn position_error(position: DVec3, half_extent: DVec3) -> f64 {
    f64::EPSILON * (16.0 * half_extent.max_element() + 4.0 * position.abs().max_element())
}

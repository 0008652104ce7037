// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`SurfacePoint`]: where a ray ends on a surface.

use crate::math::DVec3;

/// A point on a surface, with what the next ray needs to leave it on the right side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Distance from the ray's origin, in mm.
    pub t: f64,
    /// The point itself, in mm.
    pub position: DVec3,
    /// The surface's own unit normal: outward for a closed body.
    pub normal: DVec3,
    /// How far, in mm, the point may be from where the intersection routines see the surface.
    pub error: f64,
}

impl SurfacePoint {
    /// The origin of a ray that leaves along `direction`: the point moved to that side of the
    /// surface by its own error bound, so that the surface is not met again.
    pub fn leave_along(&self, direction: DVec3) -> DVec3 {
        self.position + self.normal * self.error.copysign(self.normal.dot(direction))
    }
}

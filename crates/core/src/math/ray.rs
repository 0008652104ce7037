// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Ray`]: a walk's next segment.

use super::DVec3;

/// A ray: all points `origin + t·direction` with 0 < t < `t_max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts, in mm.
    pub origin: DVec3,
    /// Where it goes: a unit vector.
    pub direction: DVec3,
    /// Where it ends, in mm along `direction`; infinite for a ray that goes on.
    pub t_max: f64,
}

impl Ray {
    /// A ray without end.
    pub fn endless(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, direction, t_max: f64::INFINITY }
    }

    /// The point at `t` mm.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}

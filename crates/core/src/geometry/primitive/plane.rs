// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The plane and the disc: open surfaces, which only opaque matter may cover.

use super::{positive, unit, Crossing, Patch, PrimitiveError};
use crate::math::DVec3;

/// An endless plane through a point.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
}

impl Plane {
    /// The plane through `point` at right angles to `normal`.
    ///
    /// # Errors
    /// The normal has no length.
    pub fn new(point: DVec3, normal: DVec3) -> Result<Self, PrimitiveError> {
        Ok(Self { point, normal: unit("the normal of a plane", normal)? })
    }

    pub(super) fn crossing(&self, origin: DVec3, direction: DVec3) -> Option<Crossing> {
        let along = self.normal.dot(direction);
        (along != 0.0).then(|| Crossing {
            t: self.normal.dot(self.point - origin) / along,
            normal: self.normal,
        })
    }
}

/// A flat disc.
#[derive(Clone, Copy, Debug)]
pub struct Disc {
    pub(super) plane: Plane,
    radius: f64,
}

impl Disc {
    /// The disc of `radius` mm round `centre`, at right angles to `normal`.
    ///
    /// # Errors
    /// The normal has no length, or the radius is not positive.
    pub fn new(centre: DVec3, normal: DVec3, radius: f64) -> Result<Self, PrimitiveError> {
        let radius = positive("the radius of a disc", radius)?;
        Ok(Self { plane: Plane::new(centre, normal)?, radius })
    }

    pub(super) fn crossing(&self, origin: DVec3, direction: DVec3) -> Option<Crossing> {
        let crossing = self.plane.crossing(origin, direction)?;
        let from_centre = origin + direction * crossing.t - self.plane.point;
        (from_centre.length_squared() <= self.radius * self.radius).then_some(crossing)
    }

    pub(super) fn patches(&self) -> Vec<Patch> {
        let Plane { point: centre, normal } = self.plane;
        vec![Patch::Disc { centre, normal, radius: self.radius }]
    }

    pub(super) fn bounding_sphere(&self) -> (DVec3, f64) {
        (self.plane.point, self.radius)
    }
}

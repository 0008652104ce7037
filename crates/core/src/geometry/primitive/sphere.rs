// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The sphere.

use super::{positive, Crossing, Patch, PrimitiveError};
use crate::math::DVec3;

/// All points at distance r from a centre.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    centre: DVec3,
    radius: f64,
}

impl Sphere {
    /// The sphere of radius `radius` mm round `centre`.
    ///
    /// # Errors
    /// The radius is not positive.
    pub fn new(centre: DVec3, radius: f64) -> Result<Self, PrimitiveError> {
        Ok(Self { centre, radius: positive("the radius of a sphere", radius)? })
    }

    /// Where a line through `origin` enters and leaves.
    ///
    /// The half chord comes from the distance q of the centre to the line, h = √(r² − q²), which
    /// keeps its digits where the usual discriminant b² − c loses them.
    pub(super) fn crossings(&self, origin: DVec3, direction: DVec3) -> Option<[Crossing; 2]> {
        let length = direction.length();
        let unit = direction / length;
        let to_centre = self.centre - origin;
        let middle = to_centre.dot(unit);
        let q = to_centre - unit * middle;
        let h_squared = (self.radius - q.length()) * (self.radius + q.length());
        if h_squared <= 0.0 {
            return None;
        }
        let h = h_squared.sqrt();
        Some([middle - h, middle + h].map(|distance| Crossing {
            t: distance / length,
            normal: origin + unit * distance - self.centre,
        }))
    }

    pub(super) fn project(&self, point: DVec3) -> DVec3 {
        let from_centre = point - self.centre;
        self.centre + from_centre * (self.radius / from_centre.length())
    }

    pub(super) fn patches(&self) -> Vec<Patch> {
        vec![Patch::Sphere { centre: self.centre, radius: self.radius }]
    }

    pub(super) fn bounding_sphere(&self) -> (DVec3, f64) {
        (self.centre, self.radius)
    }
}

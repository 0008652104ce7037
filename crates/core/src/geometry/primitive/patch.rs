// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Patch`]: the pieces of a shape's surface, for sampling it by area.

use crate::math::DVec3;

/// A piece of a shape's surface, in the shape's own frame.
#[derive(Clone, Debug)]
pub(in crate::geometry) enum Patch {
    /// All points at `radius` from `centre`.
    Sphere {
        /// The centre.
        centre: DVec3,
        /// The radius.
        radius: f64,
    },
    /// A convex flat face; its corners run counter-clockwise seen from outside.
    Polygon(Vec<DVec3>),
    /// A flat round face.
    Disc {
        /// The centre.
        centre: DVec3,
        /// The outward unit normal.
        normal: DVec3,
        /// The radius.
        radius: f64,
    },
    /// The side of a cylinder, cone or cut cone.
    Mantle(Mantle),
}

/// The side of a cylinder, cone or cut cone.
#[derive(Clone, Copy, Debug)]
pub(in crate::geometry) struct Mantle {
    /// The middle of the lower rim.
    pub base: DVec3,
    /// The unit direction from there to the upper rim.
    pub axis: DVec3,
    /// The radii of the lower and the upper rim.
    pub radii: [f64; 2],
    /// The distance of the rims along the axis.
    pub height: f64,
}

impl Mantle {
    /// The length of a straight line on it from rim to rim.
    pub fn slant(&self) -> f64 {
        self.height.hypot(self.radii[0] - self.radii[1])
    }

    /// The point at a share `along` of the way from the lower rim to the upper, out along the unit
    /// vector `radial`.
    pub fn point(&self, along: f64, radial: DVec3) -> DVec3 {
        let radius = self.radii[0] + (self.radii[1] - self.radii[0]) * along;
        self.base + self.axis * (self.height * along) + radial * radius
    }

    /// The outward unit normal where the unit vector `radial` points out from the axis.
    pub fn normal(&self, radial: DVec3) -> DVec3 {
        let slant = self.slant();
        radial * (self.height / slant) + self.axis * ((self.radii[0] - self.radii[1]) / slant)
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Patch`]: the pieces of a shape's surface, for sampling it by area.

use crate::math::{DAffine3, DVec3};

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

impl Patch {
    /// Its box, lower and upper corner, after `to_world`.
    pub fn bounds(&self, to_world: &DAffine3) -> [DVec3; 2] {
        match self {
            Self::Sphere { centre, radius } => round(to_world, *centre, *radius, DVec3::ZERO),
            Self::Polygon(corners) => corners
                .iter()
                .map(|corner| [to_world.transform_point3(*corner); 2])
                .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], join),
            Self::Disc { centre, normal, radius } => round(to_world, *centre, *radius, *normal),
            Self::Mantle(mantle) => {
                let upper = mantle.base + mantle.axis * mantle.height;
                let rim = |centre, radius| round(to_world, centre, radius, mantle.axis);
                join(rim(mantle.base, mantle.radii[0]), rim(upper, mantle.radii[1]))
            }
        }
    }
}

/// The box round two boxes.
pub(super) fn join([a_lo, a_hi]: [DVec3; 2], [b_lo, b_hi]: [DVec3; 2]) -> [DVec3; 2] {
    [a_lo.min(b_lo), a_hi.max(b_hi)]
}

/// The box of what lies round `centre` within `radius`, at right angles to the unit `normal`, or of
/// the ball where that is zero.
fn round(to_world: &DAffine3, centre: DVec3, radius: f64, normal: DVec3) -> [DVec3; 2] {
    let middle = to_world.transform_point3(centre);
    let half = [0, 1, 2].map(|axis| {
        let row = to_world.matrix3.row(axis);
        radius * (row.length_squared() - row.dot(normal).powi(2)).max(0.0).sqrt()
    });
    let half = DVec3::from_array(half);
    [middle - half, middle + half]
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

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The capped cylinder.

use super::{positive, roots, unit, Crossing, Mantle, Patch, PrimitiveError};
use crate::math::DVec3;

/// The points within a radius of an axis, between two caps.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    base: DVec3,
    axis: DVec3,
    radius: f64,
    height: f64,
}

impl Cylinder {
    /// The cylinder of `radius` and `height` mm that stands on `base` along `axis`.
    ///
    /// # Errors
    /// A length is not positive, or the axis has none.
    pub fn new(base: DVec3, axis: DVec3, radius: f64, height: f64) -> Result<Self, PrimitiveError> {
        Ok(Self {
            base,
            axis: unit("the axis of a cylinder", axis)?,
            radius: positive("the radius of a cylinder", radius)?,
            height: positive("the height of a cylinder", height)?,
        })
    }

    /// The interval inside the endless cylinder, cut by the interval between the caps.
    pub(super) fn crossings(&self, origin: DVec3, direction: DVec3) -> Option<[Crossing; 2]> {
        let from_base = origin - self.base;
        let (z, dz) = (from_base.dot(self.axis), direction.dot(self.axis));
        let across = from_base - self.axis * z;
        let d_across = direction - self.axis * dz;
        let side = |t: f64| Crossing { t, normal: across + d_across * t };
        let everywhere = [f64::NEG_INFINITY, f64::INFINITY].map(side);
        let c = (across.length() - self.radius) * (across.length() + self.radius);
        let wall = if d_across == DVec3::ZERO {
            (c < 0.0).then_some(everywhere)?
        } else {
            roots(d_across.length_squared(), across.dot(d_across), c)?.map(side)
        };
        let caps = slab(z, dz, self.height, self.axis)?;
        let enter = if caps[0].t > wall[0].t { caps[0] } else { wall[0] };
        let leave = if caps[1].t < wall[1].t { caps[1] } else { wall[1] };
        (enter.t < leave.t).then_some([enter, leave])
    }

    pub(super) fn patches(&self) -> Vec<Patch> {
        let Self { base, axis, radius, height } = *self;
        vec![
            Patch::Mantle(Mantle { base, axis, radii: [radius, radius], height }),
            Patch::Disc { centre: base, normal: -axis, radius },
            Patch::Disc { centre: base + axis * height, normal: axis, radius },
        ]
    }

    pub(super) fn bounding_sphere(&self) -> (DVec3, f64) {
        (self.base + self.axis * (self.height / 2.0), self.radius.hypot(self.height / 2.0))
    }
}

/// Where a line with height `z` + t·`dz` is between 0 and `height`.
pub(super) fn slab(z: f64, dz: f64, height: f64, axis: DVec3) -> Option<[Crossing; 2]> {
    let at = |level: f64, normal: DVec3| Crossing { t: (level - z) / dz, normal };
    if dz > 0.0 {
        Some([at(0.0, -axis), at(height, axis)])
    } else if dz < 0.0 {
        Some([at(height, axis), at(0.0, -axis)])
    } else if (0.0..=height).contains(&z) {
        let endless = |t: f64| Crossing { t, normal: axis };
        Some([endless(f64::NEG_INFINITY), endless(f64::INFINITY)])
    } else {
        None
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The capped cone.

use super::cylinder::slab;
use super::{positive, roots, unit, Crossing, Mantle, Patch, PrimitiveError};
use crate::math::DVec3;

/// The points inside a cone, from its base to its apex.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    base: DVec3,
    axis: DVec3,
    radius: f64,
    height: f64,
}

impl Cone {
    /// The cone that stands on a disc of `radius` mm round `base`, its apex `height` mm along
    /// `axis`.
    ///
    /// # Errors
    /// A length is not positive, or the axis has none.
    pub fn new(base: DVec3, axis: DVec3, radius: f64, height: f64) -> Result<Self, PrimitiveError> {
        Ok(Self {
            base,
            axis: unit("the axis of a cone", axis)?,
            radius: positive("the radius of a cone", radius)?,
            height: positive("the height of a cone", height)?,
        })
    }

    /// At most two of the mantle's and the base's crossings bound the solid; the mirror cone above
    /// the apex is cut away by the slab between base and apex.
    pub(super) fn crossings(&self, origin: DVec3, direction: DVec3) -> Option<[Crossing; 2]> {
        let slope = self.radius / self.height;
        let from_base = origin - self.base;
        let (z, dz) = (from_base.dot(self.axis), direction.dot(self.axis));
        let across = from_base - self.axis * z;
        let d_across = direction - self.axis * dz;
        let (below, d_below) = (slope * (self.height - z), -slope * dz);
        let a = d_across.length_squared() - d_below * d_below;
        let half_b = across.dot(d_across) - below * d_below;
        let c = (across.length() - below) * (across.length() + below);
        let caps = slab(z, dz, self.height, self.axis)?;
        let mut found: Vec<Crossing> = Vec::with_capacity(3);
        let mantle = roots(a, half_b, c).map_or_else(
            || if a == 0.0 && half_b != 0.0 { vec![-c / (2.0 * half_b)] } else { Vec::new() },
            Vec::from,
        );
        for t in mantle {
            if t >= caps[0].t && t <= caps[1].t {
                let out = across + d_across * t;
                found.push(Crossing { t, normal: out + self.axis * (slope * out.length()) });
            }
        }
        for cap in caps {
            let out = across + d_across * cap.t;
            let is_base = cap.normal.dot(self.axis) < 0.0;
            if is_base && out.length_squared() <= self.radius * self.radius {
                found.push(cap);
            }
        }
        let enter = found.iter().copied().min_by(|p, q| p.t.total_cmp(&q.t))?;
        let leave = found.iter().copied().max_by(|p, q| p.t.total_cmp(&q.t))?;
        (enter.t < leave.t).then_some([enter, leave])
    }

    pub(super) fn patches(&self) -> Vec<Patch> {
        let Self { base, axis, radius, height } = *self;
        vec![
            Patch::Mantle(Mantle { base, axis, radii: [radius, 0.0], height }),
            Patch::Disc { centre: base, normal: -axis, radius },
        ]
    }

    pub(super) fn bounding_sphere(&self) -> (DVec3, f64) {
        (self.base + self.axis * (self.height / 2.0), self.radius.hypot(self.height / 2.0))
    }
}

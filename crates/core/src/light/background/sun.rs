// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Sun`]: a bright disc endlessly far away.

use std::f64::consts::{PI, TAU};

use crate::math::{orthonormal_pair, DVec3};
use crate::sampling::uniform_cone;
use crate::spectrum::SpectralTable;

/// A round disc of even radiance, endlessly far away; what the sky scatters is added to it.
#[derive(Clone, Debug)]
pub struct Sun {
    /// The unit direction towards its middle.
    pub towards: DVec3,
    /// Its radiance.
    pub radiance: SpectralTable,
    /// The light group that its light is counted to.
    pub group: usize,
    /// 1 − cos of its angular radius: the digits of a small disc stay.
    one_minus_cos: f64,
}

impl Sun {
    /// The sun in the unit direction `towards`, of `angular_radius` rad in (0, π/2].
    pub fn new(towards: DVec3, angular_radius: f64, radiance: SpectralTable, group: usize) -> Self {
        let one_minus_cos = 2.0 * (angular_radius / 2.0).sin().powi(2);
        Self { towards, radiance, group, one_minus_cos }
    }

    /// The solid angle of the disc, in sr.
    pub fn solid_angle(&self) -> f64 {
        TAU * self.one_minus_cos
    }

    /// The irradiance of a plane that faces it, per radiance, in sr: π sin² of its radius. For a
    /// wanted illuminance, divide by it to get the luminance.
    pub fn projected_solid_angle(&self) -> f64 {
        PI * self.one_minus_cos * (2.0 - self.one_minus_cos)
    }

    /// Whether `direction`, a unit vector, points at the disc.
    pub fn covers(&self, direction: DVec3) -> bool {
        // The squared chord between unit vectors is 2(1 − cos), without its cancellation.
        direction.distance_squared(self.towards) <= 2.0 * self.one_minus_cos
    }

    /// The direction to the point of the disc for `u` uniform in the unit square, uniform by solid
    /// angle.
    pub(super) fn direction(&self, u: [f64; 2]) -> DVec3 {
        let local = uniform_cone(u, self.one_minus_cos);
        let (x, y) = orthonormal_pair(self.towards);
        (x * local.x + y * local.y + self.towards * local.z).normalize()
    }
}

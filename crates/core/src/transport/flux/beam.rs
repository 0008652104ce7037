// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Beam`]: parallel light from outside, as a retro-reflector is measured in.

use std::f64::consts::PI;

use super::{Departure, FluxError};
use crate::math::{orthonormal_pair, DVec3, Ray};
use crate::sampling::{uniform_cone, uniform_disc, PixelSampler};
use crate::scene::{Interior, Scene};
use crate::spectrum::SpectralTable;

const M2_PER_MM2: f64 = 1e-6;

/// Light from a far, even disc, over all of a scene.
pub struct Beam {
    /// Where its middle travels to.
    direction: DVec3,
    /// 1 − cos of the disc's angular radius.
    one_minus_cos: f64,
    /// The spectral irradiance in W/(m² nm) on a face square to `direction`.
    irradiance: SpectralTable,
    centre: DVec3,
    /// Of a sphere round all bodies but endless planes, in mm.
    radius: f64,
}

impl Beam {
    /// A beam that travels along `direction`, from a disc of `angular_radius` in rad (0 for exactly
    /// parallel light), and gives a face square to it the spectral `irradiance` in W/(m² nm).
    ///
    /// # Errors
    /// There is no direction, no sound radius, or no body.
    pub fn new(
        scene: &Scene,
        direction: DVec3,
        angular_radius: f64,
        irradiance: SpectralTable,
    ) -> Result<Self, FluxError> {
        let direction = direction.try_normalize().ok_or(FluxError::Beam)?;
        let [lo, hi] = scene.bounds().ok_or(FluxError::Beam)?;
        if !(0.0..PI / 2.0).contains(&angular_radius) {
            return Err(FluxError::Beam);
        }
        let one_minus_cos = 2.0 * (0.5 * angular_radius).sin().powi(2);
        let (centre, radius) = ((lo + hi) / 2.0, (hi - lo).length() / 2.0);
        Ok(Self { direction, one_minus_cos, irradiance, centre, radius })
    }

    /// The flux over all of the scene, per irradiance in W/m². From each direction ω of the disc an
    /// area A = πR² square to it is covered, and the face gets cos θ of that: L∫dω A over L∫cos θ dω.
    fn area(&self) -> f64 {
        let middle = 1.0 - 0.5 * self.one_minus_cos;
        PI * self.radius * self.radius * M2_PER_MM2 / middle
    }

    pub(super) fn flux(&self, scene: &Scene) -> [f64; 3] {
        let area = self.area();
        [0, 1, 2].map(|i| self.irradiance.mean_dot(&scene.colour_matching[i]) * area)
    }

    /// Draw a direction of the disc, and a place across it.
    pub(super) fn depart(
        &self,
        scene: &Scene,
        [u, v, a, b]: [f64; 4],
        sampler: &PixelSampler,
    ) -> Departure {
        let wavelengths = sampler.wavelengths(scene.phases());
        let local = uniform_cone([a, b], self.one_minus_cos);
        let (x, y) = orthonormal_pair(self.direction);
        let direction = (x * local.x + y * local.y + self.direction * local.z).normalize();
        let (across, along) = orthonormal_pair(direction);
        let [p, q] = uniform_disc([u, v]);
        let place = self.centre + (across * p + along * q - direction * 1.001) * self.radius;
        Departure {
            ray: Ray::endless(place, direction),
            interior: Ok(Interior::OUTSIDE),
            wavelengths,
            flux: self.irradiance.at(wavelengths) * self.area(),
            group: 0,
        }
    }
}

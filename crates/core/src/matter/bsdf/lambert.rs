// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Surfaces that send light everywhere alike, by Lambert's law.

use std::f64::consts::FRAC_1_PI;

use super::happens;
use crate::math::{DVec2, DVec3};
use crate::sampling::cosine_hemisphere;
use crate::spectrum::SampledSpectrum;

/// A matt surface of reflectance ρ: f = ρ/π.
#[derive(Clone, Copy, Debug)]
pub struct Diffuse {
    reflectance: SampledSpectrum,
}

impl Diffuse {
    /// A surface of diffuse reflectance ρ.
    pub fn new(reflectance: SampledSpectrum) -> Self {
        Self { reflectance }
    }

    pub(super) fn eval(&self, wi: DVec3, wo: DVec3) -> SampledSpectrum {
        self.reflectance * self.pdf(wi, wo)
    }

    #[expect(clippy::unused_self, reason = "one signature for all surfaces")]
    pub(super) fn pdf(&self, wi: DVec3, wo: DVec3) -> f64 {
        if wi.z > 0.0 {
            wo.z.max(0.0) * FRAC_1_PI
        } else {
            0.0
        }
    }

    #[expect(clippy::unused_self, reason = "one signature for all surfaces")]
    pub(super) fn sample(&self, u: [f64; 3]) -> Option<DVec3> {
        above(cosine_hemisphere(DVec2::new(u[0], u[1])))
    }

    pub(super) fn albedo(&self) -> SampledSpectrum {
        self.reflectance
    }
}

/// A thin sheet that spreads what it reflects (ρ) and what it lets through (τ) evenly.
#[derive(Clone, Copy, Debug)]
pub struct Transmitter {
    reflectance: SampledSpectrum,
    transmittance: SampledSpectrum,
}

impl Transmitter {
    /// A sheet of diffuse reflectance ρ and transmittance τ.
    pub fn new(reflectance: SampledSpectrum, transmittance: SampledSpectrum) -> Self {
        Self { reflectance, transmittance }
    }

    pub(super) fn eval(&self, wi: DVec3, wo: DVec3) -> SampledSpectrum {
        if wi.z <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        let share = if wo.z > 0.0 { self.reflectance } else { self.transmittance };
        share * (wo.z.abs() * FRAC_1_PI)
    }

    pub(super) fn pdf(&self, wi: DVec3, wo: DVec3, lanes: &SampledSpectrum) -> f64 {
        if wi.z <= 0.0 {
            return 0.0;
        }
        let through = self.chance_through(lanes);
        let side = if wo.z > 0.0 { 1.0 - through } else { through };
        side * wo.z.abs() * FRAC_1_PI
    }

    pub(super) fn sample(&self, lanes: &SampledSpectrum, u: [f64; 3]) -> Option<DVec3> {
        let mut choice = u[2];
        let goes_through = happens(self.chance_through(lanes), &mut choice);
        let wo = above(cosine_hemisphere(DVec2::new(u[0], u[1])))?;
        Some(if goes_through { -wo } else { wo })
    }

    pub(super) fn albedo(&self) -> SampledSpectrum {
        self.reflectance + self.transmittance
    }

    /// τ/(ρ + τ) over the lanes that matter.
    fn chance_through(&self, lanes: &SampledSpectrum) -> f64 {
        let (back, through) = (lanes.dot(self.reflectance), lanes.dot(self.transmittance));
        if through > 0.0 {
            through / (back + through)
        } else {
            0.0
        }
    }
}

/// A direction above the surface: at its rim there is nothing to carry.
pub(super) fn above(wo: DVec3) -> Option<DVec3> {
    (wo.z > 0.0).then_some(wo)
}

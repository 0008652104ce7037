// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Sky`]: the CIE standard general sky.

use std::f64::consts::FRAC_PI_2;

use crate::math::DVec3;
use crate::spectrum::{SampledSpectrum, SampledWavelengths, SpectralTable};

/// The coefficients a, b (gradation) and c, d, e (indicatrix) of the standard's types 1 to 15.
///
/// Source: ISO 15469:2004 / CIE S 011/E:2003, table 1. Type 12 is the CIE clear sky.
pub const CIE_GENERAL_SKIES: [[f64; 5]; 15] = [
    [4.0, -0.70, 0.0, -1.0, 0.0],
    [4.0, -0.70, 2.0, -1.5, 0.15],
    [1.1, -0.8, 0.0, -1.0, 0.0],
    [1.1, -0.8, 2.0, -1.5, 0.15],
    [0.0, -1.0, 0.0, -1.0, 0.0],
    [0.0, -1.0, 2.0, -1.5, 0.15],
    [0.0, -1.0, 5.0, -2.5, 0.30],
    [0.0, -1.0, 10.0, -3.0, 0.45],
    [-1.0, -0.55, 2.0, -1.5, 0.15],
    [-1.0, -0.55, 5.0, -2.5, 0.30],
    [-1.0, -0.55, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 16.0, -3.0, 0.30],
    [-1.0, -0.15, 16.0, -3.0, 0.30],
    [-1.0, -0.15, 24.0, -2.8, 0.15],
];

/// How a sky's luminance goes from place to place.
#[derive(Clone, Copy, Debug)]
pub enum SkyModel {
    /// The traditional overcast sky of Moon and Spencer, (1 + 2 cos Z)/3, the standard's type 16.
    Overcast,
    /// The general sky.
    General {
        /// a, b, c, d, e.
        coefficients: [f64; 5],
        /// The unit direction towards the sun.
        sun: DVec3,
    },
}

impl SkyModel {
    /// The luminance from `direction`, of which y is the cosine of the zenith angle Z ≥ 0, relative
    /// to the zenith: f(χ)·φ(Z) / (f(Zₛ)·φ(0)), eq. (1) to (4) of the standard, with χ the angle to
    /// the sun and Zₛ the sun's zenith angle.
    pub fn relative(&self, direction: DVec3) -> f64 {
        let cos_zenith = direction.y.clamp(0.0, 1.0);
        match *self {
            Self::Overcast => (1.0 + 2.0 * cos_zenith) / 3.0,
            Self::General { coefficients: [a, b, c, d, e], sun } => {
                let gradation = |cos: f64| 1.0 + a * (b / cos).exp();
                let indicatrix = |angle: f64| {
                    1.0 + c * ((d * angle).exp() - (d * FRAC_PI_2).exp()) + e * angle.cos().powi(2)
                };
                let to_sun = direction.cross(sun).length().atan2(direction.dot(sun));
                let sun_zenith = sun.y.clamp(-1.0, 1.0).acos();
                indicatrix(to_sun) * gradation(cos_zenith)
                    / (indicatrix(sun_zenith) * gradation(1.0))
            }
        }
    }
}

/// A sky over even ground.
#[derive(Clone, Debug)]
pub struct Sky {
    /// How its luminance goes from place to place.
    pub model: SkyModel,
    /// The spectral radiance of the zenith; that of other places has the same shape.
    pub zenith: SpectralTable,
    /// The spectral radiance from below the horizon.
    pub ground: SpectralTable,
}

impl Sky {
    /// The spectral radiance from `direction`.
    pub(super) fn radiance(&self, direction: DVec3, at: SampledWavelengths) -> SampledSpectrum {
        if direction.y < 0.0 {
            return self.ground.at(at);
        }
        self.zenith.at(at) * self.model.relative(direction)
    }
}

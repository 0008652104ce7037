// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The phase function of Henyey and Greenstein (1941): how a medium scatters.
//!
//! `cos` is the cosine of the deflection: 1 goes straight on. As `wi` points back to where the walk
//! came from, cos = −wi·wo. `g`, from −1 to 1, is the mean of that cosine: positive scatters forward.

use std::f64::consts::{PI, TAU};

use crate::math::{orthonormal_pair, DVec3};

/// The density per sr of scattering by a deflection of cosine `cos`; it integrates to 1.
pub fn henyey_greenstein(cos: f64, g: f64) -> f64 {
    // 1 + g² − 2g·cos, without cancellation as g and cos go to 1.
    let base = (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - cos);
    (1.0 - g * g) / (4.0 * PI * base * base.sqrt())
}

/// Choose the direction after scattering by two uniform numbers, with the density
/// [`henyey_greenstein`] of −wi·wo.
pub fn sample_henyey_greenstein(wi: DVec3, g: f64, u: [f64; 2]) -> DVec3 {
    // The distribution of cos inverted, in a form without a division by g.
    let s = 2.0 * u[0] - 1.0;
    let base = 1.0 + g * s;
    let even = s * (1.0 + g * g);
    let odd = 0.5 * g * (s * s + 3.0 - g * g * (1.0 - s * s));
    let cos = ((even + odd) / (base * base)).clamp(-1.0, 1.0);
    let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
    let (sin_azimuth, cos_azimuth) = (TAU * u[1]).sin_cos();
    let (x, y) = orthonormal_pair(-wi);
    x * (sin * cos_azimuth) + y * (sin * sin_azimuth) - wi * cos
}

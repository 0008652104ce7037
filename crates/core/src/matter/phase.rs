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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matter::bsdf::tests::{chi_square::deviate, Dome};

    #[test]
    fn the_phase_function_is_normalised_with_the_mean_cosine_g() {
        for g in [-0.9, -0.3, 0.0, 0.5, 0.95] {
            let steps = 200_000;
            let (mut whole, mut mean) = (0.0, 0.0);
            for i in 0..steps {
                let cos = 2.0 * (f64::from(i) + 0.5) / f64::from(steps) - 1.0;
                let share = henyey_greenstein(cos, g) * 2.0 * TAU / f64::from(steps);
                whole += share;
                mean += share * cos;
            }
            assert!((whole - 1.0).abs() < 1e-5 && (mean - g).abs() < 1e-5, "{g}: {whole} {mean}");
        }
    }

    #[test]
    fn scattering_is_sampled_by_the_phase_function() {
        let wi = DVec3::new(0.3, -0.5, 0.2).normalize();
        for (seed, g) in [-0.8_f64, 0.0, 1e-9, 0.6, 0.98].into_iter().enumerate() {
            let axis = if g < 0.0 { wi } else { -wi };
            let dome = Dome::new(axis, ((1.0 - g) * (1.0 - g)).clamp(1e-4, 0.5));
            let pdf = |wo: DVec3| henyey_greenstein(-wi.dot(wo), g);
            let sample = |u: [f64; 3]| Some(sample_henyey_greenstein(wi, g, [u[0], u[1]]));
            let z = deviate(dome, &|_| true, &pdf, &sample, seed as u64);
            assert!(z < 3.5, "g = {g}: {z:.2} sigma");
        }
    }

    #[test]
    fn positive_g_goes_straight_on() {
        let wi = DVec3::Z;
        assert!((sample_henyey_greenstein(wi, 0.999, [0.5, 0.1]) + wi).length() < 0.01);
        assert!((sample_henyey_greenstein(wi, -0.999, [0.5, 0.1]) - wi).length() < 0.01);
    }
}

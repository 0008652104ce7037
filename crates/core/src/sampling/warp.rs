// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Maps from the unit square to other domains that keep uniform density.

use std::f64::consts::TAU;

use crate::math::{DVec2, DVec3};

/// Return a point of the unit sphere, uniform by area for a uniform `u` (Archimedes' map).
pub fn uniform_sphere(u: DVec2) -> DVec3 {
    let z = 1.0 - 2.0 * u.x;
    let radius = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = (TAU * u.y).sin_cos();
    DVec3::new(radius * cos, radius * sin, z)
}

/// Return a direction above the plane z = 0 with the density z/π per sr, for a uniform `u`.
///
/// Malley's method: a point of the unit disc, uniform by area, lifted to the hemisphere.
pub fn cosine_hemisphere(u: DVec2) -> DVec3 {
    let radius = u.x.sqrt();
    let (sin, cos) = (TAU * u.y).sin_cos();
    DVec3::new(radius * cos, radius * sin, (1.0 - u.x).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_band_of_equal_height_gets_the_same_share_of_the_sphere() {
        const BANDS: usize = 8;
        const SIDE: usize = 64;
        let mut counts = [0usize; BANDS];
        for i in 0..SIDE {
            for j in 0..SIDE {
                let u = DVec2::new(i as f64 + 0.5, j as f64 + 0.5) / SIDE as f64;
                let point = uniform_sphere(u);
                assert!((point.length() - 1.0).abs() < 1e-14);
                counts[((point.x * 0.5 + 0.5) * BANDS as f64) as usize] += 1;
            }
        }
        let expected = (SIDE * SIDE / BANDS) as f64;
        let chi_square: f64 =
            counts.iter().map(|c| (*c as f64 - expected).powi(2) / expected).sum();
        assert!(chi_square < 14.07, "χ² = {chi_square} (7 degrees of freedom, α = 0.05)");
    }
}

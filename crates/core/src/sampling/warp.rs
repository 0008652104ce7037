// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Maps from the unit square to other domains that keep uniform density.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

use crate::math::{DVec2, DVec3};

/// Return a point of the unit sphere, uniform by area for a uniform `u` (Archimedes' map).
pub fn uniform_sphere(u: DVec2) -> DVec3 {
    let z = 1.0 - 2.0 * u.x;
    let radius = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = (TAU * u.y).sin_cos();
    DVec3::new(radius * cos, radius * sin, z)
}

/// Return a point of the unit disc, uniform by area for a uniform `u`.
///
/// Source: P. Shirley, K. Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997.
pub fn uniform_disc(u: DVec2) -> DVec2 {
    let v = 2.0 * u - DVec2::ONE;
    if v == DVec2::ZERO {
        return DVec2::ZERO;
    }
    let (radius, angle) = if v.x.abs() > v.y.abs() {
        (v.x, FRAC_PI_4 * (v.y / v.x))
    } else {
        (v.y, FRAC_PI_2 - FRAC_PI_4 * (v.x / v.y))
    };
    DVec2::from_angle(angle) * radius
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

    #[test]
    fn every_ring_and_sector_of_equal_area_gets_the_same_share_of_the_disc() {
        const SIDE: usize = 128;
        let mut counts = [0_usize; 16];
        for i in 0..SIDE * SIDE {
            let u = DVec2::new((i % SIDE) as f64 + 0.5, (i / SIDE) as f64 + 0.5) / SIDE as f64;
            let point = uniform_disc(u);
            let ring = (point.length_squared() * 4.0) as usize;
            let sector = ((point.to_angle() / TAU + 0.5) * 4.0) as usize;
            counts[ring * 4 + sector] += 1;
        }
        let expected = (SIDE * SIDE / 16) as f64;
        let chi_square: f64 =
            counts.iter().map(|c| (*c as f64 - expected).powi(2) / expected).sum();
        assert!(chi_square < 25.0, "χ² = {chi_square} (15 degrees of freedom, α = 0.05)");
    }
}

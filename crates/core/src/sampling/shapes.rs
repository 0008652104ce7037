// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Maps from the unit square to triangles, discs and cones, each of uniform density.

use std::f64::consts::TAU;

use crate::math::DVec3;

/// The weights of the corners of a triangle for a point uniform by area.
///
/// Source: E. Heitz, "A Low-Distortion Map Between Triangle and Square", 2019.
pub fn uniform_triangle([u, v]: [f64; 2]) -> [f64; 3] {
    let (a, b) = if v > u { (u / 2.0, v - u / 2.0) } else { (u - v / 2.0, v / 2.0) };
    [1.0 - a - b, a, b]
}

/// A point of the unit disc, uniform by area.
pub fn uniform_disc([u, v]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = (TAU * v).sin_cos();
    let radius = u.sqrt();
    [radius * cos, radius * sin]
}

/// A direction within a cone round +z, uniform by solid angle. The cone's half-angle is given by
/// `1 − cos`, which keeps its digits where the cone is narrow.
pub fn uniform_cone([u, v]: [f64; 2], one_minus_cos: f64) -> DVec3 {
    let h = u * one_minus_cos;
    let (sin, cos) = (TAU * v).sin_cos();
    let radius = (h * (2.0 - h)).max(0.0).sqrt();
    DVec3::new(radius * cos, radius * sin, 1.0 - h)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 256;

    fn grid() -> impl Iterator<Item = [f64; 2]> {
        (0..SIDE * SIDE).map(|i| [i % SIDE, i / SIDE].map(|k| (k as f64 + 0.5) / SIDE as f64))
    }

    #[test]
    fn the_four_quarters_of_a_triangle_get_the_same_share() {
        let mut counts = [0usize; 4];
        for u in grid() {
            let weights = uniform_triangle(u);
            assert!(weights.iter().all(|w| *w >= 0.0));
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            counts[weights.iter().position(|w| *w > 0.5).unwrap_or(3)] += 1;
        }
        for count in counts {
            let share = count as f64 / (SIDE * SIDE) as f64;
            assert!((share - 0.25).abs() < 0.004, "{counts:?}");
        }
    }

    #[test]
    fn rings_of_a_disc_and_of_a_cone_get_shares_by_their_area() {
        let one_minus_cos = 0.7;
        let mut counts = [[0usize; 4]; 2];
        for u in grid() {
            let [x, y] = uniform_disc(u);
            counts[0][((x * x + y * y) * 4.0) as usize] += 1;
            let direction = uniform_cone(u, one_minus_cos);
            assert!((direction.length() - 1.0).abs() < 1e-15);
            counts[1][((1.0 - direction.z) / one_minus_cos * 4.0) as usize] += 1;
        }
        for count in counts.into_iter().flatten() {
            assert_eq!(count, SIDE * SIDE / 4);
        }
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! What every surface must hold: `sample` follows `pdf`, light goes both ways alike, and none is
//! made or lost.

pub mod chi_square;
mod energy;
mod limits;
mod reciprocity;
mod sampling;

use super::*;
use crate::math::orthonormal_pair;
use crate::matter::lacquer::Lacquer;
use crate::spectrum::{SampledWavelengths, SpectralTable};

/// The same chance for all lanes.
fn even_lanes() -> SampledSpectrum {
    SampledSpectrum::splat(1.0 / LANES as f64)
}

/// Lanes of very different weight; the first does not matter at all.
fn uneven_lanes() -> SampledSpectrum {
    SampledSpectrum::from_fn(|j| j as f64 / (LANES * (LANES - 1) / 2) as f64)
}

/// The unit vector of this cosine and azimuth.
fn direction(cos: f64, azimuth: f64) -> DVec3 {
    let sin = (1.0 - cos * cos).sqrt();
    DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), cos)
}

/// An index ratio that falls by 4 % over the lanes.
fn dispersive(eta: f64) -> SampledSpectrum {
    SampledSpectrum::from_fn(|j| eta * (1.02 - 0.04 * j as f64 / (LANES - 1) as f64))
}

fn rising(from: f64, to: f64) -> SampledSpectrum {
    SampledSpectrum::from_fn(|j| from + (to - from) * j as f64 / (LANES - 1) as f64)
}

fn aluminium() -> Facet {
    Facet::Metal { n: rising(0.45, 2.0), k: rising(4.7, 8.0), factor: 1.0 }
}

fn lacquered() -> Facet {
    let table = |value| SpectralTable::from_ascending(&[value; LANES]).unwrap();
    let lacquer = Lacquer { index: table(1.5), optical_depth: table(0.4) };
    Facet::Lacquered(LacqueredMetal {
        lacquer: lacquer.at(SampledWavelengths { phase: 0 }),
        medium_index: SampledSpectrum::ONE,
        n: rising(0.45, 2.0),
        k: rising(4.7, 8.0),
        factor: 0.9,
    })
}

/// Numbers that look random and are the same every time (`SplitMix64`).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Directions in a grid round an axis, that is finer near it: w = ½(1 − cos γ) of a direction at
/// the angle γ is w = ε·s/(1 + ε − s) with s uniform, so that half of the grid has w < ε.
#[derive(Clone, Copy)]
pub struct Dome {
    frame: [DVec3; 3],
    epsilon: f64,
}

impl Dome {
    pub fn new(axis: DVec3, epsilon: f64) -> Self {
        let (x, y) = orthonormal_pair(axis);
        Self { frame: [x, y, axis], epsilon }
    }

    /// The direction of a point of the unit square, and sr per area of the square.
    fn direction(&self, s: f64, v: f64) -> (DVec3, f64) {
        let e = self.epsilon;
        let w = e * s / (1.0 + e - s);
        let (sin_v, cos_v) = (std::f64::consts::TAU * v).sin_cos();
        let sin = 2.0 * (w * (1.0 - w)).max(0.0).sqrt();
        let [x, y, z] = self.frame;
        let d = x * (sin * cos_v) + y * (sin * sin_v) + z * (1.0 - 2.0 * w);
        let slope = e * (1.0 + e) / (1.0 + e - s).powi(2);
        (d, 2.0 * std::f64::consts::TAU * slope)
    }

    /// The point of the unit square of a direction.
    fn place(&self, d: DVec3) -> (f64, f64) {
        let [x, y, z] = self.frame;
        // ½(1 − cos γ) = ¼|d − axis|², without cancellation.
        let w = 0.25 * (d - z).length_squared();
        let s = (1.0 + self.epsilon) * w / (self.epsilon + w);
        let v = d.dot(y).atan2(d.dot(x)) / std::f64::consts::TAU;
        (s.clamp(0.0, 1.0), v.rem_euclid(1.0))
    }
}

/// ∫ f over a rectangle of the unit square, by halving it where two rules differ.
fn integrate(
    f: &dyn Fn(f64, f64) -> f64,
    [s0, s1]: [f64; 2],
    [v0, v1]: [f64; 2],
    depth: u32,
    tolerance: f64,
) -> f64 {
    // Gauss's rules with 5 and 4 points on each side.
    const FIVE: [(f64, f64); 5] = [
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    const FOUR: [(f64, f64); 4] = [
        (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
        (-0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
        (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
        (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    ];
    let rule = |points: &[(f64, f64)]| {
        let mut sum = 0.0;
        for (a, wa) in points {
            for (b, wb) in points {
                let s = 0.5 * (s0 + s1) + 0.5 * (s1 - s0) * a;
                let v = 0.5 * (v0 + v1) + 0.5 * (v1 - v0) * b;
                sum += wa * wb * f(s, v);
            }
        }
        sum * 0.25 * (s1 - s0) * (v1 - v0)
    };
    let (fine, coarse) = (rule(&FIVE), rule(&FOUR));
    if depth == 0 || (fine - coarse).abs() <= tolerance {
        return fine;
    }
    let (s, v) = (0.5 * (s0 + s1), 0.5 * (v0 + v1));
    let quarter = |s: [f64; 2], v: [f64; 2]| integrate(f, s, v, depth - 1, tolerance);
    quarter([s0, s], [v0, v])
        + quarter([s, s1], [v0, v])
        + quarter([s0, s], [v, v1])
        + quarter([s, s1], [v, v1])
}

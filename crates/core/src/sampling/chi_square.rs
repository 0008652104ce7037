// SPDX-License-Identifier: Apache-2.0 OR MIT
//! For tests: whether a sampler of directions follows the density that it states.

use std::f64::consts::TAU;

use crate::math::{orthonormal_pair, DVec3};

/// Independent uniform numbers (Steele, Lea and Flood's `SplitMix64`).
pub(crate) struct Uniform(pub u64);

impl Uniform {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn triple(&mut self) -> [f64; 3] {
        [self.next(), self.next(), self.next()]
    }
}

/// How far Pearson's χ² lies above its mean, in standard deviations of the normal distribution that
/// Wilson and Hilferty (1931) liken it to. Cells that expect less than ten are put together.
pub(crate) fn excess(counts: &[f64], expected: &[f64]) -> f64 {
    let (mut sum, mut cells) = (0.0, -1.0);
    let (mut few, mut few_expected) = (0.0, 0.0);
    for (count, expected) in counts.iter().zip(expected) {
        if *expected < 10.0 {
            few += count;
            few_expected += expected;
        } else {
            sum += (count - expected).powi(2) / expected;
            cells += 1.0;
        }
    }
    if few_expected >= 10.0 {
        sum += (few - few_expected).powi(2) / few_expected;
        cells += 1.0;
    } else {
        assert!(few < 40.0, "{few} samples where {few_expected} are expected");
    }
    assert!(cells > 3.0, "too few cells");
    let spread = 2.0 / (9.0 * cells);
    ((sum / cells).cbrt() - (1.0 - spread)) / spread.sqrt()
}

/// A cone of directions, cut into cells of equal solid angle, and the rest of the sphere.
pub(crate) struct Cells {
    pub axis: DVec3,
    /// 1 − cos of the cone's half-angle: 2 for the whole sphere.
    pub one_minus_cos: f64,
}

impl Cells {
    const RINGS: usize = 12;
    const STEPS: usize = 24;
    /// Points for each side of a cell, by which its expectation is summed.
    const FINE: usize = 60;
    const SAMPLES: usize = 400_000;

    fn direction(&self, ring: f64, step: f64) -> DVec3 {
        let h = ring * self.one_minus_cos;
        let (sin, cos) = (TAU * step).sin_cos();
        let (x, y) = orthonormal_pair(self.axis);
        (x * cos + y * sin) * (h * (2.0 - h)).max(0.0).sqrt() + self.axis * (1.0 - h)
    }

    fn cell(&self, direction: DVec3) -> Option<usize> {
        let (x, y) = orthonormal_pair(self.axis);
        let ring = direction.distance_squared(self.axis) / 2.0 / self.one_minus_cos;
        let step = (direction.dot(y).atan2(direction.dot(x)) / TAU).rem_euclid(1.0);
        let at = (step * Self::STEPS as f64) as usize % Self::STEPS;
        (ring < 1.0).then(|| (ring * Self::RINGS as f64) as usize * Self::STEPS + at)
    }

    /// What the density expects in each cell, as a share of all samples.
    fn shares(&self, density: impl Fn(DVec3) -> f64) -> Vec<f64> {
        let fine = Self::FINE;
        let total = Self::RINGS * Self::STEPS * fine * fine;
        let solid_angle = TAU * self.one_minus_cos / total as f64;
        let share = |cell: usize| {
            let (ring, step) = (cell / Self::STEPS, cell % Self::STEPS);
            let within = |at: usize, k: usize, n: usize| {
                (at as f64 + (k as f64 + 0.5) / fine as f64) / n as f64
            };
            let points = (0..fine * fine).map(|k| {
                density(self.direction(
                    within(ring, k / fine, Self::RINGS),
                    within(step, k % fine, Self::STEPS),
                ))
            });
            points.sum::<f64>() * solid_angle
        };
        (0..Self::RINGS * Self::STEPS).map(share).collect()
    }

    /// How far χ² of the samples lies above its mean, in standard deviations: all of the density
    /// must lie in the cone, and what it lacks to 1 must be samples that come to nothing.
    pub fn excess(
        &self,
        mut sample: impl FnMut([f64; 3]) -> Option<DVec3>,
        density: impl Fn(DVec3) -> f64,
    ) -> f64 {
        let n = Self::SAMPLES as f64;
        let mut expected: Vec<f64> = self.shares(density).iter().map(|share| share * n).collect();
        let mut counts = vec![0.0; expected.len() + 1];
        let mut random = Uniform(7);
        for _ in 0..Self::SAMPLES {
            match sample(random.triple()) {
                Some(direction) => {
                    counts[self.cell(direction).expect("a sample is outside the cone")] += 1.0;
                }
                None => counts[expected.len()] += 1.0,
            }
        }
        let missing = n - expected.iter().sum::<f64>();
        if counts[expected.len()] == 0.0 {
            assert!(missing.abs() < 6e-3 * n, "the density's integral is {}", 1.0 - missing / n);
            counts.pop();
        } else {
            expected.push(missing);
        }
        excess(&counts, &expected)
    }

    /// Fail unless the samples' 1/density finds the solid angle of the directions in each cell that
    /// have a density: for one with poles, such as that of a curved surface's rim.
    pub fn check_reciprocal(
        &self,
        what: &str,
        mut sample: impl FnMut([f64; 3]) -> Option<DVec3>,
        density: impl Fn(DVec3) -> f64,
    ) {
        let expected = self.shares(|direction| f64::from(density(direction) > 0.0));
        let mut sums = vec![[0.0; 2]; expected.len()];
        let mut random = Uniform(7);
        for _ in 0..Self::SAMPLES {
            let Some(direction) = sample(random.triple()) else { continue };
            let sum = &mut sums[self.cell(direction).expect("a sample is outside the cone")];
            let weight = density(direction);
            // A direction that grazes the rim may miss the surface by rounding.
            if weight > 0.0 {
                sum[0] += 1.0 / weight;
                sum[1] += 1.0 / (weight * weight);
            }
        }
        // In units in which each cell's variance is its expectation, as χ² has it for counts.
        let full = TAU * self.one_minus_cos / expected.len() as f64;
        let scaled =
            sums.iter().zip(&expected).filter(|(_, e)| **e > 0.2 * full).map(|(sum, e)| {
                let mean = sum[0] / Self::SAMPLES as f64;
                let variance = (sum[1] / Self::SAMPLES as f64 - mean * mean) / Self::SAMPLES as f64;
                (mean * e / variance, e * e / variance)
            });
        let (counts, expected): (Vec<f64>, Vec<f64>) = scaled.unzip();
        let excess = excess(&counts, &expected);
        assert!(excess < 3.72, "{what}: χ² is {excess} standard deviations above its mean");
    }

    /// Fail unless the samples follow the density, at a significance of 1e-4 for this one test.
    pub fn check(
        &self,
        what: &str,
        sample: impl FnMut([f64; 3]) -> Option<DVec3>,
        density: impl Fn(DVec3) -> f64,
    ) {
        let excess = self.excess(sample, density);
        assert!(excess < 3.72, "{what}: χ² is {excess} standard deviations above its mean");
    }
}

#[test]
fn the_test_of_samplers_sees_a_density_that_leans_by_five_percent() {
    let cells = Cells { axis: DVec3::Z, one_minus_cos: 2.0 };
    let sample = |[u, v, _]: [f64; 3]| Some(super::uniform_sphere(crate::math::DVec2::new(u, v)));
    cells.check("uniform", sample, |_| 0.5 / TAU);
    assert!(cells.excess(sample, |direction| (1.0 + 0.05 * direction.x) * 0.5 / TAU) > 3.72);
}

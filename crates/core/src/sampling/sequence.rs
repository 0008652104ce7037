// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Sample positions that depend on (seed, pixel, sample, dimension) and on nothing else.

use thiserror::Error;

use crate::math::DVec2;
use crate::spectrum::SampledWavelengths;

/// How the sub-samples of a pixel lie in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelSequence {
    /// The centres of n×n cells.
    Grid {
        /// Cells along a side.
        side: u32,
    },
    /// Owen-scrambled Sobol points, scrambled anew for every pixel.
    Sobol,
}

/// Why a sequence cannot be made.
#[derive(Debug, Error, PartialEq)]
pub enum SequenceError {
    /// The grid needs n×n samples.
    #[error("the grid sampler needs a square number of samples, not {0}")]
    NotSquare(u32),
    /// More samples than the sequence holds.
    #[error("a pixel takes 1 to 65536 samples, not {0}")]
    Count(u32),
}

impl PixelSequence {
    /// How many samples have points of one Sobol sequence; those after them take another one's.
    pub const MOST_SAMPLES: u32 = 1 << 16;

    /// The n×n grid with `samples` points.
    ///
    /// # Errors
    /// `samples` is not a square, or out of range.
    pub fn grid(samples: u32) -> Result<Self, SequenceError> {
        if samples == 0 || samples > Self::MOST_SAMPLES {
            return Err(SequenceError::Count(samples));
        }
        let side = samples.isqrt();
        if side * side == samples {
            Ok(Self::Grid { side })
        } else {
            Err(SequenceError::NotSquare(samples))
        }
    }

    /// The random numbers of sample number `sample` of pixel number `pixel`.
    pub fn sampler(self, seed: u64, pixel: u64, sample: u32) -> PixelSampler {
        let key = hash(seed ^ hash(pixel.wrapping_add(0x9E37_79B9_7F4A_7C15)));
        PixelSampler { sequence: self, key, sample, dimension: 2, phase: None }
    }
}

/// The numbers one sample of one pixel draws, in the order of its questions.
#[derive(Clone, Debug)]
pub struct PixelSampler {
    sequence: PixelSequence,
    key: u64,
    sample: u32,
    dimension: u32,
    /// The phase, if it is not the sequence that says.
    phase: Option<SampledWavelengths>,
}

impl PixelSampler {
    /// The place of this sample in the unit square of its pixel.
    pub fn pixel(&self) -> DVec2 {
        match self.sequence {
            PixelSequence::Grid { side } => {
                let cells = side * side;
                let cell = strided(self.sample % cells, cells, 0);
                let middle = |index: u32| (f64::from(index) + 0.5) / f64::from(side);
                DVec2::new(middle(cell % side), middle(cell / side))
            }
            PixelSequence::Sobol => DVec2::new(self.sobol(0), self.sobol(1)),
        }
    }

    /// The phase of this sample: every run of `phases` samples visits each phase once.
    pub fn wavelengths(&self, phases: usize) -> SampledWavelengths {
        if let Some(phase) = self.phase {
            return phase;
        }
        let phases = phases as u32;
        let offset = (self.key >> 32) as u32 % phases;
        SampledWavelengths { phase: strided(self.sample % phases, phases, offset) as usize }
    }

    /// The same, of one given phase.
    #[must_use]
    pub fn on_phase(self, phase: SampledWavelengths) -> Self {
        Self { phase: Some(phase), ..self }
    }

    /// The place of this sample on the camera's lens, in the unit square.
    pub fn lens(&self) -> DVec2 {
        DVec2::new(self.sobol(2), self.sobol(3))
    }

    /// The first four numbers, those of [`pixel`](Self::pixel) and [`lens`](Self::lens) of a walk from
    /// the eye: for a walk that starts elsewhere.
    pub fn first_4d(&self) -> [f64; 4] {
        let (index, seed) = self.point(0);
        sobol_burley::sample_4d(index, 0, seed).map(f64::from)
    }

    /// The next two numbers, uniform in the unit square.
    pub fn next_2d(&mut self) -> DVec2 {
        let first = self.dimension;
        self.dimension += 2;
        DVec2::new(self.sobol(first), self.sobol(first + 1))
    }

    /// The next four numbers, uniform in the unit hypercube and well spread in all of it.
    pub fn next_4d(&mut self) -> [f64; 4] {
        let set = self.dimension.div_ceil(4);
        self.dimension = 4 * (set + 1);
        let (index, seed) = self.point(set / sobol_burley::NUM_DIMENSION_SETS_4D);
        let last = sobol_burley::NUM_DIMENSION_SETS_4D;
        sobol_burley::sample_4d(index, set % last, seed).map(f64::from)
    }

    /// The numbers of another branch of this sample's tree of rays: independent of this one's.
    #[must_use]
    pub fn fork(&self, branch: u32) -> Self {
        let salt = u64::from(self.dimension) << 32 | u64::from(branch + 1);
        Self { key: hash(self.key ^ hash(salt)), ..self.clone() }
    }

    fn sobol(&self, dimension: u32) -> f64 {
        let last = sobol_burley::NUM_DIMENSIONS;
        let (index, seed) = self.point(dimension / last);
        f64::from(sobol_burley::sample(index, dimension % last, seed))
    }

    /// The index into the sequence and the scramble's seed, for the `round`th use of all dimensions.
    fn point(&self, round: u32) -> (u32, u32) {
        let most = PixelSequence::MOST_SAMPLES;
        let turn = (self.sample / most).wrapping_mul(0x9E37_79B9);
        (self.sample % most, (self.key as u32).wrapping_add(round).wrapping_add(turn))
    }
}

/// Walk through 0..count by steps near the golden section, so that every first part is spread.
fn strided(index: u32, count: u32, offset: u32) -> u32 {
    let golden = (f64::from(count) * 0.618_033_988_749_895).round() as u32;
    let near = (0..count).flat_map(|away| [golden.saturating_sub(away), golden + away]);
    let stride = near.filter(|step| *step > 0).find(|step| coprime(*step, count)).unwrap_or(1);
    ((u64::from(index) * u64::from(stride) + u64::from(offset)) % u64::from(count)) as u32
}

fn coprime(a: u32, b: u32) -> bool {
    let (mut a, mut b) = (a, b);
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a == 1
}

/// `SplitMix64`'s finaliser (Steele, Lea, Flood 2014): a bijection whose output bits all depend
/// on all input bits.
fn hash(value: u64) -> u64 {
    let mut z = value;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn a_grid_puts_one_sample_into_each_cell() {
        let sequence = PixelSequence::grid(25).unwrap();
        let cells: HashSet<(u32, u32)> = (0..25)
            .map(|sample| {
                let u = sequence.sampler(1, 7, sample).pixel() * 5.0;
                assert_eq!(u.fract(), DVec2::splat(0.5));
                (u.x as u32, u.y as u32)
            })
            .collect();
        assert_eq!(cells.len(), 25);
    }

    #[test]
    fn as_many_samples_as_phases_visit_each_phase_once() {
        for pixel in 0..50 {
            let phases: HashSet<usize> = (25..50)
                .map(|s| PixelSequence::Sobol.sampler(3, pixel, s).wavelengths(25).phase)
                .collect();
            assert_eq!(phases.len(), 25);
        }
    }

    #[test]
    fn sixteen_sobol_points_fill_sixteen_cells() {
        let cells: HashSet<(u32, u32)> = (0..16)
            .map(|sample| {
                let u = PixelSequence::Sobol.sampler(9, 4, sample).pixel() * 4.0;
                (u.x as u32, u.y as u32)
            })
            .collect();
        assert_eq!(cells.len(), 16);
    }

    #[test]
    fn another_seed_or_pixel_draws_other_numbers() {
        let draw = |seed, pixel| PixelSequence::Sobol.sampler(seed, pixel, 5).pixel();
        assert_eq!(draw(1, 2), draw(1, 2));
        assert_ne!(draw(1, 2), draw(2, 2));
        assert_ne!(draw(1, 2), draw(1, 3));
    }

    #[test]
    fn a_grid_of_ten_samples_is_refused() {
        assert_eq!(PixelSequence::grid(10), Err(SequenceError::NotSquare(10)));
        assert_eq!(PixelSequence::grid(0), Err(SequenceError::Count(0)));
    }
}

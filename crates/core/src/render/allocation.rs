// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Pilot`] and [`Allocation`]: how many samples each pixel takes.

use crate::film::Film;
use crate::sampling::PixelSequence;

/// What a first round of samples tells of every pixel. Its samples are then thrown away: a pixel
/// whose own samples decided how many it takes would stop when they happen to agree, and be biased.
pub(super) struct Pilot {
    /// The standard deviation of one sample's luminance, relative to the pixel's tone.
    noise: Vec<f64>,
    /// Segments that one sample takes.
    cost: Vec<f64>,
}

/// How many samples each pixel takes.
pub(super) struct Allocation {
    counts: Vec<u32>,
}

/// The tone of a pixel is its luminance and this share of the picture's mean: a relative error of
/// black has no meaning.
const FLOOR: f64 = 0.01;

/// No pixel is taken to be quieter than this share of the mean noise, since it may have missed what
/// is bright and rare, nor louder than this multiple, since it may have met it by chance.
const QUIETEST: f64 = 0.25;
const LOUDEST: f64 = 16.0;

impl Pilot {
    /// How many samples of every pixel the first round has.
    pub const SAMPLES: u32 = 16;

    /// Read a first round.
    ///
    /// A pixel takes the mean variance of it and its neighbours: its few samples tell little.
    pub fn of(film: &Film) -> Self {
        let pixels = &film.pixels;
        let mean = pixels.iter().map(|pixel| pixel.mean()[1]).sum::<f64>() / pixels.len() as f64;
        let variance = |at: usize| {
            let pixel = &pixels[at];
            pixel.standard_error()[1].powi(2) * f64::from(pixel.samples)
        };
        let own: Vec<f64> = (0..pixels.len()).map(variance).collect();
        let noise = (0..pixels.len()).map(|at| {
            let tone = pixels[at].mean()[1] + FLOOR * mean;
            let spread = mean_round(&own, film.width as usize, at).sqrt();
            if tone > 0.0 {
                spread / tone
            } else {
                0.0
            }
        });
        let mut noise: Vec<f64> = noise.collect();
        let mean = noise.iter().sum::<f64>() / noise.len() as f64;
        let bounds = (QUIETEST * mean, LOUDEST * mean);
        for noise in &mut noise {
            *noise = noise.clamp(bounds.0, bounds.1);
        }
        let cost = film.segments.iter().zip(pixels);
        let cost = cost.map(|(segments, pixel)| *segments as f64 / f64::from(pixel.samples.max(1)));
        Self { noise, cost: cost.map(|cost| cost.max(1.0)).collect() }
    }

    /// Segments that one sample of every pixel takes.
    pub fn cost(&self) -> f64 {
        self.cost.iter().sum()
    }

    /// The samples that bring the root mean square of the relative errors to `target`, or as low as
    /// the cost of `mean_samples` of every pixel allows.
    ///
    /// The sum of squares Σ sᵢ²/nᵢ at the cost Σ nᵢ·cᵢ is least for nᵢ ∝ sᵢ/√cᵢ (Neyman).
    pub fn allocate(&self, mean_samples: f64, target: Option<f64>) -> Allocation {
        let affordable = mean_samples * self.cost();
        let suffices = |allocation: &Allocation| {
            let is_spent = self.cost_of(allocation) >= affordable;
            is_spent || target.is_some_and(|target| self.error_of(allocation) <= target)
        };
        let (mut low, mut high) = (0.0, 1.0);
        while high < 1e12 && !suffices(&self.scaled(high)) {
            (low, high) = (high, 2.0 * high);
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if suffices(&self.scaled(middle)) {
                high = middle;
            } else {
                low = middle;
            }
        }
        self.scaled(high)
    }

    fn scaled(&self, scale: f64) -> Allocation {
        const FEWEST: f64 = 8.0;
        const MOST: f64 = PixelSequence::MOST_SAMPLES as f64;
        let count = |(noise, cost): (&f64, &f64)| {
            (scale * noise / cost.sqrt()).ceil().clamp(FEWEST, MOST) as u32
        };
        Allocation { counts: self.noise.iter().zip(&self.cost).map(count).collect() }
    }

    fn cost_of(&self, allocation: &Allocation) -> f64 {
        let counts = allocation.counts.iter().zip(&self.cost);
        counts.map(|(count, cost)| f64::from(*count) * cost).sum()
    }

    fn error_of(&self, allocation: &Allocation) -> f64 {
        let counts = allocation.counts.iter().zip(&self.noise);
        let squares: f64 = counts.map(|(count, noise)| noise * noise / f64::from(*count)).sum();
        (squares / self.noise.len() as f64).sqrt()
    }
}

impl Allocation {
    /// How many samples the pixel takes.
    pub fn of(&self, pixel: usize) -> u32 {
        self.counts[pixel]
    }

    /// The most that a pixel takes.
    pub fn most(&self) -> u32 {
        self.counts.iter().copied().max().unwrap_or(0)
    }

    /// All samples of all pixels.
    pub fn total(&self) -> u64 {
        self.counts.iter().map(|count| u64::from(*count)).sum()
    }
}

/// The mean of the values of a pixel and its neighbours.
fn mean_round(values: &[f64], width: usize, at: usize) -> f64 {
    let (column, row, height) = (at % width, at / width, values.len() / width);
    let columns = column.saturating_sub(1)..width.min(column + 2);
    let rows = row.saturating_sub(1)..height.min(row + 2);
    let count = columns.len() * rows.len();
    let sum: f64 = rows.flat_map(|row| &values[row * width..][columns.clone()]).sum();
    sum / count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row of white pixels of which the first is noisy, with the standard deviation `spread`.
    fn film(spread: f64) -> Film {
        let mut film = Film::new(5, 1, 0, 0);
        film.segments.fill(16);
        for (at, pixel) in film.pixels.iter_mut().enumerate() {
            for sample in 0..16 {
                let sign = if sample % 2 == 0 { 1.0 } else { -1.0 };
                let noise = if at == 0 { sign * spread * (15.0_f64 / 16.0).sqrt() } else { 0.0 };
                pixel.add([1.0, 1.0 + noise, 1.0]);
            }
        }
        film
    }

    #[test]
    fn a_noisy_pixel_gets_more_its_neighbour_some_and_a_quiet_one_the_least() {
        let pilot = Pilot::of(&film(0.5));
        let allocation = pilot.allocate(100.0, None);
        let counts: Vec<u32> = (0..5).map(|pixel| allocation.of(pixel)).collect();
        let share = f64::from(counts[1]) / f64::from(counts[0]);
        assert!((share - (2.0_f64 / 3.0).sqrt()).abs() < 0.01, "1/3 and 1/2 of it, {counts:?}");
        assert!(counts[2] == counts[4] && counts[2] < counts[1], "{counts:?}");
        let total = allocation.total() as f64;
        assert!((total - 500.0).abs() <= 5.0, "{total}");
    }

    #[test]
    fn a_target_takes_no_more_samples_than_it_needs() {
        let pilot = Pilot::of(&film(0.5));
        let allocation = pilot.allocate(1e5, Some(0.01));
        let reached = pilot.error_of(&allocation);
        assert!(reached <= 0.01 && reached > 0.0099, "{reached}");
    }

    #[test]
    fn of_two_pixels_as_noisy_the_dearer_takes_fewer() {
        let mut film = film(0.0);
        for pixel in &mut film.pixels {
            pixel.add([1.0, 1.5, 1.0]);
        }
        film.segments.fill(17);
        film.segments[0] = 68;
        let allocation = Pilot::of(&film).allocate(1000.0, None);
        let ratio = f64::from(allocation.of(4)) / f64::from(allocation.of(0));
        assert!((ratio - 2.0).abs() < 0.01, "{ratio}");
    }

    #[test]
    fn a_black_picture_takes_the_least() {
        let mut film = Film::new(2, 2, 0, 0);
        film.pixels.iter_mut().for_each(|pixel| (0..16).for_each(|_| pixel.add([0.0; 3])));
        assert_eq!(Pilot::of(&film).allocate(1000.0, Some(0.01)).total(), 4 * 8);
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Allocation`]: how many samples each pixel takes.

use crate::film::Film;

/// How many samples each pixel takes, from a first round that is then thrown away.
///
/// A pixel whose samples decided how many it takes would be biased: it stops when they happen to
/// agree. So the samples that decide are not those that count.
pub(super) struct Allocation {
    counts: Vec<u32>,
}

impl Allocation {
    /// How many samples the first round has.
    pub const PILOT_SAMPLES: u32 = 16;

    /// As many samples, from [`Self::PILOT_SAMPLES`] to `most`, as bring each pixel's luminance to a
    /// standard error of `target`·(luminance + mean luminance of the picture).
    ///
    /// A pixel takes the largest variance among its neighbours and itself: 16 samples may all have
    /// missed what is bright and rare, but not all those round it.
    pub fn from_pilot(film: &Film, target: f64, most: u32) -> Self {
        let pixels = &film.pixels;
        let mean = pixels.iter().map(|pixel| pixel.mean()[1]).sum::<f64>() / pixels.len() as f64;
        let (width, height) = (film.width as usize, film.height as usize);
        let needed = |at: usize| {
            let (column, row) = (at % width, at / width);
            let rows = row.saturating_sub(1)..height.min(row + 2);
            let variance = rows
                .flat_map(|row| {
                    let columns = column.saturating_sub(1)..width.min(column + 2);
                    columns.map(move |column| row * width + column)
                })
                .map(|neighbour| {
                    let pixel = &pixels[neighbour];
                    pixel.standard_error()[1].powi(2) * f64::from(pixel.samples)
                })
                .fold(0.0, f64::max);
            let allowed = target * (pixels[at].mean()[1] + mean);
            let count = (variance / (allowed * allowed)).ceil();
            // A black picture allows nothing, and has no variance: 0/0 takes the least.
            (count.max(1.0) as u32).clamp(Self::PILOT_SAMPLES.min(most), most)
        };
        Self { counts: (0..pixels.len()).map(needed).collect() }
    }

    /// How many samples the pixel takes.
    pub fn of(&self, pixel: usize) -> u32 {
        self.counts[pixel]
    }

    /// All samples of all pixels.
    pub fn total(&self) -> u64 {
        self.counts.iter().map(|count| u64::from(*count)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_beside_a_noisy_one_takes_as_many_samples_and_a_quiet_one_the_least() {
        let mut film = Film::new(5, 1, 0, 0);
        for (at, pixel) in film.pixels.iter_mut().enumerate() {
            for sample in 0..16 {
                let noise = if at == 0 && sample == 3 { 16.0 } else { 0.0 };
                pixel.add([1.0, 1.0 + noise, 1.0]);
            }
        }
        let allocation = Allocation::from_pilot(&film, 0.05, 10_000);
        // Pixel 0 has the variance 16, mean 2; the picture's mean is 1.2.
        assert_eq!(allocation.of(0), (16.0_f64 / (0.05_f64 * 3.2).powi(2)).ceil() as u32);
        assert_eq!(allocation.of(1), (16.0_f64 / (0.05_f64 * 2.2).powi(2)).ceil() as u32);
        assert_eq!(allocation.of(2), Allocation::PILOT_SAMPLES);
    }

    #[test]
    fn a_black_picture_takes_the_least() {
        let mut film = Film::new(2, 2, 0, 0);
        film.pixels.iter_mut().for_each(|pixel| (0..16).for_each(|_| pixel.add([0.0; 3])));
        let allocation = Allocation::from_pilot(&film, 0.01, 1000);
        assert_eq!(allocation.total(), 4 * u64::from(Allocation::PILOT_SAMPLES));
    }
}

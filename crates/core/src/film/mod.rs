// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Film`]: what every pixel has gathered, as sums in the order of its samples; and
//! [`Receivers`], where flux is caught that leaves a scene.

mod receivers;

use crate::spectrum::{SampledSpectrum, SampledWavelengths, LANES};

pub use receivers::{DirectionCells, GroupSums, PlaneMap, Receivers, Spot, Spots, Xyz};

/// The sums of one pixel, over samples that come in batches: those of one batch may depend on each
/// other, batches do not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelSums {
    /// Σ X, Σ Y, Σ Z in cd/m².
    pub xyz: [f64; 3],
    /// How many samples.
    pub samples: u32,
    batches: u32,
    /// Σ s² over the sums s of batches, Σ n·s with their numbers of samples n, and Σ n².
    squares: [f64; 3],
    products: [f64; 3],
    squared_sizes: f64,
}

impl PixelSums {
    /// Add a sample's X, Y and Z, a batch of its own.
    pub fn add(&mut self, xyz: [f64; 3]) {
        self.add_batch(xyz, 1);
    }

    /// Add the sums of X, Y and Z of a batch of samples.
    pub fn add_batch(&mut self, sums: [f64; 3], samples: u32) {
        if samples == 0 {
            return;
        }
        let size = f64::from(samples);
        for (i, sum) in sums.into_iter().enumerate() {
            self.xyz[i] += sum;
            self.squares[i] += sum * sum;
            self.products[i] += size * sum;
        }
        self.squared_sizes += size * size;
        self.samples += samples;
        self.batches += 1;
    }

    /// The mean X, Y and Z; nothing where there is no sample.
    pub fn mean(&self) -> [f64; 3] {
        let n = f64::from(self.samples.max(1));
        self.xyz.map(|sum| sum / n)
    }

    /// The standard errors of the mean m, √(b/(b − 1)·Σ (s − n·m)²)/Σ n over b batches; infinite below
    /// two. For batches of one it is √(Σ (x − m)²/(b(b − 1))).
    ///
    /// Source: K.-Y. Liang and S. Zeger, "Longitudinal Data Analysis Using Generalized Linear Models",
    /// Biometrika 73(1), 1986 (the variance of a mean of clusters).
    pub fn standard_error(&self) -> [f64; 3] {
        if self.batches < 2 {
            return [f64::INFINITY; 3];
        }
        let (mean, batches) = (self.mean(), f64::from(self.batches));
        [0, 1, 2].map(|i| {
            let m = mean[i];
            let spread = self.squares[i] - 2.0 * m * self.products[i] + m * m * self.squared_sizes;
            (spread.max(0.0) * batches / (batches - 1.0)).sqrt() / f64::from(self.samples)
        })
    }

    /// The sums of the samples that a pixel would have whose mean is the sum of both means, with their
    /// standard errors.
    fn plus(&self, other: &Self) -> Self {
        let samples = self.samples.saturating_add(other.samples);
        let n = f64::from(samples.max(1));
        let means = [self.mean(), other.mean()];
        let errors = [self.standard_error(), other.standard_error()];
        let xyz = [0, 1, 2].map(|i| n * (means[0][i] + means[1][i]));
        let squares = [0, 1, 2].map(|i| {
            let variance = errors[0][i] * errors[0][i] + errors[1][i] * errors[1][i];
            variance * n * (n - 1.0) + xyz[i] * xyz[i] / n
        });
        Self { xyz, samples, batches: samples, squares, products: xyz, squared_sizes: n }
    }
}

/// The sums of a batch of one pixel's samples: of all light, and of each light group.
#[derive(Debug)]
pub struct Batch {
    xyz: [f64; 3],
    layers: Vec<[f64; 3]>,
    samples: u32,
}

impl Batch {
    /// Nothing yet, of so many light groups.
    pub fn new(layers: usize) -> Self {
        Self { xyz: [0.0; 3], layers: vec![[0.0; 3]; layers], samples: 0 }
    }

    /// Add a sample's X, Y and Z, and those of each light group.
    pub fn add(&mut self, xyz: [f64; 3], layers: &[[f64; 3]]) {
        let sums = std::iter::once(&mut self.xyz).chain(&mut self.layers);
        for (sum, value) in sums.zip(std::iter::once(&xyz).chain(layers)) {
            *sum = [0, 1, 2].map(|i| sum[i] + value[i]);
        }
        self.samples += 1;
    }

    /// Add the batch to a pixel, and begin another.
    pub fn close(&mut self, pixel: &mut PixelSums, layers: &mut [PixelSums]) {
        pixel.add_batch(self.xyz, self.samples);
        for (sums, own) in layers.iter_mut().zip(&self.layers) {
            sums.add_batch(*own, self.samples);
        }
        (self.xyz, self.samples) = ([0.0; 3], 0);
        self.layers.fill([0.0; 3]);
    }
}

/// The spectral sums of one pixel: LANES·`per_lane` bands of equal width.
#[derive(Debug)]
pub struct BandSums<'a> {
    /// Σ spectral radiance per band.
    pub sums: &'a mut [f64],
    /// How many samples each of the `per_lane` parts of a lane has.
    pub visits: &'a mut [u32],
}

impl BandSums<'_> {
    /// Add a sample of one of `phases` phases.
    pub fn add(
        &mut self,
        radiance: SampledSpectrum,
        wavelengths: SampledWavelengths,
        phases: usize,
    ) {
        let per_lane = self.visits.len();
        let part = wavelengths.phase * per_lane / phases;
        self.visits[part] += 1;
        for (lane, value) in radiance.0.into_iter().enumerate() {
            self.sums[lane * per_lane + part] += value;
        }
    }
}

/// A picture in the making.
#[derive(Debug)]
pub struct Film {
    /// Pixels along a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The sums, row by row from the upper left.
    pub pixels: Vec<PixelSums>,
    /// How many segments were followed for each pixel.
    pub segments: Vec<u64>,
    /// The sum of the luminance that was found where light had landed, for each pixel.
    pub landed: Vec<f64>,
    /// Bands per lane; 0 for a film without spectra.
    pub bands_per_lane: usize,
    /// The spectral sums, pixel by pixel, [`Film::bands`] for each.
    pub band_sums: Vec<f64>,
    /// How many samples each part of the lanes has, pixel by pixel.
    pub band_visits: Vec<u32>,
    /// How many light groups have sums of their own; 0 where the total is all there is.
    pub layers: usize,
    /// The sums of each light group, pixel by pixel, [`Film::layers`] for each.
    pub layer_sums: Vec<PixelSums>,
}

impl Film {
    /// An empty film.
    pub fn new(width: u32, height: u32, bands_per_lane: usize, layers: usize) -> Self {
        let count = width as usize * height as usize;
        Self {
            width,
            height,
            pixels: vec![PixelSums::default(); count],
            segments: vec![0; count],
            landed: vec![0.0; count],
            bands_per_lane,
            band_sums: vec![0.0; count * bands_per_lane * LANES],
            band_visits: vec![0; count * bands_per_lane],
            layers,
            layer_sums: vec![PixelSums::default(); count * layers],
        }
    }

    /// The picture that is the sum of pictures of the same form, taken independently: means add up, and
    /// so do the squares of standard errors.
    pub fn sum(films: Vec<Self>) -> Self {
        let mut films = films.into_iter();
        let Some(mut sum) = films.next() else {
            return Self::new(0, 0, 0, 0);
        };
        for film in films {
            let add = |own: &mut [PixelSums], other: &[PixelSums]| {
                own.iter_mut().zip(other).for_each(|(own, other)| *own = own.plus(other));
            };
            add(&mut sum.pixels, &film.pixels);
            add(&mut sum.layer_sums, &film.layer_sums);
            sum.segments.iter_mut().zip(&film.segments).for_each(|(own, other)| *own += other);
            let means = sum.band_means().into_iter().zip(film.band_means());
            sum.band_sums = means.map(|(own, other)| own + other).collect();
            sum.band_visits.fill(1);
        }
        sum
    }

    /// How many bands a pixel has.
    pub fn bands(&self) -> usize {
        self.bands_per_lane * LANES
    }

    /// The mean spectral radiance of every band of every pixel.
    ///
    /// In a film that was stopped early a band may have no sample yet: it takes the mean of its
    /// lane, and nothing where the pixel has no sample at all.
    pub fn band_means(&self) -> Vec<f64> {
        if self.bands_per_lane == 0 {
            return Vec::new();
        }
        let lanes = self.band_sums.chunks_exact(self.bands_per_lane);
        lanes
            .enumerate()
            .flat_map(|(at, sums)| {
                let first = at / LANES * self.bands_per_lane;
                let visits = &self.band_visits[first..first + self.bands_per_lane];
                let all = f64::from(visits.iter().sum::<u32>().max(1));
                let lane_mean = sums.iter().sum::<f64>() / all;
                sums.iter().zip(visits).map(move |(sum, &visits)| match visits {
                    0 => lane_mean,
                    n => sum / f64::from(n),
                })
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_standard_error_are_those_of_the_samples() {
        let mut sums = PixelSums::default();
        for value in [1.0, 2.0, 3.0, 6.0] {
            sums.add([value, 2.0 * value, 0.0]);
        }
        assert_eq!(sums.mean(), [3.0, 6.0, 0.0]);
        // The variance is 14/3, and that of the mean a quarter of it.
        let expected = (14.0_f64 / 12.0).sqrt();
        for (got, factor) in sums.standard_error().into_iter().zip([1.0, 2.0, 0.0]) {
            assert!((got - factor * expected).abs() < 1e-15);
        }
        let mut one = PixelSums::default();
        one.add([1.0; 3]);
        assert_eq!(one.standard_error(), [f64::INFINITY; 3]);
    }

    #[test]
    fn samples_that_are_alike_count_once() {
        let values = [1.0, 2.0, 3.0, 6.0];
        let [mut alone, mut alike] = [PixelSums::default(); 2];
        for value in values {
            alone.add([value; 3]);
            alike.add_batch([5.0 * value; 3], 5);
        }
        assert_eq!((alike.mean(), alike.samples), (alone.mean(), 20));
        let [alone, alike] = [alone, alike].map(|sums| sums.standard_error()[1]);
        assert!((alike / alone - 1.0).abs() < 1e-12, "{alike} {alone}");
    }

    #[test]
    fn batches_of_unlike_sizes_weigh_by_their_samples() {
        let mut sums = PixelSums::default();
        sums.add([1.0; 3]);
        sums.add_batch([9.0; 3], 3);
        // The mean is 10/4; the sums are 1.5 less and more than it makes one expect.
        let expected = (2.0_f64 * (1.5 * 1.5 + 1.5 * 1.5)).sqrt() / 4.0;
        assert!((sums.standard_error()[0] - expected).abs() < 1e-15);
    }

    #[test]
    fn a_sum_of_pictures_has_the_sum_of_means_and_the_sum_of_variances() {
        let mut films = [Film::new(1, 1, 1, 1), Film::new(1, 1, 1, 1)];
        let values: [&[f64]; 2] = [&[1.0, 2.0, 3.0], &[10.0, 30.0]];
        for (film, values) in films.iter_mut().zip(values) {
            for value in values {
                film.pixels[0].add([*value; 3]);
                film.layer_sums[0].add([0.5 * value; 3]);
                let mut bands =
                    BandSums { sums: &mut film.band_sums, visits: &mut film.band_visits };
                bands.add(SampledSpectrum::splat(*value), SampledWavelengths { phase: 0 }, 1);
            }
        }
        // Variances of the means: 1/3 and 100.
        let sum = Film::sum(films.into());
        let (mean, error) = (sum.pixels[0].mean()[1], sum.pixels[0].standard_error()[1]);
        assert!(
            (mean - 22.0).abs() < 1e-12 && (error - (100.0 + 1.0 / 3.0_f64).sqrt()).abs() < 1e-12
        );
        assert!((sum.layer_sums[0].mean()[0] - 11.0).abs() < 1e-12);
        assert_eq!(sum.band_means(), vec![22.0; LANES]);
        assert_eq!(sum.pixels[0].samples, 5);
    }

    #[test]
    fn each_phase_falls_into_the_band_of_its_wavelengths() {
        let mut film = Film::new(1, 1, 5, 0);
        let phases = 25;
        for phase in 0..phases {
            let wavelength = |lane: usize| (lane * phases + phase) as f64;
            let mut bands = BandSums { sums: &mut film.band_sums, visits: &mut film.band_visits };
            bands.add(SampledSpectrum::from_fn(wavelength), SampledWavelengths { phase }, phases);
        }
        let expected: Vec<f64> = (0..80).map(|band| f64::from(band * 5 + 2)).collect();
        assert_eq!(film.band_means(), expected);
    }

    #[test]
    fn a_band_without_a_sample_takes_the_mean_of_its_lane() {
        let mut film = Film::new(1, 1, 2, 0);
        let mut bands = BandSums { sums: &mut film.band_sums, visits: &mut film.band_visits };
        bands.add(SampledSpectrum::splat(3.0), SampledWavelengths { phase: 0 }, 2);
        assert_eq!(film.band_means(), vec![3.0; 2 * LANES]);
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Pilot`] and [`Allocation`]: how many samples each pixel takes.
//!
//! A first round of samples tells how noisy the picture is, and stays in it. A pixel whose own
//! samples decided how many more it takes would stop when they happen to agree, and be biased. So
//! the pixels are coloured like a chess board, and all that is decided about a pixel (its noise, its
//! cost, and the scale of both) comes from pixels of the other colour alone.
//!
//! Neighbours do not see a light of one pixel's size. A film whose samples are cheap has its first round
//! set aside, and other samples make the picture: there, each pixel decides with its neighbours.

use crate::film::{Film, PixelSums};
use crate::sampling::PixelSequence;

/// What a first round of samples tells of every pixel, on each of the films whose sum is the picture.
pub(super) struct Pilot {
    films: Vec<Trial>,
    width: usize,
}

/// What it tells of one film.
struct Trial {
    /// The standard deviation of one sample's luminance, relative to the pixel's tone, as the
    /// neighbours have it; the pixel itself, too, where its samples are not kept.
    noise: Vec<f64>,
    /// Segments that one sample takes, as those have it who decide.
    cost: Vec<f64>,
    /// The fewest samples of a pixel: those that it has, if they are kept.
    least: u32,
    /// Samples that every pixel took and that are not kept.
    set_aside: u32,
}

/// A first round of samples on one film.
pub(super) struct FirstRound<'a> {
    pub film: &'a Film,
    /// Whether it stays in the picture.
    pub is_kept: bool,
}

/// How many samples each pixel takes, those of the first round included.
pub(super) struct Allocation {
    counts: Vec<u32>,
}

/// The tone of a pixel is its luminance and this share of the picture's mean: a relative error of
/// black has no meaning.
const FLOOR: f64 = 0.01;

/// The tone of a pixel with this luminance in a picture of `pixels` with this mean. What is brighter than the
/// mean by more than the root of their number is not brighter here: else a pixel whose error no eye sees
/// would be most of the error of the picture's flux.
fn tone_of(luminance: f64, mean: f64, pixels: usize) -> f64 {
    (luminance + FLOOR * mean).min((pixels as f64).sqrt() * mean)
}

/// No pixel is taken to be quieter than this share of the mean noise, since its neighbours may have
/// missed what is bright and rare, nor louder than this multiple, since they may have met it by
/// chance.
const QUIETEST: f64 = 0.25;
const LOUDEST: f64 = 16.0;

/// Where a pixel's neighbours of the other colour lie, and how much they count.
const NEIGHBOURS: [(isize, isize, f64); 12] = [
    (-1, 0, 1.0),
    (1, 0, 1.0),
    (0, -1, 1.0),
    (0, 1, 1.0),
    (-2, -1, 0.25),
    (-2, 1, 0.25),
    (2, -1, 0.25),
    (2, 1, 0.25),
    (-1, -2, 0.25),
    (-1, 2, 0.25),
    (1, -2, 0.25),
    (1, 2, 0.25),
];

impl Pilot {
    /// The fewest and the most samples of every pixel in a first round.
    pub const FEWEST: u32 = 4;
    pub const MOST: u32 = 64;
    /// Its samples where it is not known how many there will be.
    pub const USUAL: u32 = 16;

    /// Read the first rounds of all films.
    pub fn of(rounds: &[FirstRound<'_>]) -> Self {
        let width = rounds[0].film.width as usize;
        let pixels = rounds[0].film.pixels.len();
        let of_kind = |is_kept: bool| {
            let mut sums = vec![0.0; pixels];
            for round in rounds.iter().filter(|round| round.is_kept == is_kept) {
                for (sum, pixel) in sums.iter_mut().zip(&round.film.pixels) {
                    *sum += pixel.mean()[1];
                }
            }
            sums
        };
        let [kept, set_aside] = [true, false].map(of_kind);
        let luminance: Vec<f64> = kept.iter().zip(&set_aside).map(|(a, b)| a + b).collect();
        let means = by_colour(&luminance, width);
        let tone = luminance.iter().enumerate();
        let tone: Vec<f64> =
            tone.map(|(at, own)| tone_of(*own, means[colour(at, width)], pixels)).collect();
        // Its own, by all that is set aside, and what is kept of the other colour.
        let found = set_aside.iter().sum::<f64>() / pixels as f64;
        let means = by_colour(&kept, width).map(|mean| mean + found);
        let own_tone = set_aside.iter().zip(round(&kept, width)).enumerate();
        let own_tone: Vec<f64> = own_tone
            .map(|(at, (a, b))| tone_of(a + b, means[1 - colour(at, width)], pixels))
            .collect();
        let mut films: Vec<Trial> =
            rounds.iter().map(|round| Trial::of(round, &tone, &own_tone)).collect();
        hold(&mut films, width);
        Self { films, width }
    }

    /// The samples, on each film, that bring the root mean square of the relative errors to `target`,
    /// or as low as the cost of `mean_samples` of every pixel on every film allows.
    ///
    /// The sum of squares Σ sᵢ²/nᵢ at the cost Σ nᵢ·cᵢ is least for nᵢ ∝ sᵢ/√cᵢ (Neyman), over the
    /// pixels of all films: so the films share what there is.
    pub fn allocate(&self, mean_samples: f64, target: Option<f64>) -> Vec<Allocation> {
        let scales = [0, 1].map(|colour| self.scale(colour, mean_samples, target));
        let counts = |trial: &Trial| {
            let pixels = 0..trial.noise.len();
            pixels.map(|at| trial.count(at, scales[colour(at, self.width)])).collect()
        };
        let allocations = self.films.iter().map(|trial| Allocation { counts: counts(trial) });
        allocations.collect()
    }

    /// The scale of the samples for the pixels of one colour.
    fn scale(&self, of_colour: usize, mean_samples: f64, target: Option<f64>) -> f64 {
        let all = 0..self.films[0].noise.len();
        let own: Vec<usize> = all.filter(|at| colour(*at, self.width) == of_colour).collect();
        let pixels = || self.films.iter().flat_map(|trial| own.iter().map(move |at| (trial, *at)));
        let left = |trial: &Trial| mean_samples - f64::from(trial.set_aside);
        let affordable: f64 = pixels().map(|(trial, at)| left(trial) * trial.cost[at]).sum();
        let suffices = |scale: f64| {
            let (mut cost, mut squares) = (0.0, 0.0);
            for (trial, at) in pixels() {
                let count = f64::from(trial.count(at, scale));
                cost += count * trial.cost[at];
                squares += trial.noise[at].powi(2) / count;
            }
            let number = own.len() as f64;
            cost >= affordable || target.is_some_and(|target| squares <= target * target * number)
        };
        let (mut low, mut high) = (0.0, 1.0);
        while high < 1e12 && !suffices(high) {
            (low, high) = (high, 2.0 * high);
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if suffices(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        high
    }
}

impl Trial {
    fn of(round: &FirstRound<'_>, tone: &[f64], own_tone: &[f64]) -> Self {
        let FirstRound { film, is_kept } = *round;
        let (width, pixels) = (film.width as usize, &film.pixels);
        let relative = |tone: &[f64]| -> Vec<f64> {
            let variance =
                |pixel: &PixelSums| pixel.standard_error()[1].powi(2) * f64::from(pixel.samples);
            let share = |(pixel, tone): (_, &f64)| {
                if *tone > 0.0 {
                    variance(pixel) / (tone * tone)
                } else {
                    0.0
                }
            };
            pixels.iter().zip(tone).map(share).collect()
        };
        let cost = film.segments.iter().zip(pixels);
        let cost = cost.map(|(segments, pixel)| *segments as f64 / f64::from(pixel.samples.max(1)));
        let mut cost: Vec<f64> = cost.map(|cost| cost.max(1.0)).collect();
        let mut variance = self::round(&relative(tone), width);
        let samples = pixels.iter().map(|pixel| pixel.samples).max().unwrap_or(0);
        let (least, set_aside) = if is_kept {
            cost = self::round(&cost, width);
            (samples, 0)
        } else {
            let own = relative(own_tone);
            variance.iter_mut().zip(own).for_each(|(round, own)| *round = round.max(own));
            (samples.min(Pilot::FEWEST), samples)
        };
        let noise = variance.iter().map(|variance| variance.sqrt()).collect();
        Self { noise, cost, least, set_aside }
    }

    fn count(&self, at: usize, scale: f64) -> u32 {
        const MOST: f64 = PixelSequence::MOST_SAMPLES as f64;
        let wanted = scale * self.noise[at] / self.cost[at].sqrt();
        wanted.ceil().clamp(f64::from(self.least), MOST.max(f64::from(self.least))) as u32
    }
}

impl Allocation {
    /// So many for each pixel.
    pub fn given(counts: Vec<u32>) -> Self {
        Self { counts }
    }

    /// How many samples the pixel takes.
    pub fn of(&self, pixel: usize) -> u32 {
        self.counts[pixel]
    }

    /// How many pixels take the sample `number`, counted from 0.
    pub fn taking(&self, number: u32) -> u64 {
        self.counts.iter().filter(|count| **count > number).count() as u64
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

/// Hold the noise of every pixel within bounds: of its film's mean from below, of the noisiest film's
/// mean from above.
fn hold(films: &mut [Trial], width: usize) {
    let means: Vec<_> = films.iter().map(|trial| by_colour(&trial.noise, width)).collect();
    let most = [0, 1].map(|colour| means.iter().map(|own| own[colour]).fold(0.0, f64::max));
    for (trial, own) in films.iter_mut().zip(&means) {
        // What its own samples met it did not meet by its neighbours' chance.
        let decides_itself = trial.set_aside > 0;
        for (at, noise) in trial.noise.iter_mut().enumerate() {
            let colour = colour(at, width);
            let loudest = if decides_itself { f64::INFINITY } else { LOUDEST * most[colour] };
            *noise = noise.clamp(QUIETEST * own[colour], loudest);
        }
    }
}

/// The colour of a pixel on the chess board.
fn colour(at: usize, width: usize) -> usize {
    (at % width + at / width) % 2
}

/// The mean of `values` over the pixels of each colour.
fn by_colour(values: &[f64], width: usize) -> [f64; 2] {
    [0, 1].map(|of_colour| {
        let own = values.iter().enumerate().filter(|(at, _)| colour(*at, width) == of_colour);
        let (count, sum) = own.fold((0, 0.0), |(count, sum), (_, value)| (count + 1, sum + value));
        sum / f64::from(count.max(1))
    })
}

/// The mean of the values round every pixel, without itself.
fn round(values: &[f64], width: usize) -> Vec<f64> {
    let height = values.len() / width;
    let mean = |at: usize| {
        let (column, row) = (at % width, at / width);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (right, down, weight) in NEIGHBOURS {
            let place = (column.checked_add_signed(right), row.checked_add_signed(down));
            let (Some(x), Some(y)) = place else {
                continue;
            };
            if x < width && y < height {
                sum += weight * values[y * width + x];
                weights += weight;
            }
        }
        sum / f64::max(weights, f64::MIN_POSITIVE)
    };
    (0..values.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: u32 = 12;

    /// A white picture of 16 samples a pixel, with the standard deviation `spread` of a sample by
    /// column and row.
    fn film(spread: impl Fn(u32, u32) -> f64) -> Film {
        let mut film = Film::new(SIZE, SIZE, 0, 0);
        film.segments.fill(16);
        for (at, pixel) in film.pixels.iter_mut().enumerate() {
            let deviation = spread(at as u32 % SIZE, at as u32 / SIZE) * (15.0_f64 / 16.0).sqrt();
            for sample in 0..16 {
                let sign = if sample % 2 == 0 { 1.0 } else { -1.0 };
                pixel.add([1.0, 1.0 + sign * deviation, 1.0]);
            }
        }
        film
    }

    fn pilot(film: &Film) -> Pilot {
        Pilot::of(&[FirstRound { film, is_kept: true }])
    }

    fn at(column: u32, row: u32) -> usize {
        (row * SIZE + column) as usize
    }

    #[test]
    fn a_pixel_never_decides_its_own_samples() {
        let quiet = film(|_, _| 0.1);
        let mut loud = film(|_, _| 0.1);
        let own = at(5, 5);
        for _ in 0..8 {
            loud.pixels[own].add([9.0; 3]);
            loud.pixels[own].add([0.0; 3]);
        }
        loud.pixels[own].samples = 16;
        loud.segments[own] = 1000;
        for target in [None, Some(0.01)] {
            let [quiet, loud] =
                [&quiet, &loud].map(|film| pilot(film).allocate(64.0, target).remove(0));
            assert_eq!(quiet.of(own), loud.of(own), "{target:?}");
            assert_ne!(quiet.of(at(5, 6)), loud.of(at(5, 6)), "{target:?}");
        }
    }

    #[test]
    fn a_pixel_whose_first_round_is_set_aside_decides_itself_and_by_nothing_that_is_kept() {
        let of = |kept: &Film, set_aside: &Film| {
            let rounds = [(kept, true), (set_aside, false)];
            let pilot = Pilot::of(&rounds.map(|(film, is_kept)| FirstRound { film, is_kept }));
            let counts = pilot.allocate(64.0, None);
            [counts[0].of(at(5, 5)), counts[1].of(at(5, 5))]
        };
        let quiet = film(|_, _| 0.1);
        let mut lone = film(|_, _| 0.1);
        let own = &mut lone.pixels[at(5, 5)];
        *own = PixelSums::default();
        (0..16).for_each(|sample| own.add([if sample == 3 { 500.0 } else { 1.0 }; 3]));
        let [_, found] = of(&quiet, &lone);
        let [_, missed] = of(&quiet, &quiet);
        assert!(found > 20 * missed, "{found} {missed}");
        assert_eq!(of(&lone, &quiet), of(&quiet, &quiet));
    }

    #[test]
    fn a_pixel_is_no_brighter_than_all_of_the_picture_s_noise_lets_it_be() {
        assert_eq!(tone_of(3.0, 100.0, 64), 4.0);
        assert_eq!(tone_of(1e9, 100.0, 64), 800.0);
    }

    #[test]
    fn counts_follow_the_noise_round_a_pixel_and_spend_what_there_is() {
        let film = film(|column, _| if column < 6 { 0.3 } else { 0.1 });
        let allocation = pilot(&film).allocate(200.0, None).remove(0);
        let ratio = f64::from(allocation.of(at(2, 6))) / f64::from(allocation.of(at(9, 6)));
        assert!((ratio - 3.0).abs() < 0.05, "{ratio}");
        let mean = allocation.total() as f64 / f64::from(SIZE * SIZE);
        assert!((mean - 200.0).abs() < 1.0, "{mean}");
    }

    #[test]
    fn a_target_takes_no_more_samples_than_it_needs() {
        let allocation = pilot(&film(|_, _| 0.5)).allocate(1e5, Some(0.01)).remove(0);
        // Relative to a tone of 1.01: (0.5/1.01/0.01)² samples.
        let expected = (0.5_f64 / 1.01 / 0.01).powi(2).ceil() as u32;
        assert!(allocation.counts.iter().all(|count| count.abs_diff(expected) <= 1));
    }

    #[test]
    fn where_walks_are_four_times_as_long_pixels_take_half_as_many() {
        let mut film = film(|_, _| 0.2);
        for (pixel, segments) in film.segments.iter_mut().enumerate() {
            *segments = if pixel % (SIZE as usize) < 6 { 64 } else { 16 };
        }
        let allocation = pilot(&film).allocate(1000.0, None).remove(0);
        let ratio = f64::from(allocation.of(at(9, 6))) / f64::from(allocation.of(at(2, 6)));
        assert!((ratio - 2.0).abs() < 0.01, "{ratio}");
    }

    #[test]
    fn a_black_picture_takes_the_least() {
        let mut film = Film::new(2, 2, 0, 0);
        film.pixels.iter_mut().for_each(|pixel| (0..16).for_each(|_| pixel.add([0.0; 3])));
        assert_eq!(pilot(&film).allocate(1000.0, Some(0.01))[0].total(), 4 * 16);
    }
}

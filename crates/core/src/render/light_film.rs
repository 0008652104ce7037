// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`LightFilm`]: the part of a picture that walks from lights show to the camera.
//!
//! Where the first thing that the eye sees is a rough boundary between transparent media, such as a
//! frosted cover, walks from the eye have two rough surfaces or more to guess through; walks from the
//! light have them behind them, and show the camera what arrives. Each path of light belongs to one of
//! the two.

use rayon::prelude::*;

use super::photometer::FROM_LIGHTS;
use super::settings::RenderSettings;
use super::Progress;
use crate::film::Film;
use crate::math::DVec2;
use crate::sampling::PixelSequence;
use crate::scene::Scene;
use crate::transport::{
    Carried, FluxError, Ledger, LightSource, LightWalk, Parted, PathSettings, Screen, Tally,
};

/// Independent repetitions of the picture: their spread is the standard error.
const BATCHES: usize = 16;
/// Keeps these walks and those of a photometer apart.
const TO_SHOW: u64 = 0x9E6C_63D0_876A_68DE;
/// The most paths of a batch between two looks at whether to stop.
const ROUND: u32 = 1 << 12;

/// The part of a picture that walks from lights show.
pub(super) struct LightFilm<'a> {
    scene: &'a Scene,
    walk: LightWalk<'a>,
    settings: &'a RenderSettings,
    batches: Vec<Batch>,
    /// The first path of every batch.
    first: u32,
    /// How many light groups have sums of their own; one sum is for all where nobody asks for layers.
    groups: usize,
}

/// One repetition.
#[derive(Clone)]
struct Batch {
    paths: u32,
    segments: u64,
    /// Σ X, Y, Z by pixel, then by light group.
    sums: Vec<[f64; 3]>,
}

/// What walks so far tell: the variance of one, relative to the picture's tone and summed over the
/// pixels, and what it costs in segments.
pub(super) struct LightTrial {
    pub variance: f64,
    pub cost: f64,
}

impl<'a> LightFilm<'a> {
    /// The paths of each batch that are walked before anything is told of them.
    pub const FEWEST: u32 = 64;
    /// The most of them.
    pub const MOST_OF_TRIAL: u32 = 1 << 14;

    /// Nothing shown yet.
    ///
    /// # Errors
    /// There is no visible flux.
    pub fn new(
        scene: &'a Scene,
        source: &'a LightSource,
        path: PathSettings,
        settings: &'a RenderSettings,
    ) -> Result<Self, FluxError> {
        let screen = Screen { width: settings.width, height: settings.height };
        let walk = LightWalk::new(scene, source, path.from_lights())?.shown_on(screen);
        let pixels = settings.width as usize * settings.height as usize;
        let groups = if settings.layers { scene.groups } else { 1 };
        let batch = Batch { paths: 0, segments: 0, sums: vec![[0.0; 3]; pixels * groups] };
        Ok(Self { scene, walk, settings, batches: vec![batch; BATCHES], first: 0, groups })
    }

    /// Forget what was shown, and go on with other walks.
    pub fn begin_anew(&mut self) {
        self.first += self.batches[0].paths;
        for Batch { paths, segments, sums } in &mut self.batches {
            (*paths, *segments) = (0, 0);
            sums.fill([0.0; 3]);
        }
    }

    /// Walk `more` paths of every batch, unless it is cancelled.
    pub fn walk(&mut self, more: u32, progress: &Progress) {
        let Self { scene, walk, settings, batches, first, groups } = self;
        let mut left = more;
        while left > 0 && !progress.is_cancelled() {
            let paths = left.min(ROUND);
            batches.par_iter_mut().enumerate().for_each(|(number, batch)| {
                batch.add((scene, walk, settings), number as u64, (*first, paths), *groups);
            });
            left -= paths;
        }
    }

    /// How many segments have been walked.
    pub fn segments(&self) -> u64 {
        self.batches.iter().map(|batch| batch.segments).sum()
    }

    /// How many paths every batch has walked.
    pub fn paths(&self) -> u32 {
        self.batches[0].paths
    }

    /// What the walks so far tell, for pixels of the `tone`.
    pub fn trial(&self, tone: &[f64]) -> LightTrial {
        let film = self.film(0);
        let paths = f64::from(self.paths()) * BATCHES as f64;
        let relative = film.pixels.iter().zip(tone).map(|(pixel, tone)| {
            if *tone > 0.0 {
                (pixel.standard_error()[1] / tone).powi(2)
            } else {
                0.0
            }
        });
        LightTrial {
            variance: relative.sum::<f64>() * paths,
            cost: self.segments() as f64 / paths.max(1.0),
        }
    }

    /// The paths of every batch that are nearest to so many of all together.
    pub fn per_batch(paths: f64) -> u32 {
        (paths / BATCHES as f64).ceil().clamp(1.0, f64::from(u32::MAX / 2)) as u32
    }

    /// The picture, with sums for `layers` light groups: every batch is one sample of each pixel.
    pub fn film(&self, layers: usize) -> Film {
        let mut film = Film::new(self.settings.width, self.settings.height, 0, layers);
        let groups = self.groups;
        for batch in self.batches.iter().filter(|batch| batch.paths > 0) {
            let mean = |sum: &[f64; 3]| sum.map(|value| value / f64::from(batch.paths));
            for (pixel, sums) in batch.sums.chunks_exact(groups).enumerate() {
                let mut all = [0.0; 3];
                for (group, sum) in sums.iter().map(mean).enumerate() {
                    all = [0, 1, 2].map(|i| all[i] + sum[i]);
                    if group < layers {
                        film.layer_sums[pixel * layers + group].add(sum);
                    }
                }
                film.pixels[pixel].add(all);
            }
        }
        film
    }
}

impl Batch {
    /// Walk paths `first` and on, after those that were walked, and add what they show.
    fn add(
        &mut self,
        (scene, walk, settings): (&Scene, &LightWalk<'_>, &RenderSettings),
        number: u64,
        (first, paths): (u32, u32),
        groups: usize,
    ) {
        let mut tally = Tally::new(scene.bodies.len());
        let mut ledgers = vec![Ledger::new(scene.bodies.len()); scene.groups];
        let seed = settings.seed ^ FROM_LIGHTS ^ TO_SHOW;
        let Self { paths: done, segments, sums } = self;
        for path in first + *done..first + *done + paths {
            let sampler = PixelSequence::Sobol.sampler(seed, number, path);
            let mut show = |part: &Parted<'_>| {
                let Carried::Shown(place) = part.what else {
                    return;
                };
                if part.flux.is_radiance() {
                    let xyz = scene.tristimulus(part.flux, part.wavelengths);
                    let group = part.group.min(groups - 1);
                    spread(settings, place, |pixel, weight| {
                        let sum = &mut sums[pixel * groups + group];
                        *sum = [0, 1, 2].map(|i| sum[i] + weight * xyz[i]);
                    });
                }
            };
            walk.walk(sampler, &mut tally, &mut ledgers, &mut show);
        }
        *done += paths;
        *segments += tally.segments();
    }
}

/// Give each pixel that gathers light from `place` its weight, per pixel.
fn spread(settings: &RenderSettings, place: DVec2, mut add: impl FnMut(usize, f64)) {
    let reach = settings.filter.reach();
    let range = |at: f64, size: u32| {
        let first = (at - reach - 0.5).ceil().max(0.0) as u32;
        let end = (at + reach - 0.5).floor() + 1.0;
        first..(end.max(0.0) as u32).min(size)
    };
    for row in range(place.y, settings.height) {
        for column in range(place.x, settings.width) {
            let middle = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let weight = settings.filter.density(place - middle);
            add(row as usize * settings.width as usize + column as usize, weight);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::PixelFilter;

    #[test]
    fn the_weights_of_a_place_add_up_to_one_on_average() {
        for filter in [PixelFilter::Box, PixelFilter::Tent, PixelFilter::Gaussian] {
            let settings = crate::render::settings::tests::of_size(8, 6, filter);
            let (mut sum, steps) = (0.0, 40);
            for i in 0..steps {
                for j in 0..steps {
                    let shift =
                        DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) / f64::from(steps);
                    spread(&settings, DVec2::splat(3.0) + shift, |_, weight| sum += weight);
                }
            }
            let mean = sum / f64::from(steps * steps);
            assert!((mean - 1.0).abs() < 2e-3, "{filter:?}: {mean}");
        }
    }

    #[test]
    fn a_place_outside_of_the_image_gives_what_its_filter_reaches() {
        let settings = crate::render::settings::tests::of_size(8, 6, PixelFilter::Tent);
        let mut seen = Vec::new();
        spread(&settings, DVec2::new(-0.25, 5.9), |pixel, weight| seen.push((pixel, weight)));
        assert_eq!(seen.len(), 1);
        assert_eq!(seen[0].0, 40);
        assert!((seen[0].1 - 0.25 * 0.6).abs() < 1e-12);
    }
}

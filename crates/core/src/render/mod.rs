// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Renders a scene onto a film, on several threads, with the same result from any number of them.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::Mutex;

use rayon::prelude::*;
use thiserror::Error;

use crate::film::{BandSums, Film, PixelSums};
use crate::math::DVec2;
use crate::sampling::{PixelFilter, PixelSequence};
use crate::scene::{Interior, Scene};
use crate::transport::{HallSettings, HallWalk, Tally};

/// What is rendered, and how finely.
#[derive(Clone, Debug)]
pub struct RenderSettings {
    /// Pixels along a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Which samples of every pixel.
    pub samples: Range<u32>,
    /// How they lie in the pixel.
    pub sequence: PixelSequence,
    /// How the pixel weighs its surroundings.
    pub filter: PixelFilter,
    /// What keys the random numbers.
    pub seed: u64,
    /// The method and how far it goes.
    pub hall: HallSettings,
    /// Spectral bands per lane on the film; 0 for none.
    pub bands_per_lane: usize,
    /// Threads; 0 takes one per core.
    pub threads: usize,
    /// How many neighbouring pixels one thread takes at a time.
    pub tile: usize,
}

/// Where a rendering stands, shared with whoever watches it.
#[derive(Debug, Default)]
pub struct Progress {
    /// How many samples are done, over all pixels.
    pub done: AtomicU64,
    /// Set it to stop: what is done stays.
    pub cancelled: AtomicBool,
}

impl Progress {
    /// Whether somebody asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// Why a rendering cannot start.
#[derive(Debug, Error)]
pub enum RenderError {
    /// The camera stands inside an opaque body.
    #[error("the camera is inside the opaque body {0:?}")]
    CameraInside(String),
    /// Rays are to be followed deeper than the stack of a thread allows.
    #[error("max_depth is at most {DEEPEST}, not {0}")]
    TooDeep(u32),
    /// The threads cannot be started.
    #[error("the threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// The most samples that a pixel takes before the next pixel has its turn.
const LONGEST_PASS: u32 = 64;

/// The most reflections and refractions that are followed.
pub const DEEPEST: u32 = 256;

/// The stack of a thread, in bytes. One level of a walk takes about 4 KiB.
const STACK: usize = 16 * 1024 * DEEPEST as usize;

/// Render `settings.samples` of every pixel of `scene`.
///
/// The samples of a pixel are summed in their order by whichever thread holds it, so the film
/// depends on the scene, the seed and the range of samples alone. A cancelled rendering returns
/// what it has.
///
/// # Errors
/// The camera is inside an opaque body, `max_depth` exceeds [`DEEPEST`], or no threads can be had.
pub fn render(
    scene: &Scene,
    settings: &RenderSettings,
    progress: &Progress,
) -> Result<(Film, Tally), RenderError> {
    if settings.hall.max_depth > DEEPEST {
        return Err(RenderError::TooDeep(settings.hall.max_depth));
    }
    let interior = scene
        .bodies_round(scene.camera.position())
        .map_err(|body| RenderError::CameraInside(scene.bodies[body as usize].name.clone()))?;
    let threads = rayon::ThreadPoolBuilder::new().num_threads(settings.threads);
    let pool = threads.stack_size(STACK).build()?;
    let mut film = Film::new(settings.width, settings.height, settings.bands_per_lane);
    let total = Mutex::new(Tally::new(scene.bodies.len()));
    for samples in passes(settings.samples.clone()) {
        if progress.is_cancelled() {
            break;
        }
        let pass = Pass { scene, settings, interior, samples, progress };
        let tally = pool.install(|| pass.run(&mut film));
        if let Ok(mut sum) = total.lock() {
            sum.add(&tally);
        }
    }
    Ok((film, total.into_inner().unwrap_or_default()))
}

/// Cut a range of samples into passes over the image: a first rough one, then longer ones.
fn passes(samples: Range<u32>) -> Vec<Range<u32>> {
    let mut passes = Vec::new();
    let (mut start, mut length) = (samples.start, 1);
    while start < samples.end {
        let end = samples.end.min(start + length);
        passes.push(start..end);
        start = end;
        length = (length * 2).min(LONGEST_PASS);
    }
    passes
}

/// Some samples of every pixel.
struct Pass<'a> {
    scene: &'a Scene,
    settings: &'a RenderSettings,
    interior: Interior,
    samples: Range<u32>,
    progress: &'a Progress,
}

impl Pass<'_> {
    fn run(&self, film: &mut Film) -> Tally {
        let tile = self.settings.tile.max(1);
        let (bands, per_lane) = (film.bands(), film.bands_per_lane);
        // A film without spectra lends every tile empty slices of these.
        let count = film.pixels.len().div_ceil(tile);
        let sums = split(&mut film.band_sums, tile * bands, count);
        let visits = split(&mut film.band_visits, tile * per_lane, count);
        film.pixels
            .par_chunks_mut(tile)
            .zip(sums)
            .zip(visits)
            .enumerate()
            .map(|(at, ((pixels, sums), visits))| {
                let mut tally = Tally::new(self.scene.bodies.len());
                for (i, pixel) in pixels.iter_mut().enumerate() {
                    let mut bands = BandSums {
                        sums: &mut sums[i * bands..(i + 1) * bands],
                        visits: &mut visits[i * per_lane..(i + 1) * per_lane],
                    };
                    if self.progress.is_cancelled() {
                        break;
                    }
                    self.expose((at * tile + i) as u64, pixel, &mut bands, &mut tally);
                }
                tally
            })
            .reduce(
                || Tally::new(self.scene.bodies.len()),
                |mut a, b| {
                    a.add(&b);
                    a
                },
            )
    }

    /// Add this pass's samples to one pixel.
    fn expose(
        &self,
        number: u64,
        pixel: &mut PixelSums,
        bands: &mut BandSums<'_>,
        tally: &mut Tally,
    ) {
        let settings = self.settings;
        let width = u64::from(settings.width);
        let centre = DVec2::new((number % width) as f64 + 0.5, (number / width) as f64 + 0.5);
        let phases = self.scene.phases();
        for sample in self.samples.clone() {
            let sampler = settings.sequence.sampler(settings.seed, number, sample);
            let place = centre + settings.filter.offset(sampler.pixel());
            let ray = self.scene.camera.ray(place, settings.width, settings.height);
            let wavelengths = sampler.wavelengths(phases);
            let start = (ray, self.interior);
            let radiance =
                HallWalk::radiance(self.scene, settings.hall, wavelengths, sampler, tally, start);
            if radiance.is_radiance() {
                pixel.add(self.scene.tristimulus(radiance, wavelengths));
                if !bands.visits.is_empty() {
                    bands.add(radiance, wavelengths, phases);
                }
            } else {
                tally.drop_sample(number, sample);
            }
        }
        let done = u64::from(self.samples.end - self.samples.start);
        self.progress.done.fetch_add(done, Ordering::Relaxed);
    }
}

/// Cut `values` into `count` slices of `size`, empty ones where `size` is 0.
fn split<T: Send>(values: &mut [T], size: usize, count: usize) -> Vec<&mut [T]> {
    if size == 0 {
        return (0..count).map(|_| <&mut [T]>::default()).collect();
    }
    values.chunks_mut(size).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_passes_cover_every_sample_once_and_start_small() {
        let passes = passes(3..203);
        let all: Vec<u32> = passes.iter().cloned().flatten().collect();
        assert_eq!(all, (3..203).collect::<Vec<u32>>());
        assert_eq!(passes[0].len(), 1);
        assert!(passes.iter().all(|pass| pass.len() <= LONGEST_PASS as usize));
    }
}

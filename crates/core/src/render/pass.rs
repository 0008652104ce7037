// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Pass`]: some samples of every pixel, over all threads.

use std::ops::Range;
use std::sync::atomic::Ordering;

use rayon::prelude::*;

use super::allocation::Allocation;
use super::settings::{Method, RenderSettings};
use super::Progress;
use crate::film::{BandSums, Batch, Film, PixelSums};
use crate::math::DVec2;
use crate::scene::{Interior, Scene};
use crate::transport::{
    Eye, Gathered, Guide, HallWalk, Part, PathSettings, PathWalk, Photons, Tally,
};

/// Some samples of every pixel.
pub(super) struct Pass<'a> {
    pub scene: &'a Scene,
    pub settings: &'a RenderSettings,
    /// The bodies that the eye is in.
    pub interior: Interior,
    /// Which of the light.
    pub part: Part,
    /// How walks for sharp light are spent, where that is apart.
    pub sharp: Option<PathSettings>,
    pub samples: Range<u32>,
    /// What keys their random numbers.
    pub seed: u64,
    /// How many samples each pixel takes in all, where that is not the same.
    pub limit: Option<&'a Allocation>,
    /// Where light comes from, for walks that know.
    pub guide: Option<&'a Guide>,
    /// What landed on surfaces for these samples, which are one batch then.
    pub photons: Option<&'a Photons>,
    pub progress: &'a Progress,
}

/// The sums of one pixel.
struct Exposure<'a> {
    pixel: &'a mut PixelSums,
    segments: &'a mut u64,
    landed: &'a mut f64,
    bands: BandSums<'a>,
    layers: &'a mut [PixelSums],
}

impl Pass<'_> {
    /// Add the samples to the film.
    pub fn run(&self, film: &mut Film) -> Tally {
        let tile = self.settings.tile.max(1);
        let (bands, per_lane, layers) = (film.bands(), film.bands_per_lane, film.layers);
        // A film without spectra or layers lends every tile empty slices of these.
        let count = film.pixels.len().div_ceil(tile);
        let sums = split(&mut film.band_sums, tile * bands, count);
        let visits = split(&mut film.band_visits, tile * per_lane, count);
        let layer_sums = split(&mut film.layer_sums, tile * layers, count);
        film.pixels
            .par_chunks_mut(tile)
            .zip(film.segments.par_chunks_mut(tile))
            .zip(film.landed.par_chunks_mut(tile))
            .zip(sums)
            .zip(visits)
            .zip(layer_sums)
            .enumerate()
            .map(|(at, (((((pixels, segments), landed), sums), visits), layer_sums))| {
                let mut tally = Tally::new(self.scene.bodies.len());
                let mut gathered = Gathered::new(layers);
                let mut batch = Batch::new(layers);
                let pixels = pixels.iter_mut().zip(segments).zip(landed);
                for (i, ((pixel, segments), landed)) in pixels.enumerate() {
                    if self.progress.is_cancelled() {
                        break;
                    }
                    let bands = BandSums {
                        sums: &mut sums[i * bands..(i + 1) * bands],
                        visits: &mut visits[i * per_lane..(i + 1) * per_lane],
                    };
                    let layers = &mut layer_sums[i * layers..(i + 1) * layers];
                    let exposure = Exposure { pixel, segments, landed, bands, layers };
                    let scratch = (&mut gathered, &mut batch);
                    self.expose(at * tile + i, exposure, scratch, &mut tally);
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

    /// The samples that this pass takes of a pixel.
    fn samples_of(&self, pixel: usize) -> Range<u32> {
        let Range { start, end } = self.samples;
        let first = self.settings.samples.start;
        let limit = self.limit.map(|allocation| first.saturating_add(allocation.of(pixel)));
        start..limit.unwrap_or(end).clamp(start, end)
    }

    fn expose(
        &self,
        number: usize,
        exposure: Exposure<'_>,
        (gathered, batch): (&mut Gathered, &mut Batch),
        tally: &mut Tally,
    ) {
        let Exposure { pixel, segments, landed, mut bands, layers } = exposure;
        let samples = self.samples_of(number);
        let phases = self.scene.phases();
        let done = u64::from(samples.end - samples.start);
        let before = tally.segments();
        for sample in samples {
            let wavelengths = self.take(number, sample, gathered, tally);
            let layers_are_sound = gathered.layers.iter().flatten().all(|value| value.is_finite());
            if !(gathered.radiance.is_radiance() && layers_are_sound) {
                tally.drop_sample(number as u64, sample);
                continue;
            }
            batch.add(self.scene.tristimulus(gathered.radiance, wavelengths), &gathered.layers);
            if self.photons.is_none() {
                batch.close(pixel, layers);
            }
            *landed += self.scene.tristimulus(gathered.landed, wavelengths)[1];
            if !bands.visits.is_empty() {
                bands.add(gathered.radiance, wavelengths, phases);
            }
        }
        batch.close(pixel, layers);
        *segments += tally.segments() - before;
        self.progress.done.fetch_add(done, Ordering::Relaxed);
    }

    /// Take one sample of a pixel and return its wavelengths.
    fn take(
        &self,
        number: usize,
        sample: u32,
        gathered: &mut Gathered,
        tally: &mut Tally,
    ) -> crate::spectrum::SampledWavelengths {
        let (scene, settings) = (self.scene, self.settings);
        let sampler = settings.sequence.sampler(self.seed, number as u64, sample);
        let sampler = match self.photons {
            Some(photons) => sampler.on_phase(photons.wavelengths()),
            None => sampler,
        };
        let wavelengths = sampler.wavelengths(scene.phases());
        let width = settings.width as usize;
        let centre = DVec2::new((number % width) as f64 + 0.5, (number / width) as f64 + 0.5);
        let place = centre + settings.filter.offset(sampler.pixel());
        let ray = scene.camera.ray(place, sampler.lens(), settings.width, settings.height);
        let start = (ray, self.interior);
        gathered.clear();
        match settings.method {
            Method::Hall(hall) => {
                gathered.radiance =
                    HallWalk::radiance(scene, hall, wavelengths, sampler, tally, start);
            }
            Method::Path(path) | Method::Lit(path) => {
                let Self { part, guide, photons, .. } = *self;
                let path = self.sharp.filter(|_| part == Part::Specular).unwrap_or(path);
                let eye = Eye { gathered, part, guide, photons };
                PathWalk::gather(scene, path, wavelengths, sampler, tally, eye, start);
            }
        }
        wavelengths
    }
}

/// Cut `values` into `count` slices of `size`, empty ones where `size` is 0.
fn split<T: Send>(values: &mut [T], size: usize, count: usize) -> Vec<&mut [T]> {
    if size == 0 {
        return (0..count).map(|_| <&mut [T]>::default()).collect();
    }
    values.chunks_mut(size).collect()
}

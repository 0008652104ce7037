// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Landings`]: for batches of samples of the pixels, the light that lands on surfaces.

use std::ops::Range;
use std::sync::Arc;

use crate::sampling::PixelSequence;
use crate::scene::Scene;
use crate::transport::{Crowd, FluxError, Landed, LightSource, LightWalk, PathSettings, Photons};

use super::settings::RenderSettings;
use super::trial::Trial;
use super::Progress;

/// Keeps the random numbers of phases apart from all others.
const TO_CHOOSE: u64 = 0xBB67_AE85_84CA_A73B;
/// Walks from lights for each time that a walk from the eye meets what landed.
const PER_MEETING: f64 = 2.0;
/// About how much may land at once: a bound to the memory.
const MOST_LANDED: f64 = 262_144.0;
/// The first samples each have walks of their own; later ones share what landed, as many as memory lets, but
/// no more than these. Of the photons in a disc a glossy surface answers few, at each place of the pixel others.
const ALONE: u32 = 16;
const MOST_TOGETHER: f64 = 8.0;
/// The walks of the trial.
const OF_TRIAL: u32 = 1 << 15;
/// The fewest walks from lights, and the fewest for each walk from the eye, whatever trials tell: they
/// can miss what is small.
const FEWEST: f64 = 1024.0;
const LEAST_SHARE: f64 = 0.5;
/// The first sample's radius is that of so many pixels at the mean distance of what landed, or that in
/// which one of its photons usually lands, whichever is more.
const PIXELS: f64 = 3.0;
/// How many of the trial's photons tell how far apart they land.
const PHOTONS: usize = 4;
/// Radii fall with the sample's number to this power: with −1/6, noise and blur vanish at one rate.
const SHRINKING: f64 = -1.0 / 6.0;

/// For batches of samples of the pixels, the light that lands on surfaces.
pub(super) struct Landings<'a> {
    scene: &'a Scene,
    walk: LightWalk<'a>,
    settings: &'a RenderSettings,
    progress: &'a Progress,
    /// Walks from lights for each walk from the eye.
    share: f64,
    most_paths: f64,
    /// How many samples share what landed.
    together: u32,
    first_radius: f64,
    crowd: Arc<Crowd>,
}

impl<'a> Landings<'a> {
    /// See how many walks from the eye meet what lands, and where that is.
    ///
    /// # Errors
    /// There is no visible flux.
    pub fn new(
        trial: Trial<'a>,
        source: &'a LightSource,
        path: PathSettings,
        progress: &'a Progress,
    ) -> Result<Self, FluxError> {
        let Trial { scene, settings, .. } = trial;
        let walk = LightWalk::new(scene, source, path.from_lights())?;
        let share = (PER_MEETING * trial.meetings(path)).max(LEAST_SHARE);
        let crowd = Arc::default();
        let mut own = Self {
            scene,
            walk,
            settings,
            progress,
            share,
            most_paths: 0.0,
            together: 1,
            first_radius: 0.0,
            crowd,
        };
        let trial = own.land(u32::MAX, OF_TRIAL);
        if trial.per_path() <= 0.0 {
            // Nothing that the trial found: the fewest walks will do.
            own.share = 0.0;
        }
        let distance = trial.mean_distance(scene.camera.position());
        let pixels = PIXELS * scene.camera.pixel_mm(distance, settings.height);
        own.most_paths = (MOST_LANDED / trial.per_path().max(1.0)).max(FEWEST);
        let each = f64::from(own.paths(1, settings.pixels()));
        own.together = (own.most_paths / each).clamp(1.0, MOST_TOGETHER) as u32;
        let fewer = each / f64::from(OF_TRIAL);
        let apart = trial.spacing(PHOTONS) / (PHOTONS as f64 * fewer).sqrt();
        own.first_radius = pixels.max(apart);
        let trial = Photons::new(trial, own.first_radius, 1.0, Arc::default());
        own.crowd = Arc::new(trial.crowd(scene));
        Ok(own)
    }

    /// The samples that share what landed with the sample `own`, counted from the first, and the number of
    /// their batch.
    pub fn batch(&self, own: u32) -> (u32, Range<u32>) {
        let Some(later) = own.checked_sub(ALONE) else {
            return (own, own..own + 1);
        };
        let start = own - later % self.together;
        (ALONE + later / self.together, start..start.saturating_add(self.together))
    }

    /// The light that lands for the batch `number` of samples, all of which count from the first; of all
    /// pixels together, it takes so many of them.
    pub fn of_batch(&self, number: u32, batch: &Range<u32>, taken: u64) -> Photons {
        let start = self.settings.samples.start;
        let shrunk = (f64::from(start) + f64::from(batch.end)).powf(SHRINKING);
        let number = start.saturating_add(number);
        let landed = self.land(number, self.paths(batch.len(), taken));
        Photons::new(landed, self.first_radius, shrunk, Arc::clone(&self.crowd)).kept_whole(
            self.scene,
            (self.settings.seed, number),
            &|| self.progress.is_cancelled(),
        )
    }

    /// How many walks from lights a batch of so many samples has, of which pixels take so many.
    fn paths(&self, samples: usize, taken: u64) -> u32 {
        let fewest = (FEWEST * samples as f64).min(self.most_paths);
        (self.share * taken as f64).clamp(fewest, self.most_paths) as u32
    }

    fn land(&self, number: u32, paths: u32) -> Landed {
        let seed = self.settings.seed;
        let sampler = PixelSequence::Sobol.sampler(seed ^ TO_CHOOSE, 0, number);
        let wavelengths = sampler.wavelengths(self.scene.phases());
        let is_cancelled = || self.progress.is_cancelled();
        Landed::walk(self.scene, &self.walk, (seed, number), wavelengths, paths, &is_cancelled)
    }
}

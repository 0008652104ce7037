// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Photometer`]: walks of a source's light in batches, and what its receivers caught of them.

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use thiserror::Error;

use super::settings::DEEPEST;
use super::Progress;
use crate::film::{GroupSums, Receivers};
use crate::sampling::PixelSequence;
use crate::scene::Scene;
use crate::transport::{
    Carried, FluxError, Ledger, LightSource, LightWalk, Parted, PathSettings, Tally,
};

/// Independent repetitions of the measurement: their spread is the standard error.
pub const BATCHES: usize = 32;

/// Keeps the random numbers of walks from lights and from the eye apart.
const FROM_LIGHTS: u64 = 0xA076_1D64_78BD_642F;

/// How long a round of all batches should take: what is done is looked at, and kept, in between.
const ROUND: Duration = Duration::from_millis(200);

/// The most paths of each batch in one round.
const LONGEST_ROUND: u32 = 1 << 14;

/// Why nothing can be measured.
#[derive(Debug, Error)]
pub enum MeasureError {
    /// There is no light.
    #[error(transparent)]
    Flux(#[from] FluxError),
    /// The sphere of the receivers cuts a body.
    #[error("the receivers stand {distance} mm from their centre, within the lamp: its bodies reach {reach} mm from there")]
    ReceiverInside {
        /// The radius of the sphere in mm.
        distance: f64,
        /// How far the box round all bodies reaches.
        reach: f64,
    },
    /// Walks are to be followed deeper than allowed.
    #[error("max_depth is at most {DEEPEST}, not {0}")]
    TooDeep(u32),
    /// The threads cannot be started.
    #[error("the threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// What one batch has walked and caught.
#[derive(Clone, Debug)]
pub struct Batch {
    /// How many paths.
    pub paths: u32,
    /// What was caught, by light group.
    pub groups: Vec<GroupSums>,
    /// Where the luminous flux went, by light group.
    pub ledgers: Vec<Ledger>,
    /// What happened to the rays.
    pub tally: Tally,
}

/// Walks of a source's light in [`BATCHES`] batches, each with random numbers of its own.
///
/// A path is keyed by (seed, batch, number of the path), and a batch adds its paths in their order
/// by whichever thread holds it: what is caught depends on the seed and the number of paths alone,
/// not on threads, nor on the calls that walked them.
pub struct Photometer {
    source: LightSource,
    receivers: Receivers,
    settings: PathSettings,
    seed: u64,
    batches: Vec<Batch>,
}

impl Photometer {
    /// Nothing walked yet.
    ///
    /// # Errors
    /// There is no visible flux, the receivers stand among the bodies, or the depth is too much.
    pub fn new(
        scene: &Scene,
        source: LightSource,
        receivers: Receivers,
        settings: PathSettings,
        seed: u64,
    ) -> Result<Self, MeasureError> {
        if settings.max_depth > DEEPEST {
            return Err(MeasureError::TooDeep(settings.max_depth));
        }
        if let (Some(bounds), Some(distance)) = (scene.bounds(), receivers.distance) {
            if !receivers.reach_round(bounds) {
                let reach = receivers.farthest(bounds);
                return Err(MeasureError::ReceiverInside { distance, reach });
            }
        }
        LightWalk::new(scene, &source, settings)?;
        let groups = source.groups(scene);
        let batch = Batch {
            paths: 0,
            groups: vec![GroupSums::new(&receivers); groups],
            ledgers: vec![Ledger::new(scene.bodies.len()); groups],
            tally: Tally::new(scene.bodies.len()),
        };
        Ok(Self { source, receivers, settings, seed, batches: vec![batch; BATCHES] })
    }

    /// What has been walked.
    pub fn batches(&self) -> &[Batch] {
        &self.batches
    }

    /// How many paths each batch has walked.
    pub fn paths_per_batch(&self) -> u32 {
        self.batches[0].paths
    }

    /// What catches it.
    pub fn receivers(&self) -> &Receivers {
        &self.receivers
    }

    /// What sends out the light.
    pub fn source(&self) -> &LightSource {
        &self.source
    }

    /// Walk `more` paths of every batch through `scene`, the one that this was made for. Stops, at
    /// the end of a round of all batches, when the time is up or it is cancelled.
    ///
    /// # Errors
    /// No threads can be had.
    pub fn walk(
        &mut self,
        scene: &Scene,
        more: u32,
        time_budget: Option<Duration>,
        threads: usize,
        progress: &Progress,
    ) -> Result<(), MeasureError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let Self { source, receivers, settings, seed, batches } = self;
        let walk = LightWalk::new(scene, source, *settings)?;
        let round = Round { walk, scene, receivers, seed: *seed ^ FROM_LIGHTS };
        let total = u64::from(more) * BATCHES as u64;
        progress.total.store(total, Ordering::Relaxed);
        let started = Instant::now();
        let (mut left, mut length) = (more, 8);
        while left > 0 && !progress.is_cancelled() {
            let began = Instant::now();
            let paths = length.min(left);
            pool.install(|| {
                batches.par_iter_mut().enumerate().for_each(|(number, batch)| {
                    round.add(number, batch, paths);
                });
            });
            left -= paths;
            progress.done.store(total - u64::from(left) * BATCHES as u64, Ordering::Relaxed);
            let took = began.elapsed().as_secs_f64();
            let mut wanted = ROUND.as_secs_f64();
            if let Some(budget) = time_budget {
                let rest = budget.as_secs_f64() - started.elapsed().as_secs_f64();
                wanted = wanted.min(rest);
            }
            let affordable = f64::from(paths) * wanted / took;
            if affordable < 1.0 && time_budget.is_some_and(|budget| started.elapsed() >= budget) {
                break;
            }
            length = (affordable as u32).clamp(1, LONGEST_ROUND).min(2 * paths);
        }
        Ok(())
    }
}

/// What every batch of a round needs.
struct Round<'a> {
    walk: LightWalk<'a>,
    scene: &'a Scene,
    receivers: &'a Receivers,
    seed: u64,
}

impl Round<'_> {
    /// Walk the next `paths` of a batch.
    fn add(&self, number: usize, batch: &mut Batch, paths: u32) {
        let Batch { paths: done, groups, ledgers, tally } = batch;
        let phases = self.scene.phases();
        for path in *done..*done + paths {
            let sampler = PixelSequence::Sobol.sampler(self.seed, number as u64, path);
            let mut is_sound = true;
            let mut receive = |part: &Parted<'_>| {
                let Carried::Left(ray) = part.what else {
                    return;
                };
                if !part.flux.is_radiance() {
                    is_sound = false;
                    return;
                }
                let xyz = self.scene.tristimulus(part.flux, part.wavelengths);
                let (flux, phase) = ((part.flux, xyz), (part.wavelengths, phases));
                self.receivers.catch(&mut groups[part.group], ray, flux, phase);
            };
            self.walk.walk(sampler, tally, ledgers, &mut receive);
            if !is_sound {
                tally.drop_sample(number as u64, path);
            }
        }
        *done += paths;
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Rendering: samples of all pixels, over threads, with the same result for any number of them.

mod allocation;
mod features;
mod pass;
mod photometer;
mod settings;
mod snapshot;

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use thiserror::Error;

use crate::film::Film;
use crate::scene::{Interior, Scene};
use crate::transport::Tally;
use allocation::{Allocation, Pilot};
use pass::Pass;

pub use features::{features, Features};
pub use photometer::{Batch, MeasureError, Photometer, BATCHES};
pub use settings::{Method, RenderSettings, DEEPEST};
pub use snapshot::{Outlook, Snapshot, Viewfinder};

/// Where a rendering stands, shared with whoever watches it.
#[derive(Debug, Default)]
pub struct Progress {
    /// How many samples are done, over all pixels.
    pub done: AtomicU64,
    /// How many there will be, as far as is known yet.
    pub total: AtomicU64,
    /// Set it to stop: what is done stays.
    pub cancelled: AtomicBool,
    /// Shows the picture in the making.
    pub viewfinder: Viewfinder,
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
    /// Rays are to be followed deeper than allowed.
    #[error("max_depth is at most {deepest}, not {asked}")]
    TooDeep {
        /// The limit of the method.
        deepest: u32,
        /// What was asked for.
        asked: u32,
    },
    /// The threads cannot be started.
    #[error("the threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// The stack of a thread, in bytes. One level of Hall's recursion takes about 4 KiB.
const STACK: usize = 16 * 1024 * settings::DEEPEST_HALL as usize;

/// What a rendering brought.
#[derive(Debug)]
pub struct Rendered {
    /// The picture.
    pub film: Film,
    /// What happened to the rays.
    pub tally: Tally,
}

/// Render `scene`.
///
/// The samples of a pixel are summed in their order by whichever thread holds it, so the film
/// depends on the scene, the seed and the range of samples alone. Where samples are allotted, a
/// first round tells how many each pixel takes. With a time budget the
/// clock chooses the number of samples, and nothing else. A cancelled rendering returns what it has.
///
/// # Errors
/// The camera is inside an opaque body, the depth exceeds [`DEEPEST`], or no threads can be had.
pub fn render(
    scene: &Scene,
    settings: &RenderSettings,
    progress: &Progress,
) -> Result<Rendered, RenderError> {
    settings.check()?;
    let interior = eye_interior(scene)?;
    let threads = rayon::ThreadPoolBuilder::new().num_threads(settings.threads);
    let pool = threads.stack_size(STACK).build()?;
    pool.install(|| Ok(Rendering { scene, settings, interior, progress }.run()))
}

/// The bodies that the eye is in.
fn eye_interior(scene: &Scene) -> Result<Interior, RenderError> {
    let name = |body: u32| RenderError::CameraInside(scene.bodies[body as usize].name.clone());
    scene.bodies_round(scene.camera.position()).map_err(name)
}

struct Rendering<'a> {
    scene: &'a Scene,
    settings: &'a RenderSettings,
    interior: Interior,
    progress: &'a Progress,
}

impl Rendering<'_> {
    fn run(&self) -> Rendered {
        let started = Instant::now();
        let samples = self.settings.samples.clone();
        self.expect(self.pixels() * samples.len() as u64);
        let mut film = self.settings.new_film(self.scene);
        let mut tally = Tally::new(self.scene.bodies.len());
        let pilot_samples = self.pilot_samples();
        if !self.settings.adaptive || pilot_samples == samples.len() as u32 {
            self.expose(&mut film, &mut tally, samples, self.settings.time_budget, None);
            return Rendered { film, tally };
        }
        let rest = samples.start + pilot_samples;
        self.expose(&mut film, &mut tally, samples.start..rest, None, None);
        if !self.progress.is_cancelled() {
            let allocation = self.allocate(&Pilot::of(&film), pilot_samples, started);
            self.expect(allocation.total());
            let range = rest..samples.start.saturating_add(allocation.most());
            self.expose(&mut film, &mut tally, range, None, Some(&allocation));
        }
        Rendered { film, tally }
    }

    /// How many samples of every pixel the first round has: a quarter of all where their number is
    /// known. A picture of one pixel has no neighbours to learn from.
    fn pilot_samples(&self) -> u32 {
        let samples = self.settings.samples.len() as u32;
        let is_open = self.settings.target_error.is_some() || self.settings.time_budget.is_some();
        let wanted = if is_open { Pilot::USUAL } else { samples / 4 };
        if self.pixels() == 1 {
            samples
        } else {
            wanted.clamp(Pilot::FEWEST, Pilot::MOST).min(samples)
        }
    }

    /// Allot samples, or time, as the first round says.
    fn allocate(&self, pilot: &Pilot, pilot_samples: u32, started: Instant) -> Allocation {
        let mut affordable = self.settings.samples.len() as f64;
        if let Some(budget) = self.settings.time_budget {
            let share = budget.as_secs_f64() / started.elapsed().as_secs_f64();
            affordable = affordable.min(f64::from(pilot_samples) * share);
        }
        pilot.allocate(affordable, self.settings.target_error)
    }

    fn pixels(&self) -> u64 {
        u64::from(self.settings.width) * u64::from(self.settings.height)
    }

    fn expect(&self, samples: u64) {
        self.progress.total.store(samples, Ordering::Relaxed);
    }

    /// Take samples of every pixel, as many of them as it is allotted or as the time allows.
    fn expose(
        &self,
        film: &mut Film,
        tally: &mut Tally,
        samples: Range<u32>,
        time_budget: Option<Duration>,
        limit: Option<&Allocation>,
    ) {
        let started = Instant::now();
        let (mut next, mut length) = (samples.start, 1);
        let is_counted = limit.is_some() || !self.settings.adaptive && time_budget.is_none();
        let at_end = |pixel| limit.map_or(samples.len() as u32, |counts| counts.of(pixel));
        while next < samples.end && !self.progress.is_cancelled() {
            let end = samples.end.min(next + length);
            let Self { scene, settings, interior, progress } = *self;
            let pass = Pass { scene, settings, interior, samples: next..end, limit, progress };
            let pass_started = Instant::now();
            tally.add(&pass.run(film));
            next = end;
            self.progress.viewfinder.show(|| Snapshot::of(film, is_counted.then_some(at_end)));
            length = self.progress.viewfinder.next_length(length, pass_started.elapsed());
            if let Some(budget) = time_budget {
                let spent = started.elapsed().as_secs_f64();
                let left = (budget.as_secs_f64() - spent) / spent;
                let affordable = (left * f64::from(next - samples.start)) as u32;
                if affordable == 0 {
                    break;
                }
                // Half of what is left at a time: how long a sample takes is only an estimate.
                length = length.min(affordable.div_ceil(2));
            }
        }
    }
}

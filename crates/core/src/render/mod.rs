// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Rendering: samples of all pixels, over threads, with the same result for any number of them.

mod allocation;
mod features;
mod learning;
mod light_film;
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
use crate::transport::{Guide, Ledger, LightSource, Part, Shining, Tally};
use allocation::{Allocation, Pilot};
use light_film::LightFilm;
use pass::Pass;

pub use features::{features, Features};
pub use learning::learn;
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
    /// Not every pixel has a count of samples.
    #[error("there are {counts} counts of samples for {pixels} pixels")]
    Counts {
        /// How many pixels there are.
        pixels: usize,
        /// How many counts there are.
        counts: usize,
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
    pool.install(|| {
        let began = Instant::now();
        let guide = learning::guide(scene, settings, progress);
        let (guide, source) = (guide.as_deref(), LightSource::from(Shining::of(scene)));
        let shown = light_film(scene, &source, settings);
        let leaves_rough = shown.is_some();
        let rendering =
            Rendering { scene, settings, interior, guide, leaves_rough, progress, began };
        Ok(rendering.run(shown))
    })
}

/// The film of walks from lights, where these have a part: in a picture without spectra whose samples
/// are allotted, if something rough and transparent is there.
fn light_film<'a>(
    scene: &'a Scene,
    source: &'a LightSource,
    settings: &'a RenderSettings,
) -> Option<LightFilm<'a>> {
    let Method::Lit(path) = settings.method else {
        return None;
    };
    let is_for_it = settings.allots() && settings.bands_per_lane == 0 && scene.has_rough_glass();
    is_for_it.then(|| LightFilm::new(scene, source, path, settings).ok()).flatten()
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
    guide: Option<&'a Guide>,
    /// Whether walks from lights show what they send through rough boundaries.
    leaves_rough: bool,
    progress: &'a Progress,
    began: Instant,
}

/// A part of the light, and the film that gathers it.
struct Exposure {
    part: Part,
    film: Film,
    /// How many samples each pixel takes in all, once that is decided.
    limit: Option<Allocation>,
}

impl Rendering<'_> {
    fn run(&self, shown: Option<LightFilm<'_>>) -> Rendered {
        let samples = self.settings.samples.clone();
        let new = |part: &Part| Exposure {
            part: *part,
            film: self.settings.new_film(self.scene),
            limit: None,
        };
        let mut exposures: Vec<Exposure> = self.settings.parts().iter().map(new).collect();
        let mut tally = Tally::new(self.scene.bodies.len());
        if let Some(counts) = &self.settings.counts {
            for exposure in &mut exposures {
                exposure.limit = Some(Allocation::given(counts.clone()));
            }
            self.expose(&mut exposures, &mut tally, samples.start..u32::MAX, None, None);
            return Rendered::of(exposures, None, tally);
        }
        let pilot_samples = self.pilot_samples();
        if !self.settings.allots() || pilot_samples == samples.len() as u32 {
            self.expose(&mut exposures, &mut tally, samples, self.settings.time_budget, None);
            return Rendered::of(exposures, None, tally);
        }
        let eyes = Instant::now();
        let first = samples.start..samples.start + pilot_samples;
        let rest = self.expose_first(&mut exposures, &mut tally, first);
        let pilot_samples = rest - samples.start;
        let mut shown = shown;
        if !self.progress.is_cancelled() {
            let affordable = self.affordable(pilot_samples, eyes.elapsed());
            let paths = self.allocate(&mut exposures, shown.as_mut(), affordable);
            if let Some(shown) = &mut shown {
                shown.begin_anew();
                shown.walk(LightFilm::per_batch(paths), self.progress);
            }
            self.expose(&mut exposures, &mut tally, rest..u32::MAX, None, shown.as_ref());
        }
        Rendered::of(exposures, shown, tally)
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

    /// The first round, as far as a quarter of the time allows; the number of the sample after it.
    fn expose_first(
        &self,
        exposures: &mut [Exposure],
        tally: &mut Tally,
        samples: Range<u32>,
    ) -> u32 {
        // No spread is known of fewer than two.
        let second = samples.end.min(samples.start + 2);
        self.expose(exposures, tally, samples.start..second, None, None);
        let quarter = self.settings.time_budget.map(|budget| {
            (budget / 4).saturating_sub(self.began.elapsed()).max(Duration::from_nanos(1))
        });
        self.expose(exposures, tally, second..samples.end, quarter, None).max(second)
    }

    /// How many samples of every pixel can be had, if those of the first round took so long.
    fn affordable(&self, pilot_samples: u32, took: Duration) -> f64 {
        let most = self.settings.samples.len() as f64;
        self.settings.time_budget.map_or(most, |budget| {
            let left = budget.as_secs_f64() - self.began.elapsed().as_secs_f64();
            let more = (left / took.as_secs_f64()).max(0.0);
            most.min(f64::from(pilot_samples) * (1.0 + more))
        })
    }

    /// Allot samples, or time, as the first round says; how many walks from lights there are to be.
    fn allocate(
        &self,
        exposures: &mut [Exposure],
        shown: Option<&mut LightFilm<'_>>,
        affordable: f64,
    ) -> f64 {
        let films: Vec<&Film> = exposures.iter().map(|exposure| &exposure.film).collect();
        let mut pilot = Pilot::of(&films);
        if let Some(shown) = shown {
            let segments = films.iter().flat_map(|film| &film.segments).sum::<u64>();
            let mut more = LightFilm::FEWEST;
            while shown.segments() < segments / 4 && !self.progress.is_cancelled() {
                shown.walk(more, self.progress);
                more = shown.paths();
            }
            pilot.share_with(shown.trial(&pilot.tone));
        }
        let (allocations, paths) = pilot.allocate(affordable, self.settings.target_error);
        for (exposure, allocation) in exposures.iter_mut().zip(allocations) {
            exposure.limit = Some(allocation);
        }
        paths
    }

    fn pixels(&self) -> u64 {
        u64::from(self.settings.width) * u64::from(self.settings.height)
    }

    /// Take samples of every pixel on all films, as many of them as are allotted or as the time allows.
    fn expose(
        &self,
        exposures: &mut [Exposure],
        tally: &mut Tally,
        samples: Range<u32>,
        time_budget: Option<Duration>,
        shown: Option<&LightFilm<'_>>,
    ) -> u32 {
        let started = Instant::now();
        let most = |exposure: &Exposure| {
            let limit = exposure.limit.as_ref();
            limit.map_or(samples.end, |limit| {
                self.settings.samples.start.saturating_add(limit.most())
            })
        };
        let end = exposures.iter().map(most).max().unwrap_or(samples.end).min(samples.end);
        let all = |exposure: &Exposure| {
            let each = self.pixels() * u64::from(end.saturating_sub(samples.start));
            exposure.limit.as_ref().map_or(each, Allocation::total)
        };
        self.progress.total.store(exposures.iter().map(all).sum(), Ordering::Relaxed);
        let (mut next, mut length) = (samples.start, 1);
        let is_counted = !self.settings.allots() && time_budget.is_none();
        let each = is_counted.then_some(samples.len() as u32);
        while next < end && !self.progress.is_cancelled() {
            let until = end.min(next + length);
            let pass_started = Instant::now();
            let Self { scene, settings, interior, guide, leaves_rough, progress, .. } = *self;
            for Exposure { part, film, limit } in &mut *exposures {
                let (part, limit) = (*part, limit.as_ref());
                let samples = next..until;
                let pass = Pass {
                    scene,
                    settings,
                    interior,
                    part,
                    samples,
                    limit,
                    leaves_rough,
                    guide,
                    progress,
                };
                let mut own = pass.run(film);
                if part == Part::Specular {
                    // Its walks end half-way; those of the other part go all the way.
                    own.ledger = Ledger::new(scene.bodies.len());
                }
                tally.add(&own);
            }
            next = until;
            self.progress.viewfinder.show(|| self.snapshot(exposures, shown, each));
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
        next.min(end)
    }
}

impl Rendered {
    fn of(exposures: Vec<Exposure>, shown: Option<LightFilm<'_>>, mut tally: Tally) -> Self {
        let layers = exposures[0].film.layers;
        let mut films: Vec<Film> = exposures.into_iter().map(|exposure| exposure.film).collect();
        if let Some(shown) = shown {
            films.push(shown.film(layers));
            tally.eye_rays += shown.segments();
        }
        Self { film: Film::sum(films), tally }
    }
}

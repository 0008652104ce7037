// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Rendering`]: the films of a picture's parts, a first round of samples, and what it allots.

use std::ops::Range;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use super::allocation::{Allocation, FirstRound, Pilot};
use super::landings::Landings;
use super::pass::Pass;
use super::settings::RenderSettings;
use super::snapshot::Snapshot;
use super::{Progress, Rendered};
use crate::film::Film;
use crate::scene::{Interior, Scene};
use crate::transport::{Guide, Ledger, Part, PathSettings, Photons, Tally};

/// Keeps the random numbers of what is set aside and of all others apart.
const TO_SET_ASIDE: u64 = 0xA54F_F53A_5F1D_36F1;
/// The most samples between two looks at the clock.
const MOST_TIMED: u32 = 8;

/// A picture in the making.
pub(super) struct Rendering<'a> {
    pub scene: &'a Scene,
    pub settings: &'a RenderSettings,
    pub interior: Interior,
    pub guide: Option<&'a Guide>,
    /// How walks for sharp light are spent, where that is apart.
    pub sharp: Option<PathSettings>,
    /// What lands on surfaces, for the scattered part.
    pub landings: Option<Landings<'a>>,
    pub progress: &'a Progress,
    pub began: Instant,
}

/// A part of the light, and the film that gathers it.
pub(super) struct Exposure {
    pub part: Part,
    pub film: Film,
    /// What keys its random numbers.
    seed: u64,
    /// How many samples each pixel takes in all, once that is decided.
    pub limit: Option<Allocation>,
    /// Samples of all pixels that it took and that are not on the film.
    set_aside: u64,
}

impl Exposure {
    /// Whether its first round stays in the picture: walks for sharp light are short, and what they look for
    /// may be no larger than a pixel, so that no neighbour knows.
    fn keeps_first_round(&self) -> bool {
        self.part != Part::Specular
    }

    fn first_round(&self) -> FirstRound<'_> {
        FirstRound { film: &self.film, is_kept: self.keeps_first_round() }
    }
}

impl Rendering<'_> {
    /// Expose all films, and add them up.
    pub fn run(&self) -> Rendered {
        let samples = self.settings.samples.clone();
        let parts = self.settings.parts().iter();
        let mut exposures: Vec<Exposure> = parts.map(|part| self.new_exposure(*part)).collect();
        let mut tally = Tally::new(self.scene.bodies.len());
        if let Some(counts) = &self.settings.counts {
            for exposure in &mut exposures {
                exposure.limit = Some(Allocation::given(counts.clone()));
            }
            self.expose(&mut exposures, &mut tally, samples.start..u32::MAX, None);
            return Rendered::of(exposures, tally);
        }
        let Some(pilot_samples) = self.settings.first_round() else {
            self.expose(&mut exposures, &mut tally, samples, self.settings.time_budget);
            return Rendered::of(exposures, tally);
        };
        let eyes = Instant::now();
        // What one batch is has one error: rounds do not part it.
        let end = samples.end.min(self.whole(samples.start + pilot_samples));
        let first = samples.start..end;
        for exposure in exposures.iter_mut().filter(|exposure| !exposure.keeps_first_round()) {
            exposure.seed ^= TO_SET_ASIDE;
        }
        let rest = self.expose_first(&mut exposures, &mut tally, first);
        let pilot_samples = rest - samples.start;
        if !self.progress.is_cancelled() {
            let affordable = self.affordable(pilot_samples, eyes.elapsed());
            self.allocate(&mut exposures, affordable);
            self.begin_anew(&mut exposures, &mut tally, samples.start..rest);
            self.expose(&mut exposures, &mut tally, rest..u32::MAX, None);
        }
        Rendered::of(exposures, tally)
    }

    fn new_exposure(&self, part: Part) -> Exposure {
        let (film, seed) = (self.settings.new_film(self.scene), self.settings.seed);
        Exposure { part, film, seed, limit: None, set_aside: 0 }
    }

    /// Set aside the first `samples` where they are not kept, and take others in their place.
    fn begin_anew(&self, exposures: &mut [Exposure], tally: &mut Tally, samples: Range<u32>) {
        for exposure in exposures.iter_mut().filter(|exposure| !exposure.keeps_first_round()) {
            let set_aside = self.pixels() * u64::from(samples.end - samples.start);
            let limit = exposure.limit.take();
            let mut anew = Exposure { limit, set_aside, ..self.new_exposure(exposure.part) };
            tally.add(&self.expose_part(&mut anew, samples.clone()));
            if self.progress.is_cancelled() {
                return;
            }
            *exposure = anew;
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
        self.expose(exposures, tally, samples.start..second, None);
        let quarter =
            self.settings.time_budget.map(|all| (all / 4).saturating_sub(self.began.elapsed()));
        if quarter.is_some_and(|left| left.is_zero()) {
            return second;
        }
        self.expose(exposures, tally, second..samples.end, quarter).max(second)
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

    /// Allot samples, or time, as the first round says.
    fn allocate(&self, exposures: &mut [Exposure], affordable: f64) {
        let rounds: Vec<FirstRound<'_>> = exposures.iter().map(Exposure::first_round).collect();
        let pilot = Pilot::of(&rounds);
        let allocations = pilot.allocate(affordable, self.settings.target_error);
        for (exposure, allocation) in exposures.iter_mut().zip(allocations) {
            exposure.limit = Some(allocation);
        }
    }

    /// Whether what was allotted takes more time than there is: how long it takes is only an estimate.
    fn is_overdue(&self) -> bool {
        let budget = self.settings.time_budget;
        budget.is_some_and(|budget| self.began.elapsed() > budget + budget / 10)
    }

    fn pixels(&self) -> u64 {
        self.settings.pixels()
    }

    /// Take samples of every pixel on all films, as many of them as are allotted or as the time allows.
    fn expose(
        &self,
        exposures: &mut [Exposure],
        tally: &mut Tally,
        samples: Range<u32>,
        time_budget: Option<Duration>,
    ) -> u32 {
        let started = Instant::now();
        let most = |exposure: &Exposure| {
            let limit = exposure.limit.as_ref();
            limit.map_or(samples.end, |limit| {
                self.settings.samples.start.saturating_add(limit.most())
            })
        };
        let end = exposures.iter().map(most).max().unwrap_or(samples.end).min(samples.end);
        // Until samples are allotted there will be about as many as were asked for, if a number was.
        let known = if self.settings.is_open() { end } else { self.settings.samples.end };
        let each = self.pixels() * u64::from(known.saturating_sub(self.settings.samples.start));
        let all = |exposure: &Exposure| {
            exposure.set_aside + exposure.limit.as_ref().map_or(each, Allocation::total)
        };
        self.progress.total.store(exposures.iter().map(all).sum(), Ordering::Relaxed);
        let (mut next, mut length) = (samples.start, 1);
        let is_counted = !self.settings.allots() && time_budget.is_none();
        let each = is_counted.then_some(samples.len() as u32);
        while next < end && !self.progress.is_cancelled() {
            let until = end.min(self.whole(next + length));
            let pass_started = Instant::now();
            for exposure in &mut *exposures {
                tally.add(&self.expose_part(exposure, next..until));
            }
            next = until;
            self.progress.viewfinder.show(|| Snapshot::so_far(exposures, each));
            length = self.progress.viewfinder.next_length(length, pass_started.elapsed());
            if self.settings.time_budget.is_some() {
                // So that it is seen when the time is over.
                length = length.min(MOST_TIMED);
            }
            if self.is_overdue() {
                break;
            }
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

impl Rendering<'_> {
    /// The end of the batch that the sample before `end` belongs to.
    fn whole(&self, end: u32) -> u32 {
        let first = self.settings.samples.start;
        self.landings
            .as_ref()
            .map_or(end, |landings| first.saturating_add(landings.batch(end - 1 - first).1.end))
    }

    /// Take samples of one part of the light.
    fn expose_part(&self, exposure: &mut Exposure, samples: Range<u32>) -> Tally {
        let Self { scene, settings, interior, guide, sharp, progress, .. } = *self;
        let Exposure { part, film, seed, limit, .. } = exposure;
        let (part, seed, limit) = (*part, *seed, limit.as_ref());
        let mut run = |samples: Range<u32>, photons: Option<&Photons>| {
            let pass = Pass {
                scene,
                settings,
                interior,
                part,
                sharp,
                samples,
                seed,
                limit,
                guide,
                photons,
                progress,
            };
            pass.run(film)
        };
        let mut tally = Tally::new(scene.bodies.len());
        match &self.landings {
            Some(landings) if part == Part::Scattered => {
                let first = settings.samples.start;
                let mut next = samples.start;
                while next < samples.end && !progress.is_cancelled() {
                    let (number, batch) = landings.batch(next - first);
                    let until = samples.end.min(first.saturating_add(batch.end));
                    let taken = |own| limit.map_or(self.pixels(), |limit| limit.taking(own));
                    let all = (next - first..until - first).map(taken).sum();
                    if all == 0 {
                        // Only the other part has pixels with so many samples.
                        break;
                    }
                    let photons = landings.of_batch(number, &batch, all);
                    tally.add(&run(next..until, Some(&photons)));
                    tally.eye_rays += photons.segments();
                    next = until;
                }
            }
            _ => tally.add(&run(samples, None)),
        }
        if part == Part::Specular {
            // Its walks end half-way; those of the other part go all the way.
            tally.ledger = Ledger::new(scene.bodies.len());
        }
        tally
    }
}

impl Rendered {
    /// The sum of all parts.
    fn of(exposures: Vec<Exposure>, tally: Tally) -> Self {
        let mut found = Vec::new();
        let mut films = Vec::new();
        for Exposure { part, film, .. } in exposures {
            let landed = mean_landed(&film);
            found.push((Found::by_eye(part), mean_luminance(&film) - landed));
            if part == Part::Scattered {
                found.push((Found::Landed, landed));
            }
            films.push(film);
        }
        Self { film: Film::sum(films), tally, found }
    }
}

/// How the light of a picture was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// By walks from the eye, of any kind.
    ByEye,
    /// By walks from the eye, in mirrors and through smooth glass alone.
    Specular,
    /// By walks from the eye that were turned at random.
    Scattered,
    /// By walks from lights, which landed where walks from the eye met them.
    Landed,
}

impl Found {
    fn by_eye(part: Part) -> Self {
        match part {
            Part::All => Self::ByEye,
            Part::Specular => Self::Specular,
            Part::Scattered => Self::Scattered,
        }
    }
}

/// The mean luminance of what was found where it had landed, in cd/m².
fn mean_landed(film: &Film) -> f64 {
    let means = film.landed.iter().zip(&film.pixels);
    let means = means.map(|(landed, pixel)| landed / f64::from(pixel.samples.max(1)));
    means.sum::<f64>() / film.pixels.len().max(1) as f64
}

/// The mean luminance of a film's pixels, in cd/m².
fn mean_luminance(film: &Film) -> f64 {
    let sum = film.pixels.iter().map(|pixel| pixel.mean()[1]).sum::<f64>();
    sum / film.pixels.len().max(1) as f64
}

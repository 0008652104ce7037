// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Photons`]: light that landed on surfaces, kept for walks from the eye to meet there.
//!
//! A matt floor behind a lens is lit by ways that no walk from the eye finds: it would have to leave
//! in just the direction that the lens mirrors into a die. Walks from the lights land there by
//! themselves. So the two meet: a walk from the eye takes the light that landed within a small disc
//! round the place where it arrives. Light that came to opaque matter by refraction alone, or straight,
//! is met behind rough boundaries alone: elsewhere walks from the eye find it without any blur.
//!
//! Every batch of samples has photons of its own, so that batches are independent, and its discs
//! are smaller than those before it: the blur goes to nothing, and so does the noise.
//!
//! Source: H. Jensen, "Global Illumination using Photon Maps", EGWR 1996; T. Hachisuka and H. Jensen,
//! "Stochastic Progressive Photon Mapping", ACM TOG 28(5), 2009; C. Knaus and M. Zwicker, "Progressive
//! Photon Mapping: A Probabilistic Approach", ACM TOG 30(3), 2011 (radii that shrink by themselves).

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::disc::{cell, Cell, Crowd, Disc};
use super::flux::LightWalk;
use super::ledger::Ledger;
use super::path::Carried;
use super::tally::Tally;
use crate::math::{DVec3, IVec3};
use crate::sampling::PixelSequence;
use crate::scene::{BodyId, Scene};
use crate::spectrum::{SampledSpectrum, SampledWavelengths};

/// Keeps the random numbers of these walks and of all others apart.
const TO_LAND: u64 = 0x6A09_E667_F3BC_C909;
/// The same for the places that are drawn round what landed.
const TO_FIT: u64 = 0x510E_527F_ADE6_82D1;
/// Walks that land are independent of threads in so many batches.
const BATCHES: u32 = 16;
/// So many of the discs in a cell tell whether surfaces end near it; each looks in four directions, turned by
/// a share of a turn that leaves no gaps.
const LOOKED_AT: usize = 8;
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// A first disc is no larger than this share of the middle of its body's three extents.
const OF_BODY: f64 = 0.25;

/// Where light landed.
#[derive(Clone, Copy, Debug)]
pub struct Landing {
    /// The place, in mm.
    pub position: DVec3,
    /// The unit vector back to where it came from.
    pub direction: DVec3,
    /// The surface's true normal, out of its body: the two faces of a film are not one.
    pub normal: DVec3,
    /// Its shading normal, on the same side.
    pub shading: DVec3,
    /// The body whose surface it is.
    pub body: BodyId,
    /// Whether it came to opaque matter by refraction alone, or straight.
    pub is_straight: bool,
    /// Σ 1/f, in sr, of the ground behind it where walks from the eye may meet it, too.
    pub rivals: f64,
}

/// Light that landed.
#[derive(Clone, Copy, Debug)]
struct Photon {
    at: Landing,
    /// Its share of the spectral flux of all walks together.
    flux: SampledSpectrum,
    group: usize,
}

/// The light that landed from some walks.
#[derive(Debug)]
pub struct Landed {
    photons: Vec<Photon>,
    wavelengths: SampledWavelengths,
    /// How many walks there were, and their segments.
    paths: u32,
    segments: u64,
}

impl Landed {
    /// Walk light of the lanes `wavelengths`, with random numbers that no other `number` has. What was
    /// cancelled is not to be used.
    pub fn walk(
        scene: &Scene,
        walk: &LightWalk<'_>,
        (seed, number): (u64, u32),
        wavelengths: SampledWavelengths,
        paths: u32,
        is_cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Self {
        let each = paths.div_ceil(BATCHES);
        let share = 1.0 / f64::from(each * BATCHES);
        // These are met behind rough glass alone.
        let keeps_straight = scene.has_rough_glass();
        let batches: Vec<(Vec<Photon>, u64)> = (0..BATCHES)
            .into_par_iter()
            .map(|batch| {
                let mut tally = Tally::new(scene.bodies.len());
                let mut ledgers = vec![Ledger::new(scene.bodies.len()); scene.groups];
                let mut photons = Vec::new();
                let own = u64::from(number) * u64::from(BATCHES) + u64::from(batch);
                for path in (0..each).take_while(|_| !is_cancelled()) {
                    let sampler = PixelSequence::Sobol.sampler(seed ^ TO_LAND, own, path);
                    let sampler = sampler.on_phase(wavelengths);
                    walk.walk(sampler, &mut tally, &mut ledgers, &mut |part| {
                        let Carried::Landed(at) = part.what else {
                            return;
                        };
                        if keeps_straight || !at.is_straight {
                            photons.push(Photon { at, flux: part.flux * share, group: part.group });
                        }
                    });
                }
                photons.retain(|photon| photon.flux.is_radiance());
                (photons, tally.segments())
            })
            .collect();
        let segments = batches.iter().map(|(_, segments)| segments).sum();
        let photons = batches.into_iter().flat_map(|(own, _)| own).collect();
        Self { photons, wavelengths, paths: each * BATCHES, segments }
    }

    /// How often a walk landed, on average.
    pub fn per_path(&self) -> f64 {
        self.photons.len() as f64 / f64::from(self.paths.max(1))
    }

    /// How far from `eye` it landed on average, in mm.
    pub fn mean_distance(&self, eye: DVec3) -> f64 {
        let sum: f64 = self.photons.iter().map(|photon| photon.at.position.distance(eye)).sum();
        sum / self.photons.len().max(1) as f64
    }

    /// The largest radius of a first disc on each body: a share of its middle extent, as far as light landed
    /// there.
    fn largest_discs(&self) -> FxHashMap<BodyId, f64> {
        let mut boxes = FxHashMap::<BodyId, [DVec3; 2]>::default();
        for Photon { at: Landing { position, body, .. }, .. } in &self.photons {
            let [low, high] = boxes.entry(*body).or_insert([*position; 2]);
            (*low, *high) = (low.min(*position), high.max(*position));
        }
        let radius = |[low, high]: [DVec3; 2]| {
            let mut extents = (high - low).to_array();
            extents.sort_by(f64::total_cmp);
            OF_BODY * extents[1]
        };
        boxes.into_iter().map(|(body, own)| (body, radius(own))).collect()
    }

    /// The usual distance, in mm, within which `count` others landed.
    pub fn spacing(&self, count: usize) -> f64 {
        const PROBES: usize = 64;
        let step = self.photons.len().div_ceil(PROBES).max(1);
        let probes: Vec<&Photon> = self.photons.iter().step_by(step).collect();
        let mut distances: Vec<f64> = probes
            .par_iter()
            .filter_map(|probe| {
                let to = |photon: &Photon| photon.at.position.distance(probe.at.position);
                let mut all: Vec<f64> = self.photons.iter().map(to).collect();
                (all.len() > count).then(|| *all.select_nth_unstable_by(count, f64::total_cmp).1)
            })
            .collect();
        distances.sort_by(f64::total_cmp);
        distances.get(distances.len() / 2).copied().unwrap_or(0.0)
    }
}

/// The light that landed for one batch of samples of the pixels.
#[derive(Debug)]
pub struct Photons {
    landed: Landed,
    /// Where each of them landed, once more and close together: most of them are only looked at for that.
    places: Vec<DVec3>,
    /// Which of them lie in each cell of a grid; cells are as wide as a disc's radius.
    cells: FxHashMap<IVec3, Range<usize>>,
    radius: f64,
    /// How much smaller discs are than the first ones.
    shrunk: f64,
    crowd: Arc<Crowd>,
}

impl Photons {
    /// What `landed`, to be met within discs that are `shrunk` from the radius of the `first`, in mm;
    /// smaller ones in a `crowd`.
    pub fn new(mut landed: Landed, first: f64, shrunk: f64, crowd: Arc<Crowd>) -> Self {
        let radius = (first * shrunk).max(f64::MIN_POSITIVE);
        let keyed = landed.photons.par_iter().enumerate();
        let keyed = keyed.map(|(at, photon)| (cell(photon.at.position, radius).to_array(), at));
        let mut order: Vec<([i32; 3], usize)> = keyed.collect();
        order.par_sort_unstable();
        landed.photons = order.par_iter().map(|(_, at)| landed.photons[*at]).collect();
        let places = landed.photons.par_iter().map(|photon| photon.at.position).collect();
        let mut cells = FxHashMap::default();
        let mut first = 0;
        for run in order.chunk_by(|(a, _), (b, _)| a == b) {
            cells.insert(IVec3::from(run[0].0), first..first + run.len());
            first += run.len();
        }
        Self { landed, places, cells, radius, shrunk, crowd }
    }

    /// Let what landed near edges weigh more, so that none of it is lost beyond them; with random numbers that
    /// no other `number` has. What was cancelled is not to be used.
    #[must_use]
    pub fn kept_whole(
        mut self,
        scene: &Scene,
        (seed, number): (u64, u32),
        is_cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Self {
        let weight = |(at, photon): (usize, &Photon)| {
            let Landing { position, normal, body, .. } = photon.at;
            let disc = self.disc(position, normal, body);
            if is_cancelled() {
                return 1;
            }
            let sampler = PixelSequence::Sobol.sampler(seed ^ TO_FIT, at as u64, number);
            disc.makes_good(scene, sampler)
        };
        let weights: Vec<u32> = self.landed.photons.par_iter().enumerate().map(weight).collect();
        for (photon, weight) in self.landed.photons.iter_mut().zip(weights) {
            photon.flux *= f64::from(weight);
        }
        self
    }

    /// Nothing landed.
    pub fn none() -> Self {
        let wavelengths = SampledWavelengths { phase: 0 };
        let nothing = Landed { photons: Vec::new(), wavelengths, paths: 0, segments: 0 };
        Self::new(nothing, 1.0, 1.0, Arc::default())
    }

    /// The lanes on which it can be met.
    pub fn wavelengths(&self) -> SampledWavelengths {
        self.landed.wavelengths
    }

    /// How many segments were walked for it.
    pub fn segments(&self) -> u64 {
        self.landed.segments
    }

    /// Where more lands than it takes, and where surfaces end, for other walks.
    pub fn crowd(&self, scene: &Scene) -> Crowd {
        let per_path = 1.0 / f64::from(self.landed.paths.max(1));
        let most = self.landed.largest_discs();
        let is_cut = |at: usize| {
            let Landing { position, normal, body, .. } = self.landed.photons[at].at;
            let radius = most.get(&body).map_or(self.radius, |most| most.min(self.radius));
            let disc = Disc { position, normal, body, radius, is_whole: false };
            disc.is_cut(scene, at as f64 * GOLDEN)
        };
        let known = |own: &Range<usize>| Cell {
            // Of a flat surface, a cell holds about its square.
            density: own.len() as f64 * per_path / self.radius.powi(2),
            has_edges: own.clone().step_by(own.len().div_ceil(LOOKED_AT)).any(is_cut),
        };
        let cells = self.cells.par_iter().map(|(cell, own)| (*cell, known(own))).collect();
        Crowd { width: self.radius, cells, most }
    }

    /// The disc round a place on the surface of a body, with the true `normal` out of it.
    pub fn disc(&self, position: DVec3, normal: DVec3, body: BodyId) -> Disc {
        let at_once = (self.shrunk, self.landed.paths);
        let (most, is_whole) = self.crowd.disc(position, body, at_once);
        Disc { position, normal, body, radius: self.radius.min(most), is_whole }
    }

    /// Hand on what landed on a disc: where it came from, its flux per m² there, and its light group.
    pub fn on(&self, disc: &Disc, mut found: impl FnMut(&Landing, SampledSpectrum, usize)) {
        let Disc { position, radius, .. } = *disc;
        let [low, high] = [-radius, radius].map(|r| cell(position + r, self.radius));
        let steps = high.wrapping_sub(low) + IVec3::ONE;
        for index in 0..steps.element_product() {
            let (x, rest) = (index % steps.x, index / steps.x);
            let step = IVec3::new(x, rest % steps.y, rest / steps.y);
            let Some(own) = self.cells.get(&low.wrapping_add(step)) else {
                continue;
            };
            for index in own.clone() {
                let Some(per_m2) = disc.weight(self.places[index]) else {
                    continue;
                };
                let Photon { at, flux, group } = &self.landed.photons[index];
                if disc.is_along(at.normal) {
                    found(at, *flux * per_m2, *group);
                }
            }
        }
    }
}

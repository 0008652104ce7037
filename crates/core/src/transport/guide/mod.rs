// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Guide`]: where light comes from, learned from walks of the light itself.
//!
//! A walk from the eye that turns at a rough surface does not know that the filament is behind the
//! bulb's glass there, or which way the die is seen through its collimator. Walks from the lights do:
//! every time that one arrives at a rough surface or scatters in a body, it shows a direction that
//! light came from, and how far away its source seems to be. From such arrivals the guide learns, for
//! each region of space, a mixture of lobes ([`Region`]). Half of the directions drawn there are drawn
//! from it, and all are weighted by the density of the whole mixture: whatever was learned, the
//! picture tends to the same, and is only calmer.
//!
//! Arrivals are learned from and thrown away; none is counted as light.
//!
//! Source: H. Jensen, "Importance Driven Path Tracing using the Photon Map", EGWR 1995; J. Vorba et
//! al., "On-line Learning of Parametric Mixture Models for Light Transport Simulation", ACM TOG 33(4),
//! 2014.

mod fit;
mod lobe;
mod tree;

use rayon::prelude::*;

use super::flux::{FluxError, LightSource, LightWalk};
use super::ledger::Ledger;
use super::path::{Carried, PathSettings};
use super::tally::Tally;
use crate::math::DVec3;
use crate::sampling::{pick, PixelSequence};
use crate::scene::Scene;
use fit::MOST_LOBES;
use lobe::Lobe;
use tree::Tree;

/// Keeps the random numbers of learning and of all other walks apart.
const TO_LEARN: u64 = 0x2545_F491_4F6C_DD1D;
/// Walks that learn are independent of threads in so many batches.
const BATCHES: u64 = 32;
/// How many arrivals are enough, and after how many segments there is an end of it, where each round doubles
/// what was walked before; light that is walled in where it starts takes none, and ends by its paths.
const ENOUGH: usize = 1 << 16;
const MOST_SEGMENTS: u64 = 1 << 19;
const MOST_PATHS: u32 = 1 << 15;
/// After so many segments, where only one in so many ends where a walk may be guided, guiding matters
/// little.
const SOON: u64 = 1 << 16;
const RARE: u64 = 64;
/// The most arrivals of a region, and the fewest that one can learn from.
const MOST: usize = 400;
const FEWEST: usize = 16;
/// A lobe is chosen as if this share of the largest answer were added to its own.
const MISJUDGED: f64 = 0.05;

/// Light that was seen to arrive where a walk turns at random.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// The place, in mm.
    pub position: DVec3,
    /// The unit vector back to where it came from.
    pub direction: DVec3,
    /// How far it has come, in mm, since it started or turned at random.
    pub way: f64,
    /// How much the eye gets of it.
    pub weight: f64,
}

impl Arrival {
    /// Where it would come from if it had gone straight on: behind a plane mirror, the mirror image.
    fn origin(&self) -> DVec3 {
        self.position + self.direction * self.way
    }
}

/// Where light comes from, for every place.
#[derive(Clone, Debug)]
pub struct Guide {
    tree: Tree,
    regions: Vec<Region>,
}

/// Where light comes from in one region.
#[derive(Clone, Debug)]
pub struct Region {
    lobes: Vec<Lobe>,
    /// Their shares of the light, together 1.
    shares: Vec<f64>,
}

impl Region {
    fn of(arrivals: &[Arrival]) -> Self {
        if arrivals.len() < FEWEST {
            return Self { lobes: Vec::new(), shares: Vec::new() };
        }
        let (lobes, shares) = fit::lobes(arrivals).into_iter().unzip();
        Self { lobes, shares }
    }

    /// The light at `place`, of which a vertex there passes on what `answer` says by direction.
    pub fn answered(&self, place: DVec3, answer: impl Fn(DVec3) -> f64) -> Answered<'_> {
        let mut sums = [0.0; MOST_LOBES];
        let mut most = 0.0_f64;
        for (sum, lobe) in sums.iter_mut().zip(&self.lobes) {
            *sum = answer(lobe.origin.from(place));
            most = most.max(*sum);
        }
        // A wide lobe may have what is answered beside its middle.
        let (floor, mut total) = (MISJUDGED * most.max(f64::MIN_POSITIVE), 0.0);
        for (sum, share) in sums.iter_mut().zip(&self.shares) {
            total += share * (*sum + floor);
            *sum = total;
        }
        Answered { region: self, place, sums }
    }
}

/// The light of a region, weighted by what becomes of it at a vertex.
pub struct Answered<'a> {
    region: &'a Region,
    place: DVec3,
    /// The sums of the lobes' weights up to and with each.
    sums: [f64; MOST_LOBES],
}

impl Answered<'_> {
    /// A direction towards light, for `u` uniform in the unit cube.
    pub fn sample(&self, [u, v, w]: [f64; 3]) -> DVec3 {
        let (lobe, _) = pick(&self.sums[..self.region.lobes.len()], u);
        self.region.lobes[lobe].sample(self.place, [v, w])
    }

    /// The density of `sample`, per steradian.
    pub fn pdf(&self, direction: DVec3) -> f64 {
        let mut before = 0.0;
        let parts = self.region.lobes.iter().zip(&self.sums).map(|(lobe, sum)| {
            let share = sum - before;
            before = *sum;
            share * lobe.pdf(self.place, direction)
        });
        let sum: f64 = parts.sum();
        sum / before
    }
}

impl Guide {
    /// Learn from walks of `source`. What is learned depends on the scene, the settings and the seed
    /// alone, unless it `is_cancelled`.
    ///
    /// # Errors
    /// There is no visible flux.
    pub fn learn(
        scene: &Scene,
        source: &LightSource,
        settings: PathSettings,
        seed: u64,
        is_cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Result<Self, FluxError> {
        let walk = LightWalk::new(scene, source, settings.from_lights())?;
        let groups = source.groups(scene);
        let mut batches = vec![(Vec::new(), Tally::new(scene.bodies.len())); BATCHES as usize];
        let (mut done, mut paths) = (0, 64);
        while !is_cancelled() {
            batches.par_iter_mut().enumerate().for_each(|(number, (arrivals, tally))| {
                let mut ledgers = vec![Ledger::new(scene.bodies.len()); groups];
                for path in done..done + paths {
                    let sampler =
                        PixelSequence::Sobol.sampler(seed ^ TO_LEARN, number as u64, path);
                    walk.walk(sampler, tally, &mut ledgers, &mut |carried| {
                        if let Carried::Arrived(arrival) = carried.what {
                            arrivals.push(arrival);
                        }
                    });
                }
            });
            let arrivals = batches.iter().map(|(arrivals, _)| arrivals.len()).sum::<usize>();
            let segments = batches.iter().map(|(_, tally)| tally.segments()).sum::<u64>();
            done += paths;
            let is_rare = segments >= SOON && (arrivals as u64) < segments / RARE;
            if arrivals >= ENOUGH || is_rare || segments >= MOST_SEGMENTS || done >= MOST_PATHS {
                break;
            }
            paths = done;
        }
        let arrivals = batches.into_iter().flat_map(|(arrivals, _)| arrivals).collect();
        Ok(Self::from_arrivals(arrivals))
    }

    fn from_arrivals(mut arrivals: Vec<Arrival>) -> Self {
        arrivals.retain(|arrival| arrival.weight.is_finite() && arrival.weight > 0.0);
        let (tree, counts) = Tree::cut(&mut arrivals, MOST, |arrival| arrival.position);
        let mut parts = Vec::new();
        let mut rest = &arrivals[..];
        for count in counts {
            let (own, others) = rest.split_at(count);
            parts.push(own);
            rest = others;
        }
        Self { tree, regions: parts.into_par_iter().map(Region::of).collect() }
    }

    /// What is known of the light at `place`; nothing where too little of it was seen.
    pub fn at(&self, place: DVec3) -> Option<&Region> {
        let region = &self.regions[self.tree.find(place)];
        (!region.lobes.is_empty()).then_some(region)
    }
}

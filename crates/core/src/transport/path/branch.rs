// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Branch`]: one way of a sample's tree of rays, on its way from the eye.

use crate::math::{DVec3, Ray};
use crate::sampling::PixelSampler;
use crate::scene::Interior;
use crate::spectrum::SampledSpectrum;

/// One way of a sample's tree of rays.
#[derive(Clone)]
pub(super) struct Branch {
    /// The segment that it follows next.
    pub ray: Ray,
    /// The share of the basic radiance L/n² arriving against `ray` that reaches the eye.
    pub throughput: SampledSpectrum,
    /// The bodies that `ray` starts in.
    pub interior: Interior,
    /// Its random numbers.
    pub sampler: PixelSampler,
    /// How far it has come, in mm, since it started or turned at random.
    pub way: f64,
    /// How many surfaces and scatterings it has behind it.
    pub depth: u32,
    /// How many times its tree has been split above it.
    pub splits: u32,
    /// How many branches have parted from it.
    pub parted: u32,
    /// How many times it has turned at random.
    pub scatterings: u32,
    /// Which of the emitters that it meets count.
    pub seeks: Seeks,
    /// Whether it has been reflected or turned at random since it started.
    pub has_turned: bool,
    /// Σ 1/f, in sr, of the ground behind it where the light on its way can be met, too: 0 where none is, or
    /// more than refraction lies between.
    pub rivals: f64,
    /// Its share in the light of emitters that it meets.
    pub share: f64,
    /// How it got its direction.
    pub came_by: CameBy,
    /// How much more light may come against `ray` than its throughput makes one expect: it was aimed
    /// at what is bright. Roulette goes by both.
    pub promise: f64,
}

/// Which emitters count that a branch meets; walks from lights bring the light of the others.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Seeks {
    /// All.
    All,
    /// Those that it meets by refraction alone.
    Refracted,
    /// None.
    Nothing,
}

/// How a branch got its direction: which other technique would have found the same light.
#[derive(Clone, Copy)]
pub(super) enum CameBy {
    /// From the eye, a mirror or a smooth interface: no other technique finds this way.
    OneWay,
    /// By chance, at a point that also asks for the emitters it sees.
    Scattering {
        /// That point.
        from: DVec3,
        /// The density of the direction, per steradian.
        pdf: f64,
    },
}

/// Where a step leads.
#[derive(Default)]
pub(super) struct Ways {
    /// Whether the branch itself goes on.
    pub goes_on: bool,
    /// What the ledger books of a branch that parted from it and waits.
    pub parted: f64,
}

impl Ways {
    /// On or nowhere, in one way.
    pub fn one(goes_on: bool) -> Self {
        Self { goes_on, parted: 0.0 }
    }
}

impl Branch {
    /// The branch that every other comes from.
    pub fn from_eye((ray, interior): (Ray, Interior), sampler: PixelSampler) -> Self {
        let (throughput, came_by) = (SampledSpectrum::ONE, CameBy::OneWay);
        Self {
            ray,
            throughput,
            interior,
            sampler,
            way: 0.0,
            depth: 0,
            splits: 0,
            parted: 0,
            scatterings: 0,
            seeks: Seeks::All,
            has_turned: false,
            rivals: 0.0,
            share: 1.0,
            came_by,
            promise: 1.0,
        }
    }

    /// Whether all that it meets of emitters is left to walks from lights.
    pub fn is_left(&self) -> bool {
        self.seeks == Seeks::Nothing
    }

    /// Go on from a mirror or a smooth interface.
    pub fn deflect(&mut self, origin: DVec3, direction: DVec3) {
        self.ray = Ray::endless(origin, direction);
        self.came_by = CameBy::OneWay;
    }

    /// A second branch for the other way on, with random numbers of its own.
    #[must_use]
    pub fn part(&mut self) -> Self {
        self.parted += 1;
        Self { sampler: self.sampler.fork(self.parted), ..self.clone() }
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Forward transport: flux, walked from what sends it out to where it leaves the scene.
//!
//! The flux Φ = ∫∫ L cos θ dω dA of a source is an integral over places and directions. A walk
//! draws one of each and carries Φ's integrand over the density of that draw ([`LightSource`]), on
//! 16 lanes at once, by the same steps as a walk from the eye ([`PathWalk::carry`]). What leaves the
//! scene goes to whoever receives it; the mean over walks is the flux there.
//!
//! Source: E. Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, ch. 4 and 5.

mod beam;
mod rays;
mod shining;

use std::sync::Arc;

use thiserror::Error;

use super::ledger::Ledger;
use super::path::{Carried, PathSettings, PathWalk};
use super::tally::Tally;
use crate::math::Ray;
use crate::sampling::{Choice, PixelSampler};
use crate::scene::{BodyId, Interior, Scene};
use crate::spectrum::{SampledSpectrum, SampledWavelengths};

pub use beam::Beam;
pub use rays::RaySet;
pub use shining::Shining;

/// Why no light can be walked.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FluxError {
    /// Nothing shines, or nothing that the eye sees.
    #[error("nothing sends out any visible flux")]
    NoFlux,
    /// Rays that cannot be used.
    #[error("ray {ray}: {fault}")]
    Ray {
        /// Its number.
        ray: usize,
        /// Why.
        fault: &'static str,
    },
    /// Arrays of a ray set that do not belong together.
    #[error("{what} has {count} entries for {rays} rays")]
    Count {
        /// Which array.
        what: &'static str,
        /// Its length.
        count: usize,
        /// How many rays there are.
        rays: usize,
    },
    /// A beam without a direction or a size.
    #[error("a beam needs a direction, an angular radius from 0 to 90° and a body to meet")]
    Beam,
}

/// Where a walk begins, and what it carries there.
pub(super) struct Departure {
    ray: Ray,
    /// The bodies that the ray starts in, or the opaque body that it is stuck in.
    interior: Result<Interior, BodyId>,
    wavelengths: SampledWavelengths,
    /// The spectral flux in W/nm, over the density of the draw.
    flux: SampledSpectrum,
    group: usize,
}

/// What sends light out.
pub enum LightSource {
    /// The bodies that shine.
    Shining(Shining),
    /// Given rays.
    Rays(Arc<RaySet>),
    /// Parallel light from outside.
    Beam(Beam),
    /// Several of these, each chosen by its luminous flux.
    Several(Vec<LightSource>, Choice),
}

impl From<Shining> for LightSource {
    fn from(shining: Shining) -> Self {
        Self::Shining(shining)
    }
}

impl LightSource {
    /// All of `parts` together.
    ///
    /// # Errors
    /// None has visible flux.
    pub fn several(scene: &Scene, parts: Vec<Self>) -> Result<Self, FluxError> {
        let lumens = |part: &Self| part.flux(scene).iter().map(|xyz| xyz[1]).sum();
        let by_flux = Choice::new(parts.iter().map(lumens)).ok_or(FluxError::NoFlux)?;
        Ok(Self::Several(parts, by_flux))
    }

    /// How many light groups its light is counted to.
    pub fn groups(&self, scene: &Scene) -> usize {
        match self {
            Self::Shining(_) => scene.groups,
            Self::Rays(rays) => rays.group() + 1,
            Self::Beam(_) => 1,
            Self::Several(parts, _) => {
                parts.iter().map(|part| part.groups(scene)).max().unwrap_or(0)
            }
        }
    }

    /// The tristimulus values X, Y, Z of the flux of each light group; Y in lm.
    pub fn flux(&self, scene: &Scene) -> Vec<[f64; 3]> {
        match self {
            Self::Shining(shining) => shining.flux(scene),
            Self::Rays(rays) => {
                let mut flux = vec![[0.0; 3]; rays.group() + 1];
                flux[rays.group()] = rays.flux(scene);
                flux
            }
            Self::Beam(beam) => vec![beam.flux(scene)],
            Self::Several(parts, _) => {
                let mut sums = vec![[0.0; 3]; self.groups(scene)];
                for part in parts {
                    for (sum, own) in sums.iter_mut().zip(part.flux(scene)) {
                        *sum = [0, 1, 2].map(|i| sum[i] + own[i]);
                    }
                }
                sums
            }
        }
    }

    /// Draw a place and a direction, for `u` uniform in the unit cube and the sampler's next numbers.
    fn depart(
        &self,
        scene: &Scene,
        [choice, v, w, x]: [f64; 4],
        sampler: &mut PixelSampler,
    ) -> Option<Departure> {
        let u = [choice, v, w, x];
        match self {
            Self::Shining(shining) => shining.depart(scene, u, sampler),
            Self::Rays(rays) => rays.depart(scene, u, sampler),
            Self::Beam(beam) => Some(beam.depart(scene, u, sampler)),
            Self::Several(parts, by_flux) => {
                let (part, rest) = by_flux.pick(choice);
                let departure = parts[part].depart(scene, [rest, v, w, x], sampler)?;
                let flux = departure.flux * (1.0 / by_flux.probability(part));
                Some(Departure { flux, ..departure })
            }
        }
    }
}

/// A part of a walk's flux.
pub struct Parted<'r> {
    /// What became of it.
    pub what: Carried<'r>,
    /// The light group that it is counted to.
    pub group: usize,
    /// On which wavelengths.
    pub wavelengths: SampledWavelengths,
    /// The spectral flux in W/nm.
    pub flux: SampledSpectrum,
}

/// Walks of one source's light through a scene.
pub struct LightWalk<'a> {
    scene: &'a Scene,
    source: &'a LightSource,
    settings: PathSettings,
    /// The flux, as the eye weighs it by X + Y + Z, of a usual walk: roulette goes by shares of it.
    usual: f64,
    luminous_flux: f64,
}

impl<'a> LightWalk<'a> {
    /// Make ready to walk.
    ///
    /// # Errors
    /// There is no visible flux.
    pub fn new(
        scene: &'a Scene,
        source: &'a LightSource,
        settings: PathSettings,
    ) -> Result<Self, FluxError> {
        let [x, y, z] = source
            .flux(scene)
            .into_iter()
            .fold([0.0; 3], |sum, own| [0, 1, 2].map(|i| sum[i] + own[i]));
        // `visibility` is X + Y + Z of the lane, scaled to a sum of 1 in each phase.
        let scale = [0, 1, 2].map(|i| {
            let table = &scene.colour_matching[i];
            table.at(SampledWavelengths { phase: 0 }).dot(SampledSpectrum::ONE)
        });
        let usual = (x + y + z) / scale.iter().sum::<f64>();
        let sound = y.is_finite() && y > 0.0 && usual.is_finite() && usual > 0.0;
        sound
            .then_some(Self { scene, source, settings, usual, luminous_flux: y })
            .ok_or(FluxError::NoFlux)
    }

    /// The luminous flux of all groups in lm: the unit of the ledgers.
    pub fn luminous_flux(&self) -> f64 {
        self.luminous_flux
    }

    /// Walk once, and show where the light arrives and leaves. The ledger of the walk's light group, of which
    /// `ledgers` has one each, books luminous flux in units of [`luminous_flux`](Self::luminous_flux).
    pub fn walk(
        &self,
        mut sampler: PixelSampler,
        tally: &mut Tally,
        ledgers: &mut [Ledger],
        receive: &mut dyn FnMut(&Parted<'_>),
    ) {
        let scene = self.scene;
        let Some(departure) = self.source.depart(scene, sampler.first_4d(), &mut sampler) else {
            return;
        };
        let Departure { ray, interior, wavelengths, flux, group } = departure;
        let luminosity = scene.colour_matching[1].at(wavelengths);
        let booked = luminosity * (self.usual / self.luminous_flux);
        let carried = flux * (1.0 / self.usual);
        std::mem::swap(&mut tally.ledger, &mut ledgers[group]);
        match interior {
            Err(body) => {
                let weight = carried.dot(booked);
                tally.ledger.start(weight);
                tally.ledger.absorb(body, weight, 0.0);
            }
            Ok(interior) => {
                let usual = self.usual;
                let mut shown = |what: Carried<'_>, flux: SampledSpectrum| {
                    receive(&Parted { what, group, wavelengths, flux: flux * usual });
                };
                let (settings, start) = (self.settings, (ray, interior));
                let carried = (carried, booked);
                PathWalk::carry(
                    scene,
                    settings,
                    wavelengths,
                    sampler,
                    tally,
                    &mut shown,
                    start,
                    carried,
                );
            }
        }
        std::mem::swap(&mut tally.ledger, &mut ledgers[group]);
    }
}

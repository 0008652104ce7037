// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Bsdf`]: what a surface does with light at one point, on one path's wavelengths.
//!
//! Directions are local: z is the shading normal on the walk's side. `wi` points to where the walk
//! came from (wi.z > 0), `wo` to where it goes on; both point away from the surface. A walk carries
//! basic radiance L/n², so that nothing but directions changes at a refraction.
//!
//! - `mirror` is the part that goes in one direction only: its share of the light.
//! - `eval` is all the rest, **with** |cos θₒ|, per sr of wo: ∫ eval dωₒ is the albedo.
//! - `sample` chooses wo for that rest with the density `pdf` per sr. Where lanes differ, a lane is
//!   chosen by `lanes` (probabilities, sum 1) and steers; `pdf` is the density over that choice.
//!
//! Reciprocity: n(wi)²·f(wi, wo) = n(wo)²·f(wo, wi), with f = eval/|cos θₒ|.

mod glossy;
mod interface;
mod lambert;
mod reflector;

pub use glossy::Glossy;
pub use interface::Interface;
pub use lambert::{Diffuse, Transmitter};
pub use reflector::{Facet, LacqueredMetal, Reflector};

#[cfg(test)]
pub(super) mod tests;

use super::albedo::{AlbedoTable, Sides};
use crate::math::DVec3;
use crate::spectrum::{SampledSpectrum, LANES};

/// The answer of a surface at one point.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "made at every hit: a box would cost an allocation")]
pub enum Bsdf<'a> {
    /// A matt surface.
    Diffuse(Diffuse),
    /// A thin matt sheet that light passes.
    Transmitter(Transmitter),
    /// A metal or a mirror.
    Reflector(Reflector<'a>),
    /// A coat over a matt base.
    Glossy(Glossy<'a>),
    /// The boundary between two transparent media.
    Interface(Interface<'a>),
}

impl<'a> Bsdf<'a> {
    /// The boundary to a medium of another index, `eta` = n(other side)/n(this side) per lane;
    /// smooth without a table.
    pub fn interface(eta: SampledSpectrum, roughness: Option<&'a AlbedoTable>) -> Self {
        Self::Interface(Interface::new(eta, roughness))
    }

    /// The share of the light that is reflected in the mirror direction only; none where there is
    /// no such part, as on matt and rough surfaces.
    pub fn mirror(&self, cos_i: f64) -> Option<SampledSpectrum> {
        match self {
            Self::Diffuse(_) | Self::Transmitter(_) => None,
            Self::Reflector(reflector) => reflector.mirror(cos_i),
            Self::Glossy(glossy) => glossy.mirror(cos_i),
            Self::Interface(interface) => interface.mirror(cos_i),
        }
    }

    /// Whether there is anything but a mirror: whether `eval` is not zero everywhere.
    pub fn scatters(&self) -> bool {
        match self {
            Self::Diffuse(_) | Self::Transmitter(_) | Self::Glossy(_) => true,
            Self::Reflector(reflector) => reflector.is_rough(),
            Self::Interface(interface) => interface.is_rough(),
        }
    }

    /// Whether light from anywhere goes on about everywhere: on matt and very rough surfaces.
    pub fn is_broad(&self) -> bool {
        match self {
            Self::Diffuse(_) | Self::Transmitter(_) => true,
            Self::Glossy(glossy) => glossy.table().is_none_or(AlbedoTable::is_broad),
            Self::Reflector(reflector) => reflector.table().is_some_and(AlbedoTable::is_broad),
            Self::Interface(interface) => interface.table().is_some_and(AlbedoTable::is_broad),
        }
    }

    /// Whether light is spread so much that it can be gathered from about where it arrives.
    pub fn spreads(&self) -> bool {
        let table = match self {
            Self::Diffuse(_) | Self::Transmitter(_) => return true,
            Self::Glossy(glossy) => return glossy.table().is_none_or(AlbedoTable::spreads),
            Self::Reflector(reflector) => reflector.table(),
            Self::Interface(interface) => interface.table(),
        };
        table.is_some_and(AlbedoTable::spreads)
    }

    /// The share of the light from `wo` that goes to `wi`, per sr of `wo`, with |cos θₒ| and
    /// without the mirror.
    pub fn eval(&self, wi: DVec3, wo: DVec3) -> SampledSpectrum {
        match self {
            Self::Diffuse(diffuse) => diffuse.eval(wi, wo),
            Self::Transmitter(transmitter) => transmitter.eval(wi, wo),
            Self::Reflector(reflector) => reflector.eval(wi, wo),
            Self::Glossy(glossy) => glossy.eval(wi, wo),
            Self::Interface(interface) => interface.eval(wi, wo),
        }
    }

    /// The density per sr of [`Self::sample`].
    pub fn pdf(&self, wi: DVec3, wo: DVec3, lanes: &SampledSpectrum) -> f64 {
        match self {
            Self::Diffuse(diffuse) => diffuse.pdf(wi, wo),
            Self::Transmitter(transmitter) => transmitter.pdf(wi, wo, lanes),
            Self::Reflector(reflector) => reflector.pdf(wi, wo),
            Self::Glossy(glossy) => glossy.pdf(wi, wo, lanes),
            Self::Interface(interface) => interface.pdf(wi, wo, lanes),
        }
    }

    /// Choose where the walk goes on, by three uniform numbers; never the mirror. `None` where
    /// nothing comes back: the walk ends.
    pub fn sample(&self, wi: DVec3, lanes: &SampledSpectrum, u: [f64; 3]) -> Option<DVec3> {
        if wi.z <= 0.0 {
            return None;
        }
        match self {
            Self::Diffuse(diffuse) => diffuse.sample(u),
            Self::Transmitter(transmitter) => transmitter.sample(lanes, u),
            Self::Reflector(reflector) => reflector.sample(wi, u),
            Self::Glossy(glossy) => glossy.sample(wi, lanes, u),
            Self::Interface(interface) => interface.sample(wi, lanes, u),
        }
    }

    /// The density per sr of [`Self::sample_side`] on the side of `wo`.
    pub fn pdf_of_side(&self, wi: DVec3, wo: DVec3, lanes: &SampledSpectrum) -> f64 {
        match self {
            Self::Interface(interface) => interface.pdf_of_side(wi, wo, lanes),
            _ => self.pdf(wi, wo, lanes),
        }
    }

    /// As [`Self::sample`], but on the near side or on the far side of a boundary alone; nothing else has
    /// sides.
    pub fn sample_side(
        &self,
        wi: DVec3,
        is_near: bool,
        lanes: &SampledSpectrum,
        u: [f64; 3],
    ) -> Option<DVec3> {
        match self {
            Self::Interface(interface) if wi.z > 0.0 => {
                interface.sample_side(wi, is_near, lanes, u)
            }
            _ => self.sample(wi, lanes, u),
        }
    }

    /// The directional albedo ∫ eval dωₒ per lane: an estimate for rough reflectors,
    /// which takes their facets at the mean cosine of incidence. Zero without anything but a mirror.
    pub fn albedo(&self, wi: DVec3) -> SampledSpectrum {
        match self {
            Self::Diffuse(diffuse) => diffuse.albedo(),
            Self::Transmitter(transmitter) => transmitter.albedo(),
            Self::Reflector(reflector) => reflector.albedo(wi),
            Self::Glossy(glossy) => glossy.albedo(wi),
            Self::Interface(interface) => interface.albedo(),
        }
    }
}

/// A function of η on the lanes: once for all where they share it.
#[derive(Clone, Copy, Debug)]
struct Ratios {
    eta: SampledSpectrum,
    is_dispersive: bool,
}

impl Ratios {
    fn new(eta: SampledSpectrum) -> Self {
        let is_dispersive = eta.0.iter().any(|other| *other != eta.0[0]);
        Self { eta, is_dispersive }
    }

    fn map(&self, mut f: impl FnMut(f64) -> f64) -> SampledSpectrum {
        if self.is_dispersive {
            self.eta.map(f)
        } else {
            SampledSpectrum::splat(f(self.eta.0[0]))
        }
    }

    /// The smallest and the largest η.
    fn outermost(&self) -> (f64, f64) {
        let least = self.eta.0.iter().copied().fold(f64::INFINITY, f64::min);
        (least, self.eta.max())
    }

    /// The η of a lane that is chosen by its probability.
    fn choose(&self, lanes: &SampledSpectrum, u: &mut f64) -> f64 {
        let lane = if self.is_dispersive { choose_lane(lanes, u) } else { 0 };
        self.eta.0[lane]
    }
}

/// What a rough dielectric surface knows of its facets.
#[derive(Clone, Copy, Debug)]
struct Rough<'a> {
    table: &'a AlbedoTable,
    /// The sides of the middle lane, by which all lanes choose what to follow.
    middle: Sides<'a>,
    is_dispersive: bool,
}

impl<'a> Rough<'a> {
    fn new(table: &'a AlbedoTable, ratios: &Ratios) -> Self {
        let middle = table.sides(ratios.eta.0[LANES / 2]);
        Self { table, middle, is_dispersive: ratios.is_dispersive }
    }

    fn sides(&self, eta: f64) -> Sides<'a> {
        if self.is_dispersive {
            self.table.sides(eta)
        } else {
            self.middle
        }
    }
}

/// Choose a lane by its probability, and stretch what is left of `u` to a uniform number.
fn choose_lane(lanes: &SampledSpectrum, u: &mut f64) -> usize {
    let mut chosen = 0;
    let mut before = 0.0;
    for j in 0..LANES {
        let probability = lanes.0[j];
        if probability <= 0.0 {
            continue;
        }
        chosen = j;
        if *u < before + probability {
            *u = below_one((*u - before) / probability);
            return chosen;
        }
        before += probability;
    }
    // Only rounding of the sum comes here.
    *u = 0.5;
    chosen
}

/// Whether an event of `probability` happens, and stretch what is left of `u` to a uniform number.
fn happens(probability: f64, u: &mut f64) -> bool {
    let is_so = *u < probability;
    *u = below_one(if is_so { *u / probability } else { (*u - probability) / (1.0 - probability) });
    is_so
}

fn below_one(u: f64) -> f64 {
    u.clamp(0.0, 1.0 - f64::EPSILON)
}

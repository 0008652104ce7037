// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Metals, lacquered metals and mirrors: facets that reflect or absorb.

use std::f64::consts::FRAC_1_PI;

use super::happens;
use super::lambert::above;
use crate::math::DVec3;
use crate::matter::albedo::AlbedoTable;
use crate::matter::fresnel::{conductor_reflectance, reflect};
use crate::matter::lacquer::SampledLacquer;
use crate::matter::microfacet::masking_of_reflection;
use crate::spectrum::SampledSpectrum;

/// What one facet reflects.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "made at every hit: a box would cost an allocation")]
pub enum Facet {
    /// A bare metal, n + ik relative to the medium before it.
    Metal {
        /// The relative n.
        n: SampledSpectrum,
        /// The relative k.
        k: SampledSpectrum,
        /// What the reflectance is multiplied with.
        factor: f64,
    },
    /// A metal under a lacquer, all indices absolute.
    Lacquered(LacqueredMetal),
    /// A measured reflectance, the same at all angles.
    Measured(SampledSpectrum),
}

/// A metal, its lacquer, and the medium before them.
#[derive(Clone, Copy, Debug)]
pub struct LacqueredMetal {
    pub(in crate::matter) lacquer: SampledLacquer,
    pub(in crate::matter) medium_index: SampledSpectrum,
    pub(in crate::matter) n: SampledSpectrum,
    pub(in crate::matter) k: SampledSpectrum,
    pub(in crate::matter) factor: f64,
}

impl Facet {
    /// The reflectance at an angle of incidence.
    pub fn reflectance(&self, cos_i: f64) -> SampledSpectrum {
        match self {
            Self::Metal { n, k, factor } => {
                n.zip(*k, |n, k| factor * conductor_reflectance(cos_i, n, k))
            }
            Self::Lacquered(LacqueredMetal { lacquer, medium_index, n, k, factor }) => {
                lacquer.reflectance(cos_i, *medium_index, (*n, *k), *factor)
            }
            Self::Measured(reflectance) => *reflectance,
        }
    }

    /// 2∫ F(µ) µ dµ, by Gauss's rule with two nodes for the weight µ.
    fn mean_reflectance(&self) -> SampledSpectrum {
        if let Self::Measured(reflectance) = self {
            return *reflectance;
        }
        self.reflectance(0.355_051_025_721_682_2) * 0.363_917_239_552_072_6
            + self.reflectance(0.844_948_974_278_317_8) * 0.636_082_760_447_927_4
    }
}

/// A smooth or rough surface of reflecting facets.
#[derive(Clone, Copy, Debug)]
pub struct Reflector<'a> {
    facet: Facet,
    rough: Option<Rough<'a>>,
}

/// What a rough reflector adds to its facets.
#[derive(Clone, Copy, Debug)]
struct Rough<'a> {
    table: &'a AlbedoTable,
    /// What light keeps that meets more than one facet, divided by π and the mean loss.
    further: SampledSpectrum,
}

impl<'a> Reflector<'a> {
    /// A surface of such facets; smooth without a table.
    pub fn new(facet: Facet, roughness: Option<&'a AlbedoTable>) -> Self {
        let rough = roughness.map(|table| {
            // The loss of the first facet meets a second one, and so on:
            // F²(1 − ℓ) + F³ℓ(1 − ℓ) + …, the factor of S. Hill, "A Multi-Faceted Exploration", 2018.
            let loss = table.mean_reflector_loss();
            let kept = facet.mean_reflectance().map(|f| f * f * (1.0 - loss) / (1.0 - f * loss));
            let scale = if loss > 0.0 { FRAC_1_PI / loss } else { 0.0 };
            Rough { table, further: kept * scale }
        });
        Self { facet, rough }
    }

    pub(super) fn is_rough(&self) -> bool {
        self.rough.is_some()
    }

    pub(super) fn table(&self) -> Option<&AlbedoTable> {
        self.rough.as_ref().map(|rough| rough.table)
    }

    pub(super) fn mirror(&self, cos_i: f64) -> Option<SampledSpectrum> {
        self.rough.is_none().then(|| self.facet.reflectance(cos_i))
    }

    pub(super) fn eval(&self, wi: DVec3, wo: DVec3) -> SampledSpectrum {
        let Some(rough) = self.rough.filter(|_| wi.z > 0.0 && wo.z > 0.0) else {
            return SampledSpectrum::ZERO;
        };
        let (ggx, h) = (rough.table.ggx(), (wi + wo).normalize());
        let masking = masking_of_reflection(ggx.lambda(wi), ggx.lambda(wo));
        let single = ggx.density(h) * masking / (4.0 * wi.z);
        let lost = rough.loss(wi.z) * rough.loss(wo.z) * wo.z;
        self.facet.reflectance(wi.dot(h)) * single + rough.further * lost
    }

    pub(super) fn pdf(&self, wi: DVec3, wo: DVec3) -> f64 {
        let Some(rough) = self.rough.filter(|_| wi.z > 0.0 && wo.z > 0.0) else {
            return 0.0;
        };
        let (ggx, h) = (rough.table.ggx(), (wi + wo).normalize());
        let single = ggx.visible_density(wi, h, ggx.lambda(wi)) / (4.0 * wi.dot(h));
        let loss = rough.loss(wi.z);
        let lobe = rough.table.reflector_density(rough.table.between_cosines(wo.z));
        (1.0 - loss) * single + loss * lobe * wo.z * FRAC_1_PI
    }

    pub(super) fn sample(&self, wi: DVec3, u: [f64; 3]) -> Option<DVec3> {
        let rough = self.rough?;
        let mut choice = u[2];
        if happens(rough.loss(wi.z), &mut choice) {
            return above(rough.table.sample_reflector_lobe([u[0], u[1]]));
        }
        let h = rough.table.ggx().visible_normal(wi, [u[0], u[1]]);
        above(reflect(wi, h))
    }

    pub(super) fn albedo(&self, wi: DVec3) -> SampledSpectrum {
        let Some(rough) = self.rough.filter(|_| wi.z > 0.0) else {
            return SampledSpectrum::ZERO;
        };
        let mu = rough.table.between_cosines(wi.z);
        let loss = rough.table.reflector_loss(mu);
        let lost = std::f64::consts::PI * rough.table.mean_reflector_loss() * loss;
        let facet = self.facet.reflectance(rough.table.incidence(mu));
        facet * (1.0 - loss) + rough.further * lost
    }
}

impl Rough<'_> {
    fn loss(&self, mu: f64) -> f64 {
        self.table.reflector_loss(self.table.between_cosines(mu))
    }
}

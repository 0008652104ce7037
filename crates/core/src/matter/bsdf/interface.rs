// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Interface`]: the smooth or rough boundary between two transparent media.

use std::f64::consts::FRAC_1_PI;

use super::lambert::above;
use super::{choose_lane, happens, Ratios};
use crate::math::{DVec2, DVec3};
use crate::matter::albedo::{AlbedoTable, Between};
use crate::matter::fresnel::{dielectric_reflectance, reflect, refract};
use crate::matter::microfacet::{masking_of_reflection, masking_of_transmission};
use crate::sampling::cosine_hemisphere;
use crate::spectrum::SampledSpectrum;

/// A lane whose index ratio is nearer to 1 is held off at this distance on a rough surface: facets
/// that do not refract have no half-vector.
const LEAST_CONTRAST: f64 = 1e-6;

/// A boundary with η = n(other side)/n(this side) per lane.
///
/// Lanes of different η see different facets for one pair of directions; where all share one η,
/// the facet is found once.
#[derive(Clone, Copy, Debug)]
pub struct Interface<'a> {
    ratios: Ratios,
    table: Option<&'a AlbedoTable>,
}

/// A pair of directions on a rough boundary, and what does not depend on η.
struct Pair<'a> {
    table: &'a AlbedoTable,
    wi: DVec3,
    wo: DVec3,
    lambda_i: f64,
    mu_i: Between,
    mu_o: Between,
}

/// The facet that joins two directions.
struct Joint {
    /// The reflectance of the facet.
    f: f64,
    /// The density of that facet among those seen, per sr of wo.
    visible: f64,
}

impl<'a> Interface<'a> {
    /// A boundary; smooth without a table.
    pub fn new(eta: SampledSpectrum, roughness: Option<&'a AlbedoTable>) -> Self {
        let held_off = |eta: f64| {
            if (eta - 1.0).abs() >= LEAST_CONTRAST {
                eta
            } else {
                1.0 + LEAST_CONTRAST.copysign(eta - 1.0)
            }
        };
        let eta = if roughness.is_some() { eta.map(held_off) } else { eta };
        Self { ratios: Ratios::new(eta), table: roughness }
    }

    pub(super) fn is_rough(&self) -> bool {
        self.table.is_some()
    }

    pub(super) fn mirror(&self, cos_i: f64) -> Option<SampledSpectrum> {
        self.table.is_none().then(|| self.ratios.map(|eta| dielectric_reflectance(cos_i, eta)))
    }

    pub(super) fn eval(&self, wi: DVec3, wo: DVec3) -> SampledSpectrum {
        let Some(pair) = self.pair(wi, wo) else {
            return SampledSpectrum::ZERO;
        };
        let masking = pair.masking() * (1.0 + pair.lambda_i);
        self.ratios.map(|eta| pair.single(eta) * masking + pair.further(eta))
    }

    pub(super) fn pdf(&self, wi: DVec3, wo: DVec3, lanes: &SampledSpectrum) -> f64 {
        let Some(pair) = self.pair(wi, wo) else {
            return 0.0;
        };
        self.ratios.mean(lanes, |eta| {
            let loss = pair.table.shares(eta, pair.mu_i).loss;
            let through = pair.table.returned_through(eta);
            let side = if wo.z > 0.0 { 1.0 - through } else { through };
            (1.0 - loss) * pair.single(eta) + loss * side * wo.z.abs() * FRAC_1_PI
        })
    }

    pub(super) fn sample(&self, wi: DVec3, lanes: &SampledSpectrum, u: [f64; 3]) -> Option<DVec3> {
        let table = self.table?;
        let mut choice = u[2];
        let lane = if self.ratios.is_dispersive { choose_lane(lanes, &mut choice) } else { 0 };
        let eta = self.ratios.eta.0[lane];
        let loss = table.shares(eta, table.between_cosines(wi.z)).loss;
        if happens(loss, &mut choice) {
            let wo = above(cosine_hemisphere(DVec2::new(u[0], u[1])))?;
            return Some(if happens(table.returned_through(eta), &mut choice) { -wo } else { wo });
        }
        let h = table.ggx().visible_normal(wi, [u[0], u[1]]);
        if happens(dielectric_reflectance(wi.dot(h), eta), &mut choice) {
            above(reflect(wi, h))
        } else {
            refract(wi, h, eta).filter(|wo| wo.z < 0.0)
        }
    }

    /// All light leaves: by one facet or by more.
    pub(super) fn albedo(&self) -> SampledSpectrum {
        if self.is_rough() {
            SampledSpectrum::ONE
        } else {
            SampledSpectrum::ZERO
        }
    }

    fn pair(&self, wi: DVec3, wo: DVec3) -> Option<Pair<'a>> {
        let table = self.table.filter(|_| wi.z > 0.0 && wo.z != 0.0)?;
        Some(Pair {
            table,
            wi,
            wo,
            lambda_i: table.ggx().lambda(wi),
            mu_i: table.between_cosines(wi.z),
            mu_o: table.between_cosines(wo.z.abs()),
        })
    }
}

impl Pair<'_> {
    fn masking(&self) -> f64 {
        let lambda_o = self.table.ggx().lambda(self.wo);
        if self.wo.z > 0.0 {
            masking_of_reflection(self.lambda_i, lambda_o)
        } else {
            masking_of_transmission(self.lambda_i, lambda_o)
        }
    }

    /// One facet's share of the light, before other facets hide it, per sr of wo.
    fn single(&self, eta: f64) -> f64 {
        let joint = if self.wo.z > 0.0 { self.mirrored(eta) } else { self.refracted(eta) };
        joint.map_or(0.0, |joint| joint.f * joint.visible)
    }

    fn mirrored(&self, eta: f64) -> Option<Joint> {
        let h = (self.wi + self.wo).normalize();
        let cos_i = self.wi.dot(h);
        let visible = self.table.ggx().visible_density(self.wi, h, self.lambda_i) / (4.0 * cos_i);
        Some(Joint { f: dielectric_reflectance(cos_i, eta), visible })
    }

    /// Walter et al., eqs. (16), (17) and (21): dωₕ/dωₒ = η²·|wo·h|/(wi·h + η·wo·h)².
    fn refracted(&self, eta: f64) -> Option<Joint> {
        let sum = self.wi + self.wo * eta;
        let length2 = sum.length_squared();
        let h = sum * (length2.sqrt().recip().copysign(sum.z));
        let (cos_i, cos_o) = (self.wi.dot(h), self.wo.dot(h));
        if !(cos_i > 0.0 && cos_o < 0.0) {
            return None;
        }
        let seen = self.table.ggx().visible_density(self.wi, h, self.lambda_i);
        let visible = seen * eta * eta * -cos_o / length2;
        Some(Joint { f: 1.0 - dielectric_reflectance(cos_i, eta), visible })
    }

    /// The light that meets more than one facet, spread evenly but for the losses.
    fn further(&self, eta: f64) -> f64 {
        let table = self.table;
        let lost = table.shares(eta, self.mu_i).loss;
        let through = table.returned_through(eta);
        let (share, eta) =
            if self.wo.z > 0.0 { (1.0 - through, eta) } else { (through, 1.0 / eta) };
        let mean = table.mean_shares(eta).loss;
        if mean <= 0.0 {
            return 0.0;
        }
        let spread = table.shares(eta, self.mu_o).loss * self.wo.z.abs() / mean;
        share * lost * spread * FRAC_1_PI
    }
}

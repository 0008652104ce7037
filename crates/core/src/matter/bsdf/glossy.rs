// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Glossy`]: a smooth or rough dielectric coat over a matt base.

use std::f64::consts::FRAC_1_PI;

use super::lambert::above;
use super::{happens, Ratios};
use crate::math::{DVec2, DVec3};
use crate::matter::albedo::{AlbedoTable, Between};
use crate::matter::fresnel::{dielectric_reflectance, diffuse_dielectric_reflectance, reflect};
use crate::matter::microfacet::masking_of_reflection;
use crate::sampling::cosine_hemisphere;
use crate::spectrum::SampledSpectrum;

/// A coat that reflects R(µ) and lets the rest to a base of reflectance ρ, with all
/// inter-reflections between them.
///
/// base: (1 − R(µᵢ))·(1 − R(µₒ))·ρ/(1 − ρ·`R_in`)·µₒ/(π·η²), where `R_in` is the coat's diffuse
/// reflectance from inside: η²·(1 − `R_in`) = 1 − 2∫ R(µ) µ dµ. Smooth coats have R = F.
#[derive(Clone, Copy, Debug)]
pub struct Glossy<'a> {
    ratios: Ratios,
    table: Option<&'a AlbedoTable>,
    /// ρ/(1 − ρ·`R_in`)/(π·η²).
    base: SampledSpectrum,
    /// 1 − 2∫ R(µ) µ dµ.
    mean_entered: SampledSpectrum,
}

impl<'a> Glossy<'a> {
    /// A coat of index `eta` times the medium's over a base of reflectance ρ; smooth without a
    /// table.
    pub fn new(
        eta: SampledSpectrum,
        base: SampledSpectrum,
        roughness: Option<&'a AlbedoTable>,
    ) -> Self {
        let ratios = Ratios::new(eta);
        let mean_entered = ratios.map(|eta| {
            let Some(table) = roughness else {
                return 1.0 - diffuse_dielectric_reflectance(eta);
            };
            let mean = table.mean_shares(eta);
            1.0 - mean.reflected - mean.loss * (1.0 - table.returned_through(eta))
        });
        let base = SampledSpectrum::from_fn(|j| {
            let (rho, eta2) = (base.0[j], eta.0[j] * eta.0[j]);
            let inside = (1.0 - mean_entered.0[j] / eta2).clamp(0.0, 1.0);
            let answered = 1.0 - rho * inside;
            if answered > 0.0 {
                rho / answered / eta2 * FRAC_1_PI
            } else {
                0.0
            }
        });
        Self { ratios, table: roughness, base, mean_entered }
    }

    pub(super) fn mirror(&self, cos_i: f64) -> Option<SampledSpectrum> {
        self.table.is_none().then(|| self.ratios.map(|eta| dielectric_reflectance(cos_i, eta)))
    }

    pub(super) fn eval(&self, wi: DVec3, wo: DVec3) -> SampledSpectrum {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        let Some(table) = self.table else {
            let entered = self.ratios.map(|eta| {
                (1.0 - dielectric_reflectance(wi.z, eta))
                    * (1.0 - dielectric_reflectance(wo.z, eta))
            });
            return self.base * entered * wo.z;
        };
        let (ggx, h) = (table.ggx(), (wi + wo).normalize());
        let masking = masking_of_reflection(ggx.lambda(wi), ggx.lambda(wo));
        let single = ggx.density(h) * masking / (4.0 * wi.z);
        let cosines = [wi.z, wo.z].map(|mu| table.between_cosines(mu));
        let coat = self.ratios.map(|eta| {
            let f = dielectric_reflectance(wi.dot(h), eta);
            f * single + returned(table, eta, cosines) * wo.z
        });
        let entered = self.ratios.map(|eta| {
            let [i, o] = cosines.map(|mu| 1.0 - coat_albedo(table, eta, mu));
            i * o
        });
        coat + self.base * entered * wo.z
    }

    pub(super) fn pdf(&self, wi: DVec3, wo: DVec3, lanes: &SampledSpectrum) -> f64 {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return 0.0;
        }
        let even = wo.z * FRAC_1_PI;
        let Some(table) = self.table else {
            return even;
        };
        let (ggx, h) = (table.ggx(), (wi + wo).normalize());
        let facet = ggx.visible_density(wi, h, ggx.lambda(wi)) / (4.0 * wi.dot(h));
        let chance = self.chance_of_facet(table, wi.z, lanes);
        chance * facet + (1.0 - chance) * even
    }

    pub(super) fn sample(&self, wi: DVec3, lanes: &SampledSpectrum, u: [f64; 3]) -> Option<DVec3> {
        if let Some(table) = self.table {
            let mut choice = u[2];
            if happens(self.chance_of_facet(table, wi.z, lanes), &mut choice) {
                return above(reflect(wi, table.ggx().visible_normal(wi, [u[0], u[1]])));
            }
        }
        above(cosine_hemisphere(DVec2::new(u[0], u[1])))
    }

    pub(super) fn albedo(&self, wi: DVec3) -> SampledSpectrum {
        if wi.z <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        let whole = self.base * self.mean_entered * std::f64::consts::PI;
        let Some(table) = self.table else {
            return whole * self.ratios.map(|eta| 1.0 - dielectric_reflectance(wi.z, eta));
        };
        let mu = table.between_cosines(wi.z);
        let coat = self.ratios.map(|eta| coat_albedo(table, eta, mu));
        coat + whole * (SampledSpectrum::ONE - coat)
    }

    /// The chance to follow one facet's reflection and not what is spread evenly.
    fn chance_of_facet(&self, table: &AlbedoTable, mu: f64, lanes: &SampledSpectrum) -> f64 {
        let mu_at = table.between_cosines(mu);
        let facet = self.ratios.mean(lanes, |eta| table.shares(eta, mu_at).reflected);
        let all = self.albedo(DVec3::new(0.0, 0.0, mu)).dot(*lanes);
        if all > 0.0 {
            (facet / all).clamp(0.0, 1.0)
        } else {
            1.0
        }
    }
}

/// R(µ): what a rough coat reflects in all, by one facet or more.
fn coat_albedo(table: &AlbedoTable, eta: f64, mu: Between) -> f64 {
    let shares = table.shares(eta, mu);
    shares.reflected + shares.loss * (1.0 - table.returned_through(eta))
}

/// What a rough coat reflects by more than one facet, but for µₒ.
fn returned(table: &AlbedoTable, eta: f64, cosines: [Between; 2]) -> f64 {
    let [i, o] = cosines.map(|mu| table.shares(eta, mu).loss);
    let mean = table.mean_shares(eta).loss;
    if mean > 0.0 {
        (1.0 - table.returned_through(eta)) * i * o / mean * FRAC_1_PI
    } else {
        0.0
    }
}

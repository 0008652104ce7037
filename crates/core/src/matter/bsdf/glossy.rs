// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Glossy`]: a smooth or rough dielectric coat over a matt base.

use std::f64::consts::FRAC_1_PI;

use super::lambert::above;
use super::{happens, Ratios, Rough};
use crate::math::{DVec2, DVec3};
use crate::matter::albedo::{AlbedoTable, Shares, Sides};
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
    rough: Option<Rough<'a>>,
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
        let rough = roughness.map(|table| Rough::new(table, &ratios));
        let mean_entered = ratios.map(|eta| {
            let Some(rough) = rough else {
                return 1.0 - diffuse_dielectric_reflectance(eta);
            };
            let sides = rough.sides(eta);
            1.0 - sides.here.mean_reflected() - sides.here.mean_loss() * (1.0 - sides.through)
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
        Self { ratios, rough, base, mean_entered }
    }

    pub(super) fn table(&self) -> Option<&AlbedoTable> {
        self.rough.as_ref().map(|rough| rough.table)
    }

    pub(super) fn mirror(&self, cos_i: f64) -> Option<SampledSpectrum> {
        self.rough.is_none().then(|| self.ratios.map(|eta| dielectric_reflectance(cos_i, eta)))
    }

    pub(super) fn eval(&self, wi: DVec3, wo: DVec3) -> SampledSpectrum {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        let Some(rough) = self.rough else {
            let entered = self.ratios.map(|eta| {
                (1.0 - dielectric_reflectance(wi.z, eta))
                    * (1.0 - dielectric_reflectance(wo.z, eta))
            });
            return self.base * entered * wo.z;
        };
        let (ggx, h) = (rough.table.ggx(), (wi + wo).normalize());
        let masking = masking_of_reflection(ggx.lambda(wi), ggx.lambda(wo));
        let single = ggx.density(h) * masking / (4.0 * wi.z);
        let cosines = [wi.z, wo.z].map(|mu| rough.table.between_cosines(mu));
        let mut entered = SampledSpectrum::ZERO;
        let mut lane = 0;
        let coat = self.ratios.map(|eta| {
            let sides = rough.sides(eta);
            let [i, o] = cosines.map(|mu| sides.here.shares(mu));
            entered.0[lane] = (1.0 - coat_albedo(&sides, i)) * (1.0 - coat_albedo(&sides, o));
            lane += 1;
            let f = dielectric_reflectance(wi.dot(h), eta);
            f * single + returned(&sides, [i.loss, o.loss]) * wo.z
        });
        if lane == 1 {
            entered = SampledSpectrum::splat(entered.0[0]);
        }
        coat + self.base * entered * wo.z
    }

    pub(super) fn pdf(&self, wi: DVec3, wo: DVec3, lanes: &SampledSpectrum) -> f64 {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return 0.0;
        }
        let even = wo.z * FRAC_1_PI;
        let Some(rough) = self.rough else {
            return even;
        };
        let (ggx, h) = (rough.table.ggx(), (wi + wo).normalize());
        let facet = ggx.visible_density(wi, h, ggx.lambda(wi)) / (4.0 * wi.dot(h));
        let [facet_share, further_share] = self.chances(&rough, wi.z, lanes);
        let mu = rough.table.between_cosines(wo.z);
        let further = rough.table.lobe_density(rough.middle.here, mu);
        let base_share = 1.0 - facet_share - further_share;
        facet_share * facet + (further_share * further + base_share) * even
    }

    pub(super) fn sample(&self, wi: DVec3, lanes: &SampledSpectrum, u: [f64; 3]) -> Option<DVec3> {
        let at = [u[0], u[1]];
        if let Some(rough) = self.rough {
            let mut choice = u[2];
            let [facet_share, further_share] = self.chances(&rough, wi.z, lanes);
            if happens(facet_share, &mut choice) {
                return above(reflect(wi, rough.table.ggx().visible_normal(wi, at)));
            }
            if happens(further_share / (1.0 - facet_share), &mut choice) {
                return above(rough.table.sample_lobe(rough.middle.here, at));
            }
        }
        above(cosine_hemisphere(DVec2::from_array(at)))
    }

    pub(super) fn albedo(&self, wi: DVec3) -> SampledSpectrum {
        if wi.z <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        let whole = self.entered_albedo();
        let Some(rough) = self.rough else {
            return whole * self.ratios.map(|eta| 1.0 - dielectric_reflectance(wi.z, eta));
        };
        let mu = rough.table.between_cosines(wi.z);
        let coat = self.ratios.map(|eta| {
            let sides = rough.sides(eta);
            coat_albedo(&sides, sides.here.shares(mu))
        });
        coat + whole * (SampledSpectrum::ONE - coat)
    }

    /// The chances to follow what one facet reflects and what more of them do, and not the base.
    fn chances(&self, rough: &Rough, mu: f64, lanes: &SampledSpectrum) -> [f64; 2] {
        let between = rough.table.between_cosines(mu);
        let shares = rough.middle.here.shares(between);
        let facet = shares.reflected;
        let further = shares.loss * (1.0 - rough.middle.through);
        let base = self.entered_albedo().dot(*lanes) * (1.0 - facet - further).max(0.0);
        let all = facet + further + base;
        if all > 0.0 {
            [facet / all, further / all]
        } else {
            [1.0, 0.0]
        }
    }

    /// What the base gives back of the light that has passed the coat once.
    fn entered_albedo(&self) -> SampledSpectrum {
        self.base * self.mean_entered * std::f64::consts::PI
    }
}

/// R(µ): what a rough coat reflects in all, by one facet or more.
fn coat_albedo(sides: &Sides, shares: Shares) -> f64 {
    shares.reflected + shares.loss * (1.0 - sides.through)
}

/// What a rough coat reflects by more than one facet, but for µₒ, by the losses at both cosines.
fn returned(sides: &Sides, losses: [f64; 2]) -> f64 {
    let mean = sides.here.mean_loss();
    if mean > 0.0 {
        (1.0 - sides.through) * losses[0] * losses[1] / mean * FRAC_1_PI
    } else {
        0.0
    }
}

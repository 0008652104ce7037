// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Interface`]: the smooth or rough boundary between two transparent media.

use std::f64::consts::FRAC_1_PI;

use super::lambert::above;
use super::{happens, Ratios, Rough};
use crate::math::DVec3;
use crate::matter::albedo::{AlbedoTable, Between, Side, Sides};
use crate::matter::fresnel::{
    dielectric_reflectance, polarised_reflectances_between, reflect, refract,
};
use crate::matter::microfacet::{masking_of_reflection, masking_of_transmission};
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
    rough: Option<Rough<'a>>,
}

/// A pair of directions on a rough boundary, and what does not depend on η.
struct Pair<'a> {
    rough: Rough<'a>,
    wi: DVec3,
    wo: DVec3,
    lambda_i: f64,
    mu_i: Between,
    mu_o: Between,
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
        let ratios = Ratios::new(eta);
        Self { ratios, rough: roughness.map(|table| Rough::new(table, &ratios)) }
    }

    pub(super) fn is_rough(&self) -> bool {
        self.rough.is_some()
    }

    pub(super) fn table(&self) -> Option<&AlbedoTable> {
        self.rough.as_ref().map(|rough| rough.table)
    }

    pub(super) fn mirror(&self, cos_i: f64) -> Option<SampledSpectrum> {
        self.rough.is_none().then(|| self.ratios.map(|eta| dielectric_reflectance(cos_i, eta)))
    }

    pub(super) fn eval(&self, wi: DVec3, wo: DVec3) -> SampledSpectrum {
        let Some(pair) = self.pair(wi, wo) else {
            return SampledSpectrum::ZERO;
        };
        let masking = pair.masking() * (1.0 + pair.lambda_i);
        pair.single(&self.ratios) * masking + pair.further(&self.ratios)
    }

    pub(super) fn pdf(&self, wi: DVec3, wo: DVec3, lanes: &SampledSpectrum) -> f64 {
        let Some(pair) = self.pair(wi, wo) else {
            return 0.0;
        };
        let [loss, chance, lobe] = pair.drawn_as_lost();
        (1.0 - loss) * pair.single(&self.ratios).dot(*lanes) + loss * chance * lobe
    }

    pub(super) fn sample(&self, wi: DVec3, lanes: &SampledSpectrum, u: [f64; 3]) -> Option<DVec3> {
        let rough = self.rough?;
        let mut choice = u[2];
        if happens(rough.loss(wi), &mut choice) {
            let is_near = !happens(rough.middle.through, &mut choice);
            return rough.sample_lost(is_near, u);
        }
        let eta = self.ratios.choose(lanes, &mut choice);
        let h = rough.table.ggx().visible_normal(wi, [u[0], u[1]]);
        if happens(dielectric_reflectance(wi.dot(h), eta), &mut choice) {
            above(reflect(wi, h))
        } else {
            refract(wi, h, eta).filter(|wo| wo.z < 0.0)
        }
    }

    /// The density of [`Self::sample_side`] on the side of `wo`.
    pub(super) fn pdf_of_side(&self, wi: DVec3, wo: DVec3, lanes: &SampledSpectrum) -> f64 {
        let Some(pair) = self.pair(wi, wo) else {
            return 0.0;
        };
        let [loss, _, lobe] = pair.drawn_as_lost();
        (1.0 - loss) * pair.visible(&self.ratios).dot(*lanes) + loss * lobe
    }

    /// A direction on one side: every facet mirrors, or every facet that can refracts.
    pub(super) fn sample_side(
        &self,
        wi: DVec3,
        is_near: bool,
        lanes: &SampledSpectrum,
        u: [f64; 3],
    ) -> Option<DVec3> {
        let rough = self.rough?;
        let mut choice = u[2];
        if happens(rough.loss(wi), &mut choice) {
            return rough.sample_lost(is_near, u);
        }
        let h = rough.table.ggx().visible_normal(wi, [u[0], u[1]]);
        if is_near {
            return above(reflect(wi, h));
        }
        let eta = self.ratios.choose(lanes, &mut choice);
        refract(wi, h, eta).filter(|wo| wo.z < 0.0)
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
        let rough = self.rough.filter(|_| wi.z > 0.0 && wo.z != 0.0)?;
        let table = rough.table;
        Some(Pair {
            rough,
            wi,
            wo,
            lambda_i: table.ggx().lambda(wi),
            mu_i: table.between_cosines(wi.z),
            mu_o: table.between_cosines(wo.z.abs()),
        })
    }
}

impl Rough<'_> {
    /// The share of the light from `wi` that one facet does not send on.
    fn loss(&self, wi: DVec3) -> f64 {
        self.middle.here.shares(self.table.between_cosines(wi.z)).loss
    }

    /// A direction of that light on one side.
    fn sample_lost(&self, is_near: bool, u: [f64; 3]) -> Option<DVec3> {
        let side = if is_near { self.middle.here } else { self.middle.there };
        let wo = above(self.table.sample_lobe(side, [u[0], u[1]]));
        wo.map(|wo| if is_near { wo } else { -wo })
    }
}

impl<'a> Pair<'a> {
    /// The share of the light that one facet does not send on, the chance that it goes to wo's side, and the
    /// density of wo there, as they are drawn.
    fn drawn_as_lost(&self) -> [f64; 3] {
        let Rough { table, middle, .. } = &self.rough;
        let (chance, side) = self.returned_to(middle);
        let lobe = table.lobe_density(side, self.mu_o) * self.wo.z.abs() * FRAC_1_PI;
        [middle.here.shares(self.mu_i).loss, chance, lobe]
    }

    fn masking(&self) -> f64 {
        let lambda_o = self.rough.table.ggx().lambda(self.wo);
        if self.wo.z > 0.0 {
            masking_of_reflection(self.lambda_i, lambda_o)
        } else {
            masking_of_transmission(self.lambda_i, lambda_o)
        }
    }

    /// One facet's share of the light, before other facets hide it, per sr of wo.
    fn single(&self, ratios: &Ratios) -> SampledSpectrum {
        if self.wo.z > 0.0 {
            let (cos_i, visible) = self.mirrored();
            return ratios.map(|eta| dielectric_reflectance(cos_i, eta)) * visible;
        }
        ratios.map(|eta| {
            let [share, visible] = self.refracted(eta);
            share * visible
        })
    }

    /// The density of the facet among those seen, per sr of wo.
    fn visible(&self, ratios: &Ratios) -> SampledSpectrum {
        if self.wo.z > 0.0 {
            SampledSpectrum::splat(self.mirrored().1)
        } else {
            ratios.map(|eta| self.refracted(eta)[1])
        }
    }

    /// The cosine of incidence on the facet that mirrors, and that facet's density.
    fn mirrored(&self) -> (f64, f64) {
        let h = (self.wi + self.wo).normalize();
        let cos_i = self.wi.dot(h);
        let seen = self.rough.table.ggx().visible_density(self.wi, h, self.lambda_i);
        (cos_i, seen / (4.0 * cos_i))
    }

    /// What the facet that refracts lets through, and that facet's density.
    ///
    /// Walter et al., eqs. (16), (17) and (21): dωₕ/dωₒ = η²·|wo·h|/(wi·h + η·wo·h)². Free of branches,
    /// so that lanes go side by side.
    fn refracted(&self, eta: f64) -> [f64; 2] {
        let sum = self.wi + self.wo * eta;
        let length2 = sum.length_squared();
        let h = sum * (length2.sqrt().recip().copysign(sum.z));
        let (cos_i, cos_o) = (self.wi.dot(h), -self.wo.dot(h));
        let seen = self.rough.table.ggx().visible_density(self.wi, h, self.lambda_i);
        // By Snell's law, these are the cosines on both sides of the facet.
        let [s, p] = polarised_reflectances_between(cos_i, cos_o, eta);
        let is_joined = cos_i > 0.0 && cos_o > 0.0;
        let found = [1.0 - 0.5 * (s + p), seen * eta * eta * cos_o / length2];
        found.map(|value| if is_joined { value } else { 0.0 })
    }

    /// The share of the lost light that goes to wo's side, and that side.
    fn returned_to(&self, sides: &Sides<'a>) -> (f64, Side<'a>) {
        if self.wo.z > 0.0 {
            (1.0 - sides.through, sides.here)
        } else {
            (sides.through, sides.there)
        }
    }

    /// The light that meets more than one facet.
    ///
    /// Between the outermost lanes it is nearly linear in the contrast (η − 1)/(η + 1). To the other side it
    /// is η² times that of the way back, and so this of it over η is the same both ways.
    fn further(&self, ratios: &Ratios) -> SampledSpectrum {
        let (low, high) = ratios.outermost();
        let scale = |eta: f64| if self.wo.z > 0.0 { 1.0 } else { eta };
        let [first, last] = [low, high].map(|eta| self.further_at(eta) / scale(eta));
        let contrast = |eta: f64| (eta - 1.0) / (eta + 1.0);
        let (from, span) = (contrast(low), contrast(high) - contrast(low));
        let slope = if span > 0.0 { (last - first) / span } else { 0.0 };
        ratios.map(|eta| (first + slope * (contrast(eta) - from)) * scale(eta))
    }

    fn further_at(&self, eta: f64) -> f64 {
        let sides = self.rough.sides(eta);
        let lost = sides.here.shares(self.mu_i).loss;
        let (share, side) = self.returned_to(&sides);
        let mean = side.mean_loss();
        if mean <= 0.0 {
            return 0.0;
        }
        share * lost * side.shares(self.mu_o).loss / mean * self.wo.z.abs() * FRAC_1_PI
    }
}

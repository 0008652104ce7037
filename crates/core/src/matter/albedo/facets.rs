// SPDX-License-Identifier: Apache-2.0 OR MIT
//! What becomes of light that meets one facet: means over the facets that are seen.

use super::Shares;
use crate::math::DVec3;
use crate::matter::fresnel::{dielectric_reflectance, reflect, refract};
use crate::matter::microfacet::{masking_of_reflection, masking_of_transmission, Ggx};

/// Points of the quadrature over visible facets: with 4096, losses are right to 1e-3.
pub const FACETS: usize = 4096;

/// Call `f(wi, h, Λ(wi))` for evenly spread facets that are seen from a direction of cosine `mu`;
/// returns the share of each.
fn for_visible(facets: usize, ggx: Ggx, mu: f64, mut f: impl FnMut(DVec3, DVec3, f64)) -> f64 {
    // A lattice by the golden ratio.
    const STEP: f64 = 0.618_033_988_749_894_8;
    // The limit µ → 0 stands for the last direction above the surface.
    let mu = mu.clamp(1e-6 * ggx.alpha(), 1.0);
    let wi = DVec3::new(((1.0 - mu) * (1.0 + mu)).sqrt(), 0.0, mu);
    let lambda = ggx.lambda(wi);
    let share = 1.0 / facets as f64;
    for i in 0..facets {
        let u = [(i as f64 * STEP).fract(), (i as f64 + 0.5) * share];
        f(wi, ggx.visible_normal(wi, u), lambda);
    }
    share
}

/// The share that does not leave a surface of facets that reflect all.
pub fn reflector_loss(facets: usize, ggx: Ggx, mu: f64) -> f64 {
    let mut sum = 0.0;
    let share = for_visible(facets, ggx, mu, |wi, h, lambda| {
        let wo = reflect(wi, h);
        if wo.z > 0.0 {
            sum += (1.0 + lambda) * masking_of_reflection(lambda, ggx.lambda(wo));
        }
    });
    (1.0 - sum * share).max(0.0)
}

/// What becomes of light at an interface of index ratio `eta`.
pub fn interface_shares(facets: usize, ggx: Ggx, mu: f64, eta: f64) -> Shares {
    let (mut reflected, mut transmitted) = (0.0, 0.0);
    let share = for_visible(facets, ggx, mu, |wi, h, lambda| {
        let f = dielectric_reflectance(wi.dot(h), eta);
        let wo = reflect(wi, h);
        if wo.z > 0.0 {
            reflected += f * (1.0 + lambda) * masking_of_reflection(lambda, ggx.lambda(wo));
        }
        if let Some(wo) = refract(wi, h, eta).filter(|wo| wo.z < 0.0) {
            let masking = masking_of_transmission(lambda, ggx.lambda(wo));
            transmitted += (1.0 - f) * (1.0 + lambda) * masking;
        }
    });
    let loss = (1.0 - (reflected + transmitted) * share).max(0.0);
    Shares { loss, reflected: reflected * share }
}

/// The mean cosine of incidence on the facets that are seen.
pub fn mean_incidence(facets: usize, ggx: Ggx, mu: f64) -> f64 {
    let mut sum = 0.0;
    let share = for_visible(facets, ggx, mu, |wi, h, _| sum += wi.dot(h));
    sum * share
}

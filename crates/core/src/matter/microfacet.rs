// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Ggx`]: how the slopes of a rough surface are spread, and how they hide each other.
//!
//! Directions are local: z is the surface's mean normal. Smith's Λ and the masking G stand for
//! surfaces whose heights and slopes are independent; light that passes through is masked on both
//! sides of the facet at the same height.
//!
//! Sources: B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007;
//! E. Heitz, "Understanding the Masking-Shadowing Function", JCGT 3(2), 2014; E. Heitz et al.,
//! "Multiple-Scattering Microfacet BSDFs with the Smith Model", SIGGRAPH 2016.

use std::f64::consts::{PI, TAU};

use crate::math::DVec3;

/// The distribution of Trowbridge and Reitz (GGX) of width α, the same in all azimuths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    alpha: f64,
}

impl Ggx {
    /// A distribution of width `alpha` > 0.
    pub fn new(alpha: f64) -> Self {
        Self { alpha }
    }

    /// The width α.
    pub fn alpha(self) -> f64 {
        self.alpha
    }

    /// D(h): the area of facets with the normal `h` (`h.z` > 0) per area of surface and per sr.
    pub fn density(self, h: DVec3) -> f64 {
        let alpha2 = self.alpha * self.alpha;
        let spread = (h.x * h.x + h.y * h.y) / alpha2 + h.z * h.z;
        1.0 / (PI * alpha2 * spread * spread)
    }

    /// Smith's Λ(w): the area that hides other facets from `w` per area that is seen.
    pub fn lambda(self, w: DVec3) -> f64 {
        let slope2 = self.alpha * self.alpha * (w.x * w.x + w.y * w.y) / (w.z * w.z);
        0.5 * slope2 / (1.0 + (1.0 + slope2).sqrt())
    }

    /// The density per sr of [`Self::visible_normal`]: D(h)·G₁(wi)·max(0, wi·h)/wi.z.
    ///
    /// `lambda_i` is Λ(wi).
    pub fn visible_density(self, wi: DVec3, h: DVec3, lambda_i: f64) -> f64 {
        self.density(h) * wi.dot(h).max(0.0) / ((1.0 + lambda_i) * wi.z)
    }

    /// The normal of a facet that is seen from `wi` (`wi.z` > 0), by two uniform numbers.
    ///
    /// Source: J. Dupuy and A. Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023.
    pub fn visible_normal(self, wi: DVec3, u: [f64; 2]) -> DVec3 {
        let stretched = DVec3::new(self.alpha * wi.x, self.alpha * wi.y, wi.z).normalize();
        let z = (1.0 - u[1]) * (1.0 + stretched.z) - stretched.z;
        let radius = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        let (sin, cos) = (TAU * u[0]).sin_cos();
        let h = DVec3::new(radius * cos, radius * sin, z) + stretched;
        DVec3::new(self.alpha * h.x, self.alpha * h.y, h.z.max(f64::MIN_POSITIVE)).normalize()
    }
}

/// The share G₂ of facets that both directions of a reflection see: 1/(1 + Λᵢ + Λₒ).
pub fn masking_of_reflection(lambda_i: f64, lambda_o: f64) -> f64 {
    1.0 / (1.0 + lambda_i + lambda_o)
}

/// The share G₂ of facets that both directions of a transmission see: the mean over the heights
/// of the facets, ∫₀¹ c^Λᵢ·(1 − c)^Λₒ dc = B(1 + Λᵢ, 1 + Λₒ).
///
/// What is high is open to one side and hidden from the other. To 1e-9, by the approximation of
/// Lanczos (1964) to Γ with γ = 5 and six terms.
pub fn masking_of_transmission(lambda_i: f64, lambda_o: f64) -> f64 {
    const ROOT_TAU: f64 = 2.506_628_274_631_000_5;
    const E_TO_MINUS_4_5: f64 = 0.011_108_996_538_242_306;
    let series = |z: f64| {
        1.000_000_000_190_015 + 76.180_091_729_471_46 / (z + 1.0)
            - 86.505_320_329_416_77 / (z + 2.0)
            + 24.014_098_240_830_91 / (z + 3.0)
            - 1.231_739_572_450_155 / (z + 4.0)
            + 1.208_650_973_866_179e-3 / (z + 5.0)
            - 5.395_239_384_953e-6 / (z + 6.0)
    };
    let (a, b) = (lambda_i.max(lambda_o), lambda_i.min(lambda_o));
    let sum = a + b + 6.5;
    let powers = (a + 0.5) * (-(b + 1.0) / sum).ln_1p() + (b + 0.5) * ((b + 5.5) / sum).ln();
    ROOT_TAU * E_TO_MINUS_4_5 * powers.exp() / sum.sqrt() * series(a) * series(b)
        / series(a + b + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn masking_of_transmission_is_the_beta_function() {
        // B(x, y) of whole numbers is (x − 1)!(y − 1)!/(x + y − 1)!.
        for (a, b, expected) in [
            (0.0, 0.0, 1.0),
            (1.0, 1.0, 1.0 / 6.0),
            (2.0, 1.0, 1.0 / 12.0),
            (4.0, 3.0, 1.0 / 280.0),
            (0.5, 0.5, PI / 8.0),
            (1e9, 0.0, 1.0 / (1e9 + 1.0)),
        ] {
            assert!((masking_of_transmission(a, b) / expected - 1.0).abs() < 2e-9, "{a} {b}");
        }
    }

    #[test]
    fn masking_is_the_mean_over_the_heights_of_the_facets() {
        // A facet at the height share c is open upwards with c^Λ and downwards with (1 − c)^Λ.
        let steps = 200_000;
        for (i, o) in [(0.3, 0.8), (2.0, 0.1), (1.0, 4.0)] {
            let (mut up, mut down) = (0.0, 0.0);
            for step in 0..steps {
                let c = (f64::from(step) + 0.5) / f64::from(steps);
                up += c.powf(i) * c.powf(o) / f64::from(steps);
                down += c.powf(i) * (1.0 - c).powf(o) / f64::from(steps);
            }
            assert!((masking_of_reflection(i, o) - up).abs() < 1e-6);
            assert!((masking_of_transmission(i, o) - down).abs() < 1e-4, "{i} {o} {down}");
        }
    }

    proptest! {
        #[test]
        fn a_surface_that_one_side_sees_whole_is_masked_alike_both_ways(lambda in 0.0..100.0f64) {
            let through = masking_of_transmission(lambda, 0.0);
            prop_assert!((through - masking_of_reflection(lambda, 0.0)).abs() < 1e-9);
            prop_assert!((through - masking_of_transmission(0.0, lambda)).abs() < 1e-15);
        }

        #[test]
        fn facets_seen_from_any_direction_add_up_to_the_surface_seen(
            cos in 0.02..1.0f64, alpha in 0.05..1.0f64,
        ) {
            // ∫ D(h)·max(0, wi·h) dh = wi.z·(1 + Λ), over a grid of slopes.
            let ggx = Ggx::new(alpha);
            let wi = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            let steps = 400;
            let mut sum = 0.0;
            for i in 0..steps {
                // tan θ = α·√(v/(1 − v)) spreads GGX evenly over v = 1 − w².
                let w = (f64::from(i) + 0.5) / f64::from(steps);
                let tangent = alpha * (1.0 - w * w).sqrt() / w;
                let z = 1.0 / (1.0 + tangent * tangent).sqrt();
                for j in 0..steps {
                    let (sin, cos) = (PI * (f64::from(j) + 0.5) / f64::from(steps)).sin_cos();
                    let h = DVec3::new(tangent * z * cos, tangent * z * sin, z);
                    sum += 2.0 * w * wi.dot(h).max(0.0) / z;
                }
            }
            let mean = sum / f64::from(steps * steps);
            let expected = cos * (1.0 + ggx.lambda(wi));
            prop_assert!((mean / expected - 1.0).abs() < 2e-3, "{mean} {expected}");
        }
    }
}

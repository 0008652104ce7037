// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Lacquer`]: a clear or dyed coat that follows a metal's surface.

use super::fresnel::{polarised_conductor_reflectances, polarised_reflectances_between};
use crate::spectrum::{SampledSpectrum, SampledWavelengths, SpectralTable};

/// A coat of even thickness, too thick to show interference, on a metal.
#[derive(Clone, Debug)]
pub struct Lacquer {
    /// Its refractive index `n_c`(λ).
    pub index: SpectralTable,
    /// Its absorption coefficient times its thickness, a(λ), without unit.
    pub optical_depth: SpectralTable,
}

impl Lacquer {
    /// The coat on one path's wavelengths.
    pub(super) fn at(&self, wavelengths: SampledWavelengths) -> SampledLacquer {
        SampledLacquer {
            index: self.index.at(wavelengths),
            optical_depth: self.optical_depth.at(wavelengths),
        }
    }
}

/// A lacquer on one path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampledLacquer {
    index: SampledSpectrum,
    optical_depth: SampledSpectrum,
}

impl SampledLacquer {
    /// The reflectance of coat and metal with all inter-reflections, for s and p apart:
    /// R = F + (1 − F)²·R₁₂·τ²/(1 − F·R₁₂·τ²), τ = exp(−a/cos `θ_c`).
    ///
    /// F belongs to the coat's surface, R₁₂ = `factor`·metal to the metal below it. The metal's
    /// indices `n` and `k` are absolute, `medium_index` is that of what lies before the coat.
    pub(super) fn reflectance(
        &self,
        cos_i: f64,
        medium_index: SampledSpectrum,
        (n, k): (SampledSpectrum, SampledSpectrum),
        factor: f64,
    ) -> SampledSpectrum {
        let sin2_i = (1.0 - cos_i) * (1.0 + cos_i);
        let eta = self.index / medium_index;
        // Beyond the critical angle the lanes run along with any cosine, and end at 1.
        let cos2_c = eta.map(|eta| 1.0 - sin2_i / (eta * eta));
        let cos_c = cos2_c.map(|cos2| cos2.max(1e-12).sqrt());
        let there_and_back = (self.optical_depth * 2.0 / cos_c).transmittance(1.0);
        SampledSpectrum::from_fn(|j| {
            let coat = polarised_reflectances_between(cos_i, cos_c.0[j], eta.0[j]);
            let (n, k) = (n.0[j] / self.index.0[j], k.0[j] / self.index.0[j]);
            let metal = polarised_conductor_reflectances(cos_c.0[j], n, k);
            let total = |f: f64, metal: f64| {
                let below = factor * metal * there_and_back.0[j];
                f + (1.0 - f) * (1.0 - f) * below / (1.0 - f * below)
            };
            let both = 0.5 * (total(coat[0], metal[0]) + total(coat[1], metal[1]));
            if cos2_c.0[j] > 0.0 {
                both
            } else {
                1.0
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matter::{conductor_reflectance, dielectric_reflectance};
    use crate::spectrum::LANES;

    const AIR: SampledSpectrum = SampledSpectrum::ONE;

    fn lacquer(index: f64, optical_depth: f64) -> SampledLacquer {
        let table = |value| SpectralTable::from_ascending(&[value; LANES]).unwrap();
        let lacquer = Lacquer { index: table(index), optical_depth: table(optical_depth) };
        lacquer.at(SampledWavelengths { phase: 0 })
    }

    fn metal(n: f64, k: f64) -> (SampledSpectrum, SampledSpectrum) {
        (SampledSpectrum::splat(n), SampledSpectrum::splat(k))
    }

    #[test]
    fn a_coat_of_the_mediums_own_index_is_the_bare_metal() {
        for cos in [1.0, 0.7, 0.2, 0.01] {
            let coated = lacquer(1.0, 0.0).reflectance(cos, AIR, metal(1.015, 6.627), 1.0);
            assert!((coated.0[0] - conductor_reflectance(cos, 1.015, 6.627)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_coat_that_absorbs_all_leaves_only_its_own_surface() {
        for cos in [1.0, 0.7, 0.2, 0.01] {
            let coated = lacquer(1.5, 800.0).reflectance(cos, AIR, metal(1.015, 6.627), 1.0);
            assert!((coated.0[0] - dielectric_reflectance(cos, 1.5)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_perfect_metal_under_a_clear_coat_reflects_all() {
        for cos in [1.0, 0.5, 0.05] {
            let coated = lacquer(1.5, 0.0).reflectance(cos, AIR, metal(0.0, 5.0), 1.0);
            assert!((coated.0[7] - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn clear_lacquer_on_aluminium_is_the_sum_of_its_inter_reflections() {
        // Normal incidence: F = 0.04, R₁₂ = 0.87539 for (1.015 + 6.627i)/1.5, τ = e⁻⁰·⁰⁵.
        let (n, k): (f64, f64) = (1.015 / 1.5, 6.627 / 1.5);
        let metal_12 = ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
        let (f, tau) = (0.04_f64, (-0.05_f64).exp());
        let mut expected = f;
        let mut carried = (1.0 - f) * metal_12 * tau * tau;
        for _ in 0..40 {
            expected += carried * (1.0 - f);
            carried *= f * metal_12 * tau * tau;
        }
        let coated = lacquer(1.5, 0.05).reflectance(1.0, AIR, metal(1.015, 6.627), 1.0);
        assert!((coated.0[3] - expected).abs() < 1e-12);
    }

    #[test]
    fn absorption_grows_with_the_slant_inside_the_coat() {
        // All but the first reflection of a weak metal: exp(−2a/cos θ_c), sin θ_c = sin 60°/1.5.
        let cos_c = (1.0 - 0.75 / 2.25_f64).sqrt();
        let (faint, depth) = (1e-9, 0.7);
        let below = |depth: f64| {
            let all = lacquer(1.5, depth).reflectance(0.5, AIR, metal(1.0, 3.0), faint);
            all.0[0] - dielectric_reflectance(0.5, 1.5)
        };
        let ratio = below(depth) / below(0.0);
        assert!((ratio / (-2.0 * depth / cos_c).exp() - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_thinner_coat_index_than_the_mediums_reflects_totally() {
        let medium = SampledSpectrum::splat(1.6);
        let coated = lacquer(1.4, 0.3).reflectance(0.2, medium, metal(1.0, 6.0), 1.0);
        assert_eq!(coated.0[0], 1.0);
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Furnaces: what does not absorb gives back all light.

use super::*;

const COSINES: [f64; 7] = [1.0, 0.9, 0.6, 0.3, 0.1, 0.03, 0.005];

/// ∫ eval dωₒ per lane, by the mean of eval/pdf over a lattice of the sampler's numbers.
fn albedo_of(bsdf: &Bsdf, wi: DVec3, lanes: &SampledSpectrum) -> SampledSpectrum {
    // The powers of the root of x⁴ = x + 1: an even lattice in three dimensions.
    const STEP: [f64; 3] =
        [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_2];
    const POINTS: usize = 60_000;
    let mut sum = SampledSpectrum::ZERO;
    for i in 0..POINTS {
        let u = STEP.map(|step| (0.5 + i as f64 * step).fract());
        if let Some(wo) = bsdf.sample(wi, lanes, u) {
            sum += bsdf.eval(wi, wo) * (1.0 / bsdf.pdf(wi, wo, lanes));
        }
    }
    sum * (1.0 / POINTS as f64)
}

#[test]
fn rough_mirrors_that_absorb_nothing_reflect_all() {
    let mut worst = (0.0, String::new());
    for alpha in [0.001, 0.01, 0.05, 0.1, 0.3, 0.6, 1.0] {
        let table = AlbedoTable::new(alpha).unwrap();
        let facet = Facet::Measured(SampledSpectrum::ONE);
        let mirror = Bsdf::Reflector(Reflector::new(facet, Some(&table)));
        for cos in COSINES {
            let wi = direction(cos, 0.3);
            let error = (albedo_of(&mirror, wi, &even_lanes()).0[0] - 1.0).abs();
            if error > worst.0 {
                worst = (error, format!("{alpha} {cos}"));
            }
        }
    }
    println!("{worst:?}");
    assert!(worst.0 < 1e-3, "{worst:?}");
}

#[test]
fn rough_glass_loses_nothing_from_either_side() {
    let mut worst = (0.0, String::new());
    for alpha in [0.001, 0.01, 0.05, 0.1, 0.3, 0.6, 1.0] {
        let table = AlbedoTable::new(alpha).unwrap();
        for eta in [1.0 / 1.7, 1.0 / 1.49, 0.94, 1.02, 1.063, 1.3, 1.5, 1.7] {
            let glass = Bsdf::interface(SampledSpectrum::splat(eta), Some(&table));
            for cos in COSINES {
                let wi = direction(cos, 0.3);
                let albedo = albedo_of(&glass, wi, &even_lanes()).0[0];
                let error = (albedo - 1.0).abs();
                if error > 5e-4 {
                    println!("{alpha} {eta} {cos}: {albedo}");
                }
                if error > worst.0 {
                    worst = (error, format!("{alpha} {eta} {cos}: {albedo}"));
                }
            }
        }
    }
    println!("{worst:?}");
    assert!(worst.0 < 1e-3, "{worst:?}");
}

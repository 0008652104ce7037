// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Furnaces: what does not absorb gives back all light.

use std::ops::Range;

use super::*;

/// ∫ eval dωₒ per lane, by the mean of eval/pdf over a lattice of the sampler's numbers.
fn albedo_of(
    bsdf: &Bsdf,
    wi: DVec3,
    lanes: &SampledSpectrum,
    points: Range<usize>,
) -> SampledSpectrum {
    // The powers of the root of x⁴ = x + 1: an even lattice in three dimensions.
    const STEP: [f64; 3] =
        [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_2];
    let mut sum = SampledSpectrum::ZERO;
    let share = 1.0 / points.len() as f64;
    for i in points {
        let u = STEP.map(|step| (0.5 + i as f64 * step).fract());
        if let Some(wo) = bsdf.sample(wi, lanes, u) {
            sum += bsdf.eval(wi, wo) * (1.0 / bsdf.pdf(wi, wo, lanes));
        }
    }
    sum * share
}

/// The mean albedo of light from everywhere on one side: what a furnace of many bounces sees.
fn mean_albedo(bsdf: &Bsdf) -> f64 {
    const DIRECTIONS: usize = 400;
    const POINTS: usize = 700;
    let sum: f64 = (0..DIRECTIONS)
        .map(|i| {
            let cos = ((i as f64 + 0.5) / DIRECTIONS as f64).sqrt();
            let points = i * POINTS..(i + 1) * POINTS;
            albedo_of(bsdf, direction(cos, 0.3), &even_lanes(), points).0[0]
        })
        .sum();
    sum / DIRECTIONS as f64
}

#[test]
fn rough_mirrors_that_absorb_nothing_reflect_all() {
    for alpha in [0.001, 0.01, 0.1, 0.3, 0.6, 1.0] {
        let table = AlbedoTable::new(alpha).unwrap();
        let facet = Facet::Measured(SampledSpectrum::ONE);
        let mirror = Bsdf::Reflector(Reflector::new(facet, Some(&table)));
        for cos in [1.0, 0.6, 0.3, 0.1, 0.03] {
            let albedo = albedo_of(&mirror, direction(cos, 0.3), &even_lanes(), 0..60_000).0[0];
            assert!((albedo - 1.0).abs() < 1e-3, "{alpha} {cos}: {albedo}");
            assert!((mirror.albedo(direction(cos, 0.3)).0[0] - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn rough_glass_loses_nothing_from_either_side() {
    for alpha in [0.001, 0.05, 0.3, 1.0] {
        let table = AlbedoTable::new(alpha).unwrap();
        for eta in [1.0 / 1.7, 0.94, 1.063, 1.49, 1.7] {
            let glass = Bsdf::interface(SampledSpectrum::splat(eta), Some(&table));
            let albedo = mean_albedo(&glass);
            assert!((albedo - 1.0).abs() < 1e-3, "{alpha} {eta}: {albedo}");
        }
    }
}

#[test]
fn dispersive_rough_glass_loses_nothing_on_any_lane() {
    let table = AlbedoTable::new(0.2).unwrap();
    for eta in [1.5, 1.0 / 1.5] {
        let glass = Bsdf::interface(dispersive(eta), Some(&table));
        // Lanes of other η than the steering one see tails of its lobe: noise, but no bias.
        for (lanes, noise) in [(even_lanes(), 0.02), (uneven_lanes(), 0.05)] {
            let albedo = albedo_of(&glass, direction(0.7, 0.0), &lanes, 0..100_000);
            for (j, lane) in albedo.0.iter().enumerate() {
                assert!((lane - 1.0).abs() < noise, "{eta}, lane {j}: {lane}");
            }
            let mean = albedo.dot(lanes);
            assert!((mean - 1.0).abs() < 8e-3, "{eta}: {mean}");
        }
    }
}

#[test]
fn a_white_base_under_a_rough_coat_gives_back_all_light() {
    for alpha in [0.001, 0.1, 0.5, 1.0] {
        let table = AlbedoTable::new(alpha).unwrap();
        for eta in [1.0 / 1.2, 1.49, 1.7] {
            let ratio = SampledSpectrum::splat(eta);
            let coat = Bsdf::Glossy(Glossy::new(ratio, SampledSpectrum::ONE, Some(&table)));
            let albedo = mean_albedo(&coat);
            // Below η = 1 a table blurs the step of R(µ) at the critical angle.
            let bound = if eta < 1.0 { 6e-3 } else { 1e-3 };
            assert!((albedo - 1.0).abs() < bound, "{alpha} {eta}: {albedo}");
        }
    }
}

#[test]
fn a_rough_metals_albedo_is_near_the_integral_of_its_answer_and_below_one() {
    let lanes = even_lanes();
    for alpha in [0.05, 0.3, 1.0] {
        let table = AlbedoTable::new(alpha).unwrap();
        for facet in [aluminium(), lacquered()] {
            let metal = Bsdf::Reflector(Reflector::new(facet, Some(&table)));
            for cos in [1.0, 0.5, 0.1] {
                let wi = direction(cos, 0.3);
                let (stated, found) = (metal.albedo(wi), albedo_of(&metal, wi, &lanes, 0..20_000));
                for (a, b) in stated.0.iter().zip(found.0) {
                    assert!(b < 1.0 && (a - b).abs() < 0.05, "{alpha} {cos}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn a_grey_rough_mirror_loses_its_share_at_every_facet() {
    // One facet gives back F·(1 − ℓ). What is lost then meets facets of the mean loss.
    let (f, table) = (0.5, AlbedoTable::new(1.0).unwrap());
    let mirror = Reflector::new(Facet::Measured(SampledSpectrum::splat(f)), Some(&table));
    let mean = table.mean_reflector_loss();
    assert!(mean > 0.1);
    for cos in [0.9, 0.4] {
        let loss = table.reflector_loss(table.between_cosines(cos));
        let mut expected = f * (1.0 - loss);
        let mut carried = f * loss;
        for _ in 0..60 {
            carried *= f;
            expected += carried * (1.0 - mean);
            carried *= mean;
        }
        let wi = direction(cos, 0.0);
        let found = albedo_of(&Bsdf::Reflector(mirror), wi, &even_lanes(), 0..60_000).0[0];
        assert!((found - expected).abs() < 1e-3, "{cos}: {found} {expected}");
    }
}

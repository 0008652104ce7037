// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Surfaces at the ends of their ranges: nearly smooth, white, black, alike on both sides.

use super::*;
use crate::matter::{
    conductor_reflectance, dielectric_reflectance, diffuse_dielectric_reflectance, reflect, refract,
};

/// Where `sample` goes for many numbers, with eval/pdf of lane 0: (direction, weight).
fn walks(bsdf: &Bsdf, wi: DVec3) -> Vec<(DVec3, f64)> {
    let mut numbers = Numbers(7);
    let lanes = even_lanes();
    (0..20_000)
        .filter_map(|_| {
            let u = [numbers.next(), numbers.next(), numbers.next()];
            let wo = bsdf.sample(wi, &lanes, u)?;
            Some((wo, bsdf.eval(wi, wo).0[0] / bsdf.pdf(wi, wo, &lanes)))
        })
        .collect()
}

/// The mean weight of the walks that end within an angle of a direction.
fn share_near(walks: &[(DVec3, f64)], axis: DVec3, angle: f64) -> f64 {
    let near = walks.iter().filter(|(wo, _)| (*wo - axis).length() < angle);
    near.map(|(_, weight)| weight).sum::<f64>() / 20_000.0
}

#[test]
fn nearly_smooth_glass_reflects_and_refracts_as_smooth_glass() {
    let table = AlbedoTable::new(0.001).unwrap();
    for eta in [1.5, 1.0 / 1.5] {
        let glass = Bsdf::interface(SampledSpectrum::splat(eta), Some(&table));
        for cos in [1.0, 0.8, 0.5] {
            let wi = direction(cos, 1.0);
            let found = walks(&glass, wi);
            let f = dielectric_reflectance(cos, eta);
            // Five standard errors of a share of 20 000.
            let bound = 5.0 * (f * (1.0 - f) / 20_000.0).sqrt() + 2e-3;
            assert!((share_near(&found, reflect(wi, DVec3::Z), 0.05) - f).abs() < bound);
            if let Some(wo) = refract(wi, DVec3::Z, eta) {
                assert!((share_near(&found, wo, 0.05) - (1.0 - f)).abs() < bound, "{eta} {cos}");
            }
        }
    }
}

#[test]
fn a_nearly_smooth_metal_reflects_as_a_smooth_one() {
    let table = AlbedoTable::new(0.001).unwrap();
    let metal = Bsdf::Reflector(Reflector::new(aluminium(), Some(&table)));
    for cos in [1.0, 0.6, 0.3] {
        let wi = direction(cos, 1.0);
        let share = share_near(&walks(&metal, wi), reflect(wi, DVec3::Z), 0.05);
        let smooth = Bsdf::Reflector(Reflector::new(aluminium(), None)).mirror(cos).unwrap();
        assert!((share - smooth.0[0]).abs() < 2e-3, "{cos}: {share} {smooth:?}");
        assert!((smooth.0[0] - conductor_reflectance(cos, 0.45, 4.7)).abs() < 1e-15);
    }
}

#[test]
fn a_nearly_smooth_coat_is_a_smooth_one() {
    let (eta, rho) = (SampledSpectrum::splat(1.5), SampledSpectrum::splat(0.6));
    let table = AlbedoTable::new(0.001).unwrap();
    let rough = Bsdf::Glossy(Glossy::new(eta, rho, Some(&table)));
    let smooth = Bsdf::Glossy(Glossy::new(eta, rho, None));
    for cos in [1.0, 0.5, 0.1] {
        let wi = direction(cos, 0.0);
        let wo = direction(0.7, 3.0);
        let (a, b) = (rough.eval(wi, wo).0[0], smooth.eval(wi, wo).0[0]);
        // The rough coat's tail reaches wo with some 1e-6.
        assert!((a / b - 1.0).abs() < 2e-3, "{cos}: {a} {b}");
        let all = smooth.albedo(wi).0[0] + smooth.mirror(cos).unwrap().0[0];
        assert!((rough.albedo(wi).0[0] - all).abs() < 1e-3);
    }
}

#[test]
fn a_white_base_under_a_clear_coat_gives_back_all_light() {
    for eta in [1.0, 1.0 / 1.2, 1.33, 1.5, 1.8] {
        let coat = Glossy::new(SampledSpectrum::splat(eta), SampledSpectrum::ONE, None);
        for cos in [1.0, 0.7, 0.3, 0.05] {
            let wi = direction(cos, 0.0);
            let all = Bsdf::Glossy(coat).albedo(wi) + Bsdf::Glossy(coat).mirror(cos).unwrap();
            let is_total = dielectric_reflectance(cos, eta) == 1.0;
            assert!((all.0[0] - 1.0).abs() < 1e-9 || is_total, "{eta} {cos} {all:?}");
        }
    }
}

#[test]
fn a_smooth_coats_albedo_is_the_integral_of_its_answer() {
    let rho = 0.5;
    let coat =
        Bsdf::Glossy(Glossy::new(SampledSpectrum::splat(1.5), SampledSpectrum::splat(rho), None));
    let wi = direction(0.8, 0.0);
    let steps = 20_000;
    let sum: f64 = (0..steps)
        .map(|i| (f64::from(i) + 0.5) / f64::from(steps))
        .map(|mu| coat.eval(wi, direction(mu, 1.0)).0[0])
        .sum();
    let integral = sum * std::f64::consts::TAU / f64::from(steps);
    assert!((integral - coat.albedo(wi).0[0]).abs() < 1e-6);
    // (1 − F(µ))·ρ·(1 − F_in)/(1 − ρ·F_in) with F_in = 0.5963 for n = 1.5 (Judd 1942).
    let inside = diffuse_dielectric_reflectance(1.0 / 1.5);
    let f = dielectric_reflectance(0.8, 1.5);
    let expected = (1.0 - f) * rho * (1.0 - inside) / (1.0 - rho * inside);
    assert!((integral - expected).abs() < 1e-6);
}

#[test]
fn black_matter_answers_nothing() {
    let table = AlbedoTable::new(0.4).unwrap();
    let black = SampledSpectrum::ZERO;
    let (wi, wo) = (direction(0.5, 0.0), direction(0.6, 2.0));
    for bsdf in [
        Bsdf::Diffuse(Diffuse::new(black)),
        Bsdf::Transmitter(Transmitter::new(black, black)),
        Bsdf::Reflector(Reflector::new(Facet::Measured(black), Some(&table))),
        Bsdf::Glossy(Glossy::new(SampledSpectrum::splat(1.5), black, None)),
    ] {
        assert_eq!(bsdf.eval(wi, wo), SampledSpectrum::ZERO);
        assert_eq!(bsdf.albedo(wi), SampledSpectrum::ZERO);
        for u in [0.0, 0.3, 1.0 - f64::EPSILON] {
            let pdf = bsdf
                .sample(wi, &even_lanes(), [u; 3])
                .map_or(1.0, |wo| bsdf.pdf(wi, wo, &even_lanes()));
            assert!(pdf.is_finite() && pdf > 0.0);
        }
    }
}

#[test]
fn a_mixed_lane_of_equal_index_passes_rough_glass_nearly_straight_on() {
    // One lane has η = 1 exactly, the others refract: nothing may overflow.
    let table = AlbedoTable::new(0.3).unwrap();
    let mut eta = dispersive(1.02);
    eta.0[5] = 1.0;
    let glass = Bsdf::interface(eta, Some(&table));
    let wi = direction(0.9, 0.0);
    let lane = SampledSpectrum::ONE.only(5..6);
    let wo = glass.sample(wi, &lane, [0.3, 0.6, 0.9]).unwrap();
    assert!((wo + wi).length() < 1e-5);
    let (value, pdf) = (glass.eval(wi, wo), glass.pdf(wi, wo, &lane));
    assert!(value.is_radiance() && pdf.is_finite());
    assert!((value.0[5] / pdf - 1.0).abs() < 0.02, "{}", value.0[5] / pdf);
}

#[test]
fn every_answer_is_finite_where_directions_graze_or_coincide() {
    for alpha in [0.001, 1.0] {
        let table = AlbedoTable::new(alpha).unwrap();
        for bsdf in [
            Bsdf::interface(SampledSpectrum::splat(1.5), Some(&table)),
            Bsdf::interface(dispersive(1.0 / 1.5), Some(&table)),
            Bsdf::Reflector(Reflector::new(aluminium(), Some(&table))),
            Bsdf::Glossy(Glossy::new(dispersive(1.5), rising(0.0, 1.0), Some(&table))),
        ] {
            for wi in [1.0, 0.5, 1e-5, 1e-12].map(|cos| direction(cos, 0.2)) {
                for wo in [wi, -wi, reflect(wi, DVec3::Z), DVec3::X, -DVec3::Z] {
                    let pdf = bsdf.pdf(wi, wo, &even_lanes());
                    assert!(bsdf.eval(wi, wo).is_radiance(), "{alpha} {wi} {wo}");
                    assert!(pdf.is_finite() && pdf >= 0.0, "{alpha} {wi} {wo}");
                }
            }
            assert_eq!(bsdf.eval(-DVec3::Z, DVec3::Z), SampledSpectrum::ZERO);
            assert_eq!(bsdf.sample(-DVec3::Z, &even_lanes(), [0.5; 3]), None);
        }
    }
}

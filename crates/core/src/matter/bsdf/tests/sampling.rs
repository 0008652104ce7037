// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Every sampler follows its density.

use super::chi_square::deviate;
use super::*;
use crate::matter::{dielectric_reflectance, reflect, refract};

/// Above this normal deviate a sampler is wrong: Šidák's level for some 200 tests that together
/// err once in a hundred runs; the seeds are fixed.
const LIMIT: f64 = 4.0;

const COSINES: [f64; 4] = [0.99, 0.6, 0.2, 0.02];

/// The last direction before grazing at which a narrow lobe still clears the horizon.
fn cosines(alpha: f64) -> impl Iterator<Item = f64> {
    COSINES.into_iter().map(move |cos| if alpha < 0.05 { cos.max(0.2) } else { cos })
}

/// Test both sides apart, each round its own peak.
fn check(name: &str, bsdf: &Bsdf, wi: DVec3, lanes: &SampledSpectrum, peaks: [(DVec3, f64); 2]) {
    for (side, (axis, epsilon)) in [1.0, -1.0].into_iter().zip(peaks) {
        let is_counted = |wo: DVec3| wo.z * side > 0.0;
        let pdf = |wo: DVec3| bsdf.pdf(wi, wo, lanes);
        let sample = |u| bsdf.sample(wi, lanes, u);
        let z = deviate(Dome::new(axis, epsilon), &is_counted, &pdf, &sample, wi.z.to_bits());
        assert!(z < LIMIT, "{name}, wi.z = {}, side {side}: {z:.2} sigma", wi.z);
    }
}

/// The grid for a lobe of this width: round its peak if it is narrow, else with the horizon on a
/// line of the grid.
fn lobe(peak: DVec3, alpha: f64, width: f64) -> (DVec3, f64) {
    if alpha < 0.3 {
        (peak, width)
    } else {
        evenly(peak.z.signum())
    }
}

fn evenly(axis: f64) -> (DVec3, f64) {
    (DVec3::Z * axis, 1.0)
}

#[test]
fn matt_surfaces_are_sampled_by_their_density() {
    let rho = rising(0.1, 0.6);
    let sheet = Bsdf::Transmitter(Transmitter::new(rho, rising(0.4, 0.0)));
    for cos in COSINES {
        let wi = direction(cos, 1.0);
        for lanes in [even_lanes(), uneven_lanes()] {
            check("sheet", &sheet, wi, &lanes, [evenly(1.0), evenly(-1.0)]);
        }
        let matt = Bsdf::Diffuse(Diffuse::new(rho));
        check("matt", &matt, wi, &even_lanes(), [evenly(1.0), evenly(-1.0)]);
        let coat = Bsdf::Glossy(Glossy::new(dispersive(1.5), rho, None));
        check("glossy", &coat, wi, &even_lanes(), [evenly(1.0), evenly(-1.0)]);
    }
}

#[test]
fn rough_reflectors_are_sampled_by_their_density() {
    for alpha in [0.01, 0.1, 0.4, 1.0] {
        let table = AlbedoTable::new(alpha).unwrap();
        for cos in cosines(alpha) {
            let wi = direction(cos, 2.0);
            let peak = lobe(reflect(wi, DVec3::Z), alpha, 2.0 * alpha * alpha);
            for facet in [aluminium(), lacquered()] {
                let metal = Bsdf::Reflector(Reflector::new(facet, Some(&table)));
                let name = format!("metal {alpha}");
                check(&name, &metal, wi, &even_lanes(), [peak, evenly(-1.0)]);
            }
        }
    }
}

#[test]
fn rough_coats_are_sampled_by_their_density() {
    for alpha in [0.01, 0.3, 1.0] {
        let table = AlbedoTable::new(alpha).unwrap();
        for eta in [SampledSpectrum::splat(1.5), dispersive(1.5)] {
            let coat = Bsdf::Glossy(Glossy::new(eta, rising(0.05, 0.5), Some(&table)));
            for cos in cosines(alpha) {
                let wi = direction(cos, 2.0);
                let peak = lobe(reflect(wi, DVec3::Z), alpha, 2.0 * alpha * alpha);
                let name = format!("coat {alpha}");
                check(&name, &coat, wi, &uneven_lanes(), [peak, evenly(-1.0)]);
            }
        }
    }
}

#[test]
fn rough_glass_is_sampled_by_its_density_from_both_sides() {
    for alpha in [0.01, 0.1, 0.4, 1.0] {
        let table = AlbedoTable::new(alpha).unwrap();
        for eta in [1.5, 1.0 / 1.5, 1.06] {
            for (etas, lanes) in
                [(SampledSpectrum::splat(eta), even_lanes()), (dispersive(eta), uneven_lanes())]
            {
                let glass = Bsdf::interface(etas, Some(&table));
                for cos in cosines(alpha) {
                    let wi = direction(cos, 0.5);
                    let through = refract(wi, DVec3::Z, eta).unwrap_or(-DVec3::Z);
                    let width = 2.0 * alpha * alpha;
                    let across = width * (1.0 - 1.0 / eta).powi(2) + 1e-4;
                    let mirror = lobe(reflect(wi, DVec3::Z), alpha, width);
                    // What grazes is spread wide on the other side.
                    let wide = if cos < 0.1 { 1.0 } else { alpha };
                    let peaks = [mirror, lobe(through, wide, across)];
                    check(&format!("glass {alpha} {eta}"), &glass, wi, &lanes, peaks);
                }
            }
        }
    }
}

#[test]
fn lanes_of_dispersive_rough_glass_answer_as_each_would_alone() {
    // What meets more than one facet is interpolated between lanes: to less than the error of its table, 1e-3.
    for alpha in [0.1, 0.4, 1.0] {
        let table = AlbedoTable::new(alpha).unwrap();
        for eta in [1.5, 1.0 / 1.5] {
            let etas = dispersive(eta);
            let glass = Bsdf::interface(etas, Some(&table));
            for (i, o) in [(0.9, 0.7), (0.9, -0.7), (0.3, 0.2), (0.3, -0.2), (0.6, -0.95)] {
                let (wi, wo) = (direction(i, 0.5), direction(o, 3.4));
                let together = glass.eval(wi, wo);
                for (lane, got) in together.0.into_iter().enumerate() {
                    let one = SampledSpectrum::splat(etas.0[lane]);
                    let alone = Bsdf::interface(one, Some(&table)).eval(wi, wo).0[lane];
                    let off = (got - alone).abs();
                    assert!(off < 3e-4, "{alpha} {eta} {i} {o} {lane}: {got} {alone}");
                }
            }
        }
    }
}

/// Directions on a side by the octants and heights that they lie in.
fn bin(wo: DVec3) -> usize {
    let octant = usize::from(wo.x > 0.0) + 2 * usize::from(wo.y > 0.0);
    octant + 4 * ((wo.z.abs() * 4.0) as usize).min(3)
}

#[test]
fn each_side_of_rough_glass_is_sampled_by_its_density() {
    // What is drawn on a side, and what is drawn on both, weighted by the ratio of the densities. The
    // density ends where facets are seen edge on, too steeply for a quadrature.
    const SAMPLES: usize = 200_000;
    for alpha in [0.1, 0.5] {
        let table = AlbedoTable::new(alpha).unwrap();
        for (eta, cos) in [(1.5, 0.7), (1.0 / 1.5, 0.9), (1.0 / 1.5, 0.7), (1.06, 0.2)] {
            let (glass, lanes) = (Bsdf::interface(dispersive(eta), Some(&table)), uneven_lanes());
            let wi = direction(cos, 0.5);
            for is_near in [true, false] {
                let mut numbers = Numbers(7);
                let mut u = || [numbers.next(), numbers.next(), numbers.next()];
                let mut counts = [0.0; 16];
                let mut weights = [[0.0; 2]; 16];
                for _ in 0..SAMPLES {
                    if let Some(wo) = glass.sample_side(wi, is_near, &lanes, u()) {
                        assert_eq!(wo.z > 0.0, is_near);
                        counts[bin(wo)] += 1.0;
                    }
                    let drawn = glass.sample(wi, &lanes, u());
                    if let Some(wo) = drawn.filter(|wo| (wo.z > 0.0) == is_near) {
                        let weight = glass.pdf_of_side(wi, wo, &lanes) / glass.pdf(wi, wo, &lanes);
                        weights[bin(wo)][0] += weight;
                        weights[bin(wo)][1] += weight * weight;
                    }
                }
                for (bin, (count, [sum, squares])) in counts.into_iter().zip(weights).enumerate() {
                    let z = (count - sum) / (count + squares + 1.0).sqrt();
                    assert!(z.abs() < LIMIT, "{alpha} {eta} {cos} {is_near} {bin}: {count} {sum}");
                }
            }
        }
    }
}

#[test]
fn smooth_surfaces_have_nothing_to_sample() {
    let (wi, lanes) = (direction(0.6, 0.0), even_lanes());
    for smooth in
        [Bsdf::Reflector(Reflector::new(aluminium(), None)), Bsdf::interface(dispersive(1.5), None)]
    {
        assert!(!smooth.scatters());
        assert_eq!(smooth.sample(wi, &lanes, [0.2, 0.3, 0.4]), None);
        assert_eq!(smooth.pdf(wi, reflect(wi, DVec3::Z), &lanes), 0.0);
        assert_eq!(smooth.eval(wi, reflect(wi, DVec3::Z)), SampledSpectrum::ZERO);
        assert_eq!(smooth.albedo(wi), SampledSpectrum::ZERO);
    }
    let f = Bsdf::interface(dispersive(1.5), None).mirror(0.6).unwrap();
    assert_eq!(f.0[3], dielectric_reflectance(0.6, dispersive(1.5).0[3]));
}

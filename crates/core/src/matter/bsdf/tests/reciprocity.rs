// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Light takes every way in both directions alike: n(wi)²·f(wi, wo) = n(wo)²·f(wo, wi).

use std::sync::LazyLock;

use super::*;
use proptest::prelude::*;

static TABLE: LazyLock<AlbedoTable> = LazyLock::new(|| AlbedoTable::new(0.5).unwrap());

/// eval/|cos θₒ| with the walk's side up, whichever side it is on.
fn f(bsdf: &Bsdf, wi: DVec3, wo: DVec3) -> SampledSpectrum {
    let flip = |d: DVec3| if wi.z < 0.0 { -d } else { d };
    bsdf.eval(flip(wi), flip(wo)) * (1.0 / wo.z.abs())
}

fn is_close(a: SampledSpectrum, b: SampledSpectrum) -> bool {
    a.0.iter().zip(b.0).all(|(a, b)| (a - b).abs() <= 1e-9 * a.abs().max(b.abs()) + 1e-12)
}

fn any_direction() -> impl Strategy<Value = DVec3> {
    (0.01..1.0f64, 0.0..std::f64::consts::TAU).prop_map(|(cos, azimuth)| direction(cos, azimuth))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn opaque_surfaces_reflect_both_ways_alike(wi in any_direction(), wo in any_direction()) {
        let rho = rising(0.1, 0.9);
        for bsdf in [
            Bsdf::Diffuse(Diffuse::new(rho)),
            Bsdf::Transmitter(Transmitter::new(rho, rising(0.8, 0.0))),
            Bsdf::Reflector(Reflector::new(aluminium(), Some(&TABLE))),
            Bsdf::Reflector(Reflector::new(lacquered(), Some(&TABLE))),
            Bsdf::Glossy(Glossy::new(SampledSpectrum::splat(1.5), rho, None)),
            Bsdf::Glossy(Glossy::new(dispersive(1.5), rho, Some(&TABLE))),
        ] {
            let there = f(&bsdf, wi, wo);
            prop_assert!(there.max() > 0.0);
            prop_assert!(is_close(there, f(&bsdf, wo, wi)));
            prop_assert!(is_close(f(&bsdf, wi, -wo), f(&bsdf, -wo, wi)));
        }
    }

    #[test]
    fn rough_glass_sends_light_both_ways_alike(
        wi in any_direction(), wo in any_direction(), eta in prop::sample::select(vec![1.06, 1.5]),
    ) {
        let etas = dispersive(eta);
        let outside = Bsdf::interface(etas, Some(&TABLE));
        let inside = Bsdf::interface(SampledSpectrum::ONE / etas, Some(&TABLE));
        prop_assert!(is_close(f(&outside, wi, wo), f(&outside, wo, wi)));
        prop_assert!(is_close(f(&inside, wi, wo), f(&inside, wo, wi)));
        // n² is 1 outside and η² inside.
        let entering = f(&outside, wi, -wo);
        prop_assert!(entering.max() > 0.0);
        prop_assert!(is_close(entering, etas * etas * f(&inside, -wo, wi)));
    }
}

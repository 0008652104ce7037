// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Turbid bodies: single scattering by its integral, and all orders by Chandrasekhar's H.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use lamplit_core::light::Base;
use lamplit_core::math::DVec3;
use lamplit_core::scene::Strength;
use lamplit_core::transport::PathSettings;

use crate::common::*;

/// p(cos γ) of Henyey and Greenstein, from the cosine of the deflection.
fn phase(cos: f64, g: f64) -> f64 {
    (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cos).powf(1.5))
}

/// One scattering: the border between equal indices is none, and does not count.
const ONCE: PathSettings = PathSettings { max_depth: 1, ..WHOLE };

#[test]
fn light_scattered_once_in_a_layer_is_its_integral_for_any_g() {
    let radius: f64 = 0.5;
    for g in [-0.6, 0.0, 0.8] {
        for towards in [tilted(50.0), tilted(130.0)] {
            // All lanes absorb the same; the layer is 2 mm thick.
            let scattering = |lane: usize| 0.1 * (lane % 8 + 1) as f64;
            let absorption = 0.03;
            let mut world = World::dark();
            let turbid = Some((by_lane(scattering), g));
            world.add(body(flat(1.0), flat(absorption), turbid), plate(0.0, 2.0));
            world.sun(towards, radius, flat(1.0));
            let scene = world.along(DVec3::Y * 20.0, -DVec3::Y);
            let lanes = Take::of(2048, ONCE).lanes(&scene);
            let solid_angle = TAU * (1.0 - radius.to_radians().cos());
            let expected = |lane: usize| {
                let depth = 2.0 * (scattering(lane) + absorption);
                let mu = towards.y.abs();
                // ∫ e^(−t)·e^(−t′/µ) dt, t′ the depth below the face that the sun shines on.
                let way = if towards.y > 0.0 {
                    (1.0 - (-depth * (1.0 + 1.0 / mu)).exp()) / (1.0 + 1.0 / mu)
                } else {
                    ((-depth).exp() - (-depth / mu).exp()) / (1.0 / mu - 1.0)
                };
                let share = scattering(lane) / (scattering(lane) + absorption);
                // The eye looks down: light from the zenith would be turned back, cos γ = −1.
                solid_angle * share * phase(-towards.y, g) * way
            };
            all_are(&lanes, expected, 1e-2);
        }
    }
}

/// H(µ) for isotropic scattering of albedo ω, by iteration of its integral equation.
fn chandrasekhar(albedo: f64, mu: f64) -> f64 {
    const NODES: usize = 400;
    let node = |i: usize| (i as f64 + 0.5) / NODES as f64;
    let loss = (1.0 - albedo).sqrt();
    let next = |h: &[f64], mu: f64| {
        let sum: f64 = h.iter().enumerate().map(|(i, h)| node(i) * h / (mu + node(i))).sum();
        1.0 / (loss + albedo / 2.0 * sum / NODES as f64)
    };
    let mut h = vec![1.0; NODES];
    for _ in 0..200 {
        h = (0..NODES).map(|i| next(&h, node(i))).collect();
    }
    next(&h, mu)
}

#[test]
fn a_deep_turbid_body_under_even_light_has_chandrasekhars_radiance() {
    // 1 − √(1 − ω)·H(µ), with all orders of scattering.
    for (albedo, degrees) in [(0.5, 0.0), (0.9, 0.0), (0.9, 70.0)] {
        let mut world = World::under(Base::Constant(flat(1.0)));
        let turbid = Some((flat(2.0 * albedo), 0.0));
        world.add(body(flat(1.0), flat(2.0 * (1.0 - albedo)), turbid), plate(0.0, 40.0));
        let scene = world.along(tilted(degrees) * 200.0, -tilted(degrees));
        let expected = 1.0 - (1.0_f64 - albedo).sqrt() * chandrasekhar(albedo, tilted(degrees).y);
        Take::of(1024, USUAL).luminance(&scene).is(expected, 4e-3);
    }
}

/// A lamp of 1 W/nm and 1 µm in a turbid body of scattering 0.02/mm and absorption 0.01/mm, seen from
/// within: directly, and by light that was scattered up to `max_depth` times.
fn lamp_in_fog(lamp: DVec3, along: DVec3, g: f64, max_depth: u32) -> Estimate {
    let mut world = World::dark();
    let fog = body(flat(1.3), flat(0.01), Some((flat(0.02), g)));
    world.add(fog, ball(DVec3::ZERO, 1e4));
    let lamp = world.add(matt(0.0), ball(lamp, 0.001));
    world.shine(lamp, Strength::Flux(flat(1.0)), 0);
    let path = PathSettings { max_depth, ..USUAL };
    Take::of(4096, path).luminance(&world.along(DVec3::ZERO, along))
}

#[test]
fn a_lamp_in_fog_is_seen_through_what_is_neither_absorbed_nor_scattered() {
    let got = lamp_in_fog(DVec3::Z * 50.0, DVec3::Z, 0.3, 0);
    // L/n² = Φ/(4π²r²n²), r in m.
    let radiance = 1.0 / (4.0 * PI * PI * 1e-12 * 1.3 * 1.3);
    got.is(radiance * (-0.03_f64 * 49.999).exp(), 2e-3);
}

#[test]
fn fog_lit_by_a_lamp_in_it_shows_the_integral_of_light_scattered_once() {
    for g in [0.0, 0.6] {
        let lamp = DVec3::new(0.0, 30.0, 40.0);
        let got = lamp_in_fog(lamp, DVec3::Z, g, 1);
        // With s the way before the point nearest to the lamp, s = 30·tan u, ds = r²/30 du.
        let steps = 20_000;
        let (from, to) = (-(40.0_f64 / 30.0).atan(), FRAC_PI_4 * 2.0);
        let mut sum = 0.0;
        for i in 0..steps {
            let u = from + (to - from) * (f64::from(i) + 0.5) / f64::from(steps);
            let (s, r) = (30.0 * u.tan(), 30.0 / u.cos());
            // Light travels from the lamp to the line, then towards −z.
            sum += phase(-s / r, g) * (-0.03 * (40.0 + s + r)).exp() / 30.0;
        }
        let intensity = 1.0 / (4.0 * PI) / (1.3 * 1.3);
        // Per mm of the way and mm² of the distance: 1e6 for W/m².
        let expected = 0.02 * intensity * 1e6 * sum * (to - from) / f64::from(steps);
        got.is(expected, 5e-3);
    }
}

#[test]
fn scattering_that_goes_to_zero_ends_as_none() {
    for coefficient in [0.0, 1e-9] {
        let mut world = World::under(gradient(1.0, 0.0));
        let turbid = Some((flat(coefficient), 0.5));
        world.add(body(flat(1.5), flat(0.1), turbid), plate(0.0, 3.0));
        let turbid = Take::of(16, WHOLE).luminance(&world.along(tilted(40.0) * 9.0, -tilted(40.0)));
        let mut world = World::under(gradient(1.0, 0.0));
        world.add(body(flat(1.5), flat(0.1), None), plate(0.0, 3.0));
        let clear = Take::of(1, WHOLE).luminance(&world.along(tilted(40.0) * 9.0, -tilted(40.0)));
        turbid.is(clear.mean, 1e-6);
    }
}

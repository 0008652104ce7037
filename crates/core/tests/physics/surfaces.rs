// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Opaque surfaces in the walk: sheets, metals, lacquer, and faces that are rough on one side.

use lamplit_core::light::Base;
use lamplit_core::math::{DAffine3, DVec3};
use lamplit_core::matter::{Finish, Lacquer, Optics};
use lamplit_core::transport::PathSettings;

use crate::common::*;

#[test]
fn a_diffuse_transmitter_mixes_what_lights_its_sides() {
    // Under a surround from 0 to 1 the upper side gets 5π/6, the lower one π/6.
    let (rho, tau) = (|lane: usize| 0.03 * lane as f64, |lane: usize| 0.5 - 0.02 * lane as f64);
    for up in [true, false] {
        let mut world = World::under(gradient(0.0, 1.0));
        let sheet = Optics::Transmitter { reflectance: by_lane(rho), transmittance: by_lane(tau) };
        world.add(sheet, disc(DVec3::ZERO, DVec3::Y, 50.0));
        let eye = tilted(if up { 30.0 } else { 150.0 }) * 20.0;
        let lanes = Take::of(1024, USUAL).lanes(&world.along(eye, -eye));
        let expected = |lane: usize| {
            let (seen, other) = if up { (5.0, 1.0) } else { (1.0, 5.0) };
            (rho(lane) * seen + tau(lane) * other) / 6.0
        };
        all_are(&lanes, expected, 5e-3);
    }
}

/// The reflectance along the normal of n + ik in a medium.
fn metal(n: f64, k: f64, medium: f64) -> f64 {
    let (n, k) = (n / medium, k / medium);
    ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k)
}

#[test]
fn metals_bare_in_glass_and_lacquered_reflect_along_the_normal_as_they_should() {
    let (n, k) = (|lane: usize| 0.8 + 0.05 * lane as f64, |lane: usize| 5.0 + 0.1 * lane as f64);
    let seen = |lacquer: Option<Lacquer>| {
        let mut world = World::under(Base::Constant(flat(1.0)));
        let optics = Optics::Conductor { n: by_lane(n), k: by_lane(k), factor: 0.95, lacquer };
        world.add(optics, disc(DVec3::ZERO, DVec3::Y, 5.0));
        Take::of(1, WHOLE).lanes(&world.along(DVec3::Y * 9.0, -DVec3::Y))
    };
    all_are(&seen(None), |lane| 0.95 * metal(n(lane), k(lane), 1.0), EXACT);
    let depth = |lane: usize| 0.02 * lane as f64;
    let lacquer = Lacquer { index: flat(1.5), optical_depth: by_lane(depth) };
    let expected = |lane: usize| {
        let below = 0.95 * metal(n(lane), k(lane), 1.5) * (-2.0 * depth(lane)).exp();
        0.04 + 0.96 * 0.96 * below / (1.0 - 0.04 * below)
    };
    all_are(&seen(Some(lacquer)), expected, EXACT);
    // Under water: the index of the medium counts. The water's own face reflects 2 % and more.
    let mut world = World::under(Base::Constant(flat(1.0)));
    let optics = Optics::Conductor { n: by_lane(n), k: by_lane(k), factor: 1.0, lacquer: None };
    world.add(optics, disc(DVec3::ZERO, DVec3::Y, 5.0));
    world.add(glass(1.33), plate(-1.0, 4.0));
    let lanes = Take::of(1, WHOLE).lanes(&world.along(DVec3::Y * 9.0, -DVec3::Y));
    let expected = |lane: usize| {
        let (face, r) = (fresnel(0.0, 1.33), metal(n(lane), k(lane), 1.33));
        face + (1.0 - face).powi(2) * r / (1.0 - face * r)
    };
    all_are(&lanes, expected, EXACT);
}

#[test]
fn a_glossy_surface_shows_its_coat_and_its_base() {
    // Coat: F(θ) of the mirrored surround; base: (1 − F(θ))·ρ/(1 − ρ·F_in)/n²·(1 − F_mean), with the
    // published diffuse reflectances 0.0918 outside and 0.596 inside for n = 1.5.
    for degrees in [0.0, 60.0] {
        let mut world = World::under(Base::Constant(flat(1.0)));
        world.add(
            Optics::Glossy { index: flat(1.5), base: by_lane(|lane| 0.06 * lane as f64) },
            disc(DVec3::ZERO, DVec3::Y, 5.0),
        );
        let lanes =
            Take::of(512, USUAL).lanes(&world.along(tilted(degrees) * 9.0, -tilted(degrees)));
        for (lane, got) in lanes.iter().enumerate() {
            let (rho, f) = (0.06 * lane as f64, fresnel(degrees, 1.5));
            let base = rho * (1.0 - 0.0918) / (1.0 - rho * 0.5964) / 2.25;
            let expected = f + (1.0 - f) * base;
            let off = (got.mean - expected).abs();
            assert!(off < 4.0 * got.sigma + 1e-3 * expected, "{lane}: {got:?} {expected}");
            assert!(got.sigma < 2e-3 * expected, "{lane}: {got:?}");
        }
    }
}

#[test]
fn a_moulded_texture_blurs_on_its_own_side_only() {
    for (towards, is_rough) in [(DVec3::Y, true), (-DVec3::Y, false)] {
        let mut world = World::dark();
        let finish = Finish::rough(world.alpha(0.4)).facing(DVec3::Y, 0.5);
        let cover = world.finished(glass(1.5), finish);
        world.place(cover, 0, plate(-5.0, 5.0), DAffine3::IDENTITY);
        world.sun(towards, 0.1, flat(1.0));
        let path = PathSettings { max_depth: 1, ..USUAL };
        let got = Take::of(256, path).luminance(&world.along(DVec3::ZERO, towards)).mean;
        assert!(if is_rough { got < 0.01 } else { (got - 0.96).abs() < 1e-9 }, "{towards}: {got}");
    }
}

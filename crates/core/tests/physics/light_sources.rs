// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Several sources at once, each with the light that it was given.

use std::f64::consts::{PI, TAU};

use lamplit_core::math::DVec3;
use lamplit_core::scene::Strength;
use lamplit_core::transport::{Beam, LightSource, RaySet, Shining};

use crate::common::*;
use crate::goniometer::*;

#[test]
fn each_of_two_unlike_lamps_brings_its_own_flux() {
    // Back to back, so that each has a half space of its own; one is larger, the other brighter.
    let mut world = World::dark();
    let first = world.add(matt(0.0), disc(DVec3::Y, DVec3::Y, 3.0));
    world.shine(first, Strength::Flux(flat(2.0)), 1);
    let second = world.add(matt(0.0), disc(-DVec3::Y, -DVec3::Y, 1.0));
    world.shine(second, Strength::Flux(flat(6.0)), 1);
    let scene = world.along(DVec3::Y * 1e3, -DVec3::Y);
    let spots = [spot(0.0, 0.0, 20.0), spot(180.0, 0.0, 20.0)];
    let got = measure(&scene, &spots, 1 << 18);
    assert!((got.flux - 8.0).abs() < 1e-9, "{}", got.flux);
    let mean = 0.5 * (1.0 + 10.0_f64.to_radians().cos());
    got.intensity(0).is(2.0 / PI * mean, 0.02);
    got.intensity(1).is(6.0 / PI * mean, 0.02);
}

#[test]
fn rays_beside_a_lamp_bring_their_flux_and_leave_it_its_own() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, 1.0));
    world.shine(lamp, Strength::Flux(flat(5.0)), 0);
    let scene = world.along(DVec3::Y * 1e3, -DVec3::Y);
    let luminosity = &scene.colour_matching[1];
    let way = (-DVec3::Y).to_array();
    let rays =
        RaySet::of_one_spectrum(&[[0.0, -2.0, 0.0]], &[way], vec![2.0], &flat(1.0), luminosity);
    let parts =
        vec![LightSource::Shining(Shining::of(&scene)), LightSource::Rays(rays.unwrap().into())];
    let source = LightSource::several(&scene, parts).unwrap();
    let spots = [spot(0.0, 0.0, 20.0), spot(180.0, 0.0, 20.0)];
    let got = measure_by(&scene, source, &spots, round(&spots), (1 << 18, FORWARD));
    assert!((got.flux - 7.0).abs() < 1e-9, "{}", got.flux);
    got.intensity(0).is(5.0 / PI * 0.5 * (1.0 + 10.0_f64.to_radians().cos()), 0.02);
    let solid_angle = TAU * (1.0 - 10.0_f64.to_radians().cos());
    got.intensity(1).times(solid_angle).is(2.0, 0.01);
}

#[test]
fn a_wide_beam_gives_a_face_square_to_it_the_irradiance_that_was_asked_for() {
    // A black disc takes E πr² from a cone of 60° all round its normal.
    let mut world = World::dark();
    world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, 20.0));
    let scene = world.along(DVec3::Y * 1e3, -DVec3::Y);
    let beam = Beam::new(&scene, -DVec3::Y, PI / 3.0, flat(7.0)).unwrap();
    let got = measure_by(&scene, LightSource::Beam(beam), &[], round(&[]), (1 << 18, FORWARD));
    let ([_, absorbed, ..], _) = got.shares();
    let expected = 7.0 * PI * 400.0 * 1e-6;
    let taken = absorbed * got.flux;
    assert!((taken / expected - 1.0).abs() < 0.01, "{taken} {expected}");
}

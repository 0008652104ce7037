// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The same intensity walked from the light and from the eye: two estimators that share the matter
//! they meet, and nothing else of what they look for.

use std::f64::consts::PI;

use lamplit_core::geometry::{ConvexPolyhedron, Shape};
use lamplit_core::math::DVec3;
use lamplit_core::matter::Optics;
use lamplit_core::scene::{Distribution, Strength};

use crate::common::*;
use crate::goniometer::*;

/// A spectrum that is not flat, so that X, Y and Z go ways of their own.
fn reddish() -> lamplit_core::spectrum::SpectralTable {
    by_lane(|lane| 0.2 + 0.15 * lane as f64)
}

/// Walk from both sides to some spots.
fn both(
    world: World,
    spots: &[lamplit_core::film::Spot],
    view: (DVec3, f64),
    (paths, eyes, samples): (u32, u32, u32),
    fine: f64,
) {
    let mut scene = world.along(DVec3::Y * 1e3, -DVec3::Y);
    let forward = measure(&scene, spots, paths);
    for (at, spot) in spots.iter().enumerate() {
        let seen = seen_from(&mut scene, *spot, view, (eyes, samples));
        agree(&forward, at, seen, fine);
    }
}

#[test]
fn an_open_box_of_matt_walls() {
    let mut world = World::dark();
    let paint = world.material(Optics::Diffuse(by_lane(|lane| 0.4 + 0.03 * lane as f64)), 0.0);
    let walls = [
        (DVec3::new(-11.0, -1.0, -11.0), DVec3::new(11.0, 0.0, 11.0)),
        (DVec3::new(-11.0, 0.0, -11.0), DVec3::new(-10.0, 20.0, 11.0)),
        (DVec3::new(10.0, 0.0, -11.0), DVec3::new(11.0, 20.0, 11.0)),
        (DVec3::new(-10.0, 0.0, -11.0), DVec3::new(10.0, 20.0, -10.0)),
        (DVec3::new(-10.0, 0.0, 10.0), DVec3::new(10.0, 20.0, 11.0)),
        // A lid with a hole beside the lamp.
        (DVec3::new(-11.0, 20.0, -11.0), DVec3::new(2.0, 21.0, 11.0)),
    ];
    for (low, high) in walls {
        world.place(paint, 0, cuboid(low, high), lamplit_core::math::DAffine3::IDENTITY);
    }
    let lamp = world.add(matt(0.2), ball(DVec3::new(-5.0, 8.0, 1.0), 1.5));
    world.shine(lamp, Strength::Flux(reddish()), 1);
    let spots = [spot(0.0, 0.0, 20.0), spot(35.0, 10.0, 20.0)];
    both(world, &spots, (DVec3::Y * 10.0, 44.0), (1 << 19, 8, 16), 0.03);
}

#[test]
fn a_rough_metal_beside_a_lamp() {
    let mut world = World::dark();
    let metal = Optics::Conductor {
        n: flat(0.9),
        k: by_lane(|lane| 3.0 + 0.2 * lane as f64),
        factor: 1.0,
        lacquer: None,
    };
    world.add_rough(
        metal,
        0.35,
        cuboid(DVec3::new(-15.0, -2.0, -15.0), DVec3::new(15.0, 0.0, 15.0)),
    );
    let lamp = world.add(matt(0.0), disc(DVec3::new(-4.0, 6.0, 0.0), -DVec3::Y, 2.0));
    world.shine(lamp, Strength::Flux(reddish()), 1);
    let spots = [spot(10.0, 0.0, 20.0), spot(65.0, 5.0, 20.0)];
    both(world, &spots, (DVec3::ZERO, 46.0), (1 << 19, 8, 16), 0.03);
}

#[test]
fn a_dyed_slab_before_a_lamp_by_its_closed_form() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, 1.0));
    world.shine(lamp, Strength::Flux(flat(2.0)), 1);
    world.add(body(flat(1.5), flat(-(0.9_f64.ln())), None), plate(300.0, 303.0));
    let spots = [0.0, 40.0, 65.0].map(|degrees| spot(degrees, 0.0, 5.0));
    let scene = world.along(DVec3::Y * 1e3, -DVec3::Y);
    let got = measure(&scene, &spots, 1 << 21);
    for (at, degrees) in [0.0_f64, 40.0, 65.0].into_iter().enumerate() {
        let r = fresnel(degrees, 1.5);
        let inside = (degrees.to_radians().sin() / 1.5).asin().cos();
        let tau = 0.729_f64.powf(1.0 / inside);
        let transmittance = (1.0 - r).powi(2) * tau / (1.0 - (r * tau).powi(2));
        let expected = 2.0 / PI * degrees.to_radians().cos() * transmittance;
        got.intensity(at).is(expected, 0.02);
    }
}

#[test]
fn a_rough_pane_before_a_lamp() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.4), disc(DVec3::ZERO, DVec3::Y, 3.0));
    world.shine(lamp, Strength::Flux(reddish()), 1);
    let dye = by_lane(|lane| 0.15 - 0.008 * lane as f64);
    let pane = cuboid(DVec3::new(-12.0, 4.0, -12.0), DVec3::new(12.0, 8.0, 12.0));
    world.add_rough(body(flat(1.6), dye, None), 0.4, pane);
    let spots = [spot(0.0, 0.0, 20.0), spot(50.0, 0.0, 20.0), spot(95.0, 0.0, 20.0)];
    both(world, &spots, (DVec3::Y * 4.0, 34.0), (1 << 20, 8, 64), 0.06);
}

#[test]
fn a_dispersive_prism_before_a_lamp() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, 2.0));
    world.shine(lamp, Strength::Flux(reddish()), 1);
    let points = [
        DVec3::new(-8.0, 2.0, -8.0),
        DVec3::new(10.0, 2.0, -8.0),
        DVec3::new(0.0, 2.0, 10.0),
        DVec3::new(-5.0, 14.0, 0.0),
    ];
    let prism = Shape::Polyhedron(ConvexPolyhedron::tetrahedron(points).unwrap());
    world.add(body(by_lane(|lane| 1.75 - 0.015 * lane as f64), flat(0.01), None), prism);
    let spots = [spot(0.0, 0.0, 20.0), spot(40.0, 20.0, 20.0), spot(-50.0, 0.0, 20.0)];
    both(world, &spots, (DVec3::Y * 6.0, 34.0), (1 << 20, 32, 128), 0.06);
}

#[test]
fn a_turbid_body_beside_a_lamp() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.1), ball(DVec3::ZERO, 1.5));
    world.shine(lamp, Strength::Flux(reddish()), 1);
    let milk = Some((by_lane(|lane| 0.5 - 0.01 * lane as f64), 0.4));
    let block = cuboid(DVec3::new(-6.0, 3.0, -6.0), DVec3::new(6.0, 8.0, 6.0));
    world.add(body(flat(1.4), flat(0.01), milk), block);
    let spots = [spot(0.0, 0.0, 20.0), spot(70.0, 0.0, 20.0)];
    both(world, &spots, (DVec3::Y * 3.0, 24.0), (1 << 19, 8, 16), 0.05);
}

#[test]
fn two_bodies_that_touch() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.2), disc(DVec3::ZERO, DVec3::Y, 2.0));
    world.shine(lamp, Strength::Flux(reddish()), 1);
    let dye = by_lane(|lane| 0.1 - 0.006 * lane as f64);
    let slab =
        |low: f64, high: f64| cuboid(DVec3::new(-7.0, low, -7.0), DVec3::new(7.0, high, 7.0));
    world.add(body(flat(1.49), dye, None), slab(1.0, 4.0));
    world.add_rough(body(flat(1.59), flat(0.02), None), 0.3, slab(4.0, 7.0));
    let spots = [spot(5.0, 0.0, 20.0), spot(60.0, 10.0, 20.0)];
    both(world, &spots, (DVec3::Y * 3.0, 24.0), (1 << 19, 8, 64), 0.05);
}

#[test]
fn a_lamp_within_a_clear_ball_sends_all_out_but_what_the_ball_reflects() {
    // Everything goes through the ball's surface along its normal; what comes back is swallowed.
    // A radiance in air makes n² as much flux inside.
    let n: f64 = 1.5;
    let r = ((n - 1.0) / (n + 1.0)).powi(2);
    let area = 4.0 * PI * 0.01 * 1e-6;
    for (strength, flux) in
        [(Strength::Flux(flat(2.0)), 2.0), (Strength::Radiance(flat(2e5)), PI * 2e5 * area * n * n)]
    {
        let mut world = World::dark();
        let lamp = world.add(matt(0.0), ball(DVec3::ZERO, 0.1));
        world.shine(lamp, strength, 1);
        world.add(glass(n), ball(DVec3::ZERO, 100.0));
        let mut scene = world.along(DVec3::Y * 1e3, -DVec3::Y);
        let spots = [spot(0.0, 0.0, 20.0), spot(120.0, 0.0, 20.0)];
        let got = measure(&scene, &spots, 1 << 18);
        assert!((got.flux / flux - 1.0).abs() < 1e-9, "{} {flux}", got.flux);
        got.out().is(flux * (1.0 - r), 2e-3);
        got.intensity(1).is(flux * (1.0 - r) / (4.0 * PI), 0.04);
        let view = (DVec3::ZERO, 0.4);
        let seen = seen_from(&mut scene, spots[0], view, (4, 16));
        agree(&got, 0, seen, 0.03);
    }
}

#[test]
fn a_die_within_a_block_of_plastic() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.3), disc(DVec3::ZERO, DVec3::Y, 2.0));
    world.shine_as(lamp, Strength::Flux(reddish()), Distribution::Cosine { exponent: 2.0 }, 1);
    let dye = by_lane(|lane| 0.05 - 0.003 * lane as f64);
    let block = cuboid(DVec3::new(-8.0, -3.0, -8.0), DVec3::new(8.0, 6.0, 8.0));
    world.add_rough(body(flat(1.49), dye, None), 0.15, block);
    let spots = [spot(0.0, 0.0, 20.0), spot(55.0, 0.0, 20.0), spot(150.0, 0.0, 20.0)];
    both(world, &spots, (DVec3::Y * 1.5, 26.0), (1 << 19, 8, 16), 0.03);
}

#[test]
fn nothing_is_lost_in_matter_that_takes_nothing() {
    for alpha in [0.0, 0.2] {
        let mut world = World::dark();
        let lamp = world.add(matt(1.0), ball(DVec3::ZERO, 1.0));
        world.shine(lamp, Strength::Flux(reddish()), 1);
        let index = by_lane(|lane| 1.45 + 0.01 * lane as f64);
        let milk = Some((flat(0.1), 0.2));
        world.add_rough(body(index, flat(0.0), milk), alpha, ball(DVec3::ZERO, 6.0));
        let scene = world.along(DVec3::Y * 1e3, -DVec3::Y);
        let got = measure(&scene, &[], 1 << 17);
        got.out().is(got.flux, 0.01);
        let ([_, absorbed, cut, lost, _], _) = got.shares();
        assert!(absorbed.abs() < 3e-3 && cut < 1e-3 && lost == 0.0, "{absorbed} {cut} {lost}");
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Furnaces: in a surround of radiance 1, all that loses no light has radiance 1, whatever it is.

use lamplit_core::geometry::{Cone, Cylinder, Shape};
use lamplit_core::light::Base;
use lamplit_core::math::{DAffine3, DVec3};
use lamplit_core::matter::Optics;
use lamplit_core::scene::{Camera, Projection, Strength};

use crate::common::*;

/// What the furnace may be off by.
const BOUND: f64 = 1e-3;

/// A picture of what is within 10 mm of the origin: but for noise every pixel is 1 ± 1e-3, and so
/// are the picture and each of its lanes.
#[track_caller]
fn is_a_furnace(world: World, samples: u32) {
    let projection = Projection::Pinhole { field_of_view_deg: 30.0 };
    let eye = DVec3::new(11.0, 17.0, 31.0);
    let camera = Camera::new(eye, DVec3::ZERO, DVec3::Y, projection).unwrap();
    let take = Take { side: 8, ..Take::of(samples, USUAL) };
    let rendered = take.picture(&world.seen_by(camera));
    for (at, pixel) in rendered.film.pixels.iter().enumerate() {
        let (got, sigma) = (pixel.mean()[1], pixel.standard_error()[1]);
        assert!((got - 1.0).abs() <= BOUND + 4.5 * sigma, "pixel {at}: {got} ± {sigma}");
    }
    let luminances: Vec<f64> = rendered.film.pixels.iter().map(|pixel| pixel.mean()[1]).collect();
    let whole = Estimate::of(luminances.iter());
    assert!((whole.mean - 1.0).abs() <= BOUND + 3.0 * whole.sigma, "{whole:?}");
    assert!(whole.sigma <= 1.5e-3, "{whole:?}");
    let means = rendered.film.band_means();
    for lane in 0..16 {
        let got = Estimate::of(means.iter().skip(lane).step_by(16));
        assert!((got.mean - 1.0).abs() <= BOUND + 4.0 * got.sigma, "lane {lane}: {got:?}");
        assert!(got.sigma <= 5e-3, "lane {lane}: {got:?}");
    }
}

fn white() -> World {
    World::under(Base::Constant(flat(1.0)))
}

fn turned() -> DAffine3 {
    DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 0.7)
}

fn block() -> Shape {
    cuboid(DVec3::new(-5.0, -4.0, -6.0), DVec3::new(5.0, 4.0, 6.0))
}

#[test]
fn closed_glass_without_loss_is_invisible_in_a_furnace_smooth_and_rough() {
    for (alpha, samples) in
        [(0.0, 256), (0.01, 256), (0.1, 1024), (0.3, 2048), (0.6, 3000), (1.0, 3000)]
    {
        for index in [1.5, 1.0 / 1.3] {
            let mut world = white();
            let material = world.material(glass(index), alpha);
            world.place(material, 0, block(), turned());
            is_a_furnace(world, samples);
        }
    }
}

#[test]
fn dispersive_glass_is_invisible_in_a_furnace() {
    for alpha in [0.0, 0.3] {
        let mut world = white();
        let index = by_lane(|lane| 1.7 - 0.02 * lane as f64);
        world.add_rough(body(index, flat(0.0), None), alpha, ball(DVec3::ZERO, 6.0));
        is_a_furnace(world, 1024);
    }
}

#[test]
fn nested_and_overlapping_bodies_are_invisible_in_a_furnace() {
    for (alpha, samples) in [(0.0, 128), (0.2, 1024)] {
        let mut world = white();
        let outer = world.material(glass(1.4), alpha);
        let inner = world.material(glass(1.7), alpha);
        let bubble = world.material(glass(1.0), 0.0);
        world.place(outer, 0, block(), turned());
        world.place(inner, 2, ball(DVec3::new(1.0, 0.0, 0.0), 3.0), DAffine3::IDENTITY);
        world.place(bubble, 3, ball(DVec3::new(2.0, 0.0, 0.0), 1.0), DAffine3::IDENTITY);
        // One that reaches out of the block, and fills less than it in common places.
        world.place(inner, -1, ball(DVec3::new(-4.0, 3.0, 2.0), 4.0), DAffine3::IDENTITY);
        is_a_furnace(world, samples);
    }
}

#[test]
fn a_turbid_body_without_absorption_is_invisible_in_a_furnace() {
    let milky = by_lane(|lane| 0.05 + 0.02 * lane as f64);
    for (index, alpha, g) in [(1.0, 0.0, 0.6), (1.5, 0.0, -0.4), (1.3, 0.3, 0.0)] {
        let mut world = white();
        let optics = body(flat(index), flat(0.0), Some((milky.clone(), g)));
        let material = world.material(optics, alpha);
        world.place(material, 0, block(), turned());
        is_a_furnace(world, 1024);
    }
}

#[test]
fn mirrors_and_perfect_metals_are_invisible_in_a_furnace_smooth_and_rough() {
    for alpha in [0.0, 0.1, 0.5, 1.0] {
        let metal = Optics::Conductor { n: flat(0.0), k: flat(5.0), factor: 1.0, lacquer: None };
        let cone = Cone::new(DVec3::new(0.0, -4.0, 0.0), DVec3::Y, 5.0, 8.0).unwrap();
        let drum = Cylinder::new(DVec3::new(0.0, -3.0, 0.0), DVec3::Y, 4.0, 6.0).unwrap();
        for (optics, shape) in
            [(metal.clone(), Shape::Cone(cone)), (Optics::Mirror(flat(1.0)), Shape::Cylinder(drum))]
        {
            let mut world = white();
            world.add_rough(optics, alpha, shape);
            is_a_furnace(world, 512);
        }
    }
}

#[test]
fn white_matt_and_white_glossy_things_are_invisible_in_a_furnace() {
    let glossy = || Optics::Glossy { index: flat(1.5), base: flat(1.0) };
    let sheet = Optics::Transmitter { reflectance: flat(0.3), transmittance: flat(0.7) };
    for (optics, alpha) in [(matt(1.0), 0.0), (sheet, 0.0), (glossy(), 0.0), (glossy(), 0.3)] {
        let mut world = white();
        let material = world.material(optics, alpha);
        world.place(material, 0, block(), turned());
        world.place(material, 0, ball(DVec3::new(7.0, 4.0, 3.0), 2.0), DAffine3::IDENTITY);
        is_a_furnace(world, 1024);
    }
}

#[test]
fn what_shines_as_brightly_as_the_furnace_and_absorbs_the_rest_is_invisible_too() {
    // Kirchhoff: a matt ball of reflectance ρ that emits 1 − ρ, seen through rough glass.
    for alpha in [0.0, 0.3] {
        let mut world = white();
        let shell = world.material(glass(1.5), alpha);
        world.place(shell, 0, block(), turned());
        let ball = world.add(matt(0.4), ball(DVec3::new(1.0, 1.0, 0.0), 2.0));
        world.shine(ball, Strength::Radiance(flat(0.6)), 1);
        is_a_furnace(world, 1024);
    }
}

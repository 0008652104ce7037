// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Light that landed on surfaces, and is met there by walks from the eye.

use std::f64::consts::PI;

use lamplit_core::math::DVec3;
use lamplit_core::matter::conductor_reflectance;
use lamplit_core::render::{render, Progress, RenderSettings};
use lamplit_core::scene::{Camera, Projection, Scene, Strength};

use crate::common::*;

/// Square pictures: from where, of what, how high the field is, and how many pixels a side.
type View = (DVec3, DVec3, f64, u32);

/// What is seen is as bright by light that landed as by path, with so many samples each, to a share `fine`.
fn is_as_by_path(world: World, view: View, [path, lit]: [u32; 2], fine: f64) {
    let (eye, at, height, side) = view;
    let projection = Projection::Orthographic { height };
    let scene = world.seen_by(Camera::new(eye, at, DVec3::Z, projection).unwrap());
    let [path, lit] = [Take::of(path, USUAL), Take::lit(lit, USUAL)]
        .map(|take| mean_over_seeds(&scene, side, &take));
    lit.is_as(path, fine);
}

#[test]
fn a_wall_that_a_lamp_shines_at_is_as_bright_as_by_path_beside_a_frosted_pane_and_behind_it() {
    for height in [-60.0, 60.0] {
        let mut world = World::dark();
        let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::X, 1.0));
        world.shine(lamp, Strength::Flux(flat(2.0)), 1);
        world.add(matt(0.6), cuboid(DVec3::new(20.0, -20.0, -20.0), DVec3::new(22.0, 20.0, 20.0)));
        let pane = cuboid(DVec3::new(2.0, 6.0, -8.0), DVec3::new(19.5, 8.0, 8.0));
        world.add_rough(glass(1.5), 0.3, pane);
        let view = (DVec3::new(-20.0, height, 1.0), DVec3::new(20.0, -4.0, 0.0), 4.0, 32);
        is_as_by_path(world, view, [1 << 8, 1 << 5], 0.06);
    }
}

#[test]
fn light_that_crosses_a_frosted_film_is_seen_once_however_thin_it_is() {
    // Much thinner than the discs in which light is met, 0.4 mm.
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, 1.0));
    world.shine(lamp, Strength::Flux(flat(2.0)), 1);
    let film = cuboid(DVec3::new(-12.0, 6.0, -12.0), DVec3::new(12.0, 6.02, 12.0));
    world.add_rough(glass(1.5), 0.3, film);
    let view = (DVec3::new(30.0, 60.0, 5.0), DVec3::new(1.0, 6.0, 0.0), 4.0, 32);
    is_as_by_path(world, view, [1 << 5, 1 << 4], 0.02);
}

/// A lamp that shines up at a mirror alone, `above` it.
fn under_mirror(above: f64, radius: f64) -> World {
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, radius));
    world.shine(lamp, Strength::Flux(flat(2.0)), 1);
    world.add(aluminium(), disc(DVec3::new(0.0, above, 0.0), -DVec3::Y, 25.0));
    world
}

/// A lamp over a floor that it lights by way of the mirror above it alone.
fn mirrored(floor: impl FnOnce(&mut World), radius: f64, eye: DVec3) -> Scene {
    let mut world = under_mirror(50.0, radius);
    floor(&mut world);
    let at = DVec3::new(30.0, -50.0, 0.0);
    world.along(at + eye, -eye)
}

#[test]
fn light_that_is_mirrored_to_a_matt_floor_is_met_where_it_lands() {
    // The image is 100 mm above the lamp, whose intensity is Φ cos/π.
    let (rho, across, down) = (0.1, 30.0, 150.0_f64);
    let floor = |world: &mut World| {
        world.add(matt(rho), plate(-51.0, -50.0));
    };
    let scene = mirrored(floor, 0.1, DVec3::new(80.0, 40.0, 30.0));
    let d2 = across * across + down * down;
    let cos = down / d2.sqrt();
    let illuminance = 2.0 * cos / PI * conductor_reflectance(cos, 0.9, 4.0) * cos / (d2 * 1e-6);
    let lit = Take::lit(1 << 9, USUAL).by_seeds(48, &scene, None);
    lit.is(rho * illuminance / PI, 0.03);
}

#[test]
fn light_that_is_mirrored_to_a_glossy_floor_is_met_where_it_lands() {
    let floor = |world: &mut World| {
        world.add_rough(aluminium(), 0.12, plate(-51.0, -50.0));
    };
    let scene = mirrored(floor, 4.0, DVec3::new(15.0, 75.0, 5.0));
    let path = Take::of(1 << 14, USUAL).luminance(&scene);
    let lit = Take::lit(1 << 8, USUAL).by_seeds(48, &scene, None);
    lit.is_as(path, 0.03);
}

#[test]
fn light_that_comes_straight_to_a_glossy_mirror_is_seen_once_in_another() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, 4.0));
    world.shine(lamp, Strength::Flux(flat(2.0)), 1);
    let mirror = cuboid(DVec3::new(-25.0, 50.0, -25.0), DVec3::new(25.0, 51.0, 25.0));
    world.add_rough(aluminium(), 0.12, mirror);
    world.add_rough(aluminium(), 0.12, plate(-51.0, -50.0));
    let (at, eye) = (DVec3::new(30.0, -50.0, 0.0), DVec3::new(15.0, 75.0, 5.0));
    let scene = world.along(at + eye, -eye);
    let path = Take::of(1 << 14, USUAL).luminance(&scene);
    let lit = Take::lit(1 << 8, USUAL).by_seeds(48, &scene, None);
    lit.is_as(path, 0.02);
}

/// A part of a paraboloid whose focus is the lamp's image: it sends what the flat mirror sends it straight
/// up, about, and each place of it by its own normal.
fn collimator(world: &mut World) {
    const SIDE: u32 = 40;
    const FOCUS: f64 = 40.0;
    const FOCAL_LENGTH: f64 = 65.5;
    let vertex = |at: u32| {
        let (x, z) =
            (28.0 + 0.5 * f64::from(at % (SIDE + 1)), 0.5 * f64::from(at / (SIDE + 1)) - 10.0);
        [x, FOCUS - FOCAL_LENGTH + (x * x + z * z) / (4.0 * FOCAL_LENGTH), z]
    };
    let vertices: Vec<_> = (0..(SIDE + 1).pow(2)).map(vertex).collect();
    let cell = |at: u32| {
        let first = at / SIDE * (SIDE + 1) + at % SIDE;
        let [a, b, c, d] = [first, first + 1, first + SIDE + 1, first + SIDE + 2];
        [[a, c, b], [b, c, d]]
    };
    let triangles: Vec<_> = (0..SIDE * SIDE).flat_map(cell).collect();
    world.add_rough_mesh(aluminium(), 0.04, &vertices, &triangles, None);
}

#[test]
fn light_that_is_mirrored_to_a_curved_mirror_leaves_it_as_it_is_curved_where_it_landed() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, 0.5));
    world.shine(lamp, Strength::Flux(flat(2.0)), 1);
    world.add(aluminium(), disc(DVec3::new(0.0, 20.0, 0.0), -DVec3::Y, 24.0));
    collimator(&mut world);
    // Its middle, away from its edges: discs are a quarter of it.
    let at = DVec3::new(38.0, -20.0, 0.0);
    is_as_by_path(world, (at + 200.0 * DVec3::Y, at, 8.0, 4), [1 << 12, 1 << 8], 0.02);
}

#[test]
fn a_small_frosted_pane_is_as_bright_as_by_path_up_to_its_edges() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, 1.0));
    world.shine(lamp, Strength::Flux(flat(2.0)), 1);
    let pane = cuboid(DVec3::new(-3.0, 6.0, -3.0), DVec3::new(3.0, 8.0, 3.0));
    world.add_rough(glass(1.5), 0.3, pane);
    let at = DVec3::new(0.0, 7.0, 0.0);
    let eye = at + DVec3::new(40.0, 60.0, 5.0);
    is_as_by_path(world, (eye, at, 8.0, 8), [1 << 9, 1 << 7], 0.015);
}

#[test]
fn a_small_glossy_mirror_is_as_bright_as_by_path_up_to_its_edges() {
    let mut world = under_mirror(20.0, 6.0);
    world.add_rough(aluminium(), 0.2, disc(DVec3::new(14.0, -20.0, 0.0), DVec3::Y, 4.0));
    let at = DVec3::new(14.0, -20.0, 0.0);
    let eye = at + DVec3::new(14.0, 60.0, 0.0);
    is_as_by_path(world, (eye, at, 10.0, 8), [1 << 11, 1 << 9], 0.015);
}

#[test]
fn a_floor_is_as_bright_as_by_path_up_to_what_stands_on_it() {
    let mut world = under_mirror(20.0, 6.0);
    world.add(matt(0.6), plate(-21.0, -20.0));
    let block = cuboid(DVec3::new(10.0, -20.0, -6.0), DVec3::new(14.0, -18.0, 6.0));
    world.add(matt(0.0), block);
    let at = DVec3::new(14.0, -20.0, 0.0);
    let eye = at + DVec3::new(30.0, 80.0, 5.0);
    is_as_by_path(world, (eye, at, 8.0, 8), [1 << 12, 1 << 8], 0.015);
}

#[test]
fn errors_of_pixels_are_those_over_seeds_where_samples_share_what_landed() {
    let floor = |world: &mut World| {
        world.add_rough(aluminium(), 0.12, plate(-51.0, -50.0));
    };
    let scene = mirrored(floor, 4.0, DVec3::new(15.0, 75.0, 5.0));
    let seeds = 48;
    let (mut foretold, mut values) = (0.0, vec![Vec::new(); 32]);
    for seed in 0..seeds {
        let settings = RenderSettings {
            width: 8,
            height: 4,
            seed,
            bands_per_lane: 0,
            ..Take::lit(112, USUAL).settings()
        };
        let film = render(&scene, &settings, &Progress::default()).unwrap().film;
        for (pixel, own) in film.pixels.iter().zip(&mut values) {
            own.push(pixel.mean()[1]);
            foretold += pixel.standard_error()[1].powi(2) / seeds as f64;
        }
    }
    let of_mean = |own: &Vec<f64>| Estimate::of(own.iter()).sigma.powi(2);
    let found: f64 = values.iter().map(of_mean).sum::<f64>() * seeds as f64;
    // About 1500 degrees of freedom of bright pixels' errors, whose photons are shared by neighbours.
    assert!((foretold / found).ln().abs() < 0.25, "{foretold} {found}");
}

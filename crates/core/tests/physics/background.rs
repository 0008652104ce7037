// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Suns, skies, pictures and soft boxes: the illuminance that they give by their integrals.

use std::f64::consts::{PI, TAU};

use lamplit_core::geometry::{Plane, Shape};
use lamplit_core::light::{Base, ImageMap, Sky, SkyModel, SoftBox};
use lamplit_core::math::DVec3;
use lamplit_core::scene::{Camera, Projection};

use crate::common::*;

/// The illuminance of level ground in the origin, over π: what a white one shows from any side.
fn ground(mut world: World, samples: u32) -> Estimate {
    let floor = Shape::Plane(Plane::new(DVec3::ZERO, DVec3::Y).unwrap());
    world.add(matt(0.5), floor);
    let scene = world.along(DVec3::new(-30.0, 50.0, 20.0), DVec3::new(30.0, -50.0, -20.0));
    Take::of(samples, STEADY).luminance(&scene).times(2.0)
}

#[test]
fn a_sun_gives_pi_sin_squared_times_the_cosine() {
    for (radius, degrees) in [(0.2665, 0.0), (0.2665, 60.0), (10.0, 30.0), (40.0, 0.0)] {
        let mut world = World::dark();
        let radiance = 1.0 / f64::to_radians(radius).sin().powi(2);
        world.sun(tilted(degrees), radius, flat(radiance));
        ground(world, 1024).is(f64::to_radians(degrees).cos(), 3e-3);
    }
}

#[test]
fn two_suns_and_a_soft_box_before_them_add_up() {
    let mut world = World::under(gradient(0.0, 1.0));
    world.sun(tilted(20.0), 5.0, flat(30.0));
    world.sun(tilted(-50.0), 1.0, flat(2000.0));
    let expected = |degrees: f64, radius: f64, radiance: f64| {
        radiance * f64::to_radians(radius).sin().powi(2) * f64::to_radians(degrees).cos()
    };
    // A surround that goes from ½ at the horizon to 1: ∫ (1 + µ)/2·µ dω = 5π/6.
    let suns = expected(20.0, 5.0, 30.0) + expected(50.0, 1.0, 2000.0);
    ground(world, 2048).is(5.0 / 6.0 + suns, 5e-3);
}

#[test]
fn the_overcast_sky_gives_seven_ninths_of_pi_times_its_zenith() {
    let sky = Sky { model: SkyModel::Overcast, zenith: flat(3.0), ground: flat(50.0) };
    ground(World::under(Base::Sky(sky)), 1024).is(3.0 * 7.0 / 9.0, 2e-3);
}

#[test]
fn the_clear_sky_gives_the_integral_of_the_standards_formula() {
    // ISO 15469, type 12: a = −1, b = −0.32, c = 10, d = −3, e = 0.45; the sun 40° from the zenith.
    let sun = tilted(40.0);
    let coefficients = [-1.0, -0.32, 10.0, -3.0, 0.45];
    let model = SkyModel::General { coefficients, sun };
    let sky = Sky { model, zenith: flat(1.0), ground: flat(0.2) };
    let gradation = |zenith: f64| 1.0 - (-0.32 / zenith.cos()).exp();
    let indicatrix = |angle: f64| {
        1.0 + 10.0 * ((-3.0 * angle).exp() - (-1.5 * PI).exp()) + 0.45 * angle.cos().powi(2)
    };
    let (mut sum, steps) = (0.0, 600);
    for i in 0..steps {
        for j in 0..steps {
            let zenith = PI / 2.0 * (f64::from(i) + 0.5) / f64::from(steps);
            let azimuth = TAU * (f64::from(j) + 0.5) / f64::from(steps);
            let (sin, cos) = zenith.sin_cos();
            let direction = DVec3::new(sin * azimuth.cos(), cos, sin * azimuth.sin());
            let value = gradation(zenith) * indicatrix(direction.dot(sun).clamp(-1.0, 1.0).acos());
            sum += value * sin * cos;
        }
    }
    let whole = sum * (PI / 2.0) * TAU / f64::from(steps * steps);
    let expected = whole / (gradation(0.0) * indicatrix(f64::to_radians(40.0))) / PI;
    ground(World::under(Base::Sky(sky)), 2048).is(expected, 3e-3);
}

#[test]
fn a_picture_lights_by_the_sum_of_its_pixels() {
    // Rows of 22.5°; one pixel of the second row is bright. A row from Z₁ to Z₂ gives a column of
    // width Δ the illuminance Δ·(sin² Z₂ − sin² Z₁)/2.
    let (width, height) = (12_usize, 8_usize);
    let value = |row: usize, column: usize| match (row, column) {
        (1, 7) => 400.0,
        (row, column) => 0.1 * (row + column) as f64,
    };
    let pixels =
        (0..width * height).map(|at| [0.0, value(at / width, at % width) as f32, 0.0]).collect();
    let bases = [flat(0.0), flat(2.0), flat(0.0)];
    let image = ImageMap::new([width, height], pixels, bases, 0.3).unwrap();
    let edge = |row: usize| (PI * row as f64 / height as f64).sin().powi(2);
    let mut expected = 0.0;
    for at in 0..width * height / 2 {
        let row = at / width;
        expected += value(row, at % width) * (edge(row + 1) - edge(row)) / width as f64;
    }
    ground(World::under(Base::Image(image)), 2048).is(2.0 * expected, 3e-3);
}

#[test]
fn roulette_ends_no_way_to_a_small_bright_thing() {
    // The way to a sun carries little, and brings much.
    let mut world = World::dark();
    world.sun(tilted(30.0), 0.2665, flat(1.0 / f64::to_radians(0.2665).sin().powi(2)));
    let floor = Shape::Plane(Plane::new(DVec3::ZERO, DVec3::Y).unwrap());
    world.add(matt(0.5), floor);
    let scene = world.along(DVec3::Y * 50.0, DVec3::new(0.1, -1.0, 0.0));
    let got = Take::of(1024, USUAL).luminance(&scene);
    got.is(0.5 * f64::to_radians(30.0).cos(), 2e-2);
}

/// A hard soft box that looks down from a height.
fn lamp(centre: DVec3, half: [f64; 2], radiance: f64) -> SoftBox {
    SoftBox {
        centre,
        half_width: DVec3::X * half[0],
        half_height: DVec3::Z * half[1],
        radiance: flat(radiance),
        edge_softness: 0.0,
        group: 1,
    }
}

#[test]
fn a_soft_box_lights_by_its_form_factor() {
    // A quarter of the rectangle seen from below its corner: Howell, configuration C-11.
    let quarter = |a: f64, b: f64| {
        let (x, y) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
        (a / x * (b / x).atan() + b / y * (a / y).atan()) / TAU
    };
    for (half, height) in [([30.0, 20.0], 40.0), ([5.0, 200.0], 25.0), ([1.0, 1.0], 300.0)] {
        let mut world = World::dark();
        world.soft_boxes.push(lamp(DVec3::Y * height, half, 7.0));
        let got = ground(world, 1024);
        got.is(7.0 * 4.0 * quarter(half[0] / height, half[1] / height), 3e-3);
    }
    // Seen from behind it is dark.
    let mut world = World::dark();
    let below = SoftBox { half_width: -DVec3::X, ..lamp(DVec3::Y * 9.0, [1.0, 1.0], 7.0) };
    world.soft_boxes.push(below);
    ground(world, 64).is(0.0, EXACT);
}

#[test]
fn a_soft_box_as_bright_as_the_surround_is_not_seen_in_what_loses_no_light() {
    // A furnace in which every turn is aimed at something: the first besides others, later in their place.
    let milk = body(flat(1.0), flat(0.0), Some((flat(0.2), 0.3)));
    for (optics, alpha) in [(milk, 0.0), (glass(1.5), 0.3), (matt(1.0), 0.0)] {
        let mut world = World::under(Base::Constant(flat(1.0)));
        world.soft_boxes.push(lamp(DVec3::Y * 40.0, [30.0, 20.0], 1.0));
        world.add(matt(1.0), Shape::Plane(Plane::new(DVec3::Y * -6.0, DVec3::Y).unwrap()));
        world.add_rough(optics, alpha, ball(DVec3::ZERO, 5.0));
        let scene = world.along(DVec3::new(1.0, 30.0, 2.0), -DVec3::Y);
        Take::of(1 << 13, USUAL).luminance(&scene).is(1.0, 1e-2);
    }
}

#[test]
fn a_thin_lens_blurs_a_spot_out_of_focus_into_its_circle_of_confusion() {
    // Rays from the middle of the picture spread, d mm away, over a disc of the diameter
    // A·|1 − d/f|. Its share that the spot of radius 1.2 mm fills is seen.
    for distance in [60.0, 100.0, 150.0, 240.0] {
        let mut world = World::dark();
        let spot = world.add(matt(0.0), disc(DVec3::Z * distance, -DVec3::Z, 1.2));
        world.shine(spot, lamplit_core::scene::Strength::Radiance(flat(3.0)), 0);
        let projection =
            Projection::ThinLens { field_of_view_deg: 1e-6, aperture: 8.0, focus: 100.0 };
        let camera = Camera::new(DVec3::ZERO, DVec3::Z, DVec3::Y, projection).unwrap();
        let got = Take::of(4096, USUAL).luminance(&world.seen_by(camera));
        let blur = 4.0 * (1.0 - distance / 100.0_f64).abs();
        let share = if blur <= 1.2 { 1.0 } else { (1.2 / blur).powi(2) };
        got.is(3.0 * share, 5e-3);
    }
}

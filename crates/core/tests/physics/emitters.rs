// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Bodies that shine: luminance, flux, intensity and illuminance in closed form.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lamplit_core::geometry::{Cylinder, Plane, Shape};
use lamplit_core::light::{DirectionGrid, SoftBox};
use lamplit_core::math::{DAffine3, DMat3, DVec3};
use lamplit_core::matter::Optics;
use lamplit_core::scene::{Camera, Distribution, Projection, Strength};

use crate::common::*;

const MM2_PER_M2: f64 = 1e6;

/// The illuminance, in W/(m²·nm), of the point `at` of a matt plane; the eye stands off to one side.
fn illuminance(mut world: World, at: DVec3, normal: DVec3, samples: u32) -> Estimate {
    let plane = Shape::Plane(Plane::new(at, normal).unwrap());
    world.add(matt(0.4), plane);
    let (aside, _) = lamplit_core::math::orthonormal_pair(normal);
    let eye = normal * 30.0 + aside * 70.0;
    Take::of(samples, USUAL).luminance(&world.along(at + eye, -eye)).times(PI / 0.4)
}

#[test]
fn a_matt_disc_of_a_flux_shows_one_luminance_from_its_front_and_none_from_behind() {
    let luminance = 5.0 / (PI * PI * 4.0 / MM2_PER_M2);
    for (degrees, expected) in
        [(0.0, luminance), (40.0, luminance), (85.0, luminance), (120.0, 0.0)]
    {
        let mut world = World::dark();
        let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, 2.0));
        world.shine(lamp, Strength::Flux(flat(5.0)), 0);
        let scene = world.along(tilted(degrees) * 100.0, -tilted(degrees));
        Take::of(4, USUAL).luminance(&scene).is(expected, EXACT);
    }
}

#[test]
fn a_ball_of_a_flux_has_its_luminance_and_lights_by_the_inverse_square_and_the_cosine() {
    // L = Φ/(4π²r²), I = Φ/4π, and a ball lights like a point, at any distance.
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), ball(DVec3::ZERO, 3.0));
    world.shine(lamp, Strength::Flux(flat(5.0)), 0);
    let scene = world.along(DVec3::new(1.0, 50.0, 2.0), -DVec3::Y);
    let luminance = 5.0 / (4.0 * PI * PI * 9.0 / MM2_PER_M2);
    Take::of(4, USUAL).luminance(&scene).is(luminance, EXACT);
    for (distance, degrees) in [(4.0, 0.0), (20.0, 0.0), (40.0, 30.0), (1000.0, 60.0)] {
        let mut world = World::dark();
        let lamp = world.add(matt(0.0), ball(DVec3::ZERO, 3.0));
        world.shine(lamp, Strength::Flux(flat(5.0)), 0);
        let at = DVec3::X * distance;
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let got = illuminance(world, at, DVec3::new(-cos, sin, 0.0), 1024);
        got.is(5.0 / (4.0 * PI) * MM2_PER_M2 / (distance * distance) * cos, 3e-3);
    }
}

#[test]
fn a_disc_lights_a_parallel_plane_by_cos4_and_from_near_by_its_size() {
    for degrees in [0.0, 30.0, 60.0] {
        let mut world = World::dark();
        let lamp = world.add(matt(0.0), disc(DVec3::Y * 200.0, -DVec3::Y, 0.2));
        world.shine(lamp, Strength::Flux(flat(PI)), 0);
        let at = DVec3::X * 200.0 * f64::to_radians(degrees).tan();
        // I₀ = Φ/π = 1.
        let expected = f64::to_radians(degrees).cos().powi(4) / (0.2 * 0.2);
        illuminance(world, at, DVec3::Y, 1024).is(expected, 2e-3);
    }
    // E = πL·r²/(r² + d²) on the axis, however near.
    for distance in [1.0, 10.0, 50.0] {
        let mut world = World::dark();
        let lamp = world.add(matt(0.0), disc(DVec3::Y * distance, -DVec3::Y, 20.0));
        world.shine(lamp, Strength::Radiance(flat(2.0)), 0);
        let at = DVec3::ZERO;
        let expected = 2.0 * PI * 400.0 / (400.0 + distance * distance);
        // From the side, so that the lamp does not hide the plane.
        let floor = Shape::Plane(Plane::new(at, DVec3::Y).unwrap());
        world.add(matt(0.4), floor);
        let scene = world.along(DVec3::Y * (distance * 0.5), -DVec3::Y);
        Take::of(2048, USUAL).luminance(&scene).times(PI / 0.4).is(expected, 3e-3);
    }
}

#[test]
fn a_cosine_law_has_the_intensity_cos_n_and_its_flux() {
    // I₀ = Φ(n + 1)/2π.
    for exponent in [0.5, 2.0, 8.0] {
        for degrees in [0.0, 50.0] {
            let mut world = World::dark();
            let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, 0.3));
            let law = Distribution::Cosine { exponent };
            world.shine_as(lamp, Strength::Flux(flat(2.0)), law, 0);
            let way = tilted(degrees);
            let got = illuminance(world, way * 300.0, -way, 1024);
            let intensity = 2.0 * (exponent + 1.0) / TAU * way.y.powf(exponent);
            got.is(intensity * MM2_PER_M2 / 90_000.0, 3e-3);
        }
    }
}

#[test]
fn a_measured_intensity_lights_as_measured_whatever_shape_carries_it() {
    // I(θ) = I₀·(1 − 2θ/π) from the axis z to 90°, Φ = 2πI₀·(1 − 2/π).
    let intensity = |theta: f64| (1.0 - theta / FRAC_PI_2) * 3.0 / (TAU * (1.0 - 2.0 / PI));
    for degrees in [0.0, 35.0, 80.0] {
        for shape in [ball(DVec3::ZERO, 0.2), cuboid(DVec3::splat(-0.1), DVec3::splat(0.2))] {
            let grid = DirectionGrid::new(vec![0.0, FRAC_PI_2], vec![0.0], vec![1.0, 0.0]);
            let frame = DMat3::from_cols(DVec3::Z, DVec3::X, DVec3::Y);
            let law = Distribution::Intensity { grid: grid.unwrap(), frame };
            let mut world = World::dark();
            let lamp = world.add(matt(0.0), shape);
            world.shine_as(lamp, Strength::Flux(flat(3.0)), law, 0);
            let way = tilted(degrees);
            let got = illuminance(world, way * 600.0, -way, 1024);
            let expected = intensity(f64::to_radians(degrees)) * MM2_PER_M2 / 360_000.0;
            // The body is small, not a point: 1e-3.
            assert!(
                (got.mean / expected - 1.0).abs() < 4e-3 + 3.0 * got.sigma / expected,
                "{got:?}"
            );
        }
    }
}

#[test]
fn convex_bodies_light_from_afar_by_their_projected_area() {
    let far = 4000.0;
    let drum = Cylinder::new(DVec3::new(0.0, -3.0, 0.0), DVec3::Y, 2.0, 6.0).unwrap();
    let squeezed = DAffine3::from_scale(DVec3::new(1.0, 2.0, 0.5));
    // Along x: an ellipse of half axes 2 and ½, a drum's side of 4 × 6, a box's face.
    let bodies = [
        (ball(DVec3::ZERO, 3.0), squeezed, PI * 6.0 * 1.5),
        (Shape::Cylinder(drum), DAffine3::IDENTITY, 24.0),
        (Shape::Cylinder(drum), squeezed, 24.0),
        (cuboid(DVec3::splat(-2.0), DVec3::splat(2.0)), squeezed, 16.0),
    ];
    for (shape, to_world, area) in bodies {
        let mut world = World::dark();
        let material = world.material(matt(0.0), 0.0);
        let lamp = world.place(material, 0, shape, to_world);
        world.shine(lamp, Strength::Radiance(flat(10.0)), 0);
        let got = illuminance(world, DVec3::X * far, -DVec3::X, 1024);
        let expected = 10.0 * area / (far * far);
        assert!((got.mean / expected - 1.0).abs() < 3e-3 + 3.0 * got.sigma / expected, "{got:?}");
        assert!(got.sigma < 3e-3 * expected, "{got:?} {expected}");
    }
}

#[test]
fn lamps_of_unlike_power_light_by_their_sum_and_each_in_its_group() {
    let lamps = [(DVec3::new(40.0, 30.0, 0.0), 1.0, 1), (DVec3::new(-20.0, 60.0, 10.0), 20.0, 2)];
    let mut world = World::under(gradient(0.0, 0.3));
    world.sun(tilted(10.0), 2.0, flat(50.0));
    let mut expected = [0.3 * 5.0 / 6.0 * PI, 0.0, 0.0, 0.0];
    expected[3] = 50.0 * PI * f64::to_radians(2.0).sin().powi(2) * f64::to_radians(10.0).cos();
    for (at, flux, group) in lamps {
        let lamp = world.add(matt(0.0), ball(at, 1.0));
        world.shine(lamp, Strength::Flux(flat(flux / MM2_PER_M2)), group);
        expected[group] = flux / (4.0 * PI) * at.y / at.length().powi(3);
    }
    // The surround is hidden behind both lamps, a little.
    for (at, ..) in lamps {
        let up = 0.5 * (at.normalize().y + 1.0);
        expected[0] -= 0.3 * up * PI * at.y / at.length().powi(3);
    }
    let floor = Shape::Plane(Plane::new(DVec3::ZERO, DVec3::Y).unwrap());
    world.add(matt(0.5), floor);
    let scene = world.along(DVec3::new(5.0, 9.0, 80.0), DVec3::new(-5.0, -9.0, -80.0));
    let film = Take::of(4096, USUAL).picture(&scene).film;
    let group = |at: usize| {
        let pixels: Vec<f64> =
            film.layer_sums.iter().skip(at).step_by(4).map(|sums| sums.mean()[1]).collect();
        Estimate::of(pixels.iter()).times(PI / 0.5)
    };
    all_are(&[0, 1, 2, 3].map(group), |at| expected[at], 2e-2);
    for (at, pixel) in film.pixels.iter().enumerate() {
        let layers = &film.layer_sums[at * 4..at * 4 + 4];
        for i in 0..3 {
            let sum: f64 = layers.iter().map(|layer| layer.xyz[i]).sum();
            assert!((sum / pixel.xyz[i] - 1.0).abs() < 1e-12, "{sum} {:?}", pixel.xyz);
        }
    }
}

#[test]
fn all_flux_of_a_lamp_in_a_clear_ball_leaves_it() {
    // Seen as a whole by parallel rays from any side: ∫ L dA = Φ/4π. The lamp takes nothing back.
    let mut world = World::dark();
    let lamp = world.add(matt(1.0), ball(DVec3::ZERO, 2.0));
    world.add(glass(1.5), ball(DVec3::ZERO, 8.0));
    world.shine(lamp, Strength::Flux(flat(6.0)), 0);
    let projection = Projection::Orthographic { height: 16.0 };
    let camera = Camera::new(DVec3::Z * 40.0, DVec3::ZERO, DVec3::Y, projection).unwrap();
    let scene = world.seen_by(camera);
    let seen = (0..16).map(|seed| {
        let take = Take { seed, ..Take::of(256, USUAL) };
        let film = take.picture(&scene).film;
        film.pixels.iter().map(|pixel| pixel.mean()[1]).sum::<f64>() * 4.0 / MM2_PER_M2
    });
    let seen: Vec<f64> = seen.collect();
    Estimate::of(seen.iter()).is(6.0 / (4.0 * PI), 3e-3);
}

#[test]
fn a_plate_in_dyed_glass_is_lit_by_a_lamp_in_it_through_the_dye() {
    // E/n² = Φ/(4πd²n²)·e^(−a·d), where a lamp's flux is given, and basic radiance seen.
    let dye = by_lane(|lane| 0.002 * (lane + 1) as f64);
    let mut world = World::dark();
    world.add(body(flat(1.4), dye, None), ball(DVec3::ZERO, 1e4));
    let lamp = world.add(matt(0.0), ball(DVec3::Y * 50.0, 0.02));
    world.shine(lamp, Strength::Flux(flat(3.0)), 0);
    let floor = Shape::Plane(Plane::new(DVec3::ZERO, DVec3::Y).unwrap());
    world.add(matt(0.5), floor);
    let from = DVec3::new(30.0, 40.0, 0.0);
    let lanes = Take::of(1024, USUAL).lanes(&world.along(from, -from));
    let expected = |lane: usize| {
        let way = (-0.002 * (lane + 1) as f64 * (50.0 + 50.0)).exp();
        0.5 / PI * 3.0 / (4.0 * PI * 2500.0) * MM2_PER_M2 / (1.4 * 1.4) * way
    };
    all_are(&lanes, expected, 3e-2);
}

#[test]
fn lamps_looked_for_and_lamps_aimed_at_light_alike() {
    // The same bright rectangle, once a mesh that shines and once a soft box of the background.
    let metal = Optics::Conductor { n: flat(1.0), k: flat(6.0), factor: 1.0, lacquer: None };
    let glossy = Optics::Glossy { index: flat(1.5), base: flat(0.4) };
    let opal = body(flat(1.0), flat(0.05), Some((flat(0.4), 0.7)));
    for (optics, alpha) in
        [(metal.clone(), 0.05), (metal, 0.4), (glossy, 0.2), (matt(0.6), 0.0), (opal, 0.0)]
    {
        let view = |world: World, seed: u64| {
            let mut world = world;
            let material = world.material(optics.clone(), alpha);
            world.place(material, 0, plate(-2.0, 0.0), DAffine3::IDENTITY);
            let eye = DVec3::new(-40.0, 30.0, 3.0);
            let take = Take { seed, ..Take::of(2048, STEADY) };
            take.luminance(&world.along(eye, -eye))
        };
        let (centre, right, up) =
            (DVec3::new(50.0, 40.0, 0.0), -DVec3::Z * 8.0, DVec3::new(6.0, -8.0, 0.0));
        let mut studio = World::dark();
        studio.soft_boxes.push(SoftBox {
            centre,
            half_width: right,
            half_height: up,
            radiance: flat(5.0),
            edge_softness: 0.0,
            group: 1,
        });
        let aimed = view(studio, 1);
        let corners = [-right - up, right - up, right + up, up - right]
            .map(|corner| (centre + corner).to_array());
        let mut lit = World::dark();
        let lamp = lit.add_mesh(matt(0.0), &corners, &[[0, 1, 2], [0, 2, 3]], None);
        lit.shine(lamp, Strength::Radiance(flat(5.0)), 1);
        let looked_for = view(lit, 2);
        assert!(aimed.mean > 1e-3, "{aimed:?}");
        let both = Estimate { sigma: aimed.sigma.hypot(looked_for.sigma), ..looked_for };
        both.is(aimed.mean, 3e-2);
    }
}

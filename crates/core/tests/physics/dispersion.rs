// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Lanes that go different ways, and the limits in which roughness, dispersion and boundaries end.

use lamplit_core::geometry::{ConvexPolyhedron, Shape};
use lamplit_core::math::{DAffine3, DVec3};
use lamplit_core::spectrum::LANES;

use crate::common::*;

/// n of PMMA over the lanes' wavelengths, 392.5 nm to 767.5 nm.
fn pmma(lane: usize) -> f64 {
    let micrometres = 0.3925 + 0.025 * lane as f64;
    1.478 + 0.00475 / (micrometres * micrometres)
}

#[test]
fn each_wavelength_leaves_a_prism_at_its_own_minimum_deviation() {
    let (sin, cos) = 30.0_f64.to_radians().sin_cos();
    // Two faces of the tetrahedron meet at 60° along z.
    let edge = DVec3::Z * 40.0;
    let base = [DVec3::new(-sin, -cos, 0.0) * 30.0, DVec3::new(sin, -cos, 0.0) * 30.0];
    for lane in [0, 4, 8, 15] {
        let mut world = World::dark();
        let prism = ConvexPolyhedron::tetrahedron([edge, -edge, base[0], base[1]]).unwrap();
        world.add(body(by_lane(pmma), flat(0.0), None), Shape::Polyhedron(prism));
        // D = 2·asin(n·sin 30°) − 60°, passed symmetrically.
        let incidence = (pmma(lane) * sin).asin();
        let half_deviation = incidence - 30.0_f64.to_radians();
        let rising = DVec3::new(half_deviation.cos(), half_deviation.sin(), 0.0);
        let falling = rising * DVec3::new(1.0, -1.0, 1.0);
        world.sun(falling, 5e-5, flat(1.0));
        let scene = world.along(base[0] * 0.5 - rising * 100.0, rising);
        let lanes = Take::of(1024, USUAL).lanes(&scene);
        let through = (1.0 - fresnel(incidence.to_degrees(), pmma(lane))).powi(2);
        all_are(&lanes, |other| if other == lane { through } else { 0.0 }, 3e-3);
    }
}

/// Indices far apart.
fn strong(lane: usize) -> f64 {
    1.8 - 0.03 * lane as f64
}

/// The radiance of a dyed slab of thickness 3 mm before a surround from `nadir` 1 to zenith 0.
fn slab(degrees: f64, n: f64, absorption: f64) -> f64 {
    let r = fresnel(degrees, n);
    let tau = (-3.0 * absorption / (degrees.to_radians().sin() / n).asin().cos()).exp();
    let rest = 1.0 - r * r * tau * tau;
    let (t, r) = ((1.0 - r).powi(2) * tau / rest, r + (1.0 - r).powi(2) * r * tau * tau / rest);
    let cos = degrees.to_radians().cos();
    f64::midpoint(t * (1.0 + cos), r * (1.0 - cos))
}

#[test]
fn every_lane_of_a_dispersive_slab_has_its_own_fresnel_and_its_own_way() {
    let dye = |lane: usize| 0.02 * lane as f64;
    for path in [USUAL, SINGLE] {
        for degrees in [10.0, 60.0, 80.0] {
            let mut world = World::under(gradient(1.0, 0.0));
            world.add(body(by_lane(strong), by_lane(dye), None), plate(0.0, 3.0));
            let scene = world.along(tilted(degrees) * 20.0, -tilted(degrees));
            let lanes = Take::of(2048, path).lanes(&scene);
            all_are(&lanes, |lane| slab(degrees, strong(lane), dye(lane)), 5e-3);
        }
    }
}

#[test]
fn the_slightest_roughness_changes_nothing() {
    // Also with dispersion: lanes then have facets of their own for one pair of directions.
    let even = |_: usize| 1.5;
    for index in [even, strong] {
        for degrees in [10.0, 60.0] {
            let mut world = World::under(gradient(1.0, 0.0));
            let optics = body(by_lane(index), flat(0.05), None);
            world.add_rough(optics, 0.001, plate(0.0, 3.0));
            let scene = world.along(tilted(degrees) * 20.0, -tilted(degrees));
            let lanes = Take::of(4096, USUAL).lanes(&scene);
            all_are(&lanes, |lane| slab(degrees, index(lane), 0.05), 6e-3);
        }
    }
}

/// A ball of glass, before a surround from 1 below to 0 above and a narrow lamp behind it.
fn ball_of(index: impl Fn(usize) -> f64, alpha: f64) -> World {
    let mut world = World::under(gradient(1.0, 0.0));
    world.add_rough(body(by_lane(index), flat(0.01), None), alpha, ball(DVec3::ZERO, 5.0));
    world.sun(DVec3::new(0.1, -0.5, -1.0).normalize(), 30.0, flat(2.0));
    world
}

fn before_ball() -> (DVec3, DVec3) {
    (DVec3::new(2.0, 1.5, 30.0), -DVec3::Z)
}

#[test]
fn lanes_together_and_each_on_its_own_agree_behind_dispersive_balls() {
    let (from, along) = before_ball();
    for alpha in [0.0, 0.2, 0.7] {
        let together = Take::of(2048, USUAL).lanes(&ball_of(strong, alpha).along(from, along));
        for lane in [0, 7, 15] {
            // One index on all lanes: no choice of a hero, no other lane's facets.
            let scene = ball_of(|_| strong(lane), alpha).along(from, along);
            let alone = Take { seed: 99, ..Take::of(1024, USUAL) }.lanes(&scene)[lane];
            let got = together[lane];
            let both = Estimate { mean: got.mean, sigma: got.sigma.hypot(alone.sigma) };
            all_are(&[both; 9], |_| alone.mean, 3e-2);
        }
    }
}

#[test]
fn dispersion_that_goes_to_zero_ends_as_none() {
    let (from, along) = before_ball();
    for alpha in [0.0, 0.3] {
        let hair = |lane: usize| 1.5 + 1e-9 * lane as f64;
        let even = Take::of(1024, USUAL).lanes(&ball_of(|_| 1.5, alpha).along(from, along));
        let scene = ball_of(hair, alpha).along(from, along);
        let nearly = Take { seed: 5, ..Take::of(2048, USUAL) }.lanes(&scene);
        let both: Vec<Estimate> = (0..LANES)
            .map(|at| Estimate { sigma: even[at].sigma.hypot(nearly[at].sigma), ..nearly[at] })
            .collect();
        all_are(&both, |lane| even[lane].mean, 2e-2);
    }
}

#[test]
fn a_boundary_between_equal_indices_is_none_smooth_or_rough() {
    for alpha in [0.0, 0.4] {
        let mut world = World::under(gradient(1.0, 0.0));
        let inner = world.material(body(flat(1.5), flat(0.1), None), alpha);
        let outer = world.material(body(flat(1.5), flat(0.1), None), 0.0);
        world.place(outer, 0, plate(0.0, 3.0), DAffine3::IDENTITY);
        world.place(inner, 1, ball(DVec3::Y * 1.5, 1.0), DAffine3::IDENTITY);
        let got = Take::of(64, WHOLE).luminance(&world.along(tilted(40.0) * 20.0, -tilted(40.0)));
        got.is(slab(40.0, 1.5, 0.1), EXACT);
    }
}

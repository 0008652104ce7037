// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Clear and dyed bodies with smooth surfaces: Bouguer, Snell, Fresnel.

use lamplit_core::geometry::{ConvexPolyhedron, Plane, Shape};
use lamplit_core::light::Base;
use lamplit_core::math::{DAffine3, DVec3};
use lamplit_core::matter::Optics;

use crate::common::*;

/// −ln 0.9 per mm: a millimetre lets nine tenths through.
fn nine_tenths() -> f64 {
    -(0.9_f64.ln())
}

#[test]
fn three_millimetres_of_nine_tenths_let_0_729_through_at_any_scale_of_the_world() {
    for scale in [1e-3, 1.0, 1e4] {
        for degrees in [0.0, 40.0, 75.0] {
            let mut world = World::under(Base::Constant(flat(1.0)));
            let dye = flat(nine_tenths() / scale);
            let corner = DVec3::new(100.0, 3.0, 100.0) * scale;
            world.add(
                body(flat(1.0), dye, None),
                cuboid(corner * DVec3::new(-1.0, 0.0, -1.0), corner),
            );
            let from = tilted(degrees) * (20.0 * scale);
            let lanes = Take::of(1, WHOLE).lanes(&world.along(from, -tilted(degrees)));
            let expected = 0.729_f64.powf(1.0 / degrees.to_radians().cos());
            all_are(&lanes, |_| expected, EXACT);
        }
    }
}

#[test]
fn a_ball_is_passed_by_its_chord_and_two_fillings_by_their_parts() {
    let mut world = World::under(Base::Constant(flat(1.0)));
    let dye = by_lane(|lane| 0.01 * lane as f64);
    let strong = by_lane(|lane| 0.05 * (lane + 1) as f64);
    let outer = world.material(body(flat(1.0), dye, None), 0.0);
    let inner = world.material(body(flat(1.0), strong, None), 0.0);
    world.place(outer, 0, ball(DVec3::ZERO, 10.0), DAffine3::IDENTITY);
    world.place(inner, 1, ball(DVec3::ZERO, 8.0), DAffine3::IDENTITY);
    let lanes = Take::of(1, WHOLE).lanes(&world.along(DVec3::new(6.0, 0.0, 30.0), -DVec3::Z));
    // Half chords: √(100 − 36) = 8 and √(64 − 36) = √28.
    let (whole, within) = (16.0, 2.0 * 28.0_f64.sqrt());
    let expected = |lane: usize| {
        let (a, b) = (0.01 * lane as f64, 0.05 * (lane + 1) as f64);
        (-(a * (whole - within) + b * within)).exp()
    };
    all_are(&lanes, expected, EXACT);
}

/// T and R of a slab of index n and internal transmittance τ along the normal, unpolarised: the
/// tracer takes the mean of s and p at each face, so R is that mean in all inter-reflections.
fn slab(degrees: f64, n: f64, tau: f64) -> (f64, f64) {
    let r = fresnel(degrees, n);
    let cos = (degrees.to_radians().sin() / n).asin().cos();
    let tau = tau.powf(1.0 / cos);
    let rest = 1.0 - r * r * tau * tau;
    ((1.0 - r).powi(2) * tau / rest, r + (1.0 - r).powi(2) * r * tau * tau / rest)
}

/// What one sees against a slab, if the surround is `nadir` below and `zenith` above.
fn before_slab(degrees: f64, (t, r): (f64, f64), nadir: f64, zenith: f64) -> f64 {
    let cos = degrees.to_radians().cos();
    let at = |y: f64| nadir + (zenith - nadir) * (1.0 + y) / 2.0;
    t * at(-cos) + r * at(cos)
}

#[test]
fn a_dyed_slab_has_its_transmittance_and_reflectance_with_all_inter_reflections() {
    for (path, samples, fine) in [(WHOLE, 1, EXACT), (USUAL, 256, 1e-3), (SINGLE, 4096, 1e-3)] {
        for degrees in [0.0, 20.0, 45.0, 56.31, 70.0, 80.0] {
            for (nadir, zenith) in [(1.0, 0.0), (0.0, 1.0)] {
                let mut world = World::under(gradient(nadir, zenith));
                let dye = flat(nine_tenths());
                world.add(body(flat(1.5), dye, None), plate(0.0, 3.0));
                let from = tilted(degrees) * 20.0;
                let scene = world.along(from, -tilted(degrees));
                let got = Take::of(samples, path).luminance(&scene);
                let expected = before_slab(degrees, slab(degrees, 1.5, 0.729), nadir, zenith);
                got.is(expected, fine * if expected < 0.2 { 5.0 } else { 1.0 });
            }
        }
    }
}

#[test]
fn an_eye_inside_of_glass_sees_out_through_snells_window_only() {
    // The critical angle of 1.5 is 41.81°.
    for (degrees, is_out) in [(0.0, true), (30.0, true), (41.5, true), (42.1, false), (60.0, false)]
    {
        let mut world = World::dark();
        world.add(glass(1.5), plate(-50.0, 50.0));
        let outside = (1.5 * f64::to_radians(degrees).sin()).min(1.0).asin().to_degrees();
        world.sun(tilted(outside), 1e-4, flat(1.0));
        let scene = world.along(DVec3::ZERO, tilted(degrees));
        let path = lamplit_core::transport::PathSettings { max_depth: 1, ..WHOLE };
        let got = Take::of(1, path).luminance(&scene);
        let expected = if is_out { 1.0 - fresnel(outside, 1.5) } else { 0.0 };
        got.is(expected, EXACT);
    }
}

#[test]
fn a_corner_of_mirrors_sends_light_back_where_it_came_from() {
    for towards in [DVec3::new(1.0, 1.0, 1.0), DVec3::new(1.0, 2.0, 0.7), DVec3::new(0.5, 0.4, 2.0)]
    {
        let towards = towards.normalize();
        let mut world = World::dark();
        for axis in DVec3::AXES {
            let plane = Shape::Plane(Plane::new(DVec3::ZERO, axis).unwrap());
            world.add(Optics::Mirror(flat(0.9)), plane);
        }
        world.sun(towards, 1e-5, flat(1.0));
        let from = towards * 50.0 + DVec3::new(3.0, 2.0, 5.0);
        let got = Take::of(1, WHOLE).luminance(&world.along(from, -towards));
        got.is(0.729, EXACT);
    }
}

#[test]
fn a_glass_corner_cube_reflects_totally_thrice_and_returns_the_light() {
    let side = 30.0;
    let points = [DVec3::ZERO, DVec3::X * side, DVec3::Y * side, DVec3::Z * side];
    let front = DVec3::ONE.normalize();
    let (aside, _) = lamplit_core::math::orthonormal_pair(front);
    for degrees in [3.0_f64, 8.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let towards = front * cos + aside * sin;
        let mut world = World::dark();
        let prism = Shape::Polyhedron(ConvexPolyhedron::tetrahedron(points).unwrap());
        world.add(body(flat(1.4915), flat(0.01), None), prism);
        world.sun(towards, 1e-4, flat(1.0));
        let entry = DVec3::splat(side / 3.0) + aside * 1.5;
        let got = Take::of(1, WHOLE).luminance(&world.along(entry + towards * 50.0, -towards));
        // The three mirrors unfold to a slab of twice the height of the corner. What the front
        // reflects inside comes back on the other side of its normal, and so on.
        let inside = (sin / 1.4915).asin().cos();
        let tau = (-0.01 * 2.0 * side / 3.0_f64.sqrt() / inside).exp();
        let r = fresnel(degrees, 1.4915);
        let expected = (1.0 - r).powi(2) * tau / (1.0 - (r * tau).powi(2));
        got.is(expected, EXACT);
    }
}

#[test]
fn a_paraboloid_sends_light_from_its_focus_along_its_axis() {
    // y = (x² + z²)/4f over a square of 80 mm, with the true normals at its vertices.
    const CELLS: u32 = 200;
    let focus = 25.0;
    let step = 80.0 / f64::from(CELLS);
    let (mut vertices, mut normals, mut triangles) = (vec![], vec![], vec![]);
    for i in 0..=CELLS {
        for j in 0..=CELLS {
            let (x, z) = (f64::from(i) * step - 40.0, f64::from(j) * step - 40.0);
            vertices.push([x, (x * x + z * z) / (4.0 * focus), z]);
            let normal = DVec3::new(-x / (2.0 * focus), 1.0, -z / (2.0 * focus)).normalize();
            normals.push(normal.to_array());
            if i < CELLS && j < CELLS {
                let at = i * (CELLS + 1) + j;
                let (right, below) = (at + CELLS + 1, at + 1);
                triangles.extend([[at, below, right], [right, below, right + 1]]);
            }
        }
    }
    for (x, z) in [(0.0, 5.0), (13.0, -7.0), (-31.0, 30.0)] {
        let mut world = World::dark();
        world.add_mesh(Optics::Mirror(flat(0.85)), &vertices, &triangles, Some(&normals));
        world.sun(DVec3::Y, 0.03, flat(1.0));
        let at = DVec3::new(x, (x * x + z * z) / (4.0 * focus), z);
        let eye = DVec3::Y * focus;
        let got = Take::of(1, WHOLE).luminance(&world.along(eye, at - eye));
        got.is(0.85, EXACT);
    }
}

#[test]
fn glued_bodies_of_one_index_are_one_body() {
    // Two halves of a dyed slab, different materials; and a ball of the slab's own glass inside.
    for degrees in [0.0, 50.0] {
        let mut world = World::under(gradient(1.0, 0.0));
        let dye = || body(flat(1.5), flat(nine_tenths()), None);
        world.add(dye(), plate(0.0, 1.0));
        world.add(dye(), plate(1.0, 3.0));
        let inner = world.material(dye(), 0.0);
        world.place(inner, 5, ball(DVec3::Y * 1.5, 1.0), DAffine3::IDENTITY);
        let scene = world.along(tilted(degrees) * 20.0, -tilted(degrees));
        let got = Take::of(1, WHOLE).luminance(&scene);
        got.is(before_slab(degrees, slab(degrees, 1.5, 0.729), 1.0, 0.0), EXACT);
    }
}

#[test]
fn of_bodies_in_one_place_the_higher_priority_fills_it() {
    // A plate of priority 2 over the upper half of another one: 2 mm of each are seen.
    for (upper, expected) in [(2, 0.4 * 2.0 + 0.1 * 2.0), (-1, 0.4 * 1.0 + 0.1 * 3.0)] {
        let mut world = World::under(Base::Constant(flat(1.0)));
        let weak = world.material(body(flat(1.0), flat(0.1), None), 0.0);
        let strong = world.material(body(flat(1.0), flat(0.4), None), 0.0);
        world.place(weak, 1, plate(0.0, 3.0), DAffine3::IDENTITY);
        world.place(strong, upper, plate(2.0, 4.0), DAffine3::IDENTITY);
        let got = Take::of(1, WHOLE).luminance(&world.along(DVec3::Y * 20.0, -DVec3::Y));
        got.is(f64::exp(-expected), EXACT);
    }
}

#[test]
fn a_film_of_ten_micrometres_a_metre_away_absorbs_what_it_should() {
    let mut world = World::under(Base::Constant(flat(1.0)));
    world.add(body(flat(1.0), flat(50.0), None), plate(1000.0, 1000.01));
    let got = Take::of(1, WHOLE).luminance(&world.along(DVec3::ZERO, DVec3::Y));
    // The film's thickness itself is rounded to 1e-13 mm.
    got.is((-0.5_f64).exp(), EXACT);
}

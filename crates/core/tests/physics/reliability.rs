// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The same bits for any threads and tiles, a ledger that closes, and rays that are lost and counted.

use std::sync::atomic::AtomicBool;

use lamplit_core::light::Base;
use lamplit_core::math::DVec3;
use lamplit_core::render::{render, Progress, RenderSettings};
use lamplit_core::scene::{Camera, Projection, Scene, Strength};

use crate::common::*;

/// Rough, dispersive and turbid glass, a lamp in it, a mirror, a floor, a sun and a graded surround.
fn of_everything() -> Scene {
    let mut world = all_but_sun();
    world.sun(tilted(40.0), 1.0, flat(100.0));
    seen(world)
}

fn all_but_sun() -> World {
    let mut world = World::under(gradient(0.2, 1.0));
    let index = by_lane(|lane| 1.6 - 0.005 * lane as f64);
    world.add_rough(body(index.clone(), flat(0.01), None), 0.2, ball(DVec3::ZERO, 5.0));
    let turbid = Some((flat(0.1), 0.4));
    world.add(body(index, flat(0.0), turbid), ball(DVec3::new(8.0, 0.0, 0.0), 4.0));
    let lamp = world.add(matt(0.5), ball(DVec3::new(1.0, 1.0, 0.0), 1.0));
    world.shine(lamp, Strength::Radiance(flat(3.0)), 1);
    world.add(
        lamplit_core::matter::Optics::Mirror(flat(0.9)),
        ball(DVec3::new(-8.0, 1.0, 0.0), 3.0),
    );
    world.add(matt(0.7), plate(-9.0, -6.0));
    world
}

fn seen(world: World) -> Scene {
    let projection = Projection::Pinhole { field_of_view_deg: 40.0 };
    let eye = DVec3::new(0.0, 10.0, 30.0);
    world.seen_by(Camera::new(eye, DVec3::ZERO, DVec3::Y, projection).unwrap())
}

#[test]
fn threads_and_tiles_change_no_bit_of_a_picture() {
    let scene = of_everything();
    for (adaptive, target_error) in [(false, None), (true, None), (true, Some(0.2))] {
        let settings = |threads: usize, tile: usize| RenderSettings {
            width: 13,
            height: 9,
            adaptive,
            target_error,
            threads,
            tile,
            ..Take::of(48, USUAL).settings()
        };
        let first = render(&scene, &settings(1, 1), &Progress::default()).unwrap();
        for threads in [1, 2, 7] {
            for tile in [1, 16, 64] {
                let other = render(&scene, &settings(threads, tile), &Progress::default()).unwrap();
                assert_eq!(first.film.pixels, other.film.pixels);
                assert_eq!(first.film.layer_sums, other.film.layer_sums);
                assert_eq!(first.film.band_sums, other.film.band_sums);
                assert_eq!(first.film.band_visits, other.film.band_visits);
                assert_eq!(first.tally, other.tally);
            }
        }
    }
}

#[test]
fn another_seed_is_another_picture_of_the_same_scene() {
    let scene = of_everything();
    let of = |seed: u64| Take { seed, ..Take::of(256, USUAL) }.picture(&scene).film;
    let (one, other) = (of(1), of(2));
    assert_ne!(one.pixels, other.pixels);
    let mut chi_square = 0.0;
    for (a, b) in one.pixels.iter().zip(&other.pixels) {
        let spread = a.standard_error()[1].hypot(b.standard_error()[1]);
        chi_square += ((a.mean()[1] - b.mean()[1]) / spread).powi(2) / 64.0;
    }
    // The spread of samples is an upper estimate for a sequence that is more even than chance.
    assert!(chi_square < 1.6, "{chi_square}");
}

#[test]
fn the_ledger_closes_and_chance_takes_as_much_as_it_gives() {
    let scene = seen(all_but_sun());
    let balances: Vec<_> = (0..24)
        .map(|seed| {
            let rendered = Take { seed, ..Take::of(128, USUAL) }.picture(&scene);
            let balance = rendered.tally.ledger.balance().unwrap();
            assert!(balance.gap().abs() < 1e-9, "{balance:?}");
            assert_eq!(balance.lost, 0.0);
            // The turbid ball is lossless, and so is the border of the rough one.
            assert!(balance.absorbed[1].abs() < 1e-9, "{balance:?}");
            balance
        })
        .collect();
    let chance: Vec<f64> = balances.iter().map(|balance| balance.chance).collect();
    let chance = Estimate::of(chance.iter());
    assert!(chance.mean.abs() < 4.0 * chance.sigma, "{chance:?}");
    assert!(chance.sigma < 2e-3, "{chance:?}");
}

#[test]
fn the_ledger_books_what_a_dyed_slab_keeps_and_lets_go() {
    let mut world = World::under(Base::Constant(flat(1.0)));
    world.add(body(flat(1.0), flat(0.3), None), plate(0.0, 2.0));
    let scene = world.along(DVec3::Y * 9.0, -DVec3::Y);
    let balance = Take::of(4, USUAL).picture(&scene).tally.ledger.balance().unwrap();
    assert!((balance.escaped - (-0.6_f64).exp()).abs() < 1e-9, "{balance:?}");
    assert!((balance.absorbed[0] - 1.0 + (-0.6_f64).exp()).abs() < 1e-9, "{balance:?}");
    assert_eq!(balance.cut_by_depth, 0.0);
}

#[test]
fn a_depth_limit_is_booked_as_a_cut() {
    let path = lamplit_core::transport::PathSettings { max_depth: 1, ..WHOLE };
    let mut world = World::under(Base::Constant(flat(1.0)));
    world.add(glass(1.5), plate(0.0, 2.0));
    let rendered = Take::of(4, path).picture(&world.along(DVec3::Y * 9.0, -DVec3::Y));
    let balance = rendered.tally.ledger.balance().unwrap();
    // What the first face lets in meets the second one, and is not followed beyond it.
    assert!((balance.cut_by_depth - 0.96).abs() < 1e-9, "{balance:?}");
    assert!((balance.escaped - 0.04).abs() < 1e-9, "{balance:?}");
    assert_eq!(rendered.tally.cut_by_depth, 2 * 4 * 64);
}

#[test]
fn rays_lost_at_an_open_mesh_are_counted_and_booked() {
    // A glass box without its lid and without its floor's second half.
    let vertices: Vec<[f64; 3]> = (0..8_u32)
        .map(|at| [at & 1, at >> 1 & 1, at >> 2].map(|bit| 8.0 * f64::from(bit) - 4.0))
        .collect();
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4]];
    let mut triangles: Vec<[u32; 3]> =
        sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    triangles.pop();
    let mut world = World::under(Base::Constant(flat(1.0)));
    world.add_mesh(glass(1.5), &vertices, &triangles, None);
    let path = lamplit_core::transport::PathSettings { max_depth: 64, ..USUAL };
    let rendered = Take::of(64, path).picture(&seen(world));
    let lost: u64 = rendered.tally.lost[0].iter().sum();
    assert!(lost > 100, "{:?}", rendered.tally.lost);
    let balance = rendered.tally.ledger.balance().unwrap();
    assert!(balance.lost > 0.01 && balance.gap().abs() < 1e-9, "{balance:?}");
    // A closed one loses nothing.
    triangles.push([0, 5, 4]);
    triangles.extend([[2, 6, 7], [2, 7, 3]]);
    let mut world = World::under(Base::Constant(flat(1.0)));
    world.add_mesh(glass(1.5), &vertices, &triangles, None);
    let rendered = Take::of(64, path).picture(&seen(world));
    assert_eq!(rendered.tally.lost[0], [0; 4]);
}

#[test]
fn a_cancelled_rendering_keeps_what_it_has() {
    let progress = Progress { cancelled: AtomicBool::new(true), ..Progress::default() };
    let rendered = render(&of_everything(), &Take::of(64, USUAL).settings(), &progress).unwrap();
    assert!(rendered.film.pixels.iter().all(|pixel| pixel.samples == 0));
}

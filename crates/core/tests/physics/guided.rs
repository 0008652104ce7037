// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Walks that learned where light comes from: the same light, found more often.

use std::f64::consts::PI;
use std::sync::Arc;

use lamplit_core::film::Film;
use lamplit_core::light::Base;
use lamplit_core::math::DVec3;
use lamplit_core::render::{learn, render, Method, Progress, RenderSettings};
use lamplit_core::sampling::PixelFilter;
use lamplit_core::scene::{Camera, Projection, Scene, Strength};

use crate::common::*;

/// A small ball of light in the middle of a ball of glass over a matt floor, seen 30 mm beside it.
fn bulb(flux: f64, index: f64, reflectance: f64) -> Scene {
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), ball(DVec3::ZERO, 0.1));
    world.shine(lamp, Strength::Flux(flat(flux)), 1);
    world.add(glass(index), ball(DVec3::ZERO, 10.0));
    world.add(matt(reflectance), plate(-51.0, -50.0));
    let at = DVec3::new(30.0, -50.0, 0.0);
    let eye = DVec3::new(80.0, 40.0, 30.0);
    world.along(at + eye, -eye)
}

#[test]
fn a_floor_under_a_bulb_is_as_bright_as_its_closed_form() {
    // All light crosses the glass along its normal. What the floor sends back to itself by way of the
    // bulb, which fills 1 % of its sky and reflects a tenth, is less than 1e-4.
    let (flux, n, rho) = (2.0, 1.5, 0.1);
    let r: f64 = ((n - 1.0) / (n + 1.0_f64)).powi(2);
    let d2: f64 = 50.0 * 50.0 + 30.0 * 30.0;
    let illuminance = flux / (4.0 * PI) * (1.0 - r) / (d2 * 1e-6) * (50.0 / d2.sqrt());
    let expected = rho * illuminance / PI;
    let scene = bulb(flux, n, rho);
    let guided = Take::lit(1 << 8, USUAL).by_seeds(16, &scene, None);
    guided.is(expected, 3e-3);
    let blind = Take::of(1 << 12, USUAL).luminance(&scene);
    assert!(blind.sigma > 20.0 * guided.sigma, "{blind:?} {guided:?}");
}

#[test]
fn an_opal_cover_lit_from_behind_is_as_bright_as_by_path() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, 1.0));
    world.shine(lamp, Strength::Flux(flat(2.0)), 1);
    world.add(matt(0.6), cuboid(DVec3::new(-20.0, -3.0, -20.0), DVec3::new(20.0, -1.0, 20.0)));
    let opal = body(flat(1.49), flat(1e-3), Some((flat(1.0), 0.6)));
    world.add(opal, cuboid(DVec3::new(-20.0, 6.0, -20.0), DVec3::new(20.0, 9.0, 20.0)));
    let scene = world.along(DVec3::new(3.0, 60.0, 2.0), -DVec3::Y);
    let path = Take::of(1 << 11, USUAL).luminance(&scene);
    let lit = Take::lit(1 << 6, USUAL).by_seeds(16, &scene, None);
    lit.is_as(path, 0.08);
}

#[test]
fn what_was_learned_of_another_scene_changes_no_expectation() {
    // The right answer by a guide that knows a lamp elsewhere: under the floor's other end.
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), disc(DVec3::new(-200.0, 60.0, 80.0), -DVec3::Y, 4.0));
    world.shine(lamp, Strength::Flux(flat(3.0)), 1);
    world.add(matt(0.5), plate(-51.0, -50.0));
    let elsewhere = world.along(DVec3::Y, -DVec3::Y);
    let guide = Arc::new(learn(&elsewhere, USUAL, 3, 2).unwrap());

    let mut world = World::dark();
    let lamp = world.add(matt(0.3), ball(DVec3::new(0.0, -20.0, 0.0), 8.0));
    world.shine(lamp, Strength::Flux(flat(2.0)), 1);
    world.add(
        body(by_lane(|lane| 1.4 + 0.01 * lane as f64), flat(0.01), None),
        ball(DVec3::new(0.0, -18.0, 0.0), 20.0),
    );
    world.add_rough(aluminium(), 0.3, plate(-51.0, -50.0));
    let at = DVec3::new(30.0, -50.0, 0.0);
    let eye = DVec3::new(50.0, 60.0, 10.0);
    let scene = world.along(at + eye, -eye);
    let expected = Take::of(1 << 13, USUAL).luminance(&scene);
    let got = Take::lit(1 << 9, USUAL).by_seeds(16, &scene, Some(&guide));
    let sigma = got.sigma.hypot(expected.sigma);
    assert!((got.mean - expected.mean).abs() < 3.0 * sigma, "{got:?} {expected:?}");
    assert!(sigma < 0.03 * expected.mean, "{sigma} {expected:?}");
}

#[test]
fn what_is_learned_does_not_depend_on_threads() {
    let scene = bulb(1.0, 1.5, 0.5);
    let pictures = [1, 2, 5].map(|threads| {
        let settings = RenderSettings { threads, ..Take::lit(40, USUAL).settings() };
        render(&scene, &settings, &Progress::default()).unwrap().film.pixels
    });
    assert!(pictures[0].iter().any(|pixel| pixel.xyz[1] > 0.0));
    assert_eq!(pictures[0], pictures[1]);
    assert_eq!(pictures[0], pictures[2]);
}

/// Two lamps behind frosted, dyed panes and before a matt wall, over a picture of 3 : 2.
fn frosted(projection: Projection, panes: &[(f64, [f64; 2])]) -> Scene {
    let mut world = World::dark();
    for (x, group) in [(-5.0, 1), (6.0, 2)] {
        // So large that walks from the eye meet them often enough to be held against.
        let lamp = world.add(matt(0.2), disc(DVec3::new(x, 0.0, 0.0), DVec3::Y, 1.6));
        world.shine(lamp, Strength::Flux(by_lane(|lane| 0.2 + 0.15 * lane as f64)), group);
    }
    world.add(matt(0.6), cuboid(DVec3::new(-16.0, -3.0, -12.0), DVec3::new(16.0, -1.0, 12.0)));
    let dye = by_lane(|lane| 0.1 - 0.005 * lane as f64);
    for (alpha, [left, right]) in panes {
        let pane = cuboid(DVec3::new(*left, 6.0, -8.0), DVec3::new(*right, 8.0, 8.0));
        let plastic = body(by_lane(|lane| 1.5 - 0.004 * lane as f64), dye.clone(), None);
        world.add_rough(plastic, *alpha, pane);
    }
    let eye = DVec3::new(20.0, 70.0, 15.0);
    world.seen_by(Camera::new(eye, DVec3::new(0.0, 4.0, 0.0), DVec3::Z, projection).unwrap())
}

/// The luminance of the blocks of 8 × 8 pixels of a frosted picture, by light group, and of all of it.
fn blocks(film: &Film) -> Vec<f64> {
    let layer = |pixel: usize, group: usize| film.layer_sums[pixel * film.layers + group].mean()[1];
    let block = |at: usize, group: usize| {
        let (column, row) = (at % 6 * 8, at / 6 * 8);
        let pixels = (0..64).map(|i| (row + i / 8) * 48 + column + i % 8);
        pixels.map(|pixel| layer(pixel, group)).sum::<f64>()
    };
    let mut all: Vec<f64> = (0..48).map(|i| block(i % 24, 1 + i / 24)).collect();
    all.push(film.pixels.iter().map(|pixel| pixel.mean()[1]).sum());
    all
}

#[test]
fn light_from_the_lamps_and_light_found_from_the_eye_make_the_picture_that_the_eye_finds() {
    // On a pane what has landed is met, in discs of some pixels, which are small beside the blocks.
    let whole = |alpha: f64| vec![(alpha, [-12.0, 12.0])];
    for (projection, panes) in [
        (Projection::Pinhole { field_of_view_deg: 24.0 }, whole(0.3)),
        (Projection::ThinLens { field_of_view_deg: 24.0, aperture: 9.0, focus: 68.0 }, whole(0.2)),
        (Projection::Orthographic { height: 30.0 }, whole(0.3)),
        (Projection::Orthographic { height: 30.0 }, vec![(0.3, [-12.0, -0.5]), (0.2, [0.5, 12.0])]),
    ] {
        let scene = frosted(projection, &panes);
        // Neighbouring pixels share what lands and is shown: σ comes from pictures of their own.
        let pictures = |method: Method, samples: u32| -> Vec<Estimate> {
            let picture = |seed: u64| {
                let settings = RenderSettings {
                    width: 48,
                    height: 32,
                    samples: 0..samples,
                    method,
                    seed,
                    adaptive: true,
                    filter: PixelFilter::Gaussian,
                    bands_per_lane: 0,
                    ..Take::of(1, USUAL).settings()
                };
                blocks(&render(&scene, &settings, &Progress::default()).unwrap().film)
            };
            let all: Vec<Vec<f64>> = (0..8).map(picture).collect();
            (0..49).map(|at| Estimate::of(all.iter().map(|blocks| &blocks[at]))).collect()
        };
        let lit = pictures(Method::Lit(USUAL), 48);
        let path = pictures(Method::Path(USUAL), 48);
        // Dark blocks live of light so rare that their σ is not known.
        let most = path[..24].iter().map(|block| block.mean).fold(0.0, f64::max);
        let (mut squares, mut number) = (0.0, 0.0);
        for (at, (a, b)) in lit[..48].iter().zip(&path).enumerate() {
            if b.mean >= 0.03 * most {
                let z = (a.mean - b.mean) / a.sigma.hypot(b.sigma);
                assert!(z.abs() < 5.0, "{projection:?} {panes:?} {at}: {a:?} {b:?} {z}");
                squares += z * z;
                number += 1.0;
            }
        }
        assert!(squares / number < 2.5, "{projection:?} {panes:?}: {}", squares / number);
        let (a, b) = (lit[48], path[48]);
        let sigma = a.sigma.hypot(b.sigma);
        let z = (a.mean - b.mean) / sigma;
        assert!(
            z.abs() < 4.0 && sigma < 0.05 * b.mean,
            "{projection:?} {panes:?}: {a:?} {b:?} {z}"
        );
    }
}

#[test]
fn a_surround_is_seen_once_by_both_parts_of_a_picture_together() {
    // All matter is lossless, so that whatever is seen is as bright as the surround.
    let mut world = World::under(Base::Constant(flat(3.0)));
    let lamp = world.add(matt(1.0), ball(DVec3::new(9.0, 4.0, 0.0), 1.0));
    world.shine(lamp, Strength::Flux(flat(0.1)), 1);
    world.add(glass(1.5), ball(DVec3::ZERO, 5.0));
    world.add(matt(1.0), ball(DVec3::new(0.0, -14.0, 0.0), 6.0));
    let scene = world.along(DVec3::new(2.0, 40.0, 1.0), -DVec3::Y);
    let film = Take::lit(1 << 10, USUAL).picture(&scene).film;
    let surround = film.layer_sums.iter().step_by(film.layers);
    let values: Vec<f64> = surround.map(|sums| sums.mean()[1]).collect();
    Estimate::of(values.iter()).is(3.0, 0.01);
}

#[test]
fn walks_that_bring_no_light_end_early_and_a_few_stand_for_all_in_the_ledger() {
    let scene = frosted(Projection::Pinhole { field_of_view_deg: 20.0 }, &[(0.2, [-12.0, 12.0])]);
    let settings = RenderSettings {
        width: 24,
        height: 16,
        samples: 0..64,
        adaptive: true,
        bands_per_lane: 0,
        ..Take::lit(1, USUAL).settings()
    };
    let rendered = render(&scene, &settings, &Progress::default()).unwrap();
    let balance = rendered.tally.ledger.balance().unwrap();
    assert!(balance.gap().abs() < 1e-9 && balance.chance.abs() < 0.1, "{balance:?}");
}

#[test]
fn the_fewest_samples_show_the_light_behind_a_rough_cover_too() {
    // So few that nothing is allotted: all of the light is the eye's then.
    let scene = frosted(Projection::Pinhole { field_of_view_deg: 24.0 }, &[(0.2, [-12.0, 12.0])]);
    let mean = |samples: u32, adaptive: bool, seed: u64| {
        let usual = Take::lit(samples, USUAL).settings();
        mean_luminance(&scene, RenderSettings { width: 24, height: 16, adaptive, seed, ..usual })
    };
    let wanted = mean(256, false, 1);
    let few: Vec<f64> = (0..16).map(|seed| mean(4, true, seed) / wanted).collect();
    Estimate::of(few.iter()).is(1.0, 0.1);
}

#[test]
fn a_lamp_that_is_walled_in_ends_its_walks() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), disc(DVec3::ZERO, DVec3::Y, 1.0));
    world.shine(lamp, Strength::Flux(flat(1.0)), 1);
    world.add(matt(0.5), cuboid(DVec3::splat(-3.0), DVec3::splat(3.0)));
    world.add_rough(
        glass(1.5),
        0.3,
        cuboid(DVec3::new(4.0, -3.0, -3.0), DVec3::new(6.0, 3.0, 3.0)),
    );
    let scene = world.along(DVec3::Y * 1e2, -DVec3::Y);
    let settings =
        RenderSettings { adaptive: true, bands_per_lane: 0, ..Take::lit(16, USUAL).settings() };
    let film = render(&scene, &settings, &Progress::default()).unwrap().film;
    assert!(film.pixels.iter().all(|pixel| pixel.mean() == [0.0; 3]));
}

#[test]
fn a_light_smaller_than_a_pixel_is_as_bright_as_it_is_however_its_samples_are_allotted() {
    // 5 % of a pixel: three of four first rounds miss it, and the pixel gets the more samples the brighter
    // it seemed.
    let mut world = World::dark();
    let lamp = world.add(matt(0.0), disc(DVec3::new(0.3, 0.0, 0.6), DVec3::Y, 0.13));
    world.shine(lamp, Strength::Flux(flat(1.0)), 1);
    let projection = Projection::Orthographic { height: 8.0 };
    let eye = DVec3::new(0.0, 50.0, 0.0);
    let scene = world.seen_by(Camera::new(eye, DVec3::ZERO, DVec3::Z, projection).unwrap());
    let guide = learn(&scene, USUAL, 1, 0).ok().map(Arc::new);
    let usual = Take::lit(24, USUAL).settings();
    let usual = RenderSettings { width: 8, height: 8, adaptive: true, guide, ..usual };
    // L = Φ/πA, on A of the 64 mm² that are seen.
    let expected = 1.0 / (PI * 64e-6);
    let few: Vec<f64> = (0..192)
        .map(|seed| mean_luminance(&scene, RenderSettings { seed, ..usual.clone() }) / expected)
        .collect();
    Estimate::of(few.iter()).is(1.0, 0.15);
}

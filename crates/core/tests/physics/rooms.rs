// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Closed rooms with matt walls: all inter-reflections in closed form.

use std::f64::consts::PI;

use lamplit_core::math::DVec3;
use lamplit_core::matter::Optics;
use lamplit_core::scene::{BodyId, Camera, Projection, Strength};
use lamplit_core::spectrum::{SpectralTable, LANES};

use crate::common::*;

/// The six faces of a cube of half the side `half`, whose fronts look inside.
fn room(world: &mut World, half: f64, walls: SpectralTable) -> BodyId {
    let corner =
        |at: u32| [at & 1, at >> 1 & 1, at >> 2].map(|bit| half * (2.0 * f64::from(bit) - 1.0));
    let vertices: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let quads =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let mut triangles = Vec::new();
    for quad in quads {
        for mut triangle in [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]] {
            let [a, b, c] = triangle.map(|at: u32| DVec3::from_array(vertices[at as usize]));
            if (b - a).cross(c - a).dot(a) > 0.0 {
                triangle.swap(1, 2);
            }
            triangles.push(triangle);
        }
    }
    world.add_mesh(Optics::Diffuse(walls), &vertices, &triangles, None)
}

#[test]
fn the_walls_of_a_cube_of_4_m_with_10_000_lm_get_104_17_rho_over_1_minus_rho_lx_indirectly() {
    // As the mean over the walls E = Φ/A directly and Φρ/((1 − ρ)A) indirectly.
    let reflectance = |lane: usize| 0.1 + 0.05 * lane as f64;
    let mut world = World::dark();
    room(&mut world, 2000.0, by_lane(reflectance));
    // What comes back to the lamp it reflects, so that it is not there.
    let lamp = world.add(matt(1.0), ball(DVec3::ZERO, 20.0));
    world.shine(lamp, Strength::Flux(flat(10_000.0)), 0);
    // Parallel rays from beside the lamp to the whole of one wall; all walls are alike.
    let projection = Projection::Orthographic { height: 4000.0 };
    let eye = DVec3::Z * 100.0;
    let camera = Camera::new(eye, eye + DVec3::Z, DVec3::Y, projection).unwrap();
    let scene = world.seen_by(camera);
    let repetitions: Vec<Vec<f64>> = (0..16)
        .map(|seed| Take { seed, ..Take::of(64, USUAL) }.picture(&scene).film.band_means())
        .collect();
    let of_lane = |lane: usize| {
        let values: Vec<f64> = repetitions
            .iter()
            .map(|means| means.iter().skip(lane).step_by(LANES).sum::<f64>() / 64.0)
            .collect();
        let total = Estimate::of(values.iter()).times(PI / reflectance(lane));
        Estimate { mean: total.mean - 10_000.0 / 96.0, ..total }
    };
    let lanes: Vec<Estimate> = (0..LANES).map(of_lane).collect();
    let expected = |lane: usize| 104.166_667 * reflectance(lane) / (1.0 - reflectance(lane));
    for (lane, got) in lanes.iter().enumerate() {
        let allowed = 4.0 * got.sigma + 1e-4 * expected(lane);
        assert!((got.mean - expected(lane)).abs() < allowed, "{lane}: {got:?} {}", expected(lane));
        assert!(got.sigma < 0.005 * expected(lane).max(100.0), "{lane}: {got:?}");
    }
}

#[test]
fn a_room_whose_walls_shine_has_l_over_1_minus_rho_everywhere() {
    // Light met by chance and light looked for, shared by their weights.
    let reflectance = |lane: usize| 0.9 - 0.05 * lane as f64;
    let mut world = World::dark();
    let walls = room(&mut world, 10.0, by_lane(reflectance));
    world.shine(walls, Strength::Radiance(flat(1.0)), 0);
    let from = DVec3::new(3.0, -2.0, 1.0);
    let scene = world.along(from, DVec3::new(1.0, 0.3, -0.4));
    let lanes = Take::of(2048, USUAL).lanes(&scene);
    all_are(&lanes, |lane| 1.0 / (1.0 - reflectance(lane)), 1e-2);
}

#[test]
fn a_rough_metal_and_a_lens_in_a_shining_room_are_in_a_furnace_too() {
    // Next-event estimation with all kinds of surfaces: radiance 1 and walls that reflect nothing.
    let metal = Optics::Conductor { n: flat(0.0), k: flat(4.0), factor: 1.0, lacquer: None };
    let sheet = Optics::Transmitter { reflectance: flat(0.6), transmittance: flat(0.4) };
    let glossy = Optics::Glossy { index: flat(1.5), base: flat(1.0) };
    let opal = body(flat(1.0), flat(0.0), Some((flat(0.2), 0.5)));
    for (optics, alpha) in [
        (metal.clone(), 0.1),
        (metal, 0.6),
        (glass(1.5), 0.2),
        (glass(1.5), 0.0),
        (sheet, 0.0),
        (glossy, 0.2),
        (opal, 0.0),
    ] {
        let mut world = World::dark();
        let walls = room(&mut world, 10.0, flat(0.0));
        world.shine(walls, Strength::Radiance(flat(1.0)), 0);
        world.add_rough(optics, alpha, ball(DVec3::ZERO, 4.0));
        let scene = world.along(DVec3::new(2.5, 1.0, 9.0), -DVec3::Z);
        let got = Take::of(2048, USUAL).luminance(&scene);
        assert!((got.mean - 1.0).abs() < 1e-3 + 3.0 * got.sigma, "{alpha}: {got:?}");
        assert!(got.sigma < 3e-3, "{alpha}: {got:?}");
    }
}

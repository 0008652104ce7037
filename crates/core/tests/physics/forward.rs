// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Flux walked from lights: closed forms of intensity and illuminance, and what must not change.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lamplit_core::film::{DirectionCells, PlaneMap, Receivers, Spots};
use lamplit_core::light::DirectionGrid;
use lamplit_core::math::{DMat3, DVec3};
use lamplit_core::matter::Optics;
use lamplit_core::render::{MeasureError, Photometer, Progress};
use lamplit_core::scene::{Distribution, Scene, Strength};
use lamplit_core::spectrum::SpectralTable;
use lamplit_core::transport::{Beam, FluxError, LightSource, RaySet, Shining};

use crate::common::*;
use crate::goniometer::*;

const PATHS: u32 = 1 << 18;

/// A small lamp by itself.
fn lamp(shape: lamplit_core::geometry::Shape, law: Distribution, flux: f64) -> Scene {
    let mut world = World::dark();
    let body = world.add(matt(0.0), shape);
    world.shine_as(body, Strength::Flux(flat(flux)), law, 1);
    world.along(DVec3::Y * 1e3, -DVec3::Y)
}

#[test]
fn a_ball_has_the_intensity_of_its_flux_over_four_pi_to_all_sides() {
    let scene = lamp(ball(DVec3::new(1.0, 2.0, -3.0), 3.0), Distribution::Lambert, 5.0);
    let spots = [spot(0.0, 0.0, 20.0), spot(90.0, 0.0, 20.0), spot(-140.0, 30.0, 20.0)];
    let got = measure(&scene, &spots, PATHS);
    for at in 0..spots.len() {
        got.intensity(at).is(5.0 / (4.0 * PI), 0.025);
    }
    got.out().is(5.0, 1e-3);
}

#[test]
fn a_matt_disc_has_its_flux_over_pi_along_its_axis_and_falls_by_the_cosine() {
    let scene = lamp(disc(DVec3::ZERO, DVec3::Y, 2.0), Distribution::Lambert, 5.0);
    let spots = [0.0, 20.0, 45.0, 70.0, 101.0].map(|degrees| spot(degrees, 0.0, 20.0));
    let got = measure(&scene, &spots, PATHS);
    for (at, spot) in spots.iter().enumerate().take(4) {
        // The mean of the cosine over a cone is its own at the axis times (1 + cos r)/2.
        let mean = spot.h.cos() * 0.5 * (1.0 + spot.half_angle.cos());
        got.intensity(at).is(5.0 / PI * mean, 0.02);
    }
    assert_eq!(got.intensity(4).mean, 0.0);
}

#[test]
fn a_cosine_law_has_its_intensity_in_the_cells_of_a_grid() {
    for exponent in [0.0, 0.5, 8.0] {
        let law = Distribution::Cosine { exponent };
        let scene = lamp(disc(DVec3::ZERO, DVec3::Y, 0.3), law, 2.0);
        let edges: Vec<f64> = (-15..=15).map(|i| f64::from(i) * 6.0_f64.to_radians()).collect();
        let mut receivers = round(&[]);
        receivers.cells = DirectionCells::new(edges.clone(), edges.clone());
        let source = Shining::of(&scene);
        let got = measure_by(&scene, source, &[], receivers, (8 * PATHS, FORWARD));
        let cell = |h: usize, v: usize| v * 30 + h;
        for (h, v) in [(15, 15), (20, 12), (3, 18), (24, 7)] {
            let (dh, dv) = (edges[h + 1] - edges[h], edges[v + 1].sin() - edges[v].sin());
            let sum = |batch: &lamplit_core::render::Batch| batch.groups[1].cells[cell(h, v)].0[1];
            // The mean over the cell by the midpoint rule, cos θ = cos H cos V.
            let n = 40;
            let at =
                |k: usize, low: f64, high: f64| low + (high - low) * (k as f64 + 0.5) / n as f64;
            let mut mean = 0.0;
            for i in 0..n * n {
                let height = at(i / n, edges[v].sin(), edges[v + 1].sin());
                let cos = at(i % n, edges[h], edges[h + 1]).cos() * (1.0 - height * height).sqrt();
                mean += cos.powf(exponent) / (n * n) as f64;
            }
            let expected = 2.0 * (exponent + 1.0) / TAU * mean;
            if expected > 0.02 {
                got.each(sum).times(1.0 / (dh * dv)).is(expected, 0.05);
            }
        }
    }
}

#[test]
fn a_measured_intensity_comes_back_from_whatever_shape_carries_it() {
    // I(θ) = I₀·(1 − 2θ/π)·(1 + ½ cos φ) from the axis z to 90°, Φ = 2πI₀·(1 − 2/π).
    let azimuths: Vec<f64> = (0..72).map(|k| f64::from(k) * TAU / 72.0).collect();
    let values = azimuths.iter().flat_map(|phi| [1.0 + 0.5 * phi.cos(), 0.0]).collect();
    let grid = DirectionGrid::new(vec![0.0, FRAC_PI_2], azimuths, values).unwrap();
    let intensity = |theta: f64, phi: f64| {
        (1.0 - theta / FRAC_PI_2) * (1.0 + 0.5 * phi.cos()) * 3.0 / (TAU * (1.0 - 2.0 / PI))
    };
    // The table's axis is +y, and φ = 0 is towards +x.
    let frame = DMat3::from_cols(DVec3::X, -DVec3::Z, DVec3::Y);
    for shape in [ball(DVec3::ZERO, 0.2), cuboid(DVec3::splat(-0.1), DVec3::splat(0.2))] {
        let law = Distribution::Intensity { grid: grid.clone(), frame };
        let scene = lamp(shape, law, 3.0);
        let spots = [spot(35.0, 0.0, 16.0), spot(-35.0, 0.0, 16.0), spot(0.0, 60.0, 16.0)];
        let got = measure(&scene, &spots, PATHS);
        for (at, spot) in spots.into_iter().enumerate() {
            let expected = mean_over(spot, |way| intensity(way.y.acos(), way.z.atan2(-way.x) + PI));
            got.intensity(at).is(expected, 0.04);
        }
        got.out().is(3.0, 5e-3);
    }
}

#[test]
fn a_wall_gets_light_by_the_inverse_square_and_the_cosine() {
    let scene = lamp(ball(DVec3::ZERO, 0.5), Distribution::Lambert, 5.0);
    for distance in [100.0, 400.0] {
        let map = PlaneMap {
            centre: DVec3::Y * distance,
            half_width: DVec3::X * distance * 1.5,
            half_height: DVec3::Z * distance * 0.5,
            size: [15, 5],
        };
        let receivers = Receivers { map: Some(map.clone()), ..round(&[]) };
        let got = measure_by(&scene, Shining::of(&scene), &[], receivers, (8 * PATHS, FORWARD));
        for column in [7, 10, 13] {
            let pixel = 2 * 15 + column;
            // cos³ over the pixel, by the midpoint rule.
            let n = 20;
            let mut mean = 0.0;
            for i in 0..n * n {
                let x = (f64::from(i / n) + 0.5) / f64::from(n) - 0.5 + column as f64 - 7.0;
                let z = (f64::from(i % n) + 0.5) / f64::from(n) - 0.5;
                let (x, z) = (0.2 * x, 0.2 * z);
                mean += (1.0 + x * x + z * z).powf(-1.5) / f64::from(n * n);
            }
            let square = (distance * 1e-3).powi(2);
            got.illuminance(pixel, &map).is(5.0 / (4.0 * PI) / square * mean, 0.04);
        }
    }
}

#[test]
fn a_receiver_at_a_finite_distance_reads_what_reaches_its_place() {
    // A disc of radius R seen from d on its axis: E = πL R²/(R² + d²), so I_d = E d².
    let (radius, distance) = (40.0, 100.0);
    let scene = lamp(disc(DVec3::ZERO, DVec3::Y, radius), Distribution::Lambert, 5.0);
    let spots = [spot(0.0, 0.0, 4.0)];
    let receivers = Receivers { distance: Some(distance), ..round(&spots) };
    let got = measure_by(&scene, Shining::of(&scene), &spots, receivers, (16 * PATHS, FORWARD));
    let share = distance * distance / (radius * radius + distance * distance);
    got.intensity(0).is(5.0 / PI * share, 0.02);
}

#[test]
fn a_flat_mirror_sends_a_beam_back_with_the_radiance_of_its_source() {
    // L = E/(π sin² a), and I = ρ L A cos θ within the mirrored disc.
    let mut world = World::dark();
    world.add(Optics::Mirror(flat(0.9)), disc(DVec3::ZERO, DVec3::Y, 20.0));
    let scene = world.along(DVec3::Y * 1e3, -DVec3::Y);
    let angle = 2.0_f64.to_radians();
    let spots = [spot(-30.0, 0.0, 3.6), spot(-30.0, 0.0, 8.0), spot(30.0, 0.0, 20.0)];
    let beam = Beam::new(&scene, -tilted(30.0), angle, flat(7.0)).unwrap();
    let source = LightSource::Beam(beam);
    let got = measure_by(&scene, source, &spots, round(&spots), (PATHS, FORWARD));
    let area = PI * 400.0 * 1e-6;
    let luminance = 7.0 / (PI * angle.sin().powi(2));
    got.intensity(0).is(0.9 * luminance * area * f64::to_radians(30.0).cos(), 0.02);
    // All of it is within 8°: the flux is ρ E A cos θ.
    let solid_angle = TAU * (1.0 - 4.0_f64.to_radians().cos());
    let flux = 0.9 * 7.0 * area * f64::to_radians(30.0).cos();
    got.intensity(1).times(solid_angle).is(flux, 0.01);
    assert_eq!(got.intensity(2).mean, 0.0);
}

#[test]
fn rays_go_where_they_point_with_their_flux_and_their_wavelength() {
    let scene = lamp(ball(DVec3::ZERO, 1.0), Distribution::Lambert, 1.0);
    let positions = [[5.0, 0.0, 0.0]; 3];
    let ways = [0.0, 20.0, 50.0].map(|degrees| (tilted(degrees) * 3.0).to_array());
    let luminosity = &scene.colour_matching[1];
    let spots = [0.0, 20.0, 50.0].map(|degrees| spot(degrees, 0.0, 1.0));
    let fluxes = vec![1.0, 3.0, 0.0];
    let set = RaySet::of_one_spectrum(&positions, &ways, fluxes, &flat(0.3), luminosity).unwrap();
    let source = LightSource::Rays(set.into());
    let got = measure_by(&scene, source, &spots, round(&spots), (1 << 14, FORWARD));
    let solid_angle = TAU * (1.0 - 0.5_f64.to_radians().cos());
    for (at, flux) in [1.0, 3.0, 0.0].into_iter().enumerate() {
        got.intensity(at).times(solid_angle).is(flux, 5e-3);
    }
    // 2 W on lane 11 of a picture whose 16 wavelengths are 25 nm apart.
    let numbers = (vec![11, 4, 4], 25.0);
    let fluxes = vec![2.0, 0.0, 1.0];
    let set = RaySet::of_wavelengths(&positions, &ways, fluxes, numbers, luminosity).unwrap();
    let source = LightSource::Rays(set.into());
    let got = measure_by(&scene, source, &spots, round(&spots), (1 << 14, FORWARD));
    for component in 0..3 {
        let per_watt = |lane: usize| {
            let table: &SpectralTable = &scene.colour_matching[component];
            table.at(lamplit_core::spectrum::SampledWavelengths { phase: 0 }).0[lane] / 25.0
        };
        let first = got.intensity_of(0, component).times(solid_angle);
        first.is(2.0 * per_watt(11), 5e-3);
        got.intensity_of(2, component).times(solid_angle).is(per_watt(4), 5e-3);
    }
    let fault =
        RaySet::of_one_spectrum(&positions, &[[0.0; 3]; 3], vec![1.0; 3], &flat(1.0), luminosity);
    let direction = FluxError::Ray { ray: 0, fault: "its direction has no length" };
    assert_eq!(fault.err(), Some(direction));
}

#[test]
fn what_is_caught_depends_on_neither_threads_nor_calls() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.5), ball(DVec3::ZERO, 1.0));
    world.shine(lamp, Strength::Flux(flat(2.0)), 1);
    let dye = by_lane(|lane| 0.01 * lane as f64);
    let shell = world.add_rough(body(flat(1.5), dye, None), 0.2, ball(DVec3::X * 10.0, 5.0));
    assert_eq!(shell, 1);
    let scene = world.along(DVec3::Y * 1e3, -DVec3::Y);
    let caught = |threads: usize, calls: &[u32]| {
        let spots = [spot(0.0, 0.0, 20.0), spot(80.0, 10.0, 20.0)];
        let receivers = Receivers { spot_bands: 1, ..round(&spots) };
        let source = LightSource::Shining(Shining::of(&scene));
        let mut meter = Photometer::new(&scene, source, receivers, FORWARD, 3).unwrap();
        for paths in calls {
            meter.walk(&scene, *paths, None, threads, &Progress::default()).unwrap();
        }
        meter
            .batches()
            .iter()
            .map(|batch| (batch.groups.clone(), batch.ledgers.clone()))
            .collect::<Vec<_>>()
    };
    let one = caught(1, &[300]);
    assert_eq!(one, caught(2, &[300]));
    assert_eq!(one, caught(5, &[1, 199, 100]));
    assert_ne!(one, caught(1, &[299]));
    assert!(one[0].0[1].spot_bands.iter().sum::<f64>() > 0.0);
}

#[test]
fn all_flux_is_found_again_in_the_ledger() {
    let mut world = World::dark();
    let lamp = world.add(matt(0.3), disc(DVec3::ZERO, DVec3::Y, 1.0));
    world.shine(lamp, Strength::Flux(flat(2.0)), 1);
    let index = by_lane(|lane| 1.48 + 0.004 * lane as f64);
    let turbid = Some((flat(0.05), 0.5));
    world.add(body(index, flat(0.02), turbid), plate(3.0, 12.0));
    let scene = world.along(DVec3::Y * 1e3, -DVec3::Y);
    for max_depth in [2000, 6] {
        let settings = lamplit_core::transport::PathSettings { max_depth, ..FORWARD };
        let got = measure_by(&scene, Shining::of(&scene), &[], round(&[]), (1 << 16, settings));
        let ([escaped, absorbed, cut, lost, chance], gap) = got.shares();
        assert!(gap.abs() < 1e-9, "{gap}");
        assert!(absorbed > 0.1 && escaped > 0.1 && lost == 0.0, "{escaped} {absorbed} {lost}");
        assert!((cut > 0.01) == (max_depth == 6), "{cut}");
        assert!(chance.abs() < 0.02, "{chance}");
        // What escaped is what was received.
        assert!((escaped * 2.0 / got.out().mean - 1.0).abs() < 1e-9);
    }
}

#[test]
fn what_cannot_be_measured_is_refused() {
    let refusal = |scene: &Scene, distance: Option<f64>| {
        let receivers = Receivers { distance, spots: Spots::default(), ..round(&[]) };
        let source = LightSource::Shining(Shining::of(scene));
        Photometer::new(scene, source, receivers, FORWARD, 1).err()
    };
    let dark = lamp(ball(DVec3::ZERO, 1.0), Distribution::Lambert, 0.0);
    assert!(matches!(refusal(&dark, None), Some(MeasureError::Flux(FluxError::NoFlux))));
    let lit = lamp(ball(DVec3::ZERO, 1.0), Distribution::Lambert, 1.0);
    assert!(matches!(refusal(&lit, Some(0.9)), Some(MeasureError::ReceiverInside { .. })));
    assert!(refusal(&lit, Some(5.0)).is_none());
}

// SPDX-License-Identifier: Apache-2.0 OR MIT

use std::f64::consts::FRAC_PI_2;

use super::*;
use crate::sampling::chi_square::Uniform;

fn along(theta_deg: f64, phi_deg: f64) -> DVec3 {
    let (sin, cos) = theta_deg.to_radians().sin_cos();
    let (y, x) = phi_deg.to_radians().sin_cos();
    DVec3::new(sin * x, sin * y, cos)
}

fn radians(degrees: &[f64]) -> Vec<f64> {
    degrees.iter().map(|angle| angle.to_radians()).collect()
}

#[test]
fn a_grid_is_linear_between_its_angles_and_goes_round() {
    let values = vec![10.0, 20.0, 0.0, 10.0, 40.0, 0.0, 10.0, 60.0, 0.0, 10.0, 80.0, 0.0];
    let azimuths = radians(&[0.0, 90.0, 180.0, 270.0]);
    let grid = DirectionGrid::new(radians(&[0.0, 60.0, 90.0]), azimuths, values).unwrap();
    let near = |theta, phi, expected: f64| {
        let value = grid.at(along(theta, phi));
        assert!((value - expected).abs() < 1e-12, "({theta}, {phi}): {value}, not {expected}");
    };
    near(0.0, 123.0, 10.0);
    near(60.0, 90.0, 40.0);
    near(30.0, 90.0, 25.0);
    near(60.0, 45.0, 30.0);
    near(75.0, 45.0, 15.0);
    near(60.0, 315.0, 50.0);
    near(60.0, 360.0 - 1e-12, 20.0);
    near(60.0, -1e-15, 20.0);
    near(91.0, 0.0, 0.0);
    near(180.0, 0.0, 0.0);
}

#[test]
fn both_poles_of_a_full_grid_have_their_values() {
    let grid = DirectionGrid::new(vec![0.0, PI], vec![0.0], vec![1.0, 3.0]).unwrap();
    assert_eq!(grid.at(DVec3::Z), 1.0);
    assert_eq!(grid.at(-DVec3::Z), 3.0);
    assert!((grid.at(DVec3::X) - 2.0).abs() < 1e-15);
}

#[test]
fn grids_that_make_no_sense_are_refused() {
    let make = |polar: &[f64], azimuths: &[f64], values: &[f64]| {
        DirectionGrid::new(polar.to_vec(), azimuths.to_vec(), values.to_vec()).unwrap_err()
    };
    let angles = |error| matches!(error, IntensityError::Angles(..));
    assert!(angles(make(&[0.0, 0.0], &[0.0], &[1.0; 2])));
    assert!(angles(make(&[0.0], &[0.0], &[1.0])));
    assert!(angles(make(&[0.0, 4.0], &[0.0], &[1.0; 2])));
    assert!(angles(make(&[0.0, f64::NAN], &[0.0], &[1.0; 2])));
    assert!(angles(make(&[0.0, 1.0], &[0.0, TAU], &[1.0; 4])));
    let size = IntensityError::Size { polar: 2, azimuths: 1, values: 3 };
    assert_eq!(make(&[0.0, 1.0], &[0.0], &[1.0; 3]), size);
    assert_eq!(make(&[0.0, 1.0], &[0.0], &[1.0, -1.0]), IntensityError::Value(-1.0));
    assert!(matches!(make(&[0.0, 1.0], &[0.0], &[1.0, f64::NAN]), IntensityError::Value(_)));
}

/// A lopsided intensity, and its flux by an independent quadrature.
fn lopsided() -> (DirectionGrid, f64) {
    let polar = radians(&[0.0, 20.0, 45.0, 90.0, 130.0, 180.0]);
    let azimuths = radians(&[0.0, 50.0, 180.0, 300.0]);
    let mut random = Uniform(5);
    let values = (0..24).map(|_| 0.5 + random.next()).collect();
    let grid = DirectionGrid::new(polar, azimuths, values).unwrap();
    let n = 1000;
    let step = |i: usize| (i as f64 + 0.5) / n as f64;
    let flux: f64 = (0..n * n)
        .map(|k| {
            let (z, phi) = (1.0 - 2.0 * step(k / n), TAU * step(k % n));
            let r = (1.0 - z * z).sqrt();
            grid.at(DVec3::new(r * phi.cos(), r * phi.sin(), z))
        })
        .sum();
    (grid, flux * 4.0 * PI / (n * n) as f64)
}

/// The area vectors of a sphere of radius r, one for each of `n` bands and as many steps.
fn sphere(radius: f64, n: usize) -> Vec<DVec3> {
    let step = |i: usize| (i as f64 + 0.5) / n as f64;
    (0..n * n)
        .map(|k| {
            let (z, phi) = (1.0 - 2.0 * step(k / n), TAU * step(k % n));
            let r = (1.0 - z * z).sqrt();
            let area = 4.0 * PI * radius * radius / (n * n) as f64;
            DVec3::new(r * phi.cos(), r * phi.sin(), z) * area
        })
        .collect()
}

#[test]
fn a_body_of_any_shape_gets_the_intensity_of_its_table() {
    let (grid, flux) = lopsided();
    let frame = DMat3::from_rotation_x(0.7) * DMat3::from_rotation_z(1.9);
    let cuboid = [DVec3::X, DVec3::Y * 2.0, DVec3::Z * 3.0].into_iter().flat_map(|a| [a, -a]);
    for (area_vectors, tolerance) in [(cuboid.collect::<Vec<_>>(), 1e-4), (sphere(1.5, 96), 1e-3)] {
        let area: f64 = area_vectors.iter().map(|a| a.length()).sum();
        let table = IntensityTable::new(grid.clone(), frame, area_vectors.clone()).unwrap();
        assert!((table.reached_share() - 1.0).abs() < 1e-12);
        for (theta, phi) in [(0.0, 0.0), (33.0, 120.0), (88.0, 260.0), (170.0, 10.0)] {
            let local = along(theta, phi);
            let direction = frame * local;
            let shadow: f64 = area_vectors.iter().map(|a| a.dot(direction).max(0.0)).sum();
            let intensity = table.factor(direction) * shadow;
            let expected = grid.at(local) / flux * PI * area;
            assert!(
                (intensity / expected - 1.0).abs() < tolerance,
                "({theta}, {phi}): {intensity}, not {expected}"
            );
        }
    }
}

#[test]
fn a_sheet_sends_out_only_what_lies_before_it_and_all_of_the_flux() {
    let polar = vec![0.0, FRAC_PI_2, PI];
    let grid = DirectionGrid::new(polar, vec![0.0], vec![1.0; 3]).unwrap();
    let table = IntensityTable::new(grid, DMat3::IDENTITY, vec![DVec3::Z * 4.0]).unwrap();
    assert!((table.reached_share() - 0.5).abs() < 1e-5);
    // I = 1 over half the sphere makes 2π; the sheet of 4 mm² has π·4 per radiance.
    assert!((table.factor(along(60.0, 5.0)) * 4.0 * 0.5 - 2.0).abs() < 1e-4);
    assert_eq!(table.factor(along(120.0, 5.0)), 0.0);
    let behind = DirectionGrid::new(vec![2.0, PI], vec![0.0], vec![1.0; 2]).unwrap();
    let dark = IntensityTable::new(behind, DMat3::IDENTITY, vec![DVec3::Z]);
    assert_eq!(dark.unwrap_err(), IntensityError::Dark);
}

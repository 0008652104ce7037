// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Skies against what the standard and its forerunners print.

use std::f64::consts::{PI, TAU};

use super::*;

fn at(zenith_deg: f64, azimuth_deg: f64) -> DVec3 {
    let (sin, cos) = zenith_deg.to_radians().sin_cos();
    let (z, x) = azimuth_deg.to_radians().sin_cos();
    DVec3::new(sin * x, cos, sin * z)
}

fn general(kind: usize, sun: DVec3) -> SkyModel {
    SkyModel::General { coefficients: CIE_GENERAL_SKIES[kind - 1], sun }
}

/// ∫ L/Lz·cos Z dω over the upper half.
fn horizontal(model: &SkyModel) -> f64 {
    let (rings, steps) = (200, 400);
    let value = |k: usize| {
        let square = ((k / steps) as f64 + 0.5) / rings as f64;
        let azimuth = TAU * ((k % steps) as f64 + 0.5) / steps as f64;
        let across = (1.0 - square).sqrt();
        model.relative(DVec3::new(across * azimuth.cos(), square.sqrt(), across * azimuth.sin()))
    };
    (0..rings * steps).map(value).sum::<f64>() * PI / (rings * steps) as f64
}

/// Moon and Spencer 1942: three times as bright above as at the horizon, and E = 7π/9·Lz.
#[test]
fn the_overcast_sky_is_that_of_moon_and_spencer() {
    assert_eq!(SkyModel::Overcast.relative(DVec3::Y), 1.0);
    assert!((SkyModel::Overcast.relative(DVec3::X) - 1.0 / 3.0).abs() < 1e-15);
    assert!((SkyModel::Overcast.relative(at(60.0, 20.0)) - 2.0 / 3.0).abs() < 1e-15);
    assert!((horizontal(&SkyModel::Overcast) / (7.0 * PI / 9.0) - 1.0).abs() < 1e-4);
}

/// CIE S 003 (1996), the clear sky: (0.91 + 10·e^−3χ + 0.45·cos²χ)(1 − e^−0.32/cos Z), over 0.27385
/// and the first factor at the sun's zenith angle: printed digits, of which 0.91 is rounded.
#[test]
fn type_12_is_the_clear_sky_of_the_older_standard() {
    let sun_zenith = 50.0_f64;
    let model = general(12, at(sun_zenith, 0.0));
    let indicatrix = |chi: f64| 0.91 + 10.0 * (-3.0 * chi).exp() + 0.45 * chi.cos().powi(2);
    for (zenith, azimuth) in [(10.0, 0.0), (50.0, 0.0), (60.0, 90.0), (85.0, 180.0), (40.0, 300.0)]
    {
        let direction = at(zenith, azimuth);
        let chi = direction.dot(at(sun_zenith, 0.0)).clamp(-1.0, 1.0).acos();
        let gradation = 1.0 - (-0.32 / zenith.to_radians().cos()).exp();
        let expected =
            indicatrix(chi) * gradation / (indicatrix(sun_zenith.to_radians()) * 0.273_85);
        let found = model.relative(direction);
        assert!((found / expected - 1.0).abs() < 2e-3, "({zenith}, {azimuth}): {found}");
    }
}

#[test]
fn every_standard_sky_is_one_at_the_zenith_and_bright_at_the_sun_if_it_has_one() {
    let sun = at(35.0, 70.0);
    for (kind, coefficients) in (1..).zip(CIE_GENERAL_SKIES) {
        let model = general(kind, sun);
        assert!((model.relative(DVec3::Y) - 1.0).abs() < 1e-12, "type {kind}");
        let opposite = model.relative(at(35.0, 250.0));
        let ratio = model.relative(sun) / opposite;
        let [_, _, c, ..] = coefficients;
        assert_eq!(ratio > 1.0 + 1e-9, c > 0.0, "type {kind}: {ratio}");
    }
}

/// By the standard's names: types 1, 3 and 5 do not depend on azimuth, 5 is of uniform luminance, and
/// type 1's horizon is 1/(1 + 4·e^−0.7) = 0.335 of the zenith.
#[test]
fn the_types_that_are_even_around_are_so_and_type_5_is_uniform() {
    for kind in [1, 3, 5] {
        let model = general(kind, at(35.0, 70.0));
        let value = model.relative(at(80.0, 70.0));
        assert!((model.relative(at(80.0, 200.0)) - value).abs() < 1e-12);
        assert!(kind != 5 || (value - 1.0).abs() < 1e-12);
    }
    let horizon = general(1, DVec3::Y).relative(DVec3::X);
    assert!((horizon - 0.335).abs() < 5e-4, "{horizon}");
    assert!((horizontal(&general(5, DVec3::Y)) - PI).abs() < 1e-9);
}

#[test]
fn below_the_horizon_is_the_ground() {
    let sky = Sky { model: SkyModel::Overcast, zenith: table(3.0), ground: table(0.25) };
    let surround = background(Base::Sky(sky), vec![]);
    let towards = |y: f64| {
        let direction = DVec3::new((1.0 - y * y).sqrt(), y, 0.0);
        value(&surround, &Ray::endless(DVec3::ZERO, direction))
    };
    assert_eq!(towards(-1e-9), 0.25);
    assert!((towards(1e-9) - 1.0).abs() < 1e-8);
    assert_eq!(towards(1.0), 3.0);
    assert!(general(12, DVec3::X).relative(at(90.0, 0.0)).is_finite(), "the sun on the horizon");
}

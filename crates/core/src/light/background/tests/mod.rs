// SPDX-License-Identifier: Apache-2.0 OR MIT

mod sampled;
mod sky;

use super::*;
use crate::spectrum::LANES;

fn table(value: f64) -> SpectralTable {
    SpectralTable::from_ascending(&[value; LANES]).unwrap()
}

fn background(base: Base, soft_boxes: Vec<SoftBox>) -> Background {
    Background::new(base, 0, soft_boxes, vec![], &table(1.0))
}

fn value(background: &Background, ray: &Ray) -> f64 {
    background.radiance(ray, SampledWavelengths { phase: 0 }).0[3]
}

fn soft_box(z: f64, radiance: f64, edge_softness: f64) -> SoftBox {
    SoftBox {
        centre: DVec3::new(0.0, 0.0, z),
        half_width: -DVec3::X * 2.0,
        half_height: DVec3::Y,
        radiance: table(radiance),
        edge_softness,
        group: 0,
    }
}

#[test]
fn a_gradient_is_halfway_at_the_horizon() {
    let base = Base::Gradient { zenith: table(3.0), nadir: table(1.0) };
    let background = background(base, vec![]);
    for (direction, expected) in [(DVec3::Y, 3.0), (DVec3::X, 2.0), (-DVec3::Y, 1.0)] {
        assert_eq!(value(&background, &Ray::endless(DVec3::ZERO, direction)), expected);
    }
}

#[test]
fn a_soft_box_covers_what_is_behind_it_from_its_front_only() {
    let soft_boxes = vec![soft_box(20.0, 9.0, 0.0), soft_box(10.0, 5.0, 0.0)];
    let background = background(Base::Constant(table(1.0)), soft_boxes);
    let towards = |x: f64, y: f64| Ray::endless(DVec3::ZERO, DVec3::new(x, y, 10.0).normalize());
    assert_eq!(value(&background, &towards(0.0, 0.0)), 5.0);
    assert_eq!(value(&background, &towards(1.99, 0.99)), 5.0);
    assert_eq!(value(&background, &towards(2.01, 0.0)), 1.0);
    let from_behind = Ray::endless(DVec3::new(0.0, 0.0, 30.0), -DVec3::Z);
    assert_eq!(value(&background, &from_behind), 1.0);
}

#[test]
fn a_soft_edge_fades_without_a_step() {
    let background = background(Base::Constant(table(0.0)), vec![soft_box(10.0, 1.0, 1.0)]);
    let at = |x: f64| value(&background, &Ray::endless(DVec3::new(x, 0.0, 0.0), DVec3::Z));
    assert_eq!(at(0.0), 1.0);
    assert!((at(1.0) - 0.5).abs() < 1e-12);
    assert!(at(1.999) < 1e-5);
}

fn with_sun() -> Background {
    let sun = Sun::new(DVec3::Z, 0.1, table(100.0), 5);
    let boxes = vec![
        SoftBox { group: 2, ..soft_box(10.0, 8.0, 1.0) },
        SoftBox { group: 3, ..soft_box(20.0, 4.0, 0.0) },
    ];
    Background::new(Base::Constant(table(1.0)), 7, boxes, vec![sun], &table(1.0))
}

fn groups(background: &Background, ray: &Ray) -> Vec<(usize, f64)> {
    let mut told = Vec::new();
    background.arriving(ray, SampledWavelengths { phase: 0 }, |group, radiance| {
        told.push((group, radiance.0[0]));
    });
    told
}

#[test]
fn light_is_told_by_its_group_and_adds_up_to_the_radiance() {
    let studio = with_sun();
    // Halfway to the first box's edge half of it is seen, and half of the second, which is hard.
    let half = Ray::endless(DVec3::X, DVec3::Z);
    assert_eq!(groups(&studio, &half), vec![(2, 4.0), (3, 2.0)]);
    assert_eq!(value(&studio, &half), 6.0);
    // Beside both boxes, into the sun and past it.
    assert_eq!(
        groups(&studio, &Ray::endless(DVec3::X * 3.0, DVec3::Z)),
        vec![(5, 100.0), (7, 1.0)]
    );
    assert_eq!(groups(&studio, &Ray::endless(DVec3::X * 3.0, DVec3::Y)), vec![(7, 1.0)]);
}

/// A picture whose pixel (row, column) has the value 10·row + column + 1 in red.
fn numbered(turn: f64) -> Background {
    let pixels = (0..32u8).map(|i| [f32::from(10 * (i / 8) + i % 8 + 1), 0.0, 0.0]).collect();
    let bases = [table(1.0), table(50.0), table(70.0)];
    background(Base::Image(ImageMap::new([8, 4], pixels, bases, turn).unwrap()), vec![])
}

#[test]
fn a_picture_stands_behind_the_lamp_with_its_right_hand_side_at_plus_x() {
    let seen = |background: &Background, x: f64, y: f64, z: f64| {
        value(background, &Ray::endless(DVec3::ZERO, DVec3::new(x, y, z).normalize()))
    };
    let unturned = numbered(0.0);
    assert_eq!(seen(&unturned, 0.01, 0.1, -1.0), 15.0);
    assert_eq!(seen(&unturned, -0.01, 0.1, -1.0), 14.0);
    assert_eq!(seen(&unturned, 1.0, -0.1, 0.01), 27.0);
    assert_eq!(seen(&unturned, -0.01, 0.1, 1.0), 11.0);
    assert_eq!(seen(&unturned, 0.01, 0.1, 1.0), 18.0);
    assert_eq!(seen(&unturned, 0.01, 1.0, -0.02), 5.0);
    assert_eq!(seen(&unturned, 0.01, -1.0, -0.02), 35.0);
    // A quarter of a turn takes what was at +z to +x, and what was at −x to +z.
    let turned = numbered(std::f64::consts::FRAC_PI_2);
    assert_eq!(seen(&turned, 1.0, 0.1, 0.01), 11.0);
    assert_eq!(seen(&turned, 0.01, 0.1, 1.0), seen(&unturned, -1.0, 0.1, 0.01));
    let ray = Ray::endless(DVec3::ZERO, turned.aim(DVec3::ZERO, [0.5, 0.999_999, 0.0]).unwrap());
    assert!(value(&turned, &ray) > 30.0, "aiming turns with the picture");
}

#[test]
fn a_pixel_mixes_the_three_bases() {
    let bases = [table(1.0), table(10.0), table(100.0)];
    let image = ImageMap::new([1, 1], vec![[1.0, 2.0, 3.0]], bases, 0.0).unwrap();
    let surround = background(Base::Image(image), vec![]);
    assert_eq!(value(&surround, &Ray::endless(DVec3::ZERO, DVec3::X)), 321.0);
}

#[test]
fn pictures_with_holes_and_false_sizes_are_refused() {
    let make = |size: [usize; 2], pixels: Vec<[f32; 3]>| {
        ImageMap::new(size, pixels, [table(1.0), table(1.0), table(1.0)], 0.0).map(|_| ())
    };
    let size = ImageError::Size { width: 3, height: 2, pixels: 5 };
    assert_eq!(make([3, 2], vec![[0.0; 3]; 5]), Err(size));
    assert!(make([0, 0], vec![]).is_err());
    let mut pixels = vec![[1.0; 3]; 6];
    pixels[4][1] = -0.5;
    let fault = ImageError::Value { row: 1, column: 1, value: -0.5 };
    assert_eq!(make([3, 2], pixels.clone()), Err(fault.clone()));
    let line = "pixel (row 1, column 1) is -0.5: values must be finite and not negative";
    assert_eq!(fault.to_string(), line);
    pixels[4][1] = f32::NAN;
    assert!(matches!(make([3, 2], pixels), Err(ImageError::Value { .. })));
}

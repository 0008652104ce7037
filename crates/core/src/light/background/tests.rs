// SPDX-License-Identifier: Apache-2.0 OR MIT

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

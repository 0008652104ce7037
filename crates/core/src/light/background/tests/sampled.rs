// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Whether aiming follows the density that it states.

use std::f64::consts::PI;

use super::*;
use crate::sampling::chi_square::{Cells, Uniform};

const WHOLE: Cells = Cells { axis: DVec3::Y, one_minus_cos: 2.0 };

fn check(what: &str, background: &Background, from: DVec3, cells: &Cells) {
    let density = |direction: DVec3| background.aim_pdf(&Ray::endless(from, direction));
    cells.check(what, |u| background.aim(from, u), density);
}

fn studio() -> Vec<SoftBox> {
    let behind = SoftBox { half_height: DVec3::new(0.0, 2.0, 1.0), ..soft_box(16.0, 2.0, 0.3) };
    vec![soft_box(10.0, 5.0, 0.0), behind, soft_box(-10.0, 90.0, 0.0)]
}

#[test]
fn aiming_at_soft_boxes_that_overlap_follows_its_density() {
    let studio = background(Base::Constant(table(1.0)), studio());
    // The third box is seen from behind.
    check("studio", &studio, DVec3::ZERO, &Cells { axis: DVec3::Z, one_minus_cos: 0.03 });
    let oblique = DVec3::new(5.0, 1.0, 3.0);
    let axis = (DVec3::Z * 11.0 - oblique).normalize();
    check("studio", &studio, oblique, &Cells { axis, one_minus_cos: 0.2 });
}

#[test]
fn where_nothing_stands_out_there_is_nothing_to_aim_at() {
    let overcast = Sky { model: SkyModel::Overcast, zenith: table(3.0), ground: table(1.0) };
    let gradient = Base::Gradient { zenith: table(3.0), nadir: table(1.0) };
    for base in [Base::Constant(table(1.0)), gradient, Base::Sky(overcast)] {
        let even = background(base, vec![soft_box(10.0, 1.0, 0.0)]);
        let behind_box = DVec3::Z * 30.0;
        assert_eq!(even.aim_share(behind_box), 0.0);
        assert_eq!(even.aim(behind_box, [0.5; 3]), None);
        assert_eq!(even.aim_pdf(&Ray::endless(behind_box, -DVec3::Z)), 0.0);
        assert_eq!(even.aim_share(DVec3::ZERO), 0.5);
    }
}

#[test]
fn a_sun_is_aimed_at_evenly_and_fills_its_own_solid_angle() {
    let towards = DVec3::new(2.0, 3.0, -1.0).normalize();
    let radius = 0.2665_f64.to_radians();
    let sun = Sun::new(towards, radius, table(1e5), 4);
    assert!((sun.solid_angle() / (PI * radius * radius) - 1.0).abs() < 1e-5);
    assert!((sun.projected_solid_angle() - PI * radius.sin().powi(2)).abs() < 1e-18);
    let base = Base::Constant(table(1.0));
    let day = Background::new(base, 0, vec![], vec![sun.clone()], &table(1.0));
    let cells = Cells { axis: towards, one_minus_cos: 2.0 * (radius / 2.0).sin().powi(2) * 1.2 };
    check("sun", &day, DVec3::ONE, &cells);
    let towards_sun = Ray::endless(DVec3::ONE, towards);
    assert!((day.aim_pdf(&towards_sun) * sun.solid_angle() - 1.0).abs() < 1e-9);
    let off = |angle: f64| (towards + towards.any_orthonormal_vector() * angle.tan()).normalize();
    assert!(sun.covers(off(radius * 0.999)) && !sun.covers(off(radius * 1.001)));
}

#[test]
fn aiming_at_a_picture_follows_its_brightness_pixel_by_pixel() {
    let mut random = Uniform(2);
    let (width, height) = (24, 12);
    let pixels = (0..width * height).map(|_| {
        let dark = random.next() < 0.3;
        [0.0, 1.0, 2.0].map(|scale| if dark { 0.0 } else { scale * random.next() as f32 })
    });
    let pixels: Vec<[f32; 3]> = pixels.collect();
    let bases = [table(1.0), table(2.0), table(0.5)];
    let image = ImageMap::new([width, height], pixels, bases, 0.0).unwrap();
    let surround = background(Base::Image(image), vec![]);
    check("picture", &surround, DVec3::ZERO, &WHOLE);
    // Exact: the density is the luminance over its integral, which no sample can miss.
    let mut integral = 0.0;
    for _ in 0..2000 {
        let direction = surround.aim(DVec3::ZERO, random.triple()).unwrap();
        let ray = Ray::endless(DVec3::ZERO, direction);
        let luminance = LANES as f64 * value(&surround, &ray);
        let found = luminance / surround.aim_pdf(&ray);
        assert!(integral == 0.0 || (found / integral - 1.0).abs() < 1e-6);
        integral = found;
    }
}

#[test]
fn aiming_at_a_clear_sky_with_sun_boxes_and_ground_follows_its_density() {
    let sun = DVec3::new(1.0, 1.5, 0.5).normalize();
    let model = SkyModel::General { coefficients: CIE_GENERAL_SKIES[11], sun };
    let sky = Sky { model, zenith: table(1.0), ground: table(0.3) };
    let suns = vec![Sun::new(sun, 0.3, table(9.0), 1)];
    let boxes = vec![soft_box(2.0, 5.0, 0.5)];
    let clear = Background::new(Base::Sky(sky), 0, boxes, suns, &table(1.0));
    check("clear sky", &clear, DVec3::new(0.1, 0.0, 0.3), &Cells { axis: sun, ..WHOLE });
}

#[test]
fn a_soft_box_weighs_about_the_solid_angle_that_it_fills_and_nothing_from_behind() {
    let panel = soft_box(10.0, 1.0, 0.0);
    for distance in [1e-3_f64, 0.5, 4.0, 1e4] {
        // Ω = 4·asin(ab/√((a² + d²)(b² + d²))) over the middle, for half sides a and b.
        let (a2, b2, d2) = (4.0_f64, 1.0, distance * distance);
        let expected = 4.0 * ((a2 * b2).sqrt() / ((a2 + d2) * (b2 + d2)).sqrt()).asin();
        let found = panel.apparent_size(DVec3::Z * (10.0 - distance));
        assert!((0.6..1.4).contains(&(found / expected)), "{distance}: {found}, not {expected}");
    }
    for behind in [DVec3::Z * 11.0, DVec3::Z * 10.0] {
        assert_eq!(panel.apparent_size(behind), 0.0);
    }
}

#[test]
fn the_mean_brightness_of_a_soft_box_is_that_of_its_faded_edges() {
    let (n, soft) = (200, soft_box(10.0, 1.0, 0.7));
    let at = |i: usize| 2.0 * (i as f64 + 0.5) / n as f64 - 1.0;
    let faded = |k: usize| {
        let target = soft.centre + soft.half_width * at(k % n) + soft.half_height * at(k / n);
        soft.meet(&Ray::endless(target - DVec3::Z, DVec3::Z)).map_or(0.0, |(_, share)| share)
    };
    let mean = (0..n * n).map(faded).sum::<f64>() / (n * n) as f64;
    assert!((mean - soft.mean_brightness()).abs() < 1e-4);
}

#[test]
fn aiming_and_following_any_other_choice_together_find_the_same_light() {
    // The irradiance of a floor, by aiming alone and by the cosine alone.
    let studio = background(Base::Constant(table(0.0)), studio());
    let from = DVec3::new(0.5, 0.0, 0.0);
    let mut random = Uniform(17);
    let n = 200_000;
    let (mut aimed, mut cosine) = (0.0, 0.0);
    for _ in 0..n {
        let direction = studio.aim(from, random.triple()).unwrap();
        let ray = Ray::endless(from, direction);
        aimed += value(&studio, &ray) * direction.z / studio.aim_pdf(&ray) / f64::from(n);
        let [u, v, _] = random.triple();
        let (sin, cos) = (2.0 * PI * v).sin_cos();
        let direction = DVec3::new(u.sqrt() * cos, u.sqrt() * sin, (1.0 - u).sqrt());
        cosine += PI * value(&studio, &Ray::endless(from, direction)) / f64::from(n);
    }
    assert!((aimed / cosine - 1.0).abs() < 0.02, "{aimed} by aiming, {cosine} without");
}

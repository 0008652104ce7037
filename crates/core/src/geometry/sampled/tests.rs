// SPDX-License-Identifier: Apache-2.0 OR MIT

use std::f64::consts::PI;

use super::*;
use crate::geometry::{Cone, ConvexPolyhedron, Cylinder, Disc, Plane, Shape, Sphere};
use crate::math::{DAffine3, Ray};
use crate::sampling::chi_square::{Cells, Uniform};

const CORNERS: [DVec3; 4] = [
    DVec3::new(-1.0, -0.5, 0.0),
    DVec3::new(2.0, 0.0, 0.3),
    DVec3::new(0.0, 1.5, 0.1),
    DVec3::new(0.2, 0.3, 1.8),
];

/// Each shape with its area and volume.
fn shapes() -> Vec<(&'static str, Shape, f64, f64)> {
    let [a, b, c, d] = CORNERS;
    let face = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).length() / 2.0;
    let faces = face(a, b, c) + face(a, b, d) + face(a, c, d) + face(b, c, d);
    let tetrahedron = ConvexPolyhedron::tetrahedron(CORNERS).unwrap();
    let cuboid = ConvexPolyhedron::cuboid(-DVec3::ONE, DVec3::new(1.0, 2.0, 0.5)).unwrap();
    let axis = DVec3::new(1.0, 2.0, -1.0);
    let cylinder = Cylinder::new(DVec3::X, axis, 0.7, 2.0).unwrap();
    let cone = Cone::new(-DVec3::Y, axis, 0.9, 2.0).unwrap();
    let disc = Disc::new(DVec3::ZERO, axis, 1.3).unwrap();
    let volume = (b - a).cross(c - a).dot(d - a).abs() / 6.0;
    let slant = 0.9_f64.hypot(2.0);
    vec![
        ("sphere", Shape::Sphere(Sphere::new(DVec3::X, 1.2).unwrap()), 4.0 * PI * 1.44, {
            4.0 / 3.0 * PI * 1.2_f64.powi(3)
        }),
        ("tetrahedron", Shape::Polyhedron(tetrahedron), faces, volume),
        ("box", Shape::Polyhedron(cuboid), 2.0 * (6.0 + 3.0 + 4.5), 9.0),
        ("cylinder", Shape::Cylinder(cylinder), 2.0 * PI * 0.7 * 2.7, PI * 0.49 * 2.0),
        ("cone", Shape::Cone(cone), PI * 0.9 * (0.9 + slant), PI * 0.81 * 2.0 / 3.0),
        ("disc", Shape::Disc(disc), PI * 1.69, 0.0),
    ]
}

fn turned(scale: DVec3) -> DAffine3 {
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -1.1, 2.0);
    let skew = DAffine3::from_scale(scale) * DAffine3::from_quat(turn);
    DAffine3::from_translation(DVec3::new(5.0, -3.0, 2.0)) * DAffine3::from_quat(turn) * skew
}

fn placed(shape: Shape, to_world: DAffine3) -> (Primitive, SampledSurface) {
    let primitive = Primitive::new(shape, to_world).unwrap();
    let surface = SampledSurface::primitive(&primitive).unwrap();
    (primitive, surface)
}

/// The mean of `f` over random samples, and its standard error.
fn mean(n: usize, mut f: impl FnMut([f64; 3]) -> f64) -> (f64, f64) {
    let mut random = Uniform(3);
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..n {
        let value = f(random.triple());
        sum += value;
        squares += value * value;
    }
    let (mean, n) = (sum / n as f64, n as f64);
    (mean, ((squares / n - mean * mean).max(0.0) / n).sqrt() + 1e-12 * mean.abs())
}

#[test]
fn areas_are_those_of_the_textbook_at_any_scale_and_mirrored() {
    for (name, shape, area, _) in shapes() {
        for scale in [DVec3::ONE, DVec3::splat(3.0), DVec3::new(2.0, 2.0, -2.0)] {
            let (_, surface) = placed(shape.clone(), turned(scale));
            let expected = area * scale.x * scale.x;
            assert!((surface.area() / expected - 1.0).abs() < 1e-12, "{name}: {}", surface.area());
        }
    }
    let plane = Shape::Plane(Plane::new(DVec3::ZERO, DVec3::Z).unwrap());
    let plane = Primitive::new(plane, DAffine3::IDENTITY).unwrap();
    assert!(SampledSurface::primitive(&plane).is_none());
}

#[test]
fn stretched_areas_are_those_of_the_spheroid_and_of_the_elliptic_cylinder() {
    for stretch in [0.05_f64, 0.5, 3.0, 30.0] {
        let sphere = Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap());
        let along = DAffine3::from_scale(DVec3::new(1.0, stretch, 1.0));
        let expected = if stretch < 1.0 {
            let e = (1.0 - stretch * stretch).sqrt();
            2.0 * PI * (1.0 + stretch * stretch / e * e.atanh())
        } else {
            let e = (1.0 - 1.0 / (stretch * stretch)).sqrt();
            2.0 * PI * (1.0 + stretch / e * e.asin())
        };
        let area = placed(sphere, along).1.area();
        assert!((area / expected - 1.0).abs() < 1e-5, "{stretch}: {area}, not {expected}");
        // The perimeter of an ellipse by Gauss and Kummer: 2π(a² − Σ 2ⁿ⁻¹cₙ²)/M(a, b).
        let (mut a, mut b, mut c2, mut power) = (stretch.max(1.0), stretch.min(1.0), 0.0, 0.5);
        let major = a;
        for _ in 0..40 {
            c2 += power * (a * a - b * b);
            power *= 2.0;
            (a, b) = (f64::midpoint(a, b), (a * b).sqrt());
            if (a - b).abs() < 1e-15 * a {
                break;
            }
        }
        let perimeter = 2.0 * PI * (major * major - c2) / a;
        let cylinder = Shape::Cylinder(Cylinder::new(DVec3::ZERO, DVec3::Z, 1.0, 2.0).unwrap());
        let area = placed(cylinder, along).1.area();
        let expected = 2.0 * perimeter + 2.0 * PI * stretch;
        assert!((area / expected - 1.0).abs() < 1e-9, "{stretch}: {area}, not {expected}");
    }
}

#[test]
fn samples_by_area_find_the_area_and_by_the_divergence_theorem_the_volume() {
    for (name, shape, _, volume) in shapes() {
        for scale in [DVec3::ONE, DVec3::new(0.6, -1.4, 2.0)] {
            let to_world = turned(scale);
            let (_, surface) = placed(shape.clone(), to_world);
            let (area, error) = mean(100_000, |u| 1.0 / surface.sample(u).pdf);
            assert!((area - surface.area()).abs() < 4.0 * error, "{name}: {area} ± {error}");
            if volume > 0.0 {
                let (flow, error) = mean(100_000, |u| {
                    let point = surface.sample(u);
                    (point.position - to_world.translation).dot(point.normal) / point.pdf
                });
                let expected = 3.0 * volume * to_world.matrix3.determinant().abs();
                assert!((flow - expected).abs() < 4.0 * error, "{name}: {flow} ± {error}");
            }
        }
    }
}

#[test]
fn samples_lie_where_rays_meet_the_surface() {
    for ((name, shape, ..), at) in shapes().into_iter().zip(0..) {
        // The disc, the last, faces the other way.
        let from = DVec3::new(5.0, -3.0, 2.0)
            + DVec3::new(-8.0, 7.0, 9.0) * if at == 5 { -1.0 } else { 1.0 };
        let (primitive, surface) = placed(shape, turned(DVec3::new(0.6, -1.4, 2.0)));
        let mut random = Uniform(11);
        let mut seen = 0;
        for _ in 0..2000 {
            let Some(point) = surface.sample_from(from, random.triple()) else { continue };
            let ray = Ray::endless(from, point.direction);
            // A ray that grazes may pass by the edge.
            let Some(hit) = primitive.closest_hit(&ray) else { continue };
            assert!((hit.t - point.distance).abs() < 1e-9, "{name}");
            assert!(hit.position.distance(point.position) < 1e-9, "{name}");
            let pdf = surface.pdf_from(from, hit.position, hit.normal, ray.direction);
            assert!((pdf / point.pdf - 1.0).abs() < 1e-6, "{name}: {pdf}, not {}", point.pdf);
            // A rim or an edge has two normals.
            seen += usize::from(hit.normal.distance(point.normal) < 1e-6);
            let before = point.position + point.normal * point.error;
            let short = Ray { t_max: before.distance(from), ..ray };
            let way = Ray { direction: (before - from).normalize(), ..short };
            assert!(primitive.closest_hit(&way).is_none(), "{name} hides its own front");
        }
        assert!(seen > 400, "{name}: {seen}");
    }
}

#[test]
fn directions_to_every_shape_follow_their_density() {
    for (name, shape, ..) in shapes() {
        for (scale, from) in [
            (DVec3::ONE, DVec3::new(5.0, -3.0, -4.0)),
            (DVec3::new(0.6, -1.4, 2.0), DVec3::new(9.0, -10.5, 2.0)),
        ] {
            let (primitive, surface) = placed(shape.clone(), turned(scale));
            let (lo, hi) = primitive.bounds().unwrap();
            let (middle, radius) = ((lo + hi) / 2.0, (hi - lo).length() / 2.0);
            let way = middle - from;
            let sin = (radius / way.length()).min(1.0);
            let cells =
                Cells { axis: way.normalize(), one_minus_cos: 1.0 - (1.0 - sin * sin).sqrt() };
            let cells = Cells { one_minus_cos: cells.one_minus_cos.min(1.0), ..cells };
            let density = |direction: DVec3| {
                primitive
                    .closest_hit(&Ray::endless(from, direction))
                    .map_or(0.0, |hit| surface.pdf_from(from, hit.position, hit.normal, direction))
            };
            let sample = |u| surface.sample_from(from, u).map(|point| point.direction);
            match name {
                "cylinder" | "cone" => cells.check_reciprocal(name, sample, density),
                _ => cells.check(name, sample, density),
            }
        }
    }
}

/// The triangles of the box of [`shapes`].
fn box_mesh() -> Vec<[DVec3; 3]> {
    let (lo, hi) = (-DVec3::ONE, DVec3::new(1.0, 2.0, 0.5));
    let corner = |i: usize| {
        let pick = |bit: usize, axis: usize| if i >> bit & 1 == 1 { hi[axis] } else { lo[axis] };
        DVec3::new(pick(0, 0), pick(1, 1), pick(2, 2))
    };
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let split = |[a, b, c, d]: [usize; 4]| [[a, b, c], [a, c, d]];
    quads.into_iter().flat_map(split).map(|t| t.map(corner)).collect()
}

#[test]
fn a_mesh_is_seen_and_sampled_as_the_box_that_it_describes() {
    let mesh = SampledSurface::triangles(box_mesh(), 0.0).unwrap();
    assert!((mesh.area() - 27.0).abs() < 1e-12);
    let (flow, error) = mean(100_000, |u| {
        let point = mesh.sample(u);
        point.position.dot(point.normal) / point.pdf
    });
    assert!((flow - 27.0).abs() < 4.0 * error, "three times the volume of 9, not {flow}");
    let (primitive, _) = placed(shapes().swap_remove(2).1, DAffine3::IDENTITY);
    let from = DVec3::new(2.0, -3.0, 3.0);
    let cells = Cells { axis: -from.normalize(), one_minus_cos: 0.6 };
    let density = |direction: DVec3| {
        primitive
            .closest_hit(&Ray::endless(from, direction))
            .map_or(0.0, |hit| mesh.pdf_from(from, hit.position, hit.normal, direction))
    };
    cells.check("mesh", |u| mesh.sample_from(from, u).map(|point| point.direction), density);
    assert!(SampledSurface::triangles(vec![[DVec3::ZERO; 3]], 0.0).is_none());
}

#[test]
fn a_sphere_is_seen_in_its_cone_from_any_distance_and_not_from_inside() {
    let (_, sphere) =
        placed(Shape::Sphere(Sphere::new(DVec3::ZERO, 2.0).unwrap()), DAffine3::IDENTITY);
    for distance in [2.0001, 3.0, 1e3, 1e9_f64] {
        let sin = 2.0 / distance;
        let solid_angle = 2.0 * PI * sin * sin / (1.0 + (1.0 - sin * sin).sqrt());
        let from = DVec3::new(0.0, 0.0, distance);
        for u in [[0.0, 0.1, 0.7], [0.0, 0.9, 0.2]] {
            let point = sphere.sample_from(from, u).unwrap();
            assert!((point.pdf * solid_angle - 1.0).abs() < 1e-9, "{distance}");
            assert!((point.position.length() - 2.0).abs() < 1e-12);
            assert!(point.normal.dot(point.direction) < 0.0);
        }
    }
    assert!(sphere.sample_from(DVec3::X, [0.5; 3]).is_none());
    assert_eq!(sphere.pdf_from(DVec3::X, DVec3::X * 2.0, DVec3::X, DVec3::X), 0.0);
}

#[test]
fn area_vectors_of_closed_bodies_cancel_and_are_as_long_as_the_area() {
    for (name, shape, _, volume) in shapes() {
        let (_, surface) = placed(shape, turned(DVec3::new(0.6, -1.4, 2.0)));
        let vectors = surface.area_vectors();
        let area: f64 = vectors.iter().map(|a| a.length()).sum();
        assert!((area / surface.area() - 1.0).abs() < 1e-3, "{name}: {area}");
        if volume > 0.0 {
            assert!(vectors.iter().sum::<DVec3>().length() < 1e-9 * area, "{name}");
        }
    }
    let mesh = SampledSurface::triangles(box_mesh(), 0.0).unwrap();
    assert_eq!(mesh.area_vectors().len(), 6, "triangles that face the same way are one vector");
}

// SPDX-License-Identifier: Apache-2.0 OR MIT

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use proptest::prelude::*;

use super::*;

fn place(shape: Shape) -> Primitive {
    Primitive::new(shape, DAffine3::IDENTITY).unwrap()
}

fn solids() -> Vec<(&'static str, Primitive)> {
    let points = [
        DVec3::new(-1.0, -1.0, -1.0),
        DVec3::new(1.0, -1.0, -1.0),
        DVec3::new(0.0, 1.0, -1.0),
        DVec3::new(0.0, 0.0, 1.0),
    ];
    vec![
        ("sphere", Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap())),
        ("tetrahedron", Shape::Polyhedron(ConvexPolyhedron::tetrahedron(points).unwrap())),
        (
            "box",
            Shape::Polyhedron(
                ConvexPolyhedron::cuboid(-DVec3::ONE, DVec3::new(1.0, 2.0, 0.5)).unwrap(),
            ),
        ),
        ("cylinder", Shape::Cylinder(Cylinder::new(-DVec3::Z, DVec3::Z, 0.7, 2.0).unwrap())),
        ("cone", Shape::Cone(Cone::new(-DVec3::Y, DVec3::Y, 0.9, 2.0).unwrap())),
    ]
    .into_iter()
    .map(|(name, shape)| (name, place(shape)))
    .collect()
}

#[test]
fn a_ray_meets_each_primitive_where_its_equation_says() {
    let down = |x: f64, y: f64| Ray::endless(DVec3::new(x, y, 10.0), -DVec3::Z);
    let z = |primitive: &Primitive, x, y| primitive.closest_hit(&down(x, y)).map(|p| p.position.z);
    let sphere = place(Shape::Sphere(Sphere::new(DVec3::ZERO, 2.0).unwrap()));
    assert!((z(&sphere, 1.0, 1.0).unwrap() - 2.0_f64.sqrt()).abs() < 1e-14);
    assert_eq!(z(&sphere, 1.5, 1.5), None);
    let cone = place(Shape::Cone(Cone::new(DVec3::ZERO, DVec3::Z, 3.0, 6.0).unwrap()));
    assert!((z(&cone, 1.0, 0.0).unwrap() - 4.0).abs() < 1e-13);
    let cylinder = place(Shape::Cylinder(Cylinder::new(DVec3::ZERO, DVec3::X, 2.0, 5.0).unwrap()));
    assert!((z(&cylinder, 1.0, 1.2).unwrap() - 1.6).abs() < 1e-14);
    assert_eq!(z(&cylinder, -0.1, 0.0), None);
    let disc = place(Shape::Disc(Disc::new(DVec3::Z, DVec3::Z, 2.0).unwrap()));
    assert_eq!(z(&disc, 1.0, 1.0), Some(1.0));
    assert_eq!(z(&disc, 2.0, 0.1), None);
    let plane = place(Shape::Plane(Plane::new(DVec3::ZERO, DVec3::new(1.0, 0.0, 1.0)).unwrap()));
    assert!((z(&plane, 3.0, 50.0).unwrap() + 3.0).abs() < 1e-14);
}

#[test]
fn a_tetrahedron_is_entered_through_its_near_face_and_left_through_its_far_one() {
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let body = place(Shape::Polyhedron(ConvexPolyhedron::tetrahedron(points).unwrap()));
    let ray = Ray::endless(DVec3::new(0.2, 0.2, -1.0), DVec3::Z);
    let enter = body.closest_hit(&ray).unwrap();
    assert!((enter.t - 1.0).abs() < 1e-15 && (enter.normal + DVec3::Z).length() < 1e-15);
    let onward = Ray::endless(enter.leave_along(ray.direction), ray.direction);
    let leave = body.closest_hit(&onward).unwrap();
    assert!((leave.position.z - 0.6).abs() < 1e-14);
    assert!((leave.normal - DVec3::splat(1.0 / 3.0_f64.sqrt())).length() < 1e-14);
}

#[test]
fn flat_and_endless_input_is_refused() {
    let flat = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y];
    assert_eq!(ConvexPolyhedron::tetrahedron(flat).unwrap_err(), PrimitiveError::Flat);
    assert!(Sphere::new(DVec3::ZERO, -1.0).is_err());
    assert!(Disc::new(DVec3::ZERO, DVec3::ZERO, 1.0).is_err());
    assert!(ConvexPolyhedron::cuboid(DVec3::ONE, DVec3::ONE).is_err());
    let sphere = Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap());
    let squeezed = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    assert_eq!(Primitive::new(sphere, squeezed).unwrap_err(), PrimitiveError::Singular);
}

#[test]
fn a_stretched_sphere_is_the_ellipsoid_with_its_own_normals() {
    let sphere = Shape::Sphere(Sphere::new(DVec3::ZERO, 1.0).unwrap());
    let stretched =
        Primitive::new(sphere, DAffine3::from_scale(DVec3::new(2.0, 1.0, 1.0))).unwrap();
    let ray = Ray::endless(DVec3::new(2.0 * FRAC_1_SQRT_2, 5.0, 0.0), -DVec3::Y);
    let hit = stretched.closest_hit(&ray).unwrap();
    assert!((hit.position.y - FRAC_1_SQRT_2).abs() < 1e-14);
    let expected = DVec3::new(hit.position.x / 4.0, hit.position.y, 0.0).normalize();
    assert!((hit.normal - expected).length() < 1e-14);
}

proptest! {
    /// From any place outside, at any scale and offset, a line through a solid enters once and
    /// leaves once, and a ray that starts on the surface never meets the same place again.
    #[test]
    fn a_line_through_a_solid_enters_once_and_leaves_once(
        theta in 0.0..TAU, phi in -1.4..1.4f64,
        ax in -0.1..0.1f64, ay in -0.1..0.1f64, az in -0.1..0.1f64,
        log_scale in -3.0..3.0f64, log_offset in -2.0..6.0f64,
    ) {
        let scale = 10f64.powf(log_scale);
        let offset = DVec3::new(0.3, -0.7, 0.5) * 10f64.powf(log_offset);
        prop_assume!(10f64.powf(log_offset) / scale < 1e8);
        let from = DVec3::new(theta.cos() * phi.cos(), phi.sin(), theta.sin() * phi.cos());
        for (name, solid) in solids() {
            let placed = Primitive::new(
                solid.shape.clone(),
                DAffine3::from_scale_rotation_translation(
                    DVec3::splat(scale), glam::DQuat::from_rotation_x(0.3), offset),
            ).unwrap();
            let target = offset + DVec3::new(ax, ay, az) * scale;
            let origin = target + from * (10.0 * scale);
            let direction = (target - origin).normalize();
            let mut ray = Ray::endless(origin, direction);
            let mut crossings = Vec::new();
            while let Some(hit) = placed.closest_hit(&ray) {
                crossings.push(hit.normal.dot(direction) > 0.0);
                prop_assert!(crossings.len() < 5, "{name} is met again and again");
                ray.origin = hit.leave_along(direction);
            }
            prop_assert_eq!(crossings, vec![false, true], "{}", name);
        }
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT

use std::f64::consts::{PI, TAU};

use super::*;
use crate::geometry::{Cylinder, Disc, Primitive, Shape, Sphere};
use crate::light::{Background, Base, DirectionGrid};
use crate::math::{orthonormal_pair, DAffine3, DMat3, Ray};
use crate::matter::{Finish, HallTerms, Material, Optics};
use crate::sampling::chi_square::{Cells, Uniform};
use crate::scene::{
    Body, Camera, Distribution, Emission, Projection, Scene, SceneBuilder, SceneError, Strength,
};
use crate::spectrum::{SampledWavelengths, LANES};

const AT: SampledWavelengths = SampledWavelengths { phase: 0 };

fn table(value: f64) -> SpectralTable {
    SpectralTable::from_ascending(&[value; LANES]).unwrap()
}

fn lambert(value: f64) -> Emission {
    let strength = Strength::Radiance(table(value));
    Emission { group: 0, strength, distribution: Distribution::Lambert }
}

fn sphere(centre: DVec3, radius: f64) -> Shape {
    Shape::Sphere(Sphere::new(centre, radius).unwrap())
}

fn disc(radius: f64) -> Shape {
    Shape::Disc(Disc::new(DVec3::ZERO, DVec3::Z, radius).unwrap())
}

/// Emitters on primitives, and the primitives.
fn emitters(shining: Vec<(Shape, DAffine3, Emission)>) -> (Emitters, Vec<Primitive>) {
    let mut primitives = Vec::new();
    let mut all = Vec::new();
    for (body, (shape, to_world, emission)) in (0..).zip(shining) {
        let primitive = Primitive::new(shape, to_world).unwrap();
        let surface = SampledSurface::primitive(&primitive).unwrap();
        all.push((emission.on(body, &surface).unwrap(), surface));
        primitives.push(primitive);
    }
    (Emitters::new(all, &table(1.0)), primitives)
}

fn alone(shape: Shape, emission: Emission) -> Emitters {
    emitters(vec![(shape, DAffine3::IDENTITY, emission)]).0
}

/// The irradiance of a place that looks along `normal`, and its standard error.
fn irradiance(emitters: &Emitters, place: DVec3, normal: DVec3) -> (f64, f64) {
    const N: usize = 100_000;
    let mut random = Uniform(23);
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..N {
        let Some(point) = emitters.sample(place, random.triple()) else { continue };
        let emitter = emitters.get(point.emitter);
        let radiance = emitter.radiance(point.normal, -point.direction, AT).0[0];
        let value = radiance * point.direction.dot(normal).max(0.0) / point.pdf;
        sum += value;
        squares += value * value;
    }
    let mean = sum / N as f64;
    (mean, ((squares / N as f64 - mean * mean) / N as f64).max(0.0).sqrt() + 1e-12)
}

fn assert_near((value, error): (f64, f64), expected: f64) {
    assert!((value - expected).abs() < 4.0 * error, "{value} ± {error}, not {expected}");
    assert!(error < 0.01 * expected, "too uncertain: ± {error} of {expected}");
}

#[test]
fn a_disc_and_a_sphere_light_a_place_as_the_textbook_says() {
    let below_disc = irradiance(&alone(disc(3.0), lambert(2.0)), DVec3::Z * 4.0, -DVec3::Z);
    assert_near(below_disc, PI * 2.0 * 9.0 / 25.0);
    let ball = alone(sphere(DVec3::ZERO, 3.0), lambert(2.0));
    assert_near(irradiance(&ball, DVec3::Y * 4.0, -DVec3::Y), PI * 2.0 * 9.0 / 16.0);
}

#[test]
fn several_emitters_light_a_place_by_their_sum() {
    let group = vec![
        (disc(3.0), DAffine3::IDENTITY, lambert(2.0)),
        (sphere(DVec3::new(0.0, 0.0, 10.0), 0.5), DAffine3::IDENTITY, lambert(40.0)),
        (sphere(DVec3::X * 50.0, 0.5), DAffine3::IDENTITY, lambert(0.0)),
    ];
    let (all, _) = emitters(group);
    let sideways = DVec3::new(0.0, 0.6, -0.8);
    let expected = 0.8 * PI * 2.0 * 9.0 / 25.0;
    // From the place the ball stands 6 mm off in the other half-space of the disc: it adds nothing.
    assert_near(irradiance(&all, DVec3::Z * 4.0, -DVec3::Z), expected / 0.8);
    let ball = PI * 40.0 * 0.25 / 36.0;
    assert_near(irradiance(&all, DVec3::Z * 4.0, DVec3::Z), ball);
    // Facing the disc aslant, all of it is still before the place, as its rim is 36.9° off the axis.
    let (all, _) = emitters(vec![(disc(3.0), DAffine3::IDENTITY, lambert(2.0))]);
    assert_near(irradiance(&all, DVec3::Z * 4.0, sideways), expected);
}

#[test]
fn samples_of_several_emitters_follow_their_density_in_which_each_counts() {
    let (all, primitives) = emitters(vec![
        (disc(1.0), DAffine3::IDENTITY, lambert(2.0)),
        (
            sphere(DVec3::ZERO, 0.5),
            DAffine3::from_translation(DVec3::new(2.0, 0.0, 0.2))
                * DAffine3::from_scale(DVec3::new(1.0, 2.0, 0.4)),
            lambert(3.0),
        ),
    ]);
    let from = DVec3::new(1.0, -0.4, 4.0);
    let density = |direction: DVec3| {
        let ray = Ray::endless(from, direction);
        let hits = primitives.iter().enumerate();
        hits.filter_map(|(body, primitive)| {
            let hit = primitive.closest_hit(&ray)?;
            let emitter = all.of_body(body as BodyId)?;
            Some(all.pdf(emitter, from, hit.position, hit.normal, direction))
        })
        .sum()
    };
    let cells = Cells { axis: -DVec3::Z, one_minus_cos: 0.2 };
    cells.check("emitters", |u| all.sample(from, u).map(|point| point.direction), density);
}

/// The laws, as made for a body with the flux of 1 W/nm.
fn laws() -> Vec<Distribution> {
    let polar: Vec<f64> = (0..=18).map(|i| PI * f64::from(i) / 18.0).collect();
    let values = polar.iter().map(|theta| 2.0 + theta.cos()).collect();
    let grid = DirectionGrid::new(polar, vec![0.0], values).unwrap();
    vec![
        Distribution::Lambert,
        Distribution::Cosine { exponent: 4.0 },
        Distribution::Intensity { grid, frame: DMat3::from_rotation_y(0.8) },
    ]
}

#[test]
fn every_law_on_every_surface_sends_out_the_flux_that_was_given() {
    let to_world = DAffine3::from_scale(DVec3::new(1.0, 2.5, -0.6));
    let cylinder = Shape::Cylinder(Cylinder::new(DVec3::ZERO, DVec3::Y, 0.4, 3.0).unwrap());
    for shape in [sphere(DVec3::Z, 1.0), cylinder, disc(2.0)] {
        for distribution in laws() {
            let name = format!("{shape:?} {distribution:?}");
            let emission =
                Emission { group: 0, strength: Strength::Flux(table(1.0)), distribution };
            let (all, _) = emitters(vec![(shape.clone(), to_world, emission)]);
            let (emitter, surface) = (all.get(0), all.surface(0));
            assert!(emitter.per_n2);
            let n = 200_000;
            let mut random = Uniform(29);
            let (mut sum, mut squares) = (0.0, 0.0);
            for _ in 0..n {
                let point = surface.sample(random.triple());
                let (cos, phi) = (random.next(), TAU * random.next());
                let (x, y) = orthonormal_pair(point.normal);
                let across = (x * phi.cos() + y * phi.sin()) * (1.0 - cos * cos).sqrt();
                let out = across + point.normal * cos;
                let radiance = emitter.radiance(point.normal, out, AT).0[0];
                // W/nm: mm² to m², and a density of 1/2π over the half-space.
                let value = radiance * cos * TAU / point.pdf * 1e-6;
                sum += value;
                squares += value * value;
            }
            let mean = sum / f64::from(n);
            let error = ((squares / f64::from(n) - mean * mean) / f64::from(n)).sqrt();
            assert!((mean - 1.0).abs() < 4.0 * error && error < 0.01, "{name}: {mean} ± {error}");
        }
    }
}

fn scene(shine: impl FnOnce(&mut SceneBuilder)) -> Result<Scene, SceneError> {
    let mut builder = SceneBuilder::default();
    shine(&mut builder);
    let projection = Projection::Orthographic { height: 1.0 };
    let camera = Camera::new(DVec3::Z * 50.0, DVec3::ZERO, DVec3::Y, projection).unwrap();
    let luminosity = table(1.0);
    let base = Base::Constant(table(0.0));
    let background = Background::new(base, 0, vec![], vec![], &luminosity);
    let matching = [luminosity.clone(), luminosity.clone(), luminosity];
    builder.build(camera, vec![], table(0.0), background, matching)
}

fn add_material(builder: &mut SceneBuilder) -> usize {
    let hall = HallTerms {
        reflection_weight: 0.0,
        transmission_weight: 0.0,
        ambient_weight: 0.0,
        highlight_exponent: 1.0,
        specular_reflectance: None,
        specular_transmittance: None,
        ambient_reflectance: None,
    };
    builder.add_material(Material {
        optics: Optics::Diffuse(table(0.5)),
        finish: Finish::SMOOTH,
        hall,
    })
}

#[test]
fn a_mesh_shines_from_the_triangles_that_rays_see() {
    let vertices = [[0.1, 0.0, 1.0], [2.1, 0.0, 1.0], [0.1, 2.0, 1.0], [1e4, 0.0, 0.0]];
    let built = scene(|builder| {
        let material = add_material(builder);
        let body = |name: &str| Body { name: name.into(), material, priority: 0 };
        let far = [[0, 1, 3]];
        builder.add_mesh(body("dark"), &vertices, &far, None).unwrap();
        let lit = builder.add_mesh(body("lit"), &vertices, &[[0, 1, 2]], None).unwrap();
        builder.shine(lit, lambert(1.0));
    })
    .unwrap();
    assert_eq!(built.emitters.of_body(0), None);
    assert_eq!(built.emitters.of_body(1), Some(0));
    assert_eq!(built.emitters.of_body(9), None);
    assert!((built.emitters.surface(0).area() - 2.0).abs() < 1e-3);
    let from = DVec3::new(0.3, 0.4, 9.0);
    let mut random = Uniform(31);
    for _ in 0..100 {
        let point = built.emitters.sample(from, random.triple()).unwrap();
        let hit = built.closest_hit(&Ray::endless(from, point.direction)).unwrap();
        assert_eq!(hit.body, 1);
        assert!((hit.point.t - point.distance).abs() <= 2.0 * point.error);
        let before = point.position + point.normal * point.error;
        let way = Ray {
            origin: from,
            direction: (before - from).normalize(),
            t_max: before.distance(from),
        };
        assert!(built.closest_hit(&way).is_none());
    }
    let behind = DVec3::new(0.3, 0.4, -9.0);
    assert!(built.emitters.sample(behind, [0.5; 3]).is_none());
}

#[test]
fn a_body_without_area_or_with_a_dark_table_cannot_shine() {
    let built = scene(|builder| {
        let material = add_material(builder);
        let body = Body { name: "thread".into(), material, priority: 0 };
        let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        let thread = builder.add_mesh(body, &vertices, &[[0, 1, 2]], None).unwrap();
        builder.shine(thread, lambert(1.0));
    });
    let message = built.err().map(|error| error.to_string());
    let expected = "body \"thread\" shines, and has no finite area to shine from";
    assert_eq!(message.as_deref(), Some(expected));
    let built = scene(|builder| {
        let material = add_material(builder);
        let body = Body { name: "sheet".into(), material, priority: 0 };
        let primitive = Primitive::new(disc(1.0), DAffine3::IDENTITY).unwrap();
        let sheet = builder.add_primitive(body, primitive).unwrap();
        let grid = DirectionGrid::new(vec![2.0, PI], vec![0.0], vec![1.0; 2]).unwrap();
        let distribution = Distribution::Intensity { grid, frame: DMat3::IDENTITY };
        builder.shine(sheet, Emission { distribution, ..lambert(1.0) });
    });
    assert!(matches!(built, Err(SceneError::Intensity { .. })));
}

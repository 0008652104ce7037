// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Scenes of a few lines.

use std::sync::Arc;

use lamplit_core::geometry::{ConvexPolyhedron, Disc, Primitive, Shape, Sphere};
use lamplit_core::light::{Background, Base, SoftBox, Sun};
use lamplit_core::math::{orthonormal_pair, DAffine3, DVec3};
use lamplit_core::matter::{
    AlbedoTable, AlbedoTables, Dielectric, Finish, HallTerms, Material, Optics, Scattering,
};
use lamplit_core::scene::{
    Body, BodyId, Camera, Distribution, Emission, Projection, Scene, SceneBuilder, Strength,
};
use lamplit_core::spectrum::{SpectralTable, LANES};

pub use crate::measure::{
    all_are, fresnel, mean_luminance, mean_over_seeds, Estimate, Take, EXACT, SINGLE, STEADY,
    USUAL, WHOLE,
};

/// The same value on all lanes.
pub fn flat(value: f64) -> SpectralTable {
    by_lane(|_| value)
}

/// A value for each lane.
pub fn by_lane(value: impl Fn(usize) -> f64) -> SpectralTable {
    let values: Vec<f64> = (0..LANES).map(value).collect();
    SpectralTable::from_ascending(&values).unwrap()
}

/// A clear body of one index.
pub fn glass(index: f64) -> Optics {
    body(flat(index), flat(0.0), None)
}

/// A transparent body; absorption per mm.
pub fn body(
    index: SpectralTable,
    absorption: SpectralTable,
    scattering: Option<(SpectralTable, f64)>,
) -> Optics {
    let scattering =
        scattering.map(|(coefficient, anisotropy)| Scattering { coefficient, anisotropy });
    Optics::Dielectric(Dielectric { index, index_d: 1.5, absorption, scattering })
}

/// Aluminium, about.
pub fn aluminium() -> Optics {
    Optics::Conductor { n: flat(0.9), k: flat(4.0), factor: 1.0, lacquer: None }
}

/// A matt surface.
pub fn matt(reflectance: f64) -> Optics {
    Optics::Diffuse(flat(reflectance))
}

/// A ball.
pub fn ball(centre: DVec3, radius: f64) -> Shape {
    Shape::Sphere(Sphere::new(centre, radius).unwrap())
}

/// A box between two corners.
pub fn cuboid(low: DVec3, high: DVec3) -> Shape {
    Shape::Polyhedron(ConvexPolyhedron::cuboid(low, high).unwrap())
}

/// A plate between two heights y, wide enough that nothing sees its rim.
pub fn plate(low: f64, high: f64) -> Shape {
    cuboid(DVec3::new(-1e4, low, -1e4), DVec3::new(1e4, high, 1e4))
}

/// A round sheet.
pub fn disc(centre: DVec3, normal: DVec3, radius: f64) -> Shape {
    Shape::Disc(Disc::new(centre, normal, radius).unwrap())
}

/// A surround that goes from `nadir` to `zenith`.
pub fn gradient(nadir: f64, zenith: f64) -> Base {
    Base::Gradient { nadir: flat(nadir), zenith: flat(zenith) }
}

/// The unit vector at `degrees` from +y, towards +x.
pub fn tilted(degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(sin, cos, 0.0)
}

/// ȳ: a bump over the lanes, together 1, so that the luminance of a flat radiance 1 is 1.
fn luminosity() -> SpectralTable {
    let bump = |lane: usize| 0.2 + (-((lane as f64 - 7.0) / 3.0).powi(2)).exp();
    let sum: f64 = (0..LANES).map(bump).sum();
    by_lane(|lane| bump(lane) / sum)
}

/// A scene under construction.
pub struct World {
    builder: SceneBuilder,
    tables: AlbedoTables,
    pub base: Base,
    pub soft_boxes: Vec<SoftBox>,
    pub suns: Vec<Sun>,
}

impl World {
    /// Nothing, under a dark surround.
    pub fn dark() -> Self {
        Self::under(Base::Constant(flat(0.0)))
    }

    /// Nothing, under a surround.
    pub fn under(base: Base) -> Self {
        let mut builder = SceneBuilder::default();
        builder.groups = 4;
        Self { builder, tables: AlbedoTables::default(), base, soft_boxes: vec![], suns: vec![] }
    }

    /// The table of one α.
    pub fn alpha(&mut self, alpha: f64) -> Arc<AlbedoTable> {
        self.tables.of(alpha).unwrap()
    }

    /// A material, smooth for α = 0.
    pub fn material(&mut self, optics: Optics, alpha: f64) -> usize {
        let finish = if alpha > 0.0 { Finish::rough(self.alpha(alpha)) } else { Finish::SMOOTH };
        self.finished(optics, finish)
    }

    /// A material with a finish.
    pub fn finished(&mut self, optics: Optics, finish: Finish) -> usize {
        let hall = HallTerms {
            reflection_weight: 1.0,
            transmission_weight: 1.0,
            ambient_weight: 1.0,
            highlight_exponent: 10.0,
            specular_reflectance: None,
            specular_transmittance: None,
            ambient_reflectance: None,
        };
        self.builder.add_material(Material { optics, finish, hall })
    }

    /// A body of a smooth material of its own.
    pub fn add(&mut self, optics: Optics, shape: Shape) -> BodyId {
        self.add_rough(optics, 0.0, shape)
    }

    /// A body of a material of its own.
    pub fn add_rough(&mut self, optics: Optics, alpha: f64, shape: Shape) -> BodyId {
        let material = self.material(optics, alpha);
        self.place(material, 0, shape, DAffine3::IDENTITY)
    }

    /// A body of a material, with a priority and a transform.
    pub fn place(
        &mut self,
        material: usize,
        priority: i32,
        shape: Shape,
        to_world: DAffine3,
    ) -> BodyId {
        let body = Body { name: "body".into(), material, priority };
        let primitive = Primitive::new(shape, to_world).unwrap();
        self.builder.add_primitive(body, primitive).unwrap()
    }

    /// A mesh of a smooth material of its own.
    pub fn add_mesh(
        &mut self,
        optics: Optics,
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        normals: Option<&[[f64; 3]]>,
    ) -> BodyId {
        self.add_rough_mesh(optics, 0.0, vertices, triangles, normals)
    }

    /// A mesh of a material of its own.
    pub fn add_rough_mesh(
        &mut self,
        optics: Optics,
        alpha: f64,
        vertices: &[[f64; 3]],
        triangles: &[[u32; 3]],
        normals: Option<&[[f64; 3]]>,
    ) -> BodyId {
        let material = self.material(optics, alpha);
        let body = Body { name: "mesh".into(), material, priority: 0 };
        self.builder.add_mesh(body, vertices, triangles, normals).unwrap()
    }

    /// Let a body shine evenly, in the light group `group`.
    pub fn shine(&mut self, body: BodyId, strength: Strength, group: usize) {
        self.shine_as(body, strength, Distribution::Lambert, group);
    }

    /// Let a body shine.
    pub fn shine_as(
        &mut self,
        body: BodyId,
        strength: Strength,
        distribution: Distribution,
        group: usize,
    ) {
        self.builder.shine(body, Emission { group, strength, distribution });
    }

    /// A sun of one radiance, by the angular radius in degrees; light group 3.
    pub fn sun(&mut self, towards: DVec3, radius_deg: f64, radiance: SpectralTable) {
        self.suns.push(Sun::new(towards, radius_deg.to_radians(), radiance, 3));
    }

    /// The scene, seen by a camera. The surround is light group 0.
    pub fn seen_by(self, camera: Camera) -> Scene {
        let y = luminosity();
        let x = by_lane(|lane| lane as f64 / 120.0);
        let z = by_lane(|lane| (15 - lane) as f64 / 120.0);
        let background = Background::new(self.base, 0, self.soft_boxes, self.suns, &y);
        self.builder.build(camera, vec![], flat(0.0), background, [x, y, z]).unwrap()
    }

    /// The scene, seen along one line.
    pub fn along(self, from: DVec3, direction: DVec3) -> Scene {
        let (up, _) = orthonormal_pair(direction.normalize());
        let projection = Projection::Orthographic { height: 1e-6 };
        self.seen_by(Camera::new(from, from + direction, up, projection).unwrap())
    }
}

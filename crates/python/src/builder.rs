// SPDX-License-Identifier: Apache-2.0 OR MIT
//! `SceneBuilder`: a scene, piece by piece, from arrays.

use lamplit_core::geometry::{
    Cone, ConvexPolyhedron, Cylinder, Disc, Plane, Primitive, Shape, Sphere,
};
use lamplit_core::light::{Light, LightShape};
use lamplit_core::matter::{AlbedoTables, Finish, Material};
use lamplit_core::scene::{self, Body, Camera, Projection};
use lamplit_core::spectrum::SpectralTable;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{affine, direction, table, triples, vector, Spectrum, Triple};
use crate::background::Background;
use crate::emission::Emission;
use crate::material::{HallTerms, Matter};
use crate::render::Scene;
use crate::value_error;

/// A scene under construction. Spectra are arrays over all wavelengths in rising order.
#[pyclass(module = "lamplit._core")]
pub struct SceneBuilder {
    scene: scene::SceneBuilder,
    camera: Option<Camera>,
    lights: Vec<Light>,
    ambient: SpectralTable,
    background: Option<Background>,
    /// One per roughness.
    albedos: AlbedoTables,
}

impl SceneBuilder {
    fn finish(&mut self, roughness: f64, texture: Option<(Triple, f64)>) -> PyResult<Finish> {
        if roughness == 0.0 {
            return Ok(Finish::SMOOTH);
        }
        let finish = Finish::rough(self.albedos.of(roughness).map_err(value_error)?);
        Ok(match texture {
            None => finish,
            Some((facing, cos_within)) => finish.facing(direction(facing)?, cos_within),
        })
    }
}

/// The name, material number and priority of a body.
type BodyTuple = (String, usize, i32);

fn body((name, material, priority): BodyTuple) -> Body {
    Body { name, material, priority }
}

#[pymethods]
impl SceneBuilder {
    /// An empty scene for spectra of `count` values: black, without a camera.
    #[new]
    fn new(count: usize) -> PyResult<Self> {
        let black = SpectralTable::from_ascending(&vec![0.0; count]).map_err(value_error)?;
        Ok(Self {
            scene: scene::SceneBuilder::default(),
            camera: None,
            lights: Vec::new(),
            ambient: black,
            background: None,
            albedos: AlbedoTables::default(),
        })
    }

    /// Add a material and return its number. `texture`, a direction and the cosine of an angle round
    /// it, says which faces have the roughness.
    #[pyo3(signature = (matter, hall, *, roughness=0.0, texture=None))]
    fn add_material(
        &mut self,
        matter: &Matter,
        hall: &HallTerms,
        roughness: f64,
        texture: Option<(Triple, f64)>,
    ) -> PyResult<usize> {
        let finish = self.finish(roughness, texture)?;
        let (optics, hall) = (matter.0.clone(), hall.0.clone());
        Ok(self.scene.add_material(Material { optics, finish, hall }))
    }

    /// Add a mesh and return the body's number.
    #[pyo3(signature = (owner, vertices_mm, triangles, normals=None))]
    fn add_mesh(
        &mut self,
        py: Python<'_>,
        owner: BodyTuple,
        vertices_mm: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, u32>,
        normals: Option<PyReadonlyArray2<'_, f64>>,
    ) -> PyResult<u32> {
        let (vertices, triangles) = (triples(&vertices_mm)?, triples(&triangles)?);
        let normals = normals.as_ref().map(|array| triples(array)).transpose()?;
        py.detach(|| self.scene.add_mesh(body(owner), &vertices, &triangles, normals.as_deref()))
            .map_err(value_error)
    }

    /// Add a primitive and return the body's number: `numbers` are its defining points and lengths, in the order of the core's
    /// constructor of that `kind`.
    fn add_primitive(
        &mut self,
        owner: BodyTuple,
        kind: &str,
        numbers: Vec<f64>,
        transform: [[f64; 4]; 4],
    ) -> PyResult<u32> {
        let shape = shape(kind, &numbers)?;
        let primitive = Primitive::new(shape, affine(transform)).map_err(value_error)?;
        self.scene.add_primitive(body(owner), primitive).map_err(value_error)
    }

    /// Let a body shine, counted to a light group.
    fn add_emission(&mut self, body: u32, emission: &Emission, group: usize) {
        let emission = scene::Emission { group, ..emission.0.clone() };
        self.scene.shine(body, emission);
    }

    /// `lens` is the diameter of a thin lens and the distance that is in focus, in mm.
    #[pyo3(signature = (
        position_mm, target_mm, up, *, field_of_view_deg=None, height_mm=None, lens_mm=None
    ))]
    fn set_camera(
        &mut self,
        position_mm: Triple,
        target_mm: Triple,
        up: Triple,
        field_of_view_deg: Option<f64>,
        height_mm: Option<f64>,
        lens_mm: Option<(f64, f64)>,
    ) -> PyResult<()> {
        let view = (position_mm, target_mm, up);
        self.camera = Some(camera(view, field_of_view_deg, height_mm, lens_mm)?);
        Ok(())
    }

    fn add_point_light(&mut self, strength: Spectrum<'_>, position_mm: Triple) -> PyResult<()> {
        let shape = LightShape::Point { position: vector(position_mm) };
        self.lights.push(Light { shape, strength: table(&strength)? });
        Ok(())
    }

    fn add_directional_light(&mut self, strength: Spectrum<'_>, travels: Triple) -> PyResult<()> {
        let shape = LightShape::Directional { travels: direction(travels)? };
        self.lights.push(Light { shape, strength: table(&strength)? });
        Ok(())
    }

    fn add_sphere_light(
        &mut self,
        strength: Spectrum<'_>,
        centre_mm: Triple,
        radius_mm: f64,
    ) -> PyResult<()> {
        let shape = LightShape::Sphere { centre: vector(centre_mm), radius: radius_mm };
        self.lights.push(Light { shape, strength: table(&strength)? });
        Ok(())
    }

    fn set_ambient(&mut self, strength: Spectrum<'_>) -> PyResult<()> {
        self.ambient = table(&strength)?;
        Ok(())
    }

    fn set_background(&mut self, background: &Background) {
        self.background = Some(background.clone());
    }

    /// Build the scene; the builder is empty afterwards. The three spectra's inner products with a
    /// path's spectral radiance are X, Y and Z in cd/m²; `groups` are the names of the light groups.
    fn build(
        &mut self,
        py: Python<'_>,
        colour_matching: [Spectrum<'_>; 3],
        groups: Vec<String>,
    ) -> PyResult<Scene> {
        let camera = self.camera.ok_or_else(|| value_error("the scene has no camera"))?;
        let [x, y, z] = colour_matching;
        let colour_matching = [table(&x)?, table(&y)?, table(&z)?];
        let background = self.background.as_ref();
        let background = background.ok_or_else(|| value_error("the scene has no background"))?;
        let background = background.assembled(&colour_matching[1]);
        let mut builder = std::mem::take(&mut self.scene);
        builder.groups = groups.len();
        let lights = std::mem::take(&mut self.lights);
        let ambient = self.ambient.clone();
        py.detach(|| builder.build(camera, lights, ambient, background, colour_matching))
            .map(|scene| Scene::new(scene, groups))
            .map_err(value_error)
    }
}

/// A camera by its position, its target and what is up, and by what says how it projects.
pub fn camera(
    (position_mm, target_mm, up): (Triple, Triple, Triple),
    field_of_view_deg: Option<f64>,
    height_mm: Option<f64>,
    lens_mm: Option<(f64, f64)>,
) -> PyResult<Camera> {
    let projection = match (field_of_view_deg, height_mm, lens_mm) {
        (Some(field_of_view_deg), None, None) => Projection::Pinhole { field_of_view_deg },
        (Some(field_of_view_deg), None, Some((aperture, focus))) => {
            Projection::ThinLens { field_of_view_deg, aperture, focus }
        }
        (None, Some(height), None) => Projection::Orthographic { height },
        _ => return Err(value_error("give field_of_view_deg or height_mm, and not both")),
    };
    let [position, target, up] = [position_mm, target_mm, up].map(vector);
    Camera::new(position, target, up, projection).map_err(value_error)
}

fn shape(kind: &str, numbers: &[f64]) -> PyResult<Shape> {
    let point = |at: usize| match numbers.get(3 * at..3 * at + 3) {
        Some(&[x, y, z]) => Ok(vector([x, y, z])),
        _ => Err(value_error(format!("a {kind} needs more numbers than {}", numbers.len()))),
    };
    let length = |from_end: usize| {
        let at = numbers.len().checked_sub(from_end);
        at.and_then(|at| numbers.get(at).copied())
            .ok_or_else(|| value_error(format!("a {kind} needs more numbers")))
    };
    let shape = match kind {
        "sphere" => Sphere::new(point(0)?, length(1)?).map(Shape::Sphere),
        "tetrahedron" => {
            let points = [point(0)?, point(1)?, point(2)?, point(3)?];
            ConvexPolyhedron::tetrahedron(points).map(Shape::Polyhedron)
        }
        "box" => ConvexPolyhedron::cuboid(point(0)?, point(1)?).map(Shape::Polyhedron),
        "plane" => Plane::new(point(0)?, point(1)?).map(Shape::Plane),
        "disc" => Disc::new(point(0)?, point(1)?, length(1)?).map(Shape::Disc),
        "cylinder" => {
            Cylinder::new(point(0)?, point(1)?, length(2)?, length(1)?).map(Shape::Cylinder)
        }
        "cone" => Cone::new(point(0)?, point(1)?, length(2)?, length(1)?).map(Shape::Cone),
        _ => return Err(value_error(format!("there is no primitive of kind {kind:?}"))),
    };
    shape.map_err(value_error)
}

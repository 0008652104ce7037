// SPDX-License-Identifier: Apache-2.0 OR MIT
//! `SceneBuilder`: a scene, piece by piece, from arrays.

use lamplit_core::geometry::{
    Cone, ConvexPolyhedron, Cylinder, Disc, Plane, Primitive, Shape, Sphere,
};
use lamplit_core::light::{Background, Base, Light, LightShape, SoftBox};
use lamplit_core::matter::{self, Checker, Dielectric, Finish, Material, Optics};
use lamplit_core::scene::{self, Body, Camera, Projection};
use lamplit_core::spectrum::SpectralTable;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{affine, table, triples, vector, Triple};
use crate::render::Scene;
use crate::value_error;

type Spectrum<'py> = PyReadonlyArray1<'py, f64>;

/// The weights k and spectra F of Hall's model for one material.
#[pyclass(frozen, module = "lamplit._core")]
pub struct HallTerms(matter::HallTerms);

#[pymethods]
impl HallTerms {
    #[new]
    #[pyo3(signature = (*, k_sr, k_st, k_sa, highlight_exponent, f_sr=None, f_st=None, f_sa=None))]
    fn new(
        k_sr: f64,
        k_st: f64,
        k_sa: f64,
        highlight_exponent: f64,
        f_sr: Option<Spectrum<'_>>,
        f_st: Option<Spectrum<'_>>,
        f_sa: Option<Spectrum<'_>>,
    ) -> PyResult<Self> {
        let optional = |values: Option<Spectrum<'_>>| values.as_ref().map(table).transpose();
        Ok(Self(matter::HallTerms {
            reflection_weight: k_sr,
            transmission_weight: k_st,
            ambient_weight: k_sa,
            highlight_exponent,
            specular_reflectance: optional(f_sr)?,
            specular_transmittance: optional(f_st)?,
            ambient_reflectance: optional(f_sa)?,
        }))
    }
}

/// A scene under construction. Spectra are arrays over all wavelengths in rising order.
#[pyclass(module = "lamplit._core")]
pub struct SceneBuilder {
    scene: scene::SceneBuilder,
    camera: Option<Camera>,
    lights: Vec<Light>,
    ambient: SpectralTable,
    base: Base,
    soft_boxes: Vec<SoftBox>,
}

impl SceneBuilder {
    fn material(&mut self, optics: Optics, hall: &HallTerms) -> usize {
        self.scene.add_material(Material { optics, finish: Finish::SMOOTH, hall: hall.0.clone() })
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
            ambient: black.clone(),
            base: Base::Constant(black),
            soft_boxes: Vec::new(),
        })
    }

    fn add_dielectric(
        &mut self,
        index: Spectrum<'_>,
        index_d: f64,
        absorption_per_mm: Spectrum<'_>,
        hall: &HallTerms,
    ) -> PyResult<usize> {
        let (index, absorption) = (table(&index)?, table(&absorption_per_mm)?);
        let body = Dielectric { index, index_d, absorption, scattering: None };
        Ok(self.material(Optics::Dielectric(body), hall))
    }

    fn add_conductor(
        &mut self,
        n: Spectrum<'_>,
        k: Spectrum<'_>,
        factor: f64,
        hall: &HallTerms,
    ) -> PyResult<usize> {
        let (n, k) = (table(&n)?, table(&k)?);
        Ok(self.material(Optics::Conductor { n, k, factor, lacquer: None }, hall))
    }

    fn add_mirror(&mut self, reflectance: Spectrum<'_>, hall: &HallTerms) -> PyResult<usize> {
        let optics = Optics::Mirror(table(&reflectance)?);
        Ok(self.material(optics, hall))
    }

    fn add_diffuse(&mut self, reflectance: Spectrum<'_>, hall: &HallTerms) -> PyResult<usize> {
        let optics = Optics::Diffuse(table(&reflectance)?);
        Ok(self.material(optics, hall))
    }

    fn add_checker(
        &mut self,
        first: Spectrum<'_>,
        second: Spectrum<'_>,
        square_mm: f64,
        hall: &HallTerms,
    ) -> PyResult<usize> {
        let (first, second) = (table(&first)?, table(&second)?);
        Ok(self.material(Optics::Checker(Checker { first, second, square: square_mm }), hall))
    }

    fn add_glossy(
        &mut self,
        index: Spectrum<'_>,
        reflectance: Spectrum<'_>,
        hall: &HallTerms,
    ) -> PyResult<usize> {
        let (index, base) = (table(&index)?, table(&reflectance)?);
        Ok(self.material(Optics::Glossy { index, base }, hall))
    }

    #[pyo3(signature = (owner, vertices_mm, triangles, normals=None))]
    fn add_mesh(
        &mut self,
        py: Python<'_>,
        owner: BodyTuple,
        vertices_mm: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, u32>,
        normals: Option<PyReadonlyArray2<'_, f64>>,
    ) -> PyResult<()> {
        let (vertices, triangles) = (triples(&vertices_mm)?, triples(&triangles)?);
        let normals = normals.as_ref().map(|array| triples(array)).transpose()?;
        py.detach(|| self.scene.add_mesh(body(owner), &vertices, &triangles, normals.as_deref()))
            .map_err(value_error)
    }

    /// Add a primitive: `numbers` are its defining points and lengths, in the order of the core's
    /// constructor of that `kind`.
    fn add_primitive(
        &mut self,
        owner: BodyTuple,
        kind: &str,
        numbers: Vec<f64>,
        transform: [[f64; 4]; 4],
    ) -> PyResult<()> {
        let shape = shape(kind, &numbers)?;
        let primitive = Primitive::new(shape, affine(transform)).map_err(value_error)?;
        self.scene.add_primitive(body(owner), primitive).map_err(value_error)
    }

    #[pyo3(signature = (position_mm, target_mm, up, *, field_of_view_deg=None, height_mm=None))]
    fn set_camera(
        &mut self,
        position_mm: Triple,
        target_mm: Triple,
        up: Triple,
        field_of_view_deg: Option<f64>,
        height_mm: Option<f64>,
    ) -> PyResult<()> {
        let projection = match (field_of_view_deg, height_mm) {
            (Some(field_of_view_deg), None) => Projection::Pinhole { field_of_view_deg },
            (None, Some(height)) => Projection::Orthographic { height },
            _ => return Err(value_error("give field_of_view_deg or height_mm, and not both")),
        };
        let [position, target, up] = [position_mm, target_mm, up].map(vector);
        self.camera = Some(Camera::new(position, target, up, projection).map_err(value_error)?);
        Ok(())
    }

    fn add_point_light(&mut self, strength: Spectrum<'_>, position_mm: Triple) -> PyResult<()> {
        let shape = LightShape::Point { position: vector(position_mm) };
        self.lights.push(Light { shape, strength: table(&strength)? });
        Ok(())
    }

    fn add_directional_light(&mut self, strength: Spectrum<'_>, direction: Triple) -> PyResult<()> {
        let travels = vector(direction)
            .try_normalize()
            .ok_or_else(|| value_error("the direction of a light must not be zero"))?;
        let shape = LightShape::Directional { travels };
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

    fn set_constant_background(&mut self, radiance: Spectrum<'_>) -> PyResult<()> {
        self.base = Base::Constant(table(&radiance)?);
        Ok(())
    }

    fn set_gradient_background(
        &mut self,
        zenith: Spectrum<'_>,
        nadir: Spectrum<'_>,
    ) -> PyResult<()> {
        self.base = Base::Gradient { zenith: table(&zenith)?, nadir: table(&nadir)? };
        Ok(())
    }

    /// Add a luminous rectangle whose front is on the side of `half_width` × `half_height`.
    fn add_soft_box(
        &mut self,
        radiance: Spectrum<'_>,
        centre_mm: Triple,
        half_width_mm: Triple,
        half_height_mm: Triple,
        edge_softness: f64,
    ) -> PyResult<()> {
        self.soft_boxes.push(SoftBox {
            centre: vector(centre_mm),
            half_width: vector(half_width_mm),
            half_height: vector(half_height_mm),
            radiance: table(&radiance)?,
            edge_softness,
        });
        Ok(())
    }

    /// Build the scene; the builder is empty afterwards. The three spectra's inner products with a
    /// path's spectral radiance are X, Y and Z in cd/m².
    fn build(&mut self, py: Python<'_>, colour_matching: [Spectrum<'_>; 3]) -> PyResult<Scene> {
        let camera = self.camera.ok_or_else(|| value_error("the scene has no camera"))?;
        let [x, y, z] = colour_matching;
        let colour_matching = [table(&x)?, table(&y)?, table(&z)?];
        let builder = std::mem::take(&mut self.scene);
        let lights = std::mem::take(&mut self.lights);
        let soft_boxes = std::mem::take(&mut self.soft_boxes);
        let background = Background { base: self.base.clone(), soft_boxes };
        let ambient = self.ambient.clone();
        py.detach(|| builder.build(camera, lights, ambient, background, colour_matching))
            .map(Scene::from)
            .map_err(value_error)
    }
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

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! `Scene.render`: renders on threads of its own while Python watches and may interrupt.

use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard};
use std::time::Duration;

use lamplit_core::render::{features, learn, render, Method, RenderSettings};
use lamplit_core::sampling::{PixelFilter, PixelSequence};
use lamplit_core::scene;
use lamplit_core::transport::{Guide, HallSettings, PathSettings};
use numpy::PyArray3;
use pyo3::prelude::*;

use crate::arrays::{shaped, Triple};
use crate::builder::camera;
use crate::outcome::Render;
use crate::preview::Preview;
use crate::value_error;
use crate::watch::watch;

/// A scene ready to be rendered.
#[pyclass(frozen, module = "lamplit._core")]
pub struct Scene {
    scene: RwLock<scene::Scene>,
    pub groups: Vec<String>,
}

impl Scene {
    /// A scene with the names of its light groups.
    pub fn new(scene: scene::Scene, groups: Vec<String>) -> Self {
        Self { scene: RwLock::new(scene), groups }
    }

    /// The scene, as it is seen now.
    pub fn world(&self) -> RwLockReadGuard<'_, scene::Scene> {
        self.scene.read().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The founding method, and how far it goes.
#[pyclass(frozen, module = "lamplit._core")]
pub struct HallMethod(HallSettings);

#[pymethods]
impl HallMethod {
    #[new]
    #[pyo3(signature = (*, max_depth, contribution_limit, dispersion_groups, shadows))]
    fn new(
        max_depth: u32,
        contribution_limit: f64,
        dispersion_groups: usize,
        shadows: bool,
    ) -> Self {
        Self(HallSettings { max_depth, contribution_limit, dispersion_groups, shadows })
    }
}

/// Path transport, and how its walks are spent.
#[pyclass(frozen, module = "lamplit._core")]
pub struct PathMethod(pub PathSettings);

#[pymethods]
impl PathMethod {
    #[new]
    #[pyo3(signature = (*, max_depth, split_depth, roulette_below))]
    fn new(max_depth: u32, split_depth: u32, roulette_below: f64) -> Self {
        Self(PathSettings { max_depth, split_depth, roulette_below })
    }
}

/// Path transport by walks that know where light comes from.
#[pyclass(frozen, module = "lamplit._core")]
pub struct LitMethod {
    path: PathSettings,
    guide: Option<Arc<Guide>>,
}

#[pymethods]
impl LitMethod {
    /// Spend walks as `path` says. What `guide` knows is used; without it, each rendering learns anew.
    #[new]
    #[pyo3(signature = (path, guide=None))]
    fn new(path: &PathMethod, guide: Option<&LightGuide>) -> Self {
        Self { path: path.0, guide: guide.map(|guide| guide.0.clone()) }
    }
}

/// Where the light of what shines in a scene comes from.
#[pyclass(frozen, module = "lamplit._core")]
pub struct LightGuide(Arc<Guide>);

#[pymethods]
impl LightGuide {
    /// Learn it from walks of the light, spent as `path` says.
    #[new]
    #[pyo3(signature = (scene, path, *, seed=1, threads=0))]
    fn new(
        py: Python<'_>,
        scene: &Scene,
        path: &PathMethod,
        seed: u64,
        threads: usize,
    ) -> PyResult<Self> {
        let learned = py.detach(|| {
            let world = scene.world();
            learn(&world, path.0, seed, threads)
        });
        Ok(Self(Arc::new(learned.map_err(value_error)?)))
    }
}

/// Any method.
#[derive(FromPyObject)]
enum AnyMethod<'py> {
    Hall(PyRef<'py, HallMethod>),
    Path(PyRef<'py, PathMethod>),
    Lit(PyRef<'py, LitMethod>),
}

#[pymethods]
impl Scene {
    /// The memory of the triangles and their hierarchy, in bytes.
    #[getter]
    fn memory_bytes(&self) -> usize {
        self.world().memory_bytes()
    }

    /// The lower and the upper corner, in mm, of the box round all bodies but endless planes.
    #[getter]
    fn bounds_mm(&self) -> Option<(Triple, Triple)> {
        self.world().bounds().map(|[lo, hi]| (lo.to_array(), hi.to_array()))
    }

    /// See the scene by another camera from now on, as `SceneBuilder.set_camera` says.
    #[pyo3(signature = (
        position_mm, target_mm, up, *, field_of_view_deg=None, height_mm=None, lens_mm=None
    ))]
    fn look(
        &self,
        position_mm: Triple,
        target_mm: Triple,
        up: Triple,
        field_of_view_deg: Option<f64>,
        height_mm: Option<f64>,
        lens_mm: Option<(f64, f64)>,
    ) -> PyResult<()> {
        let view = (position_mm, target_mm, up);
        let camera = camera(view, field_of_view_deg, height_mm, lens_mm)?;
        self.scene.write().unwrap_or_else(PoisonError::into_inner).camera = camera;
        Ok(())
    }

    /// Render samples `first_sample`..`first_sample + samples` of every pixel.
    ///
    /// `progress(done, total)` is called a few times a second with counts of samples over all
    /// pixels, and `preview(xyz, standard_error, samples, outlook)` every two seconds or more with
    /// the picture so far, (height, width, 3), and its count of samples. The outlook is None where the
    /// end is not known; else it is the share of the work that is done, and what each standard error
    /// will be multiplied with, (height, width). If one of them raises, or a signal arrives, the
    /// rendering stops and what is done comes back with `interrupted` set.
    ///
    /// `counts` are samples from `first_sample` on for each pixel, row by row: they stand in for
    /// `samples`, `adaptive`, `target_error` and `time_budget_s`.
    #[pyo3(signature = (
        width, height, samples, method, *, first_sample=0, adaptive=false, target_error=None, time_budget_s=None,
        counts=None,
        sampling="sobol", filter="gaussian", seed=1, bands_per_lane=0, layers=false, threads=0,
        tile=64, progress=None, preview=None
    ))]
    fn render(
        &self,
        py: Python<'_>,
        width: u32,
        height: u32,
        samples: u32,
        method: AnyMethod<'_>,
        first_sample: u32,
        adaptive: bool,
        target_error: Option<f64>,
        time_budget_s: Option<f64>,
        counts: Option<Vec<u32>>,
        sampling: &str,
        filter: &str,
        seed: u64,
        bands_per_lane: usize,
        layers: bool,
        threads: usize,
        tile: usize,
        progress: Option<Py<PyAny>>,
        preview: Option<Py<PyAny>>,
    ) -> PyResult<Render> {
        let time_budget = time_budget_s.map(Duration::try_from_secs_f64).transpose();
        let guide = match &method {
            AnyMethod::Lit(lit) => lit.guide.clone(),
            _ => None,
        };
        let settings = RenderSettings {
            width,
            height,
            samples: first_sample..first_sample.saturating_add(samples),
            counts,
            adaptive,
            target_error,
            time_budget: time_budget.map_err(value_error)?,
            sequence: sequence(sampling, samples)?,
            filter: pixel_filter(filter)?,
            seed,
            method: match &method {
                AnyMethod::Hall(hall) => Method::Hall(hall.0),
                AnyMethod::Path(path) => Method::Path(path.0),
                AnyMethod::Lit(lit) => Method::Lit(lit.path),
            },
            guide,
            bands_per_lane,
            layers,
            threads,
            tile,
        };
        let (outcome, interrupted) =
            watch(py, progress.as_ref(), Preview::new(preview.as_ref()), |progress| {
                render(&self.world(), &settings, progress)
            })?;
        let rendered = outcome.map_err(value_error)?;
        let bodies = self.world().bodies.iter().map(|body| body.name.clone()).collect();
        Ok(Render::new(rendered, bodies, self.groups.clone(), interrupted))
    }

    /// What each pixel looks at, (height, width, 9): depth in mm, the normal's three components,
    /// the albedo's X, Y and Z, the number of interfaces, and the body's number or −1.
    #[pyo3(signature = (width, height, *, threads=0))]
    fn features<'py>(
        &self,
        py: Python<'py>,
        width: u32,
        height: u32,
        threads: usize,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let found = py.detach(|| features(&self.world(), width, height, threads));
        let rows = found.map_err(value_error)?.into_iter().flat_map(|seen| {
            let ([x, y, z], [r, g, b]) = (seen.normal.to_array(), seen.albedo);
            let body = seen.body.map_or(-1.0, f64::from);
            [seen.depth, x, y, z, r, g, b, seen.interfaces, body]
        });
        shaped(py, rows.collect(), [height as usize, width as usize, 9])
    }
}

fn sequence(name: &str, samples: u32) -> PyResult<PixelSequence> {
    match name {
        "grid" => PixelSequence::grid(samples).map_err(value_error),
        "sobol" => Ok(PixelSequence::Sobol),
        _ => Err(value_error(format!("there is no sampling {name:?}"))),
    }
}

fn pixel_filter(name: &str) -> PyResult<PixelFilter> {
    match name {
        "box" => Ok(PixelFilter::Box),
        "tent" => Ok(PixelFilter::Tent),
        "gaussian" => Ok(PixelFilter::Gaussian),
        _ => Err(value_error(format!("there is no pixel filter {name:?}"))),
    }
}

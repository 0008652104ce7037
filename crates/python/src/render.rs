// SPDX-License-Identifier: Apache-2.0 OR MIT
//! `Scene.render`: renders on threads of its own while Python watches and may interrupt.

use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{channel, RecvTimeoutError};
use std::time::Duration;

use lamplit_core::film::{Film, PixelSums};
use lamplit_core::render::{render, Progress, RenderError, RenderSettings};
use lamplit_core::sampling::{PixelFilter, PixelSequence};
use lamplit_core::scene;
use lamplit_core::transport::{HallSettings, Tally};
use numpy::{PyArray2, PyArray3};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::shaped;
use crate::value_error;

/// How often Python is asked whether to go on.
const WATCH_INTERVAL: Duration = Duration::from_millis(50);

/// A scene ready to be rendered.
#[pyclass(frozen, module = "lamplit._core")]
pub struct Scene(scene::Scene);

impl From<scene::Scene> for Scene {
    fn from(scene: scene::Scene) -> Self {
        Self(scene)
    }
}

/// What a rendering brought.
#[pyclass(frozen, module = "lamplit._core")]
pub struct Render {
    film: Film,
    tally: Tally,
    body_names: Vec<String>,
    interrupted: bool,
}

#[pymethods]
impl Scene {
    /// The memory of the triangles and their hierarchy, in bytes.
    #[getter]
    fn memory_bytes(&self) -> usize {
        self.0.memory_bytes()
    }

    /// Render samples `first_sample`..`first_sample + samples` of every pixel.
    ///
    /// `progress(done, total)` is called a few times a second with counts of samples over all
    /// pixels. If it raises, or a signal arrives, the rendering stops and what is done comes back
    /// with `interrupted` set.
    #[pyo3(signature = (
        width, height, samples, *, first_sample=0, sampling="grid", filter="gaussian", seed=1,
        max_depth=12, contribution_limit=1e-4, dispersion_groups=1, shadows=true,
        bands_per_lane=0, threads=0, tile=64, progress=None
    ))]
    fn render(
        &self,
        py: Python<'_>,
        width: u32,
        height: u32,
        samples: u32,
        first_sample: u32,
        sampling: &str,
        filter: &str,
        seed: u64,
        max_depth: u32,
        contribution_limit: f64,
        dispersion_groups: usize,
        shadows: bool,
        bands_per_lane: usize,
        threads: usize,
        tile: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Render> {
        let settings = RenderSettings {
            width,
            height,
            samples: first_sample..first_sample.saturating_add(samples),
            sequence: sequence(sampling, samples)?,
            filter: pixel_filter(filter)?,
            seed,
            hall: HallSettings { max_depth, contribution_limit, dispersion_groups, shadows },
            bands_per_lane,
            threads,
            tile,
        };
        let (outcome, interrupted) = watch(py, &self.0, &settings, progress.as_ref())?;
        let (film, tally) = outcome.map_err(value_error)?;
        let body_names = self.0.bodies.iter().map(|body| body.name.clone()).collect();
        Ok(Render { film, tally, body_names, interrupted })
    }
}

type Outcome = Result<(Film, Tally), RenderError>;

/// Render on another thread; ask Python every now and then whether to go on.
fn watch(
    py: Python<'_>,
    scene: &scene::Scene,
    settings: &RenderSettings,
    callback: Option<&Py<PyAny>>,
) -> PyResult<(Outcome, bool)> {
    let progress = Progress::default();
    let pixels = u64::from(settings.width) * u64::from(settings.height);
    let total = pixels * u64::from(settings.samples.end - settings.samples.start);
    let mut interrupted = false;
    let mut fault = None;
    let watched = &progress;
    let outcome = py.detach(|| {
        let (send, receive) = channel();
        std::thread::scope(|scope| {
            scope.spawn(move || {
                let result = catch_unwind(AssertUnwindSafe(|| render(scene, settings, watched)));
                // The receiver outlives this thread, so that sending cannot fail.
                let _ = send.send(result);
            });
            loop {
                match receive.recv_timeout(WATCH_INTERVAL) {
                    Ok(result) => return result.ok(),
                    Err(RecvTimeoutError::Disconnected) => return None,
                    Err(RecvTimeoutError::Timeout) if progress.is_cancelled() => {}
                    Err(RecvTimeoutError::Timeout) => {
                        let asked = Python::attach(|py| {
                            py.check_signals()?;
                            let done = progress.done.load(Ordering::Relaxed);
                            callback.map(|call| call.call1(py, (done, total))).transpose()
                        });
                        if let Err(error) = asked {
                            interrupted = Python::attach(|py| {
                                error.is_instance_of::<pyo3::exceptions::PyKeyboardInterrupt>(py)
                            });
                            fault = (!interrupted).then_some(error);
                            progress.cancelled.store(true, Ordering::Relaxed);
                        }
                    }
                }
            }
        })
    });
    match (outcome, fault) {
        (_, Some(fault)) => Err(fault),
        (Some(outcome), None) => Ok((outcome, interrupted)),
        (None, None) => Err(PyRuntimeError::new_err("the renderer stopped on a fault of its own")),
    }
}

fn sequence(name: &str, samples: u32) -> PyResult<PixelSequence> {
    match name {
        "grid" => PixelSequence::grid(samples).map_err(value_error),
        "sobol" if samples <= PixelSequence::MOST_SAMPLES => Ok(PixelSequence::Sobol),
        "sobol" => Err(value_error(format!(
            "a pixel takes at most {} samples, not {samples}",
            PixelSequence::MOST_SAMPLES
        ))),
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

#[pymethods]
impl Render {
    /// Whether a signal stopped it.
    #[getter]
    fn interrupted(&self) -> bool {
        self.interrupted
    }

    /// Mean X, Y and Z in cd/m², (height, width, 3).
    fn xyz<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let values = self.film.pixels.iter().flat_map(PixelSums::mean).collect();
        shaped(py, values, self.shape(3))
    }

    /// The standard errors of X, Y and Z in cd/m², (height, width, 3); infinite below two samples.
    fn xyz_standard_error<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let values = self.film.pixels.iter().flat_map(PixelSums::standard_error).collect();
        shaped(py, values, self.shape(3))
    }

    /// How many samples each pixel has, (height, width).
    fn samples<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let values = self.film.pixels.iter().map(|pixel| pixel.samples).collect();
        shaped(py, values, [self.film.height as usize, self.film.width as usize])
    }

    /// The mean spectral radiance per band, (height, width, bands), in W·m⁻²·sr⁻¹·nm⁻¹.
    fn spectral_radiance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        shaped(py, self.film.band_means(), self.shape(self.film.bands()))
    }

    /// The counts of the tally, and lost rays by body and cause.
    fn statistics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        const CAUSES: [&str; 4] =
            ["left_without_entering", "entered_twice", "ended_inside", "too_many_bodies"];
        let lost = PyDict::new(py);
        for (name, counts) in self.body_names.iter().zip(&self.tally.lost) {
            let by_cause = PyDict::new(py);
            for (cause, count) in CAUSES.into_iter().zip(counts).filter(|(_, count)| **count > 0) {
                by_cause.set_item(cause, count)?;
            }
            if !by_cause.is_empty() {
                lost.set_item(name, by_cause)?;
            }
        }
        let statistics = PyDict::new(py);
        statistics.set_item("eye_rays", self.tally.eye_rays)?;
        statistics.set_item("shadow_rays", self.tally.shadow_rays)?;
        statistics.set_item("cut_by_depth", self.tally.cut_by_depth)?;
        statistics.set_item("cut_by_contribution", self.tally.cut_by_contribution)?;
        statistics.set_item("dropped_samples", self.tally.dropped_samples)?;
        if let Some((pixel, sample)) = self.tally.first_dropped {
            statistics.set_item("first_dropped_sample", (pixel, sample))?;
        }
        statistics.set_item("lost_rays", lost)?;
        Ok(statistics)
    }
}

impl Render {
    fn shape(&self, depth: usize) -> [usize; 3] {
        [self.film.height as usize, self.film.width as usize, depth]
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! `Render`: what a rendering brought, as arrays.

use lamplit_core::film::PixelSums;
use lamplit_core::render::{Found, Rendered};
use lamplit_core::transport::Tally;
use numpy::{PyArray2, PyArray3, PyArray4};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::shaped;

/// What a rendering brought.
#[pyclass(frozen, module = "lamplit._core")]
pub struct Render {
    rendered: Rendered,
    body_names: Vec<String>,
    groups: Vec<String>,
    interrupted: bool,
}

impl Render {
    /// What the core rendered, with the names of bodies and light groups.
    pub fn new(
        rendered: Rendered,
        body_names: Vec<String>,
        groups: Vec<String>,
        interrupted: bool,
    ) -> Self {
        Self { rendered, body_names, groups, interrupted }
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
        let values = self.rendered.film.pixels.iter().flat_map(PixelSums::mean).collect();
        shaped(py, values, self.shape(3))
    }

    /// The standard errors of X, Y and Z in cd/m², (height, width, 3); infinite below two samples.
    fn xyz_standard_error<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let values = self.rendered.film.pixels.iter().flat_map(PixelSums::standard_error).collect();
        shaped(py, values, self.shape(3))
    }

    /// How many samples each pixel has, (height, width).
    fn samples<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let values = self.rendered.film.pixels.iter().map(|pixel| pixel.samples).collect();
        shaped(py, values, [self.rendered.film.height as usize, self.rendered.film.width as usize])
    }

    /// The mean spectral radiance per band, (height, width, bands), in W·m⁻²·sr⁻¹·nm⁻¹.
    fn spectral_radiance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        shaped(py, self.rendered.film.band_means(), self.shape(self.rendered.film.bands()))
    }

    /// The names of the light groups that have sums of their own.
    #[getter]
    fn groups(&self) -> Vec<String> {
        let kept = self.rendered.film.layers;
        self.groups.iter().take(kept).cloned().collect()
    }

    /// Mean X, Y and Z in cd/m² of each light group, (groups, height, width, 3).
    fn layers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray4<f64>>> {
        self.of_layers(py, PixelSums::mean)
    }

    /// Their standard errors, (groups, height, width, 3).
    fn layers_standard_error<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray4<f64>>> {
        self.of_layers(py, PixelSums::standard_error)
    }

    /// Where the weight of the walks went, as shares: `escaped`, `cut_by_depth`, `lost`, `chance`,
    /// `gap`, and `absorbed` by body. None for a method that keeps no ledger.
    fn ledger<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(balance) = self.rendered.tally.ledger.balance() else {
            return Ok(None);
        };
        let absorbed = PyDict::new(py);
        for (name, share) in self.body_names.iter().zip(&balance.absorbed) {
            absorbed.set_item(name, share)?;
        }
        let shares = PyDict::new(py);
        shares.set_item("escaped", balance.escaped)?;
        shares.set_item("absorbed", absorbed)?;
        shares.set_item("cut_by_depth", balance.cut_by_depth)?;
        shares.set_item("lost", balance.lost)?;
        shares.set_item("chance", balance.chance)?;
        shares.set_item("gap", balance.gap())?;
        Ok(Some(shares))
    }

    /// The parts of the mean luminance in cd/m², by how they were found: `by_eye`; or `specular`,
    /// `scattered` and `landed`.
    fn found<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let parts = PyDict::new(py);
        for (how, luminance) in &self.rendered.found {
            let name = match how {
                Found::ByEye => "by_eye",
                Found::Specular => "specular",
                Found::Scattered => "scattered",
                Found::Landed => "landed",
            };
            parts.set_item(name, luminance)?;
        }
        Ok(parts)
    }

    /// The counts of the tally, and lost rays by body and cause.
    fn statistics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let lost = lost_rays(py, &self.rendered.tally, &self.body_names)?;
        let statistics = PyDict::new(py);
        statistics.set_item("eye_rays", self.rendered.tally.eye_rays)?;
        statistics.set_item("shadow_rays", self.rendered.tally.shadow_rays)?;
        statistics.set_item("cut_by_depth", self.rendered.tally.cut_by_depth)?;
        statistics.set_item("cut_by_contribution", self.rendered.tally.cut_by_contribution)?;
        statistics.set_item("dropped_samples", self.rendered.tally.dropped_samples)?;
        if let Some((pixel, sample)) = self.rendered.tally.first_dropped {
            statistics.set_item("first_dropped_sample", (pixel, sample))?;
        }
        statistics.set_item("lost_rays", lost)?;
        Ok(statistics)
    }
}

/// How many rays were lost, by body and cause.
pub fn lost_rays<'py>(
    py: Python<'py>,
    tally: &Tally,
    body_names: &[String],
) -> PyResult<Bound<'py, PyDict>> {
    const CAUSES: [&str; 4] =
        ["left_without_entering", "entered_twice", "ended_inside", "too_many_bodies"];
    let lost = PyDict::new(py);
    for (name, counts) in body_names.iter().zip(&tally.lost) {
        let by_cause = PyDict::new(py);
        for (cause, count) in CAUSES.into_iter().zip(counts).filter(|(_, count)| **count > 0) {
            by_cause.set_item(cause, count)?;
        }
        if !by_cause.is_empty() {
            lost.set_item(name, by_cause)?;
        }
    }
    Ok(lost)
}

impl Render {
    fn shape(&self, depth: usize) -> [usize; 3] {
        [self.rendered.film.height as usize, self.rendered.film.width as usize, depth]
    }

    fn of_layers<'py>(
        &self,
        py: Python<'py>,
        value: impl Fn(&PixelSums) -> [f64; 3],
    ) -> PyResult<Bound<'py, PyArray4<f64>>> {
        let film = &self.rendered.film;
        let sums = &film.layer_sums;
        let of_group = |group: usize| sums.iter().skip(group).step_by(film.layers.max(1));
        let values = (0..film.layers).flat_map(of_group).flat_map(value).collect();
        let (height, width) = (film.height as usize, film.width as usize);
        shaped(py, values, [film.layers, height, width, 3])
    }
}

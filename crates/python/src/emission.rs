// SPDX-License-Identifier: Apache-2.0 OR MIT
//! `Emission`: how a body shines, from arrays.

use lamplit_core::light::DirectionGrid;
use lamplit_core::math::DMat3;
use lamplit_core::scene::{self, Distribution, Strength};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::arrays::{table, vector, Spectrum, Triple};
use crate::value_error;

/// How a body shines: equally in all directions, unless told otherwise.
#[pyclass(module = "lamplit._core")]
pub struct Emission(pub scene::Emission);

impl Emission {
    fn of(strength: Strength) -> Self {
        Self(scene::Emission { group: 0, strength, distribution: Distribution::Lambert })
    }
}

#[pymethods]
impl Emission {
    /// By its spectral radiance in air, in W·m⁻²·sr⁻¹·nm⁻¹.
    #[staticmethod]
    fn radiance(radiance: Spectrum<'_>) -> PyResult<Self> {
        Ok(Self::of(Strength::Radiance(table(&radiance)?)))
    }

    /// By the spectral flux of the whole body, in W/nm.
    #[staticmethod]
    fn flux(flux: Spectrum<'_>) -> PyResult<Self> {
        Ok(Self::of(Strength::Flux(table(&flux)?)))
    }

    /// Shine with the intensity of a flat face ∝ cosⁿ of the angle to its normal.
    fn set_cosine(&mut self, exponent: f64) {
        self.0.distribution = Distribution::Cosine { exponent };
    }

    /// Shine with relative intensities for polar angles (from the third axis) and azimuths (from the
    /// first axis to the second) in rad, all polar angles of the first azimuth first.
    fn set_intensities(
        &mut self,
        polar_rad: PyReadonlyArray1<'_, f64>,
        azimuths_rad: PyReadonlyArray1<'_, f64>,
        intensities: PyReadonlyArray1<'_, f64>,
        axes: [Triple; 3],
    ) -> PyResult<()> {
        let list = |array: &PyReadonlyArray1<'_, f64>| array.as_array().to_vec();
        let grid = DirectionGrid::new(list(&polar_rad), list(&azimuths_rad), list(&intensities));
        let grid = grid.map_err(value_error)?;
        let [x, y, z] = axes.map(vector);
        self.0.distribution = Distribution::Intensity { grid, frame: DMat3::from_cols(x, y, z) };
        Ok(())
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! `Background`: all that lies beyond a scene, from arrays.

use lamplit_core::light::{self, Base, ImageMap, Sky, SkyModel, SoftBox, Sun, CIE_GENERAL_SKIES};
use lamplit_core::spectrum::SpectralTable;
use numpy::PyReadonlyArray3;
use pyo3::prelude::*;

use crate::arrays::{direction, table, vector, Spectrum, Triple};
use crate::value_error;

/// A surround, with suns in it and soft boxes before it. A group is the number of a light group.
#[pyclass(module = "lamplit._core")]
#[derive(Clone)]
pub struct Background {
    base: Base,
    group: usize,
    soft_boxes: Vec<SoftBox>,
    suns: Vec<Sun>,
}

impl Background {
    fn of(base: Base, group: usize) -> Self {
        Self { base, group, soft_boxes: Vec::new(), suns: Vec::new() }
    }

    /// The core's own, sampled by luminance.
    pub fn assembled(&self, luminosity: &SpectralTable) -> light::Background {
        let Self { base, group, soft_boxes, suns } = self;
        let (base, soft_boxes, suns) = (base.clone(), soft_boxes.clone(), suns.clone());
        light::Background::new(base, *group, soft_boxes, suns, luminosity)
    }
}

#[pymethods]
impl Background {
    #[staticmethod]
    fn constant(radiance: Spectrum<'_>, group: usize) -> PyResult<Self> {
        Ok(Self::of(Base::Constant(table(&radiance)?), group))
    }

    #[staticmethod]
    fn gradient(zenith: Spectrum<'_>, nadir: Spectrum<'_>, group: usize) -> PyResult<Self> {
        let (zenith, nadir) = (table(&zenith)?, table(&nadir)?);
        Ok(Self::of(Base::Gradient { zenith, nadir }, group))
    }

    /// The CIE general sky of a `kind` from 1 to 15 with the sun in a direction, or the traditional
    /// overcast sky without both.
    #[staticmethod]
    #[pyo3(signature = (zenith, ground, group, *, kind=None, towards_sun=None))]
    fn sky(
        zenith: Spectrum<'_>,
        ground: Spectrum<'_>,
        group: usize,
        kind: Option<usize>,
        towards_sun: Option<Triple>,
    ) -> PyResult<Self> {
        let model = match (kind, towards_sun) {
            (None, None) => SkyModel::Overcast,
            (Some(kind @ 1..=15), Some(sun)) => {
                let coefficients = CIE_GENERAL_SKIES[kind - 1];
                SkyModel::General { coefficients, sun: direction(sun)? }
            }
            _ => return Err(value_error("a general sky has a kind from 1 to 15 and a sun")),
        };
        let sky = Sky { model, zenith: table(&zenith)?, ground: table(&ground)? };
        Ok(Self::of(Base::Sky(sky), group))
    }

    /// Pixels (rows, columns, 3) of linear RGB on three basis spectra, turned about y.
    #[staticmethod]
    fn image(
        pixels: PyReadonlyArray3<'_, f32>,
        bases: [Spectrum<'_>; 3],
        turn_rad: f64,
        group: usize,
    ) -> PyResult<Self> {
        let view = pixels.as_array();
        let (rows, columns, channels) = view.dim();
        if channels != 3 {
            return Err(value_error(format!("an image needs 3 channels, not {channels}")));
        }
        let values: Vec<f32> = view.iter().copied().collect();
        let values = values.chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        let [r, g, b] = bases;
        let bases = [table(&r)?, table(&g)?, table(&b)?];
        let image = ImageMap::new([columns, rows], values, bases, turn_rad).map_err(value_error)?;
        Ok(Self::of(Base::Image(image), group))
    }

    /// Add a luminous rectangle whose front is on the side of `half_width` × `half_height`.
    fn add_soft_box(
        &mut self,
        radiance: Spectrum<'_>,
        centre_mm: Triple,
        half_width_mm: Triple,
        half_height_mm: Triple,
        edge_softness: f64,
        group: usize,
    ) -> PyResult<()> {
        self.soft_boxes.push(SoftBox {
            centre: vector(centre_mm),
            half_width: vector(half_width_mm),
            half_height: vector(half_height_mm),
            radiance: table(&radiance)?,
            edge_softness,
            group,
        });
        Ok(())
    }

    /// Add a disc endlessly far away.
    fn add_sun(
        &mut self,
        radiance: Spectrum<'_>,
        towards: Triple,
        angular_radius_rad: f64,
        group: usize,
    ) -> PyResult<()> {
        self.suns.push(Sun::new(direction(towards)?, angular_radius_rad, table(&radiance)?, group));
        Ok(())
    }
}

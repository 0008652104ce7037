// SPDX-License-Identifier: Apache-2.0 OR MIT
//! `Material`: the optics of a surface or body, from arrays.

use lamplit_core::matter::{Checker, Dielectric, HallTerms as Terms, Lacquer, Optics, Scattering};
use pyo3::prelude::*;

use crate::arrays::{table, Spectrum};

/// The weights k and spectra F of Hall's model for one material.
#[pyclass(frozen, module = "lamplit._core")]
pub struct HallTerms(pub Terms);

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
        Ok(Self(Terms {
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

/// What a surface or body is made of, but for its finish and its terms in Hall's model.
#[pyclass(frozen, module = "lamplit._core")]
pub struct Matter(pub Optics);

#[pymethods]
impl Matter {
    /// Transparent; `scattering_per_mm` and the mean cosine `anisotropy` make it turbid.
    #[staticmethod]
    #[pyo3(signature = (index, index_d, absorption_per_mm, *, scattering_per_mm=None, anisotropy=0.0))]
    fn dielectric(
        index: Spectrum<'_>,
        index_d: f64,
        absorption_per_mm: Spectrum<'_>,
        scattering_per_mm: Option<Spectrum<'_>>,
        anisotropy: f64,
    ) -> PyResult<Self> {
        let coefficient = scattering_per_mm.as_ref().map(table).transpose()?;
        let scattering = coefficient.map(|coefficient| Scattering { coefficient, anisotropy });
        let (index, absorption) = (table(&index)?, table(&absorption_per_mm)?);
        Ok(Self(Optics::Dielectric(Dielectric { index, index_d, absorption, scattering })))
    }

    /// A metal, under a lacquer if `lacquer` gives its index and its optical depth.
    #[staticmethod]
    #[pyo3(signature = (n, k, factor, *, lacquer=None))]
    fn conductor(
        n: Spectrum<'_>,
        k: Spectrum<'_>,
        factor: f64,
        lacquer: Option<(Spectrum<'_>, Spectrum<'_>)>,
    ) -> PyResult<Self> {
        let lacquer = match lacquer {
            None => None,
            Some((index, depth)) => {
                Some(Lacquer { index: table(&index)?, optical_depth: table(&depth)? })
            }
        };
        let (n, k) = (table(&n)?, table(&k)?);
        Ok(Self(Optics::Conductor { n, k, factor, lacquer }))
    }

    #[staticmethod]
    fn mirror(reflectance: Spectrum<'_>) -> PyResult<Self> {
        Ok(Self(Optics::Mirror(table(&reflectance)?)))
    }

    #[staticmethod]
    fn diffuse(reflectance: Spectrum<'_>) -> PyResult<Self> {
        Ok(Self(Optics::Diffuse(table(&reflectance)?)))
    }

    #[staticmethod]
    fn transmitter(reflectance: Spectrum<'_>, transmittance: Spectrum<'_>) -> PyResult<Self> {
        let (reflectance, transmittance) = (table(&reflectance)?, table(&transmittance)?);
        Ok(Self(Optics::Transmitter { reflectance, transmittance }))
    }

    #[staticmethod]
    fn checker(first: Spectrum<'_>, second: Spectrum<'_>, square_mm: f64) -> PyResult<Self> {
        let (first, second) = (table(&first)?, table(&second)?);
        Ok(Self(Optics::Checker(Checker { first, second, square: square_mm })))
    }

    #[staticmethod]
    fn glossy(index: Spectrum<'_>, reflectance: Spectrum<'_>) -> PyResult<Self> {
        let (index, base) = (table(&index)?, table(&reflectance)?);
        Ok(Self(Optics::Glossy { index, base }))
    }
}

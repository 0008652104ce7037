// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Arrays and tuples of Python as the core's types, and back.

use lamplit_core::math::{DAffine3, DMat4, DVec3};
use lamplit_core::spectrum::SpectralTable;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::value_error;

/// Three numbers as a vector.
pub type Triple = [f64; 3];

/// The values of a spectrum on all wavelengths in rising order.
pub type Spectrum<'py> = PyReadonlyArray1<'py, f64>;

/// Read a spectrum given on all wavelengths in rising order.
pub fn table(values: &Spectrum<'_>) -> PyResult<SpectralTable> {
    SpectralTable::from_ascending(values.as_slice()?).map_err(value_error)
}

/// Read an (n, 3) array.
pub fn triples<T: numpy::Element + Copy>(array: &PyReadonlyArray2<'_, T>) -> PyResult<Vec<[T; 3]>> {
    let view = array.as_array();
    if view.ncols() != 3 {
        return Err(value_error(format!(
            "an array of shape (n, 3) is needed, not {:?}",
            view.shape()
        )));
    }
    Ok(view.rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect())
}

/// Read a 4×4 matrix that acts on columns.
pub fn affine(matrix: [[f64; 4]; 4]) -> DAffine3 {
    DAffine3::from_mat4(DMat4::from_cols_array_2d(&matrix).transpose())
}

/// Read a vector.
pub fn vector(triple: Triple) -> DVec3 {
    DVec3::from_array(triple)
}

/// Read a direction of any length but zero.
pub fn direction(triple: Triple) -> PyResult<DVec3> {
    let none = || value_error("a direction must be finite and not zero");
    vector(triple).try_normalize().ok_or_else(none)
}

/// Hand a vector over as an array of the given shape.
pub fn shaped<T: numpy::Element, D>(
    py: Python<'_>,
    values: Vec<T>,
    shape: D,
) -> PyResult<Bound<'_, numpy::PyArray<T, D::Dim>>>
where
    D: numpy::ndarray::IntoDimension,
{
    PyArray1::from_vec(py, values).reshape(shape)
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! `lamplit._core`: Python's door to `lamplit-core`.
//!
//! Arrays go in and come out; no physics happens here. The interpreter is free while a scene is
//! built or rendered. A fault of the input is a `ValueError` with one line.

// PyO3 hands arguments over one by one, and by value.
#![allow(
    clippy::needless_pass_by_value,
    clippy::too_many_arguments,
    clippy::fn_params_excessive_bools
)]

mod arrays;
mod background;
mod builder;
mod emission;
mod material;
mod outcome;
mod photometer;
mod preview;
mod render;
mod watch;

use pyo3::prelude::*;

/// The compiled part of Lamplit.
#[pymodule]
mod _core {
    #[pymodule_export]
    use super::background::Background;
    #[pymodule_export]
    use super::builder::SceneBuilder;
    #[pymodule_export]
    use super::emission::Emission;
    #[pymodule_export]
    use super::material::{HallTerms, Matter};
    #[pymodule_export]
    use super::outcome::Render;
    #[pymodule_export]
    use super::photometer::{Photometer, Rays, Receivers};
    #[pymodule_export]
    use super::render::{HallMethod, LightGuide, LitMethod, PathMethod, Scene};

    /// How many wavelengths a path carries.
    #[pymodule_export]
    const LANES: usize = lamplit_core::spectrum::LANES;

    /// Independent repetitions of which a photometer's walks are made.
    #[pymodule_export]
    const BATCHES: usize = lamplit_core::render::BATCHES;

    /// The version of Lamplit.
    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}

/// One line of Python's `ValueError` for an error of the core.
fn value_error(error: impl std::fmt::Display) -> PyErr {
    pyo3::exceptions::PyValueError::new_err(error.to_string())
}

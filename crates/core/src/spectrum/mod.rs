// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The spectrum as a register: a path carries [`LANES`] wavelengths at once.
//!
//! Sample number *s* of a pixel uses phase *p* of *P*; lane *j* then stands for the wavelength
//! λ(p, j) = λ₀ + (j·P + p + ½)·Δ with Δ = (λ₁ − λ₀)/(P·LANES). P samples visit every one of the
//! P·LANES intervals once, at its middle, so that their mean is the midpoint sum with step Δ.
//!
//! Lanes are doubles: absorption over any optical depth and sums over any number of samples hold
//! a relative error of 1e-6 with room to spare, and their cost beside one ray is small.

mod lanes;
mod table;

pub use lanes::{SampledSpectrum, LANES};
pub use table::{SampledWavelengths, SpectralTable, TableError};

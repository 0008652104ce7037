// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Spectral ray tracing of lamps.
//!
//! The modules are layers, and each one imports only those before it:
//! {[`math`], [`sampling`], [`spectrum`]} ← {[`light`], [`geometry`], [`matter`]} ← [`scene`] ←
//! {[`transport`], [`film`]} ← [`render`].
//!
//! Lengths are in millimetres, wavelengths in nanometres, spectral radiance in W·m⁻²·sr⁻¹·nm⁻¹.
//! The frame is right-handed with y up; a lamp's reference axis points along +z to the observer.

pub mod film;
pub mod geometry;
pub mod light;
pub mod math;
pub mod matter;
pub mod render;
pub mod sampling;
pub mod scene;
pub mod spectrum;
pub mod transport;

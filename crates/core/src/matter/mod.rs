// SPDX-License-Identifier: Apache-2.0 OR MIT
//! What bodies and surfaces are made of, as functions of wavelength.

mod fresnel;
mod material;

pub use fresnel::{conductor_reflectance, dielectric_reflectance, reflect, refract};
pub use material::{Checker, Dielectric, HallTerms, Material, Optics};

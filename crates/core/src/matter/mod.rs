// SPDX-License-Identifier: Apache-2.0 OR MIT
//! What bodies and surfaces are made of, as functions of wavelength, and what they do with light.

mod albedo;
mod bsdf;
mod finish;
mod fresnel;
mod lacquer;
mod material;
mod microfacet;
mod phase;

pub use albedo::{AlbedoTable, AlbedoTables, RoughnessError, LEAST_ALPHA};
pub use bsdf::{Bsdf, Diffuse, Facet, Glossy, Interface, LacqueredMetal, Reflector, Transmitter};
pub use finish::Finish;
pub use fresnel::{
    conductor_reflectance, dielectric_reflectance, diffuse_dielectric_reflectance, reflect, refract,
};
pub use lacquer::Lacquer;
pub use material::{Checker, Dielectric, HallTerms, Material, Optics, Scattering};
pub use phase::{henyey_greenstein, sample_henyey_greenstein};

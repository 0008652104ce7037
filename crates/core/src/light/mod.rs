// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Lights that shade, and backgrounds that are seen and reflected.

mod background;
mod lamp;

pub use background::{
    Background, Base, ImageError, ImageMap, Sky, SkyModel, SoftBox, Sun, CIE_GENERAL_SKIES,
};
pub use lamp::{Light, LightSample, LightShape};

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Lights that shade, and backgrounds that are seen and reflected.

mod background;
mod lamp;

pub use background::{Background, Base, SoftBox};
pub use lamp::{Light, LightSample, LightShape};

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! What shines: bodies that emit, the background, and the lights of Hall's model.

mod angular;
mod background;
mod emitter;
mod lamp;

pub use angular::{AngularLaw, DirectionGrid, IntensityError, IntensityTable};
pub use background::{
    Background, Base, ImageError, ImageMap, Sky, SkyModel, SoftBox, Sun, CIE_GENERAL_SKIES,
};
pub use emitter::Emitter;
pub use lamp::{Light, LightSample, LightShape};

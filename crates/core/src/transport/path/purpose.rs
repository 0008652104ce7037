// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Purpose`]: what a walk is for.

use crate::math::Ray;
use crate::spectrum::SampledSpectrum;
use crate::transport::Gathered;

/// Takes the flux that leaves a scene along a ray.
pub type Leaving<'a> = dyn FnMut(&Ray, SampledSpectrum) + 'a;

/// What a walk is for.
pub(super) enum Purpose<'a> {
    /// To bring an eye the light that arrives there: emissions and the background are looked for.
    Eye(&'a mut Gathered),
    /// To carry flux from a light until it leaves the scene.
    Light(&'a mut Leaving<'a>),
}

impl Purpose<'_> {
    /// Whether walks look for emissions and the background.
    pub fn looks_for_light(&self) -> bool {
        matches!(self, Self::Eye(_))
    }
}

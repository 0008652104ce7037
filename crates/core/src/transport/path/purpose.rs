// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Purpose`]: what a walk is for.

use super::branch::Branch;
use crate::math::Ray;
use crate::spectrum::SampledSpectrum;
use crate::transport::guide::{Arrival, Guide};
use crate::transport::photons::{Landing, Photons};
use crate::transport::Gathered;

/// What a walk from a light shows of the flux that it carries.
pub enum Carried<'r> {
    /// It leaves the scene along a ray.
    Left(&'r Ray),
    /// It arrives where walks from the eye have to find it.
    Arrived(Arrival),
    /// It lands where walks from the eye can meet it.
    Landed(Landing),
}

/// Takes what a walk from a light shows.
pub type Receive<'a> = dyn FnMut(Carried<'_>, SampledSpectrum) + 'a;

/// Which of the light that arrives at an eye walks bring. Both parts together are all of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Part {
    /// All of it.
    #[default]
    All,
    /// What is seen in mirrors and through smooth glass alone. Walks end where they would turn at
    /// random: they are short, and the light they find is sharp.
    Specular,
    /// The rest: what has been turned at random.
    Scattered,
}

/// What an eye does with the light that walks find for it, and what it knows of where that is.
pub struct Eye<'a> {
    /// What has been found.
    pub gathered: &'a mut Gathered,
    /// What is looked for.
    pub part: Part,
    /// Where light comes from.
    pub guide: Option<&'a Guide>,
    /// What landed on surfaces: there, some of the light of emitters is left to it.
    pub photons: Option<&'a Photons>,
}

/// What a walk is for.
pub(super) enum Purpose<'a> {
    /// To bring an eye the light that arrives there: emissions and the background are looked for.
    Eye(Eye<'a>),
    /// To carry flux from a light until it leaves the scene.
    Light(&'a mut Receive<'a>),
}

impl<'a> Purpose<'a> {
    /// Whether walks look for emissions and the background.
    pub fn looks_for_light(&self) -> bool {
        matches!(self, Self::Eye(_))
    }

    /// Whether walks go on where they turn at random.
    pub fn scatters(&self) -> bool {
        !matches!(self, Self::Eye(Eye { part: Part::Specular, .. }))
    }

    /// Whether light of an emitter counts that a branch meets.
    pub fn counts(&self, branch: &Branch) -> bool {
        match self {
            Self::Eye(eye) => match eye.part {
                Part::All | Part::Specular => !branch.is_left(),
                Part::Scattered => branch.scatterings > 0 && !branch.is_left(),
            },
            Self::Light(_) => false,
        }
    }

    /// What landed on surfaces.
    pub fn photons(&self) -> Option<&'a Photons> {
        match self {
            Self::Eye(eye) => eye.photons,
            Self::Light(_) => None,
        }
    }

    /// Where light comes from, as far as that matters and is known.
    pub fn guide(&self) -> Option<&'a Guide> {
        match self {
            Self::Eye(eye) => eye.guide,
            Self::Light(_) => None,
        }
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`RenderSettings`]: what is rendered, how, and how finely.

use std::ops::Range;
use std::time::Duration;

use super::RenderError;
use crate::film::Film;
use crate::sampling::{PixelFilter, PixelSequence};
use crate::scene::Scene;
use crate::transport::{HallSettings, PathSettings};

/// How light is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The founding method.
    Hall(HallSettings),
    /// Unbiased path transport.
    Path(PathSettings),
}

/// What is rendered, how, and how finely.
#[derive(Clone, Debug)]
pub struct RenderSettings {
    /// Pixels along a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Which samples of every pixel.
    pub samples: Range<u32>,
    /// The standard error of a pixel's luminance that is enough, relative to the luminance of the
    /// pixel and the mean of the picture together; none takes all samples.
    pub target_error: Option<f64>,
    /// When to end before all samples are taken.
    pub time_budget: Option<Duration>,
    /// How they lie in the pixel.
    pub sequence: PixelSequence,
    /// How the pixel weighs its surroundings.
    pub filter: PixelFilter,
    /// What keys the random numbers.
    pub seed: u64,
    /// The method and how far it goes.
    pub method: Method,
    /// Spectral bands per lane on the film; 0 for none.
    pub bands_per_lane: usize,
    /// Whether each light group gets sums of its own.
    pub layers: bool,
    /// Threads; 0 takes one per core.
    pub threads: usize,
    /// How many neighbouring pixels one thread takes at a time.
    pub tile: usize,
}

/// The most reflections and refractions that Hall's method follows: it recurses.
pub(super) const DEEPEST_HALL: u32 = 256;

/// The most surfaces and scatterings that one walk meets.
pub const DEEPEST: u32 = 100_000;

impl RenderSettings {
    pub(super) fn check(&self) -> Result<(), RenderError> {
        let (asked, deepest) = match self.method {
            Method::Hall(hall) => (hall.max_depth, DEEPEST_HALL),
            Method::Path(path) => (path.max_depth, DEEPEST),
        };
        if asked > deepest {
            return Err(RenderError::TooDeep { deepest, asked });
        }
        Ok(())
    }

    pub(super) fn new_film(&self, scene: &Scene) -> Film {
        let layers = if self.layers { scene.groups } else { 0 };
        Film::new(self.width, self.height, self.bands_per_lane, layers)
    }
}

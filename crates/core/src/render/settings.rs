// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`RenderSettings`]: what is rendered, how, and how finely.

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use super::allocation::Pilot;
use super::RenderError;
use crate::film::Film;
use crate::sampling::{PixelFilter, PixelSequence};
use crate::scene::Scene;
use crate::transport::{Guide, HallSettings, Part, PathSettings};

/// How light is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The founding method.
    Hall(HallSettings),
    /// Unbiased path transport.
    Path(PathSettings),
    /// The same, for light that is small and behind optics: what is seen in mirrors and through glass
    /// is exposed apart from the rest, whose walks know where light comes from.
    Lit(PathSettings),
}

/// What is rendered, how, and how finely.
#[derive(Clone, Debug)]
pub struct RenderSettings {
    /// Pixels along a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Which samples of every pixel; where they are allotted, the first of them and as many as all
    /// pixels together may cost, on average.
    pub samples: Range<u32>,
    /// How many samples each pixel takes, row by row, where the caller knows; with it, `samples` says
    /// which is the first, and the settings below are not asked.
    pub counts: Option<Vec<u32>>,
    /// Whether samples are allotted to pixels by their noise.
    pub adaptive: bool,
    /// The error that is enough, with `adaptive`: the root mean square over the pixels of the
    /// luminance's standard error, relative to the luminance and 1 % of the picture's mean.
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
    /// Where light comes from, if that was learned before; `Lit` learns it else.
    pub guide: Option<Arc<Guide>>,
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
            Method::Path(path) | Method::Lit(path) => (path.max_depth, DEEPEST),
        };
        if asked > deepest {
            return Err(RenderError::TooDeep { deepest, asked });
        }
        let pixels = self.width as usize * self.height as usize;
        if let Some(counts) = self.counts.as_ref().filter(|counts| counts.len() != pixels) {
            return Err(RenderError::Counts { pixels, counts: counts.len() });
        }
        Ok(())
    }

    /// Whether samples are allotted by what a first round shows, if there is one.
    pub(super) fn allots(&self) -> bool {
        self.adaptive && self.counts.is_none()
    }

    /// Whether an error or a time, not a number of samples, says when it is enough.
    pub(super) fn is_open(&self) -> bool {
        self.target_error.is_some() || self.time_budget.is_some()
    }

    /// How many samples of every pixel the first round has, if what comes after it is allotted by it: a
    /// quarter of all where their number is known. A picture of one pixel has no neighbours to learn
    /// from, and a round that takes all samples leaves none to allot.
    pub(super) fn first_round(&self) -> Option<u32> {
        let samples = self.samples.len() as u32;
        let wanted = if self.is_open() { Pilot::USUAL } else { samples / 4 };
        let first = wanted.clamp(Pilot::FEWEST, Pilot::MOST);
        (self.allots() && self.pixels() > 1 && first < samples).then_some(first)
    }

    pub(super) fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// What is exposed by itself, each on a film of its own.
    pub(super) fn parts(&self) -> &'static [Part] {
        match self.method {
            Method::Hall(_) | Method::Path(_) => &[Part::All],
            Method::Lit(_) => &[Part::Specular, Part::Scattered],
        }
    }

    pub(super) fn new_film(&self, scene: &Scene) -> Film {
        let layers = if self.layers { scene.groups } else { 0 };
        Film::new(self.width, self.height, self.bands_per_lane, layers)
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Where samples fall: sequences keyed by (seed, pixel, sample, dimension), pixel filters, warps.

mod filter;
mod sequence;
mod warp;

pub use filter::PixelFilter;
pub use sequence::{PixelSampler, PixelSequence, SequenceError};
pub use warp::{cosine_hemisphere, uniform_sphere};

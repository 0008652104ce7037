// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Where samples fall: sequences keyed by (seed, pixel, sample, dimension), pixel filters, warps.

#[cfg(test)]
pub(crate) mod chi_square;
mod choice;
mod filter;
mod sequence;
mod shapes;
mod warp;

pub use choice::{pick, Choice};
pub use filter::PixelFilter;
pub use sequence::{PixelSampler, PixelSequence, SequenceError};
pub use shapes::{uniform_cone, uniform_disc, uniform_triangle};
pub use warp::{cosine_hemisphere, uniform_sphere};

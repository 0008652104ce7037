// SPDX-License-Identifier: Apache-2.0 OR MIT
//! How light finds its way from the scene to the eye.

mod hall;
mod shadow;
mod tally;

pub use hall::{HallSettings, HallWalk};
pub use tally::Tally;

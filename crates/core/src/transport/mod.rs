// SPDX-License-Identifier: Apache-2.0 OR MIT
//! How light finds its way from the scene to the eye, and from what shines to where it leaves.

mod disc;
mod flux;
mod gathered;
mod guide;
mod hall;
mod ledger;
mod meeting;
mod path;
mod photons;
mod shadow;
mod tally;

pub use disc::Crowd;
pub use flux::{Beam, FluxError, LightSource, LightWalk, Parted, RaySet, Shining};
pub use gathered::Gathered;
pub use guide::Guide;
pub use hall::{HallSettings, HallWalk};
pub use ledger::{Balance, Ledger};
pub use path::{Carried, Eye, Part, PathSettings, PathWalk};
pub use photons::{Landed, Landing, Photons};
pub use tally::Tally;

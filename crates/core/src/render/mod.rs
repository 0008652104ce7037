// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Rendering: samples of all pixels, over threads, with the same result for any number of them.

mod allocation;
mod features;
mod landings;
mod learning;
mod pass;
mod photometer;
mod rendering;
mod settings;
mod snapshot;
mod trial;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use thiserror::Error;

use crate::film::Film;
use crate::scene::{Interior, Scene};
use crate::transport::{LightSource, Shining, Tally};
use landings::Landings;
use rendering::Rendering;
use trial::Trial;

pub use features::{features, Features};
pub use learning::learn;
pub use photometer::{Batch, MeasureError, Photometer, BATCHES};
pub use rendering::Found;
pub use settings::{Method, RenderSettings, DEEPEST};
pub use snapshot::{Outlook, Snapshot, Viewfinder};

/// Where a rendering stands, shared with whoever watches it.
#[derive(Debug, Default)]
pub struct Progress {
    /// How many samples are done, over all pixels.
    pub done: AtomicU64,
    /// How many there will be, as far as is known yet.
    pub total: AtomicU64,
    /// Set it to stop: what is done stays.
    pub cancelled: AtomicBool,
    /// Shows the picture in the making.
    pub viewfinder: Viewfinder,
}

impl Progress {
    /// Whether somebody asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// Why a rendering cannot start.
#[derive(Debug, Error)]
pub enum RenderError {
    /// The camera stands inside an opaque body.
    #[error("the camera is inside the opaque body {0:?}")]
    CameraInside(String),
    /// Rays are to be followed deeper than allowed.
    #[error("max_depth is at most {deepest}, not {asked}")]
    TooDeep {
        /// The limit of the method.
        deepest: u32,
        /// What was asked for.
        asked: u32,
    },
    /// Not every pixel has a count of samples.
    #[error("there are {counts} counts of samples for {pixels} pixels")]
    Counts {
        /// How many pixels there are.
        pixels: usize,
        /// How many counts there are.
        counts: usize,
    },
    /// The threads cannot be started.
    #[error("the threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// The stack of a thread, in bytes. One level of Hall's recursion takes about 4 KiB.
const STACK: usize = 16 * 1024 * settings::DEEPEST_HALL as usize;

/// What a rendering brought.
#[derive(Debug)]
pub struct Rendered {
    /// The picture.
    pub film: Film,
    /// What happened to the rays.
    pub tally: Tally,
    /// The parts of its mean luminance in cd/m², by how they were found.
    pub found: Vec<(Found, f64)>,
}

/// Render `scene`.
///
/// The samples of a pixel are summed in their order by whichever thread holds it, so the film
/// depends on the scene, the seed and the range of samples alone. Where samples are allotted, a
/// first round tells how many each pixel takes. With a time budget the
/// clock chooses the number of samples, and nothing else. A cancelled rendering returns what it has.
///
/// # Errors
/// The camera is inside an opaque body, the depth exceeds [`DEEPEST`], or no threads can be had.
pub fn render(
    scene: &Scene,
    settings: &RenderSettings,
    progress: &Progress,
) -> Result<Rendered, RenderError> {
    settings.check()?;
    let interior = eye_interior(scene)?;
    let threads = rayon::ThreadPoolBuilder::new().num_threads(settings.threads);
    let pool = threads.stack_size(STACK).build()?;
    pool.install(|| {
        let began = Instant::now();
        let guide = learning::guide(scene, settings, progress);
        let (guide, source) = (guide.as_deref(), LightSource::from(Shining::of(scene)));
        let trial = Trial { scene, settings, interior };
        let (landings, sharp) = match settings.method {
            Method::Lit(path) => {
                let landings = Landings::new(trial, &source, path, progress);
                (landings.ok(), Some(trial.sharp(path)))
            }
            Method::Hall(_) | Method::Path(_) => (None, None),
        };
        let rendering =
            Rendering { scene, settings, interior, guide, sharp, landings, progress, began };
        Ok(rendering.run())
    })
}

/// The bodies that the eye is in.
fn eye_interior(scene: &Scene) -> Result<Interior, RenderError> {
    let name = |body: u32| RenderError::CameraInside(scene.bodies[body as usize].name.clone());
    scene.bodies_round(scene.camera.position()).map_err(name)
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Learning where light comes from, before it is looked for.

use std::sync::Arc;

use super::settings::{Method, RenderSettings};
use super::MeasureError;
use crate::scene::Scene;
use crate::transport::{Guide, PathSettings, Shining};

/// Learn where the light of what shines in `scene` comes from, by walks that are spent as `settings`
/// say. What is learned depends on the scene, the settings and the seed alone.
///
/// # Errors
/// Nothing shines, or no threads can be had.
pub fn learn(
    scene: &Scene,
    settings: PathSettings,
    seed: u64,
    threads: usize,
) -> Result<Guide, MeasureError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let source = Shining::of(scene).into();
    Ok(pool.install(|| Guide::learn(scene, &source, settings, seed))?)
}

/// What a rendering knows of where light comes from: what it was given, else what it learns; nothing
/// for methods that do not ask, and where nothing shines.
pub(super) fn guide(scene: &Scene, settings: &RenderSettings) -> Option<Arc<Guide>> {
    let Method::Lit(path) = settings.method else {
        return None;
    };
    let learn = || {
        let source = Shining::of(scene).into();
        Guide::learn(scene, &source, path, settings.seed).ok().map(Arc::new)
    };
    settings.guide.clone().or_else(learn)
}

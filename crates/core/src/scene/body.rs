// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Body`]: a named thing made of one material.

/// The number of a body in its scene.
pub type BodyId = u32;

/// A named thing made of one material.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name in the scene file.
    pub name: String,
    /// Its material, an index into the scene's.
    pub material: usize,
    /// Where bodies share space, the highest priority is the one that is there; among equals the
    /// later in the file.
    pub priority: i32,
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Finish`]: how rough a surface is, and where.

use std::sync::Arc;

use super::albedo::AlbedoTable;
use crate::math::DVec3;

/// Smooth, rough, or rough on the faces that look one way: moulded plastic often has a texture on
/// one side and none on the other.
#[derive(Clone, Debug)]
pub struct Finish {
    table: Option<Arc<AlbedoTable>>,
    patch: Option<Patch>,
}

/// The faces that are rough.
#[derive(Clone, Copy, Debug)]
struct Patch {
    direction: DVec3,
    cos_within: f64,
}

impl Finish {
    /// Without roughness.
    pub const SMOOTH: Self = Self { table: None, patch: None };

    /// Rough everywhere, with the table's α.
    pub fn rough(table: Arc<AlbedoTable>) -> Self {
        Self { table: Some(table), patch: None }
    }

    /// Rough only where the outward normal lies within an angle of the unit vector `direction`;
    /// `cos_within` is the angle's cosine.
    #[must_use]
    pub fn facing(self, direction: DVec3, cos_within: f64) -> Self {
        Self { patch: Some(Patch { direction, cos_within }), ..self }
    }

    /// The roughness of a face by its outward geometric normal; none where it is smooth.
    pub fn table_at(&self, normal: DVec3) -> Option<&AlbedoTable> {
        let is_bare = self.patch.is_some_and(|p| p.direction.dot(normal) < p.cos_within);
        self.table.as_deref().filter(|_| !is_bare)
    }

    /// Whether some face is rough.
    pub fn is_rough(&self) -> bool {
        self.table.is_some()
    }

    /// The α of a face by its outward geometric normal; 0 where it is smooth.
    pub fn alpha_at(&self, normal: DVec3) -> f64 {
        self.table_at(normal).map_or(0.0, AlbedoTable::alpha)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_texture_covers_the_faces_within_its_angle_and_no_others() {
        let table = Arc::new(AlbedoTable::new(0.3).unwrap());
        let finish = Finish::rough(table).facing(DVec3::Z, 80.0_f64.to_radians().cos());
        let tilted =
            |degrees: f64| DVec3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos());
        assert_eq!(finish.alpha_at(DVec3::Z), 0.3);
        assert_eq!(finish.alpha_at(tilted(79.0)), 0.3);
        assert_eq!(finish.alpha_at(tilted(81.0)), 0.0);
        assert_eq!(finish.alpha_at(-DVec3::Z), 0.0);
        assert_eq!(Finish::SMOOTH.alpha_at(DVec3::Z), 0.0);
    }
}

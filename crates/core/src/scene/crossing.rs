// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Place`]: where a ray meets surfaces, one or several in the same place.
//!
//! Bodies may touch: faces of glued meshes, a box on a floor, one box in another of the same size.
//! Faces closer than the rounding of their descriptions (50 nm for meshes that extend over 200 mm)
//! are in one place, and a ray crosses all of them at once: there is no gap, and no film of air,
//! between them. An opaque face among them ends the ray, in the matter that the ray comes from.

use std::slice;

use super::body::BodyId;
use super::interior::{Interior, LostRay};
use super::world::{Scene, SurfaceHit};
use crate::geometry::PARALLEL;
use crate::math::Ray;

/// A surface as a ray crosses it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Whose it is.
    pub body: BodyId,
    /// Whether the ray enters that body.
    pub is_entered: bool,
}

/// Where a ray meets one surface, or several that lie in the same place.
#[derive(Clone, Debug)]
pub struct Place {
    /// The surface that is shaded: an opaque one if there is one, else the first. Its point's error
    /// bound reaches past all faces of the place.
    pub hit: SurfaceHit,
    face: Face,
    /// All faces along the ray, where there are several.
    shared: Vec<Face>,
}

/// The flattest angle, by its cosine with the normal, at which faces in one place are told from
/// faces farther along the ray.
const FLATTEST: f64 = 1e-4;

impl Place {
    /// The faces crossed, in their order along the ray.
    pub fn faces(&self) -> &[Face] {
        if self.shared.is_empty() {
            slice::from_ref(&self.face)
        } else {
            &self.shared
        }
    }
}

impl SurfaceHit {
    fn face(&self, ray: &Ray) -> Face {
        let is_entered = self.point.normal.dot(ray.direction) < 0.0;
        Face { body: self.body, is_entered }
    }
}

impl Scene {
    /// The first place where `ray` meets a surface, with all faces that lie there.
    pub fn first_place(&self, ray: &Ray) -> Option<Place> {
        let hit = self.closest_hit(ray)?;
        let shared = if hit.touches { self.hits_beside(&hit, ray) } else { Vec::new() };
        if shared.iter().all(|other| other.body == hit.body) {
            return Some(Place { hit, face: hit.face(ray), shared: Vec::new() });
        }
        let is_opaque = |hit: &&SurfaceHit| self.material_of(hit.body).dielectric().is_none();
        let mut shaded = *shared.iter().find(is_opaque).unwrap_or(&hit);
        let clearance = |other: &SurfaceHit| {
            let (n, m) = (shaded.point.normal, other.point.normal);
            let height = m.dot(other.point.position - shaded.point.position) / m.dot(n);
            height.abs() + other.point.error
        };
        shaded.point.error += shared.iter().map(clearance).fold(0.0, f64::max);
        let shared = shared.iter().map(|hit| hit.face(ray)).collect();
        Some(Place { hit: shaded, face: shaded.face(ray), shared })
    }

    /// The faces in the place of `hit`, with itself, along the ray: those that are parallel to it
    /// and no farther off than rounding can take them.
    fn hits_beside(&self, hit: &SurfaceHit, ray: &Ray) -> Vec<SurfaceHit> {
        let cosine = hit.point.normal.dot(ray.direction).abs().max(FLATTEST);
        // Nothing lies before the first hit but what its own error hides.
        let back = (4.0 * hit.point.error / cosine).min(hit.point.t);
        let ahead = (self.contacts.reach + 4.0 * hit.point.error) / cosine;
        let start = hit.point.t - back;
        // From the hit and not from the ray's origin, which may be too far away to tell them apart.
        let origin = hit.point.position - ray.direction * back;
        let t_max = (back + ahead).min(ray.t_max - start);
        let mut found = self.hits_between(&Ray { origin, direction: ray.direction, t_max });
        for other in &mut found {
            other.point.t += start;
        }
        let is_parallel =
            |other: &SurfaceHit| other.point.normal.dot(hit.point.normal).abs() >= PARALLEL;
        found.retain(is_parallel);
        found.push(*hit);
        found.sort_by(|a, b| a.point.t.total_cmp(&b.point.t).then(a.body.cmp(&b.body)));
        found
    }

    /// The matter changes from one list of bodies to another: by whose surface. Of several in one
    /// place it is that of the body that is there on the far side, if the ray enters it, else that
    /// of the one left.
    pub fn interface(&self, here: &Interior, beyond: &Interior) -> Option<Face> {
        let (from, to) = (here.filling(&self.bodies), beyond.filling(&self.bodies));
        let material = |body: Option<BodyId>| body.map(|id| self.bodies[id as usize].material);
        if material(from) == material(to) {
            return None;
        }
        let entered = to.filter(|body| !here.bodies().contains(body));
        let face = |is_entered: bool| move |body: BodyId| Face { body, is_entered };
        entered.map(face(true)).or(from.map(face(false)))
    }

    /// [`interface`](Self::interface), but of two bodies that touch, one left and one entered, always
    /// the one that would fill both places: whichever way light goes, it meets the same finish.
    pub fn reversible_interface(&self, here: &Interior, beyond: &Interior) -> Option<Face> {
        let face = self.interface(here, beyond)?;
        let left = here.filling(&self.bodies).filter(|body| !beyond.bodies().contains(body));
        let rank = |body: BodyId| (self.bodies[body as usize].priority, body);
        let ranks_higher = |body: &BodyId| face.is_entered && rank(*body) > rank(face.body);
        let other = left.filter(ranks_higher).map(|body| Face { body, is_entered: false });
        Some(other.unwrap_or(face))
    }
}

impl Interior {
    /// The list after crossing all faces of one place. Their order does not matter; a body that is
    /// entered and left in the place leaves no trace. Crossings that do not fit go to `lose` and
    /// change nothing.
    #[must_use]
    pub fn through(&self, faces: &[Face], mut lose: impl FnMut(BodyId, LostRay)) -> Self {
        let mut after = *self;
        for is_entered in [false, true] {
            for (at, face) in faces.iter().enumerate() {
                let same = |other: &&Face| other.body == face.body;
                let is_first = !faces[..at].iter().any(|other| other.body == face.body);
                let is_kept = faces.iter().rfind(same) == Some(face);
                if is_first && is_kept && face.is_entered == is_entered {
                    match after.cross(face.body, is_entered) {
                        Ok(next) => after = next,
                        Err(cause) => lose(face.body, cause),
                    }
                }
            }
        }
        after
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn face(body: BodyId, is_entered: bool) -> Face {
        Face { body, is_entered }
    }

    #[test]
    fn the_order_of_faces_in_one_place_does_not_matter() {
        let here = Interior::OUTSIDE.cross(3, true).unwrap();
        let mut faces = [face(3, false), face(5, true)];
        let one = here.through(&faces, |_, _| panic!("nothing is lost"));
        faces.reverse();
        let other = here.through(&faces, |_, _| panic!("nothing is lost"));
        assert_eq!(one.bodies(), [5]);
        assert_eq!(other.bodies(), [5]);
    }

    #[test]
    fn two_triangles_of_one_face_count_once_and_a_fold_not_at_all() {
        let entered = Interior::OUTSIDE.through(&[face(1, true); 2], |_, _| panic!());
        assert_eq!(entered.bodies(), [1]);
        let fold = [face(2, true), face(1, false), face(2, false)];
        assert!(entered.through(&fold, |_, _| panic!()).bodies().is_empty());
    }

    #[test]
    fn a_full_list_has_room_for_what_is_entered_where_another_body_is_left() {
        let full = (0..16).fold(Interior::OUTSIDE, |list, id| list.cross(id, true).unwrap());
        let after = full.through(&[face(16, true), face(0, false)], |_, _| panic!());
        assert_eq!(after.bodies().len(), 16);
    }

    #[test]
    fn what_does_not_fit_is_told_and_changes_nothing() {
        let mut lost = Vec::new();
        let after = Interior::OUTSIDE
            .through(&[face(7, false), face(8, true)], |body, cause| lost.push((body, cause)));
        assert_eq!(lost, [(7, LostRay::LeftWithoutEntering)]);
        assert_eq!(after.bodies(), [8]);
    }
}

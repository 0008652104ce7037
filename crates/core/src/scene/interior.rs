// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Interior`]: the list of bodies that a ray is inside.

use super::body::{Body, BodyId};

/// How many bodies may hold one point.
const CAPACITY: usize = 16;

/// Why a walk lost its way: surfaces that do not enclose what they should.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LostRay {
    /// It leaves a body that it never entered.
    LeftWithoutEntering,
    /// It enters a body that it is inside already.
    EnteredTwice,
    /// It goes to infinity inside a body.
    EndedInside,
    /// It is inside more than 16 bodies.
    TooManyBodies,
}

/// The transparent bodies that a ray is inside, without order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interior {
    bodies: [BodyId; CAPACITY],
    count: usize,
}

impl Interior {
    /// Outside of everything.
    pub const OUTSIDE: Self = Self { bodies: [0; CAPACITY], count: 0 };

    /// The bodies, in the order they were entered.
    pub fn bodies(&self) -> &[BodyId] {
        &self.bodies[..self.count]
    }

    /// The body whose matter fills the place: the highest priority, then the latest in the scene.
    pub fn filling(&self, bodies: &[Body]) -> Option<BodyId> {
        self.bodies().iter().copied().max_by_key(|id| (bodies[*id as usize].priority, *id))
    }

    /// The list after crossing the surface of `body`.
    ///
    /// # Errors
    /// The crossing does not fit the list.
    pub fn cross(&self, body: BodyId, entering: bool) -> Result<Self, LostRay> {
        let place = self.bodies().iter().position(|id| *id == body);
        let mut after = *self;
        match (entering, place) {
            (true, None) if self.count == CAPACITY => return Err(LostRay::TooManyBodies),
            (true, None) => {
                after.bodies[after.count] = body;
                after.count += 1;
            }
            (true, Some(_)) => return Err(LostRay::EnteredTwice),
            (false, Some(at)) => {
                after.bodies.copy_within(at + 1..self.count, at);
                after.count -= 1;
            }
            (false, None) => return Err(LostRay::LeftWithoutEntering),
        }
        Ok(after)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bodies(priorities: &[i32]) -> Vec<Body> {
        let body = |p: &i32| Body { name: String::new(), material: 0, priority: *p };
        priorities.iter().map(body).collect()
    }

    #[test]
    fn the_highest_priority_fills_the_place_whatever_the_order_of_entry() {
        let bodies = bodies(&[1, 5, 1]);
        let both = Interior::OUTSIDE.cross(1, true).unwrap().cross(0, true).unwrap();
        assert_eq!(both.filling(&bodies), Some(1));
        let left = both.cross(1, false).unwrap();
        assert_eq!(left.filling(&bodies), Some(0));
        assert_eq!(left.cross(2, true).unwrap().filling(&bodies), Some(2));
        assert_eq!(left.cross(0, false).unwrap().filling(&bodies), None);
    }

    #[test]
    fn crossings_that_do_not_fit_are_told_apart() {
        let inside = Interior::OUTSIDE.cross(3, true).unwrap();
        assert_eq!(inside.cross(3, true), Err(LostRay::EnteredTwice));
        assert_eq!(inside.cross(4, false), Err(LostRay::LeftWithoutEntering));
        let full = (0..16).try_fold(Interior::OUTSIDE, |list, id| list.cross(id, true)).unwrap();
        assert_eq!(full.cross(16, true), Err(LostRay::TooManyBodies));
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Which triangles lie in one place with others.

use glam::DVec3;
use rayon::prelude::*;

use super::{Block, Link, Tree, WIDTH};

/// Faces are parallel whose normals differ in direction by no more than this cosine (2.6 degrees):
/// more than rounding turns any triangle but a sliver.
pub const PARALLEL: f64 = 0.999;

impl Tree {
    /// The farthest apart, in mm, that rounding takes two descriptions of one point of a surface.
    ///
    /// A vertex moves by √3·uR for the half extent R and u = 2⁻²⁴, a point of a triangle by no more
    /// than its corners, and both descriptions move: 4uR covers it. As much again is for the
    /// single precision of the files that meshes come from.
    pub fn rounding(&self) -> f64 {
        4.0 * f64::from(f32::EPSILON) * self.frame.half_extent.max_element()
    }

    /// Calls `visit` with every triangle whose box is `wanted`, and its corners in the world.
    /// Whatever is wanted of a box is wanted of all larger ones.
    pub fn select(
        &self,
        wanted: &impl Fn([DVec3; 2]) -> bool,
        visit: &mut impl FnMut(u32, &[DVec3; 3]),
    ) {
        self.select_below(self.root, wanted, visit);
    }

    fn select_below(
        &self,
        link: Link,
        wanted: &impl Fn([DVec3; 2]) -> bool,
        visit: &mut impl FnMut(u32, &[DVec3; 3]),
    ) {
        if link.is_leaf() {
            let block = &self.blocks[link.block_index()];
            for (triangle, corners) in block.in_world(link.lane_mask(), self.frame.centre) {
                if wanted(bounds(&corners)) {
                    visit(triangle, &corners);
                }
            }
            return;
        }
        let node = &self.nodes[link.node_index()];
        for slot in 0..WIDTH {
            let side = |at: usize| f64::from(node.bounds[at][slot]);
            let lo = DVec3::new(side(0), side(2), side(4)) + self.frame.centre;
            let hi = DVec3::new(side(1), side(3), side(5)) + self.frame.centre;
            if lo.x <= hi.x && wanted([lo, hi]) {
                self.select_below(node.children[slot], wanted, visit);
            }
        }
    }

    /// The triangles that have a face of another body within `reach` in their own plane, or seem to
    /// as far as boxes and planes can tell. `is_candidate` sorts out, by body and box, those that
    /// cannot have one, and `matters` the pairs of bodies that nobody asks about.
    pub fn touching(
        &self,
        bodies: &[u32],
        reach: f64,
        is_candidate: impl Fn(u32, [DVec3; 2]) -> bool + Sync,
        matters: impl Fn(u32, u32) -> bool + Sync,
    ) -> Vec<u32> {
        let touches = |(triangle, corners): &(u32, [DVec3; 3])| {
            let body = bodies[*triangle as usize];
            let [lo, hi] = bounds(corners);
            if !is_candidate(body, [lo, hi]) {
                return false;
            }
            let grown = [lo - DVec3::splat(reach), hi + DVec3::splat(reach)];
            let mut found = false;
            self.select(&|other| overlap(grown, other), &mut |other, other_corners| {
                found |= matters(body, bodies[other as usize])
                    && share_plane(corners, other_corners, reach);
            });
            found
        };
        let of_block = |block: &Block| {
            let all = block.in_world(u32::MAX, self.frame.centre);
            all.filter(touches).map(|(triangle, _)| triangle).collect::<Vec<u32>>()
        };
        self.blocks.par_iter().flat_map_iter(of_block).collect()
    }
}

impl Block {
    /// The triangles of some lanes, none twice, with their corners in the world.
    fn in_world(&self, lanes: u32, centre: DVec3) -> impl Iterator<Item = (u32, [DVec3; 3])> + '_ {
        let repeats = |lane: usize| lane > 0 && self.triangles[lane] == self.triangles[0];
        let used = move |lane: &usize| lanes >> lane & 1 == 1 && !repeats(*lane);
        (0..WIDTH).filter(used).map(move |lane| {
            (self.triangles[lane], self.corners(lane, [0, 1, 2]).map(|corner| corner + centre))
        })
    }
}

fn bounds([a, b, c]: &[DVec3; 3]) -> [DVec3; 2] {
    [a.min(*b).min(*c), a.max(*b).max(*c)]
}

/// Have two boxes, each a lower and an upper corner, a point in common?
pub fn overlap([a_lo, a_hi]: [DVec3; 2], [b_lo, b_hi]: [DVec3; 2]) -> bool {
    a_lo.cmple(b_hi).all() && b_lo.cmple(a_hi).all()
}

/// Are two triangles parallel, and neither wholly beyond `reach` on one side of the other's plane?
fn share_plane(first: &[DVec3; 3], second: &[DVec3; 3], reach: f64) -> bool {
    let normal = |[a, b, c]: &[DVec3; 3]| (*b - *a).cross(*c - *a).normalize_or_zero();
    let (n, m) = (normal(first), normal(second));
    let straddles = |n: DVec3, a: DVec3, others: &[DVec3; 3]| {
        let heights = others.map(|corner| n.dot(corner - a));
        heights.iter().any(|h| *h <= reach) && heights.iter().any(|h| *h >= -reach)
    };
    n.dot(m).abs() >= PARALLEL && straddles(n, first[0], second) && straddles(m, second[0], first)
}

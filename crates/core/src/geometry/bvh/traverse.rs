// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The walk through the tree, once for all instruction sets.

use std::mem::MaybeUninit;

use glam::DVec3;

use crate::math::Ray;

use super::lanes::Lanes;
use super::spread::Spread;
use super::{exact, Link, Probe, Tree, TriangleHit, MAX_DEPTH, WIDTH};

/// The nearest triangle so far that the ray crosses.
struct Crossing {
    /// Distance from the origin of the ray; before any crossing, that of the ray's end.
    t: f64,
    /// Index in the caller's list.
    triangle: u32,
    /// `None` before any crossing.
    block: Option<u32>,
    lane: u32,
    /// Weights of the corners: their sum is not one.
    weights: [f64; 3],
}

impl Crossing {
    /// None yet.
    #[inline(always)]
    fn none(t_max: f64) -> Self {
        Self { t: t_max, triangle: 0, block: None, lane: 0, weights: [0.0; 3] }
    }

    #[inline(always)]
    fn hit(&self, tree: &Tree, direction: DVec3) -> Option<TriangleHit> {
        let block = &tree.blocks[self.block? as usize];
        let corners = block.corners(self.lane as usize, [0, 1, 2]);
        let found = (self.t, self.triangle);
        Some(TriangleHit::new(found, direction, corners, self.weights, &tree.frame))
    }
}

/// A child yet to be visited, and where the ray enters its box.
#[derive(Clone, Copy)]
struct Pending {
    link: Link,
    near: f32,
}

/// Children yet to be visited: at each level at most all but the one being visited.
///
/// Left uninitialised, because to clear it for each ray would cost as much as to visit some ten
/// nodes.
type Stack = [MaybeUninit<Pending>; (WIDTH - 1) * MAX_DEPTH + 1];

/// The nearest crossing; of several at the same distance, the one with the lowest triangle.
#[inline(always)]
pub(super) fn closest<L: Lanes>(tree: &Tree, ray: &Ray) -> Option<TriangleHit> {
    let probe = &Probe::new(ray, &tree.frame)?;
    let lanes = Spread::<L>::new(probe);
    let octant = lanes.octant();
    let mut best = Crossing::none(probe.t_max);
    let mut limit = probe.limit(probe.t_max);
    let mut stack: Stack = [const { MaybeUninit::uninit() }; _];
    let mut height = 0;
    let mut link = tree.root;
    loop {
        if link.is_leaf() {
            if search_block(tree, link, probe, &lanes, &mut best) {
                limit = probe.limit(best.t);
            }
        } else {
            let node = &tree.nodes[link.node_index()];
            let (enter, leave) = lanes.boxes(node, L::splat(limit));
            let hits = enter.at_most(leave);
            // Five of six visits that hit anything hit one child.
            if hits & hits.wrapping_sub(1) == 0 && hits != 0 {
                link = node.children[hits.trailing_zeros() as usize % WIDTH];
                continue;
            }
            if hits != 0 {
                let order = node.order[octant];
                let slot = |position: u32| (order >> (3 * position) & 7) as usize;
                let mut hits = enter.at_most_in_order(leave, order);
                let enter = enter.store();
                // The nearest is visited now, the others are stacked with the farthest at the
                // bottom.
                let first = hits.trailing_zeros();
                hits &= hits - 1;
                while hits != 0 {
                    let last = hits.ilog2();
                    hits ^= 1 << last;
                    stack[height].write(Pending {
                        link: node.children[slot(last)],
                        near: enter[slot(last)],
                    });
                    height += 1;
                }
                link = node.children[slot(first)];
                continue;
            }
        }
        loop {
            if height == 0 {
                return best.hit(tree, ray.direction);
            }
            height -= 1;
            // SAFETY: all entries below the former `height` have been written.
            let pending = unsafe { stack[height].assume_init() };
            if pending.near <= limit {
                link = pending.link;
                break;
            }
        }
    }
}

/// Is there a crossing? The child with the fewest triangles is searched first, because it is the
/// cheapest to search. With `ALL` the search goes on, and every crossing is added to `found`.
#[inline(always)]
pub(super) fn any<L: Lanes, const ALL: bool>(
    tree: &Tree,
    ray: &Ray,
    found: &mut Vec<TriangleHit>,
) -> bool {
    let Some(probe) = &Probe::new(ray, &tree.frame) else {
        return false;
    };
    let lanes = Spread::<L>::new(probe);
    let limit = L::splat(probe.limit(probe.t_max));
    let mut best = Crossing::none(probe.t_max);
    let mut stack: Stack = [const { MaybeUninit::uninit() }; _];
    let mut height = 0;
    let mut link = tree.root;
    loop {
        if link.is_leaf() {
            if ALL {
                gather_block(tree, link, probe, &lanes, ray.direction, found);
            } else if search_block(tree, link, probe, &lanes, &mut best) {
                return true;
            }
        } else {
            let node = &tree.nodes[link.node_index()];
            let (enter, leave) = lanes.boxes(node, limit);
            let mut hits = enter.at_most(leave);
            if hits != 0 {
                let first = hits.trailing_zeros() as usize % WIDTH;
                hits &= hits - 1;
                while hits != 0 {
                    let last = hits.ilog2();
                    hits ^= 1 << last;
                    stack[height]
                        .write(Pending { link: node.children[last as usize % WIDTH], near: 0.0 });
                    height += 1;
                }
                link = node.children[first];
                continue;
            }
        }
        if height == 0 {
            return ALL && !found.is_empty();
        }
        height -= 1;
        // SAFETY: all entries below the former `height` have been written.
        link = unsafe { stack[height].assume_init() }.link;
    }
}

/// Looks for a crossing in a block that is nearer than `best`, and keeps it there. Was there one?
#[inline(always)]
fn search_block<L: Lanes>(
    tree: &Tree,
    link: Link,
    probe: &Probe,
    lanes: &Spread<L>,
    best: &mut Crossing,
) -> bool {
    let block = &tree.blocks[link.block_index()];
    let mut candidates = lanes.candidates(block) & link.lane_mask();
    let mut found = false;
    while candidates != 0 {
        let lane = candidates.trailing_zeros() as usize % WIDTH;
        candidates &= candidates - 1;
        let Some(point) = exact::cross(probe, &block.corners(lane, probe.axes)) else {
            continue;
        };
        let (t, triangle) = (probe.start + point.t, block.triangles[lane]);
        if (t, triangle) < (best.t, best.triangle) {
            found = true;
            *best = Crossing {
                t,
                triangle,
                block: Some(link.block_index() as u32),
                lane: lane as u32,
                weights: point.weights,
            };
        }
    }
    found
}

/// Adds every crossing of the probe with a block to `found`.
#[inline(always)]
fn gather_block<L: Lanes>(
    tree: &Tree,
    link: Link,
    probe: &Probe,
    lanes: &Spread<L>,
    direction: DVec3,
    found: &mut Vec<TriangleHit>,
) {
    let block = &tree.blocks[link.block_index()];
    let mut candidates = lanes.candidates(block) & link.lane_mask();
    while candidates != 0 {
        let lane = candidates.trailing_zeros() as usize % WIDTH;
        candidates &= candidates - 1;
        let crossed = exact::cross(probe, &block.corners(lane, probe.axes));
        let Some(point) = crossed.filter(|point| probe.start + point.t < probe.t_max) else {
            continue;
        };
        let (corners, place) = (block.corners(lane, [0, 1, 2]), probe.start + point.t);
        let triangle = (place, block.triangles[lane]);
        found.push(TriangleHit::new(triangle, direction, corners, point.weights, &tree.frame));
    }
}

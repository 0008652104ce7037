// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The walk through the tree, once for all instruction sets.

use std::mem::MaybeUninit;

use glam::DVec3;

use crate::math::Ray;

use super::lanes::Lanes;
use super::{exact, Block, Link, Node, Probe, Tree, TriangleHit, MAX_DEPTH, WIDTH};

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

/// The single-precision part of a probe, spread over lanes.
///
/// Whatever computes with lanes is a function marked `inline(always)`, never a closure: what is not
/// inlined into the entry points is compiled without their instruction set, and halved the speed.
struct Spread<L> {
    near_sides: [usize; 3],
    inverse_direction: [L; 3],
    near_offset: [L; 3],
    far_offset: [L; 3],
    /// In the order of `axes`.
    origin: [L; 3],
    axes: [usize; 3],
    shear: [L; 2],
    edge_slope: L,
    edge_constant: L,
}

#[inline(always)]
fn splat3<L: Lanes>(values: [f32; 3]) -> [L; 3] {
    [L::splat(values[0]), L::splat(values[1]), L::splat(values[2])]
}

/// x₁y₂ − y₁x₂
#[inline(always)]
fn edge<L: Lanes>(first: (L, L), second: (L, L)) -> L {
    first.0.mul_sub(second.1, first.1.mul(second.0))
}

#[inline(always)]
fn largest<L: Lanes>(a: L, b: L, c: L) -> L {
    a.abs().max(b.abs()).max(c.abs())
}

impl<L: Lanes> Spread<L> {
    #[inline(always)]
    fn new(probe: &Probe) -> Self {
        let single = &probe.single;
        let negative = single.inverse_direction.map(|d| usize::from(d < 0.0));
        Self {
            near_sides: [negative[0], 2 + negative[1], 4 + negative[2]],
            inverse_direction: splat3(single.inverse_direction),
            near_offset: splat3(single.near_offset),
            far_offset: splat3(single.far_offset),
            origin: splat3(single.turned_origin),
            axes: probe.axes,
            shear: [L::splat(single.shear[0]), L::splat(single.shear[1])],
            edge_slope: L::splat(single.edge_slope),
            edge_constant: L::splat(single.edge_constant),
        }
    }

    /// Bit k says that component k of the direction is negative.
    #[inline(always)]
    fn octant(&self) -> usize {
        let [x, y, z] = self.near_sides;
        x & 1 | (y & 1) << 1 | (z & 1) << 2
    }

    #[inline(always)]
    fn near(&self, node: &Node, axis: usize) -> L {
        let side = &node.bounds[self.near_sides[axis] % 6];
        L::load(side).mul_add(self.inverse_direction[axis], self.near_offset[axis])
    }

    #[inline(always)]
    fn far(&self, node: &Node, axis: usize) -> L {
        let side = &node.bounds[(self.near_sides[axis] ^ 1) % 6];
        L::load(side).mul_add(self.inverse_direction[axis], self.far_offset[axis])
    }

    /// Where the ray enters the children's boxes, and where it leaves them or ends.
    #[inline(always)]
    fn boxes(&self, node: &Node, limit: L) -> (L, L) {
        let enter =
            self.near(node, 0).max(self.near(node, 1)).max(self.near(node, 2).max(L::splat(0.0)));
        let leave = self.far(node, 0).min(self.far(node, 1)).min(self.far(node, 2).min(limit));
        (enter, leave)
    }

    /// The corner of eight triangles in the frame in which the ray is the z axis.
    #[inline(always)]
    fn shear(&self, corner: &[[f32; WIDTH]; 3]) -> (L, L) {
        let [i, j, k] = self.axes;
        let x = L::load(&corner[i % 3]).sub(self.origin[0]);
        let y = L::load(&corner[j % 3]).sub(self.origin[1]);
        let z = L::load(&corner[k % 3]).sub(self.origin[2]);
        (self.shear[0].mul_add(z, x), self.shear[1].mul_add(z, y))
    }

    /// The lanes of the block whose triangle the ray's line may cross.
    #[inline(always)]
    fn candidates(&self, block: &Block) -> u32 {
        let a = self.shear(&block.corners[0]);
        let b = self.shear(&block.corners[1]);
        let c = self.shear(&block.corners[2]);
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        let coordinate = largest(a.0, b.0, c.0).max(largest(a.1, b.1, c.1));
        let error = coordinate.mul_add(self.edge_slope, self.edge_constant);
        let least = u.min(v).min(w);
        let greatest = u.max(v).max(w);
        L::splat(0.0).sub(error).at_most(least) | greatest.at_most(error)
    }
}

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
/// cheapest to search.
#[inline(always)]
pub(super) fn any<L: Lanes>(tree: &Tree, ray: &Ray) -> bool {
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
            if search_block(tree, link, probe, &lanes, &mut best) {
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
            return false;
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

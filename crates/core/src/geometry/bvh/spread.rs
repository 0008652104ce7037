// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The conservative tests in single precision, eight at a time.

use super::lanes::Lanes;
use super::{Block, Node, Probe, WIDTH};

/// The single-precision part of a probe, spread over lanes.
///
/// Whatever computes with lanes is a function marked `inline(always)`, never a closure: what is not
/// inlined into the entry points is compiled without their instruction set, and halved the speed.
pub(super) struct Spread<L> {
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
    pub(super) fn new(probe: &Probe) -> Self {
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
    pub(super) fn octant(&self) -> usize {
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
    pub(super) fn boxes(&self, node: &Node, limit: L) -> (L, L) {
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
    pub(super) fn candidates(&self, block: &Block) -> u32 {
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

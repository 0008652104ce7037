// SPDX-License-Identifier: Apache-2.0 OR MIT
//! An 8-wide bounding volume hierarchy over triangles: single precision finds, double precision
//! decides.
//!
//! Nodes and triangles are stored in single precision, eight to a row, and tested eight at a time.
//! Both single-precision tests (box and triangle) are *conservative*: their rounding errors are
//! bounded and added, so they may let a near miss through but never lose a hit. What they let
//! through is decided in double precision, one triangle at a time, by a watertight test
//! ([`exact`]). The hit therefore depends on neither the instruction set nor the order of
//! traversal, and is as accurate as `f64` allows.
//!
//! [`build`] makes the tree, [`layout`] writes it into arrays, [`probe`] prepares a ray,
//! [`traverse`] walks the tree over the [`lanes`] of one instruction set, [`kernel`] chooses that
//! set at run time.

// What is not inlined into the entry points of an instruction set is compiled without it, at half
// the speed.
#![allow(clippy::inline_always)]

use glam::{DVec3, Vec3};

use crate::math::Ray;

mod build;
mod exact;
mod hit;
mod kernel;
mod lanes;
mod layout;
mod probe;
mod split;
mod spread;
#[cfg(test)]
mod tests;
mod touch;
mod traverse;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use hit::TriangleHit;
pub use kernel::Kernel;
use probe::{Frame, Probe};
pub use touch::{overlap, PARALLEL};

/// Triangles per block, children per node: the lanes of one 256-bit register of `f32`.
pub(super) const WIDTH: usize = 8;

/// No tree is deeper than this (`build` turns to median splits in time), so a stack of fixed size
/// suffices.
const MAX_DEPTH: usize = 36;

/// Eight triangles, corner by corner and axis by axis, lane = triangle. Unused lanes repeat the
/// first.
#[derive(Clone, PartialEq)]
#[repr(C, align(64))]
struct Block {
    /// `corners[corner][axis][lane]`, relative to the centre of the scene, in the unit of the
    /// scene.
    corners: [[[f32; WIDTH]; 3]; 3],
    /// Index of each triangle in the caller's list.
    triangles: [u32; WIDTH],
}

/// A node: the boxes of up to eight children, smallest number of triangles first.
#[derive(Clone, PartialEq)]
#[repr(C, align(64))]
struct Node {
    /// `bounds[2 * axis]` holds the lower, `bounds[2 * axis + 1]` the upper sides; unused slots are
    /// empty boxes.
    bounds: [[f32; WIDTH]; 6],
    children: [Link; WIDTH],
    /// Per octant of directions, the slots from near to far, three bits each.
    order: [u32; 8],
}

/// Where a child is: a node, or a block and the number of its lanes in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Link(u32);

impl Link {
    const LEAF: u32 = 1 << 31;
    /// Blocks that a link can tell apart.
    const MAX_BLOCKS: usize = 1 << 28;

    fn node(index: usize) -> Self {
        Self(index as u32)
    }

    fn leaf(block: usize, lanes: usize) -> Self {
        Self(Self::LEAF | (block as u32) << 3 | (lanes as u32 - 1))
    }

    #[inline(always)]
    fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    #[inline(always)]
    fn node_index(self) -> usize {
        self.0 as usize
    }

    #[inline(always)]
    fn block_index(self) -> usize {
        ((self.0 & !Self::LEAF) >> 3) as usize
    }

    /// One bit for each lane of the block that is in use.
    #[inline(always)]
    fn lane_mask(self) -> u32 {
        (2 << (self.0 & 7)) - 1
    }
}

/// The largest number of triangles that a [`Tree`] can hold.
pub(super) const MAX_TRIANGLES: usize = Link::MAX_BLOCKS;

/// The hierarchy over a set of triangles.
pub(super) struct Tree {
    nodes: Vec<Node>,
    blocks: Vec<Block>,
    root: Link,
    frame: Frame,
    /// One that this processor has.
    kernel: Kernel,
}

impl Tree {
    /// Builds the tree of triangles whose corners are in `vertices`, relative to `centre`: all
    /// finite, at least one triangle and at most [`MAX_TRIANGLES`], every index within `vertices`.
    pub fn build(centre: DVec3, vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Self {
        let half_extent = triangles
            .iter()
            .flatten()
            .map(|&vertex| Vec3::from_array(vertices[vertex as usize]).abs())
            .fold(Vec3::ZERO, Vec3::max)
            .as_dvec3();
        let mut references = build::references(vertices, triangles);
        let subtree = build::subtree(&mut references);
        let (nodes, blocks, root) = layout::write(&subtree, &references, vertices, triangles);
        Self { nodes, blocks, root, frame: Frame::new(centre, half_extent), kernel: Kernel::best() }
    }

    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// Chooses the kernel; false, and no change, if this processor does not have it.
    pub fn choose_kernel(&mut self, kernel: Kernel) -> bool {
        if kernel.is_available() {
            self.kernel = kernel;
        }
        kernel.is_available()
    }

    /// The nearest triangle that the ray crosses; of several at the same distance, the one with the
    /// lowest index.
    #[inline(always)]
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        self.kernel.closest(self, ray)
    }

    /// Does the ray cross any triangle?
    #[inline(always)]
    pub fn any(&self, ray: &Ray) -> bool {
        self.kernel.any(self, ray)
    }

    /// Adds every triangle that the ray crosses to `found`, in no particular order.
    pub fn all(&self, ray: &Ray, found: &mut Vec<TriangleHit>) {
        self.kernel.all(self, ray, found);
    }

    /// The lower and the upper corner of the box around all triangles.
    pub fn bounds(&self) -> [DVec3; 2] {
        let (centre, half_extent) = (self.frame.centre, self.frame.half_extent);
        [centre - half_extent, centre + half_extent]
    }

    /// A vertex as the blocks hold it, and the bound of error for points round it.
    pub fn as_traced(&self, vertex: DVec3) -> (DVec3, f64) {
        let Frame { centre, half_extent, .. } = self.frame;
        let rounded = centre + (vertex - centre).as_vec3().as_dvec3();
        (rounded, hit::position_error(rounded, half_extent))
    }

    /// Bytes of nodes and blocks.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.blocks.as_slice())
    }
}

impl Block {
    /// The corners of a triangle, with their coordinates in the order of `axes`.
    #[inline(always)]
    fn corners(&self, lane: usize, axes: [usize; 3]) -> [DVec3; 3] {
        [self.corner(0, lane, axes), self.corner(1, lane, axes), self.corner(2, lane, axes)]
    }

    #[inline(always)]
    fn corner(&self, corner: usize, lane: usize, [i, j, k]: [usize; 3]) -> DVec3 {
        let (axes, lane) = (&self.corners[corner], lane % WIDTH);
        let [x, y, z] = [axes[i % 3][lane], axes[j % 3][lane], axes[k % 3][lane]];
        DVec3::new(f64::from(x), f64::from(y), f64::from(z))
    }
}

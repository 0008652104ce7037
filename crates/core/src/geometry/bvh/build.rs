// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The hierarchy as a tree of sets: from the top down, each set is cut until there are eight.

use rayon::prelude::*;

use super::split::{self, Bounds, Extent, Reference};
use super::{MAX_DEPTH, WIDTH};

/// Sets of at least this many triangles become tasks of their own.
const TASK: usize = 1 << 12;

/// From this depth on, sets are cut in halves of equal number. Seven halvings, each of the largest
/// set, make eighths: then at most ten more levels bring 2²⁸ triangles down to blocks.
const HALVING_DEPTH: usize = MAX_DEPTH - 14;

/// A child of a node: its box and what is in it.
pub(super) struct Subtree {
    pub bounds: Bounds,
    /// The triangles are references `first..first + len`.
    pub first: usize,
    pub len: usize,
    /// From two to eight children, or none: then the triangles fit into one block.
    pub children: Vec<Subtree>,
    /// Nodes and blocks in all.
    pub nodes: usize,
    pub blocks: usize,
}

/// One reference per triangle.
pub(super) fn references(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<Reference> {
    triangles
        .par_iter()
        .enumerate()
        .with_min_len(TASK)
        .map(|(index, corners)| {
            Reference::new(corners.map(|corner| vertices[corner as usize]), index as u32)
        })
        .collect()
}

/// Builds the tree over all references, and brings them into its order.
///
/// What is cut where depends on the references alone, not on the number of threads.
pub(super) fn subtree(references: &mut [Reference]) -> Subtree {
    let extent = Extent::of(references);
    grow(Set { references, first: 0, extent }, 0)
}

struct Set<'a> {
    references: &'a mut [Reference],
    first: usize,
    extent: Extent,
}

impl<'a> Set<'a> {
    fn len(&self) -> usize {
        self.references.len()
    }

    fn cut(self, halve: bool) -> [Self; 2] {
        let (middle, extents) = if halve {
            split::in_half(self.references, &self.extent)
        } else {
            split::by_area(self.references, &self.extent)
        };
        let (below, above): (&'a mut _, &'a mut _) = self.references.split_at_mut(middle);
        [
            Set { references: below, first: self.first, extent: extents[0] },
            Set { references: above, first: self.first + middle, extent: extents[1] },
        ]
    }
}

fn grow(set: Set, depth: usize) -> Subtree {
    let (first, len, bounds) = (set.first, set.len(), set.extent.bounds);
    if len <= WIDTH {
        return Subtree { bounds, first, len, children: Vec::new(), nodes: 0, blocks: 1 };
    }
    let sets = cut_in_eight(set, depth >= HALVING_DEPTH);
    let children: Vec<Subtree> = if len >= TASK {
        sets.into_par_iter().map(|set| grow(set, depth + 1)).collect()
    } else {
        sets.into_iter().map(|set| grow(set, depth + 1)).collect()
    };
    Subtree {
        bounds,
        first,
        len,
        nodes: 1 + children.iter().map(|child| child.nodes).sum::<usize>(),
        blocks: children.iter().map(|child| child.blocks).sum(),
        children,
    }
}

/// Cuts until there are eight sets or each fits into a block: always the set with the largest
/// surface, or when halving the one with the most triangles.
fn cut_in_eight(set: Set, halve: bool) -> Vec<Set> {
    let mut sets = Vec::with_capacity(WIDTH);
    sets.push(set);
    while sets.len() < WIDTH {
        let size = |set: &Set| {
            if halve {
                set.len() as f32
            } else {
                set.extent.bounds.half_area()
            }
        };
        let largest = (0..sets.len())
            .filter(|&i| sets[i].len() > WIDTH)
            .max_by(|&i, &j| size(&sets[i]).total_cmp(&size(&sets[j])));
        let Some(largest) = largest else { break };
        let [below, above] = sets.swap_remove(largest).cut(halve);
        sets.push(below);
        sets.push(above);
    }
    sets
}

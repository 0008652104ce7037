// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The hierarchy as arrays: every node before its children, children with few triangles first.

use glam::Vec3;

use super::build::Subtree;
use super::split::{Bounds, Reference};
use super::{Block, Link, Node, WIDTH};

/// Subtrees with at least this many nodes are written as tasks of their own.
const TASK: usize = 1 << 8;

struct Source<'a> {
    references: &'a [Reference],
    vertices: &'a [[f32; 3]],
    triangles: &'a [[u32; 3]],
}

/// The part of the arrays that a subtree fills, and where it lies in them.
struct Target<'a> {
    nodes: &'a mut [Node],
    first_node: usize,
    blocks: &'a mut [Block],
    first_block: usize,
}

impl<'a> Target<'a> {
    /// Cuts off what the next subtree fills.
    fn take(&mut self, nodes: usize, blocks: usize) -> Target<'a> {
        let (these_nodes, other_nodes) = std::mem::take(&mut self.nodes).split_at_mut(nodes);
        let (these_blocks, other_blocks) = std::mem::take(&mut self.blocks).split_at_mut(blocks);
        let taken = Target {
            nodes: these_nodes,
            first_node: self.first_node,
            blocks: these_blocks,
            first_block: self.first_block,
        };
        *self = Target {
            nodes: other_nodes,
            first_node: self.first_node + nodes,
            blocks: other_blocks,
            first_block: self.first_block + blocks,
        };
        taken
    }
}

/// Writes nodes and blocks; returns them with the link to the root.
pub(super) fn write(
    root: &Subtree,
    references: &[Reference],
    vertices: &[[f32; 3]],
    triangles: &[[u32; 3]],
) -> (Vec<Node>, Vec<Block>, Link) {
    let source = Source { references, vertices, triangles };
    let mut nodes = vec![Node::EMPTY; root.nodes];
    let mut blocks = vec![Block::EMPTY; root.blocks];
    let target = Target { nodes: &mut nodes, first_node: 0, blocks: &mut blocks, first_block: 0 };
    let link = fill(root, &source, target);
    (nodes, blocks, link)
}

fn fill(subtree: &Subtree, source: &Source, mut target: Target) -> Link {
    if subtree.children.is_empty() {
        let link = Link::leaf(target.first_block, subtree.len);
        if let Some(block) = target.blocks.first_mut() {
            *block = source.block(&source.references[subtree.first..subtree.first + subtree.len]);
        }
        return link;
    }
    let mut children: Vec<&Subtree> = subtree.children.iter().collect();
    children.sort_by_key(|child| child.len);
    let this = target.take(1, 0);
    let parts: Vec<(&Subtree, Target)> =
        children.iter().map(|child| (*child, target.take(child.nodes, child.blocks))).collect();
    let links = fill_all(parts, source, subtree.nodes >= TASK);
    let link = Link::node(this.first_node);
    if let Some(node) = this.nodes.first_mut() {
        let boxes: Vec<Bounds> = children.iter().map(|child| child.bounds).collect();
        *node = Node::new(&boxes, &links);
    }
    link
}

fn fill_all(mut parts: Vec<(&Subtree, Target)>, source: &Source, parallel: bool) -> Vec<Link> {
    if parallel && parts.len() > 1 {
        let others = parts.split_off(parts.len() / 2);
        let (mut links, other_links) =
            rayon::join(|| fill_all(parts, source, true), || fill_all(others, source, true));
        links.extend(other_links);
        return links;
    }
    parts.into_iter().map(|(child, target)| fill(child, source, target)).collect()
}

impl Source<'_> {
    fn block(&self, references: &[Reference]) -> Block {
        let mut block = Block::EMPTY;
        for lane in 0..WIDTH {
            let triangle = references[if lane < references.len() { lane } else { 0 }].triangle();
            block.triangles[lane] = triangle as u32;
            for corner in 0..3 {
                let vertex = self.vertices[self.triangles[triangle][corner] as usize];
                for (axis, coordinate) in vertex.into_iter().enumerate() {
                    block.corners[corner][axis][lane] = coordinate;
                }
            }
        }
        block
    }
}

impl Block {
    const EMPTY: Self = Self { corners: [[[0.0; WIDTH]; 3]; 3], triangles: [0; WIDTH] };
}

impl Node {
    const EMPTY: Self = Self {
        bounds: [
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
            [f32::INFINITY; WIDTH],
            [f32::NEG_INFINITY; WIDTH],
        ],
        children: [Link(0); WIDTH],
        order: [0; 8],
    };

    fn new(boxes: &[Bounds], links: &[Link]) -> Self {
        let mut node = Self::EMPTY;
        for (slot, (bounds, link)) in boxes.iter().zip(links).enumerate() {
            for axis in 0..3 {
                node.bounds[2 * axis][slot] = bounds.lo[axis];
                node.bounds[2 * axis + 1][slot] = bounds.hi[axis];
            }
            node.children[slot] = *link;
        }
        for octant in 0..8 {
            node.order[octant] = near_to_far(boxes, octant);
        }
        node
    }
}

/// The slots by the distance of their boxes' centres along the middle of an octant, whose bit k
/// says that component k of the direction is negative. Unused slots come last.
fn near_to_far(boxes: &[Bounds], octant: usize) -> u32 {
    let sign = |axis: usize| if octant >> axis & 1 == 0 { 1.0 } else { -1.0 };
    let direction = Vec3::new(sign(0), sign(1), sign(2));
    let mut distances = [f32::INFINITY; WIDTH];
    for (distance, bounds) in distances.iter_mut().zip(boxes) {
        *distance = (bounds.lo + bounds.hi).truncate().dot(direction);
    }
    let mut slots: [u32; WIDTH] = std::array::from_fn(|slot| slot as u32);
    slots.sort_by(|&i, &j| distances[i as usize].total_cmp(&distances[j as usize]));
    slots.iter().rev().fold(0, |order, slot| order << 3 | slot)
}

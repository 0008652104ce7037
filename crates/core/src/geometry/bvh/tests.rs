// SPDX-License-Identifier: Apache-2.0 OR MIT

use super::*;

/// A wavy sheet of 2 n² triangles.
fn sheet(n: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let mut vertices = Vec::new();
    for row in 0..=n {
        for column in 0..=n {
            let [x, y] = [column, row].map(|i| i as f32 / n as f32 - 0.5);
            vertices.push([x, y, 0.1 * (20.0 * x).sin() * (30.0 * y).cos()]);
        }
    }
    let quads = (0..n * n).map(|i| i / n * (n + 1) + i % n);
    let triangles =
        quads.flat_map(|a| [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]).collect();
    (vertices, triangles)
}

fn build((vertices, triangles): &(Vec<[f32; 3]>, Vec<[u32; 3]>)) -> Tree {
    Tree::build(DVec3::ZERO, vertices, triangles)
}

/// Levels below a link, and how often each triangle is in a block in use.
fn census(tree: &Tree, link: Link, counts: &mut [u32]) -> usize {
    if link.is_leaf() {
        let block = &tree.blocks[link.block_index()];
        for (lane, &triangle) in block.triangles.iter().enumerate() {
            counts[triangle as usize] += link.lane_mask() >> lane & 1;
        }
        return 0;
    }
    let node = &tree.nodes[link.node_index()];
    let used = (0..WIDTH).filter(|&slot| node.bounds[0][slot] <= node.bounds[1][slot]);
    1 + used.map(|slot| census(tree, node.children[slot], counts)).max().unwrap()
}

#[test]
fn the_number_of_threads_does_not_change_the_tree() {
    let mesh = sheet(200);
    let reference = build(&mesh);
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let tree = pool.install(|| build(&mesh));
        assert!(tree.nodes == reference.nodes && tree.blocks == reference.blocks);
    }
}

#[test]
fn every_triangle_is_in_one_block() {
    let mesh = sheet(90);
    let tree = build(&mesh);
    let mut counts = vec![0; mesh.1.len()];
    census(&tree, tree.root, &mut counts);
    assert!(counts.iter().all(|&count| count == 1));
}

#[test]
fn a_triangle_takes_at_most_120_bytes() {
    let mesh = sheet(100);
    assert!(build(&mesh).memory_bytes() <= 120 * mesh.1.len());
}

#[test]
fn no_mesh_makes_the_tree_too_deep() {
    let shrinking = |i: u32| 0.5_f32.powi(i as i32 % 120);
    let spread: Vec<[f32; 3]> =
        (0..30_000).map(|i| [shrinking(i), 1.5 * shrinking(i), 0.0]).collect();
    let triangles: Vec<[u32; 3]> = (0..10_000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let piled = vec![[1.0, 2.0, 3.0]; 30_000];
    for vertices in [spread, piled] {
        let tree = Tree::build(DVec3::ZERO, &vertices, &triangles);
        let mut counts = vec![0; triangles.len()];
        assert!(census(&tree, tree.root, &mut counts) <= MAX_DEPTH);
        assert!(counts.iter().all(|&count| count == 1));
    }
}

#[test]
fn an_octant_orders_children_from_near_to_far() {
    let tree = build(&sheet(8));
    let node = &tree.nodes[0];
    for (octant, order) in node.order.iter().enumerate() {
        let sign = |axis: usize| if octant >> axis & 1 == 0 { 1.0 } else { -1.0 };
        let distance = |slot: usize| -> f32 {
            (0..3)
                .map(|axis| {
                    sign(axis) * (node.bounds[2 * axis][slot] + node.bounds[2 * axis + 1][slot])
                })
                .sum()
        };
        let slots: Vec<usize> = (0..WIDTH).map(|i| (order >> (3 * i) & 7) as usize).collect();
        let used: Vec<f32> =
            slots.iter().map(|&slot| distance(slot)).filter(|d| d.is_finite()).collect();
        assert!(used.len() > 1 && used.is_sorted());
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Tree`]: space cut into regions, so that each has seen about as much light.

use crate::math::DVec3;

/// A cut of space square to an axis, or a region.
#[derive(Clone, Copy, Debug)]
enum Node {
    /// Below `at` the next node follows, else node `above`.
    Cut {
        axis: usize,
        at: f64,
        above: u32,
    },
    Region(u32),
}

/// A k-d tree.
#[derive(Clone, Debug)]
pub(super) struct Tree(Vec<Node>);

impl Tree {
    /// Cut space until no region holds more than `most` of the `items`, which are put in the order of
    /// the regions; and their numbers, region by region.
    pub fn cut<T>(
        items: &mut [T],
        most: usize,
        place: impl Fn(&T) -> DVec3 + Copy,
    ) -> (Self, Vec<usize>) {
        let (mut nodes, mut counts) = (Vec::new(), Vec::new());
        cut(&mut nodes, &mut counts, items, most, place);
        (Self(nodes), counts)
    }

    /// The number of the region that holds `place`.
    pub fn find(&self, place: DVec3) -> usize {
        let mut node = 0;
        loop {
            match self.0[node] {
                Node::Cut { axis, at, .. } if place[axis] < at => node += 1,
                Node::Cut { above, .. } => node = above as usize,
                Node::Region(number) => return number as usize,
            }
        }
    }
}

fn cut<T>(
    nodes: &mut Vec<Node>,
    counts: &mut Vec<usize>,
    items: &mut [T],
    most: usize,
    place: impl Fn(&T) -> DVec3 + Copy,
) {
    let first = items.first().map_or(DVec3::ZERO, place);
    let (low, high) =
        items.iter().map(place).fold((first, first), |(low, high), at| (low.min(at), high.max(at)));
    let size = high - low;
    if items.len() <= most || size.max_element() <= 0.0 {
        nodes.push(Node::Region(counts.len() as u32));
        counts.push(items.len());
        return;
    }
    let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
    let middle = items.len() / 2;
    let by_place = |a: &T, b: &T| place(a)[axis].total_cmp(&place(b)[axis]);
    let (_, item, _) = items.select_nth_unstable_by(middle, by_place);
    let mut at = place(item)[axis];
    if at <= low[axis] {
        at = at.next_up();
    }
    // Equal places belong together, on the upper side.
    let below = partition(items, |item| place(item)[axis] < at);
    let own = nodes.len();
    nodes.push(Node::Cut { axis, at, above: 0 });
    let (lower, upper) = items.split_at_mut(below);
    cut(nodes, counts, lower, most, place);
    let above = nodes.len() as u32;
    nodes[own] = Node::Cut { axis, at, above };
    cut(nodes, counts, upper, most, place);
}

/// Put the items that `is_below` first, and return how many they are.
fn partition<T>(items: &mut [T], is_below: impl Fn(&T) -> bool) -> usize {
    let mut below = 0;
    for at in 0..items.len() {
        if is_below(&items[at]) {
            items.swap(below, at);
            below += 1;
        }
    }
    below
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_is_found_in_the_region_that_counts_it() {
        let golden = |i: u32, step: f64| (f64::from(i) * step).fract();
        let mut places: Vec<DVec3> = (0..3000)
            .map(|i| DVec3::new(golden(i, 0.618), golden(i, 0.755).powi(3), f64::from(i % 7)))
            .collect();
        places.extend([DVec3::ONE; 200]);
        let (tree, counts) = Tree::cut(&mut places, 100, |place| *place);
        assert_eq!(counts.iter().sum::<usize>(), 3200);
        assert!(counts.len() > 32 && counts.iter().all(|count| *count > 0 && *count <= 200));
        let mut at = 0;
        for (region, count) in counts.into_iter().enumerate() {
            assert!(places[at..at + count].iter().all(|place| tree.find(*place) == region));
            at += count;
        }
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Where to cut a set of triangles in two: the surface area heuristic over bins of centroids.

use glam::Vec4;
use rayon::prelude::*;

use super::WIDTH;

const BINS: usize = 16;

/// Sets of at least this many triangles are binned by all threads.
const PARALLEL: usize = 1 << 16;

/// A box; the fourth components mean nothing. Minimum and maximum are exact, so no order of growing
/// changes it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub lo: Vec4,
    pub hi: Vec4,
}

impl Bounds {
    pub const EMPTY: Self = Self { lo: Vec4::INFINITY, hi: Vec4::NEG_INFINITY };

    #[inline(always)]
    pub fn union(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    #[inline(always)]
    fn with(self, point: Vec4) -> Self {
        Self { lo: self.lo.min(point), hi: self.hi.max(point) }
    }

    /// Half the surface; 0 for an empty box.
    #[inline(always)]
    pub fn half_area(self) -> f32 {
        let size = (self.hi - self.lo).max(Vec4::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// The box of a triangle, and in the bits of `hi.w` its index.
#[derive(Clone, Copy)]
pub(super) struct Reference(Bounds);

impl Reference {
    pub fn new(corners: [[f32; 3]; 3], triangle: u32) -> Self {
        let bounds = corners
            .iter()
            .fold(Bounds::EMPTY, |bounds, &[x, y, z]| bounds.with(Vec4::new(x, y, z, 0.0)));
        Self(Bounds { lo: bounds.lo, hi: bounds.hi.truncate().extend(f32::from_bits(triangle)) })
    }

    #[inline(always)]
    pub fn triangle(&self) -> usize {
        self.0.hi.w.to_bits() as usize
    }

    #[inline(always)]
    fn doubled_centroid(&self) -> Vec4 {
        self.0.lo + self.0.hi
    }
}

/// The box of a set of triangles and the box of their centroids, times two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub bounds: Bounds,
    centroids: Bounds,
}

impl Extent {
    const EMPTY: Self = Self { bounds: Bounds::EMPTY, centroids: Bounds::EMPTY };

    pub fn of(references: &[Reference]) -> Self {
        references.iter().fold(Self::EMPTY, Self::with)
    }

    #[inline(always)]
    fn with(self, reference: &Reference) -> Self {
        Self {
            bounds: self.bounds.union(reference.0),
            centroids: self.centroids.with(reference.doubled_centroid()),
        }
    }
}

/// Maps doubled centroids to bins, all three axes at once.
#[derive(Clone, Copy)]
struct Grid {
    origin: Vec4,
    scale: Vec4,
    bins: usize,
}

impl Grid {
    fn new(centroids: Bounds, len: usize) -> Self {
        let bins = if len < 64 { BINS / 2 } else { BINS };
        let size = centroids.hi - centroids.lo;
        Self {
            origin: centroids.lo,
            // A little less than `bins`, so that the upper end falls into the last bin; an axis
            // without size has one bin.
            scale: Vec4::select(size.cmpgt(Vec4::ZERO), bins as f32 * 0.999_99 / size, Vec4::ZERO),
            bins,
        }
    }

    #[inline(always)]
    fn bin(&self, reference: &Reference) -> [usize; 3] {
        let position = (reference.doubled_centroid() - self.origin) * self.scale;
        [position.x, position.y, position.z].map(|x| (x as i32 as usize).min(BINS - 1))
    }
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds,
    count: usize,
}

type Histogram = [[Bin; BINS]; 3];

fn histogram(references: &[Reference], grid: &Grid) -> Histogram {
    let empty = Bin { bounds: Bounds::EMPTY, count: 0 };
    let mut bins = [[empty; BINS]; 3];
    for reference in references {
        let at = grid.bin(reference);
        for axis in 0..3 {
            let bin = &mut bins[axis][at[axis]];
            bin.bounds = bin.bounds.union(reference.0);
            bin.count += 1;
        }
    }
    bins
}

fn parallel_histogram(references: &[Reference], grid: &Grid) -> Histogram {
    let merge = |a: Histogram, b: Histogram| {
        std::array::from_fn(|axis| {
            std::array::from_fn(|i| Bin {
                bounds: a[axis][i].bounds.union(b[axis][i].bounds),
                count: a[axis][i].count + b[axis][i].count,
            })
        })
    };
    references
        .par_chunks(PARALLEL / 4)
        .map(|chunk| histogram(chunk, grid))
        .reduce_with(merge)
        .unwrap_or_else(|| histogram(references, grid))
}

/// The cheapest cut: triangles whose bin on `axis` is below `bin` go first.
struct Cut {
    axis: usize,
    bin: usize,
}

/// Area times number of blocks, summed over both sides, is least; `None` if all centroids share one
/// bin.
fn cheapest_cut(histogram: &Histogram, bins: usize) -> Option<Cut> {
    let cost = |bounds: Bounds, count: usize| bounds.half_area() * count.div_ceil(WIDTH) as f32;
    let mut cheapest = (f32::INFINITY, None);
    for (axis, row) in histogram.iter().enumerate() {
        let mut above = [f32::INFINITY; BINS];
        let (mut bounds, mut count) = (Bounds::EMPTY, 0);
        for i in (1..bins).rev() {
            bounds = bounds.union(row[i].bounds);
            count += row[i].count;
            above[i] = if count == 0 { f32::INFINITY } else { cost(bounds, count) };
        }
        let (mut bounds, mut count) = (Bounds::EMPTY, 0);
        for i in 1..bins {
            bounds = bounds.union(row[i - 1].bounds);
            count += row[i - 1].count;
            let sum = cost(bounds, count) + above[i];
            if count > 0 && sum < cheapest.0 {
                cheapest = (sum, Some(Cut { axis, bin: i }));
            }
        }
    }
    cheapest.1
}

/// Cuts the set in two where the surface area heuristic is least and moves the triangles
/// accordingly: returns the length of the first part and both extents. Neither part is empty. The
/// set must hold at least two triangles.
pub(super) fn by_area(references: &mut [Reference], extent: &Extent) -> (usize, [Extent; 2]) {
    let grid = Grid::new(extent.centroids, references.len());
    let histogram = if references.len() >= PARALLEL {
        parallel_histogram(references, &grid)
    } else {
        histogram(references, &grid)
    };
    let Some(cut) = cheapest_cut(&histogram, grid.bins) else {
        return in_half(references, extent);
    };
    let mut extents = [Extent::EMPTY; 2];
    let (mut first, mut end) = (0, references.len());
    while first < end {
        if grid.bin(&references[first])[cut.axis] < cut.bin {
            extents[0] = extents[0].with(&references[first]);
            first += 1;
        } else {
            extents[1] = extents[1].with(&references[first]);
            end -= 1;
            references.swap(first, end);
        }
    }
    (first, extents)
}

/// Cuts the set in two halves of equal number along the longest axis of the centroids. What
/// `by_area` falls back to.
pub(super) fn in_half(references: &mut [Reference], extent: &Extent) -> (usize, [Extent; 2]) {
    let size = extent.centroids.hi - extent.centroids.lo;
    let axis = size.truncate().max_position();
    let middle = references.len() / 2;
    references.select_nth_unstable_by(middle, |a, b| {
        let key = |reference: &Reference| reference.doubled_centroid()[axis];
        key(a).total_cmp(&key(b)).then(a.triangle().cmp(&b.triangle()))
    });
    let (first, second) = references.split_at(middle);
    (middle, [Extent::of(first), Extent::of(second)])
}

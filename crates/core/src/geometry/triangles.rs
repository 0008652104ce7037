// SPDX-License-Identifier: Apache-2.0 OR MIT
//! All triangles of a scene, and where rays meet them.

use glam::DVec3;
use thiserror::Error;

pub use super::bvh::TriangleHit;
use super::bvh::{Kernel, Tree, MAX_TRIANGLES};
use crate::math::Ray;

#[cfg(test)]
mod tests;

/// The largest scene, in its unit: its squares must fit into single precision.
const MAX_EXTENT: f64 = 1e12;

/// Why triangles cannot be used.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TrianglesError {
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {vertex}, but there are {vertices} vertices")]
    NoSuchVertex {
        /// Index of the triangle.
        triangle: usize,
        /// Index that it names.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A vertex of a triangle is infinite or not a number.
    #[error("vertex {vertex} of triangle {triangle} is not finite")]
    NotFinite {
        /// Index of the triangle.
        triangle: usize,
        /// Index of the vertex.
        vertex: u32,
    },
    /// The box around all triangles is too large for single precision.
    #[error("the meshes extend over {extent:e} mm; at most {MAX_EXTENT:e} mm is possible")]
    TooLarge {
        /// Longest side of the box.
        extent: f64,
    },
    /// More triangles than the index has room for.
    #[error("{triangles} triangles are too many; at most {MAX_TRIANGLES} are possible")]
    TooMany {
        /// Number of triangles.
        triangles: usize,
    },
    /// The processor lacks the instruction set.
    #[error("this processor cannot run the {kernel} kernel")]
    NoSuchKernel {
        /// The kernel that was asked for.
        kernel: Kernel,
    },
}

/// Triangles in world space, with an index to trace rays through them.
///
/// Vertices are taken relative to the middle of their box and rounded to single precision (half a
/// unit in the last place is 4 nm at 100 mm). **These rounded triangles are the geometry**; towards
/// them everything is exact to double precision: which triangle is hit, in what order, at what
/// distance.
///
/// A ray crosses both sides of a triangle, and never slips between two that share vertices. It does
/// not meet the triangle that it starts from if its origin was moved off by [`TriangleHit::error`].
/// Nothing in the result depends on the kernel or the number of threads.
pub struct Triangles {
    /// `None` without triangles.
    tree: Option<Tree>,
    len: usize,
}

impl Triangles {
    /// Builds the index over `triangles`, three indices into `vertices` (mm) each,
    /// counter-clockwise seen from outside. Uses rayon's current thread pool; its size does not
    /// change the result.
    ///
    /// # Errors
    /// An index beyond the vertices, a vertex that is not finite, and meshes too large or too many.
    pub fn build(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Self, TrianglesError> {
        if triangles.len() > MAX_TRIANGLES {
            return Err(TrianglesError::TooMany { triangles: triangles.len() });
        }
        let (lo, hi) = bounds(vertices, triangles)?;
        if triangles.is_empty() {
            return Ok(Self { tree: None, len: 0 });
        }
        let extent = (hi - lo).max_element();
        if extent > MAX_EXTENT {
            return Err(TrianglesError::TooLarge { extent });
        }
        let centre = lo + (hi - lo) / 2.0;
        let rounded: Vec<[f32; 3]> = vertices
            .iter()
            .map(|&vertex| (DVec3::from_array(vertex) - centre).as_vec3().to_array())
            .collect();
        Ok(Self { tree: Some(Tree::build(centre, &rounded, triangles)), len: triangles.len() })
    }

    /// The same triangles, traced by another kernel: for tests and measurements. All give the same
    /// hits.
    ///
    /// # Errors
    /// If this processor does not have the kernel's instruction set.
    pub fn with_kernel(mut self, kernel: Kernel) -> Result<Self, TrianglesError> {
        if let Some(tree) = &mut self.tree {
            if !tree.choose_kernel(kernel) {
                return Err(TrianglesError::NoSuchKernel { kernel });
            }
        }
        Ok(self)
    }

    /// The nearest triangle that the ray meets at 0 < t < `t_max`; of several at the same t the one
    /// with the lowest index.
    #[inline]
    pub fn closest_hit(&self, ray: &Ray) -> Option<TriangleHit> {
        self.tree.as_ref()?.closest(ray)
    }

    /// Does the ray meet any triangle at 0 < t < `t_max`?
    #[inline]
    pub fn any_hit(&self, ray: &Ray) -> bool {
        self.tree.as_ref().is_some_and(|tree| tree.any(ray))
    }

    /// Adds every triangle that the ray meets at 0 < t < `t_max` to `found`, in no particular order.
    pub fn all_hits(&self, ray: &Ray, found: &mut Vec<TriangleHit>) {
        if let Some(tree) = &self.tree {
            tree.all(ray, found);
        }
    }

    /// The farthest apart, in mm, that single precision takes two descriptions of one surface, such
    /// as the touching faces of two bodies: 50 nm where the meshes extend over 200 mm.
    pub fn rounding(&self) -> f64 {
        self.tree.as_ref().map_or(0.0, Tree::rounding)
    }

    /// The triangles of which another body's triangle, by `bodies`, seems to lie within `reach` mm in
    /// the same plane. `is_candidate` sorts out, by body and box, those that cannot have one.
    pub fn touching(
        &self,
        bodies: &[u32],
        reach: f64,
        is_candidate: impl Fn(u32, [DVec3; 2]) -> bool + Sync,
        matters: impl Fn(u32, u32) -> bool + Sync,
    ) -> Vec<u32> {
        let tree = self.tree.as_ref();
        tree.map_or_else(Vec::new, |tree| tree.touching(bodies, reach, is_candidate, matters))
    }

    /// The triangles whose box is `wanted`; whatever is wanted of a box is wanted of all larger ones.
    pub fn in_boxes(&self, wanted: impl Fn([DVec3; 2]) -> bool) -> Vec<u32> {
        let mut found = Vec::new();
        if let Some(tree) = &self.tree {
            tree.select(&wanted, &mut |triangle, _| found.push(triangle));
        }
        found
    }

    /// A vertex as rays see it, of those that the index was built over: rounded to single precision
    /// towards the middle; and how far a point on its triangles may be off.
    pub fn as_traced(&self, vertex: [f64; 3]) -> (DVec3, f64) {
        let vertex = DVec3::from_array(vertex);
        self.tree.as_ref().map_or((vertex, 0.0), |tree| tree.as_traced(vertex))
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Are there no triangles?
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Lower and upper corner (mm) of the box around all triangles; `None` without triangles.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        Some(self.tree.as_ref()?.bounds())
    }

    /// Bytes that the index takes in memory.
    pub fn memory_bytes(&self) -> usize {
        self.tree.as_ref().map_or(0, Tree::memory_bytes)
    }

    /// The kernel that traces: `portable`, `avx2` or `avx512`.
    pub fn kernel_name(&self) -> &'static str {
        self.tree.as_ref().map_or(Kernel::best(), Tree::kernel).name()
    }
}

/// The box around the vertices that the triangles use.
fn bounds(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<(DVec3, DVec3), TrianglesError> {
    let (mut lo, mut hi) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (triangle, corners) in triangles.iter().enumerate() {
        for &vertex in corners {
            let point = vertices.get(vertex as usize).ok_or(TrianglesError::NoSuchVertex {
                triangle,
                vertex,
                vertices: vertices.len(),
            })?;
            let point = DVec3::from_array(*point);
            if !point.is_finite() {
                return Err(TrianglesError::NotFinite { triangle, vertex });
            }
            lo = lo.min(point);
            hi = hi.max(point);
        }
    }
    Ok((lo, hi))
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! All triangles of a scene, and where rays meet them.

use glam::DVec3;
use thiserror::Error;

use super::bvh::{Kernel, Segment, Tree, MAX_TRIANGLES};
use super::ray::Ray;

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

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance along the ray.
    pub t: f64,
    /// Index of the triangle in the list that was given to [`Triangles::build`].
    pub triangle: u32,
    /// Weights u of the second and v of the third corner; that of the first is 1 − u − v.
    pub barycentric: [f64; 2],
    /// The point on the triangle.
    pub position: DVec3,
    /// Unit normal of the triangle, (p₁ − p₀) × (p₂ − p₀) in the order of its corners, whichever side is hit.
    /// A triangle without area faces the ray.
    pub normal: DVec3,
    /// A ray that goes on from here must start this far from `position` along the normal, on its side.
    pub error: f64,
}

/// Triangles in world space, with an index to trace rays through them.
///
/// Vertices are taken relative to the middle of their box and rounded to single precision (half a unit in the last place
/// is 4 nm at 100 mm). **These rounded triangles are the geometry**; towards them everything is exact to double precision:
/// which triangle is hit, in what order, at what distance.
///
/// A ray crosses both sides of a triangle, and never slips between two that share vertices. It does not meet the triangle that it starts
/// from if its origin was moved off by [`TriangleHit::error`]. Nothing in the result depends on the kernel or the number of threads.
pub struct Triangles {
    /// `None` without triangles.
    tree: Option<Tree>,
    len: usize,
    /// The middle of the box around all vertices.
    centre: DVec3,
}

impl Triangles {
    /// Builds the index over `triangles`, three indices into `vertices` (mm) each, counter-clockwise seen from outside.
    /// Uses rayon's current thread pool; its size does not change the result.
    ///
    /// # Errors
    /// An index beyond the vertices, a vertex that is not finite, and meshes too large or too many.
    pub fn build(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Self, TrianglesError> {
        if triangles.len() > MAX_TRIANGLES {
            return Err(TrianglesError::TooMany {
                triangles: triangles.len(),
            });
        }
        let (lo, hi) = bounds(vertices, triangles)?;
        if triangles.is_empty() {
            let (tree, len, centre) = (None, 0, DVec3::ZERO);
            return Ok(Self { tree, len, centre });
        }
        let extent = (hi - lo).max_element();
        if !(extent <= MAX_EXTENT) {
            return Err(TrianglesError::TooLarge { extent });
        }
        let centre = lo + (hi - lo) / 2.0;
        let rounded: Vec<[f32; 3]> = vertices
            .iter()
            .map(|&vertex| (DVec3::from_array(vertex) - centre).as_vec3().to_array())
            .collect();
        Ok(Self {
            tree: Some(Tree::build(&rounded, triangles)),
            len: triangles.len(),
            centre,
        })
    }

    /// The same triangles, traced by another kernel: for tests and measurements. All give the same hits.
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

    /// The nearest triangle that the ray meets at 0 < t < `t_max`; of several at the same t the one with the lowest index.
    #[inline]
    pub fn closest_hit(&self, ray: &Ray) -> Option<TriangleHit> {
        let tree = self.tree.as_ref()?;
        let crossing = tree.closest(&self.segment(ray))?;
        let [a, b, c] = tree.corners(&crossing);
        let [w, u, v] = crossing.weights;
        let scale = 1.0 / (w + u + v);
        let (u, v) = (u * scale, v * scale);
        let local = a + (u * (b - a) + v * (c - a));
        let position = self.centre + local;
        Some(TriangleHit {
            t: crossing.t,
            triangle: crossing.triangle,
            barycentric: [u, v],
            position,
            normal: (b - a)
                .cross(c - a)
                .try_normalize()
                .unwrap_or(-ray.direction),
            error: position_error(position, tree.half_extent()),
        })
    }

    /// Does the ray meet any triangle at 0 < t < `t_max`?
    #[inline]
    pub fn any_hit(&self, ray: &Ray) -> bool {
        self.tree
            .as_ref()
            .is_some_and(|tree| tree.any(&self.segment(ray)))
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
        let half_extent = self.tree.as_ref()?.half_extent();
        Some([self.centre - half_extent, self.centre + half_extent])
    }

    /// Bytes that the index takes in memory.
    pub fn memory_bytes(&self) -> usize {
        self.tree.as_ref().map_or(0, Tree::memory_bytes)
    }

    /// The kernel that traces: `portable`, `avx2` or `avx512`.
    pub fn kernel_name(&self) -> &'static str {
        self.tree
            .as_ref()
            .map_or(Kernel::best(), Tree::kernel)
            .name()
    }

    /// The ray relative to the centre.
    #[inline]
    fn segment(&self, ray: &Ray) -> Segment {
        Segment {
            origin: ray.origin - self.centre,
            direction: ray.direction,
            t_max: ray.t_max,
        }
    }
}

/// How far a ray that starts at `position` must be moved along the normal to be on its side of the triangle.
///
/// Let u = 2⁻⁵³, V the largest coordinate relative to the centre, P the largest of the position. The point
/// a + (u(b − a) + v(c − a)) lies in the triangle's plane whatever the rounding of u and v; its own roundings add up to 6uV per
/// coordinate. Then come the addition of the centre (uP), the move itself (uP), and the subtraction of the centre (uV) before
/// the next test: 7uV + 2uP per coordinate, √3 times that as a distance. Twice the sum, rounded up, is 32uV + 8uP.
/// The rounding within the next test is dealt with there: a ray that starts on a triangle, as far as the test can
/// tell, does not cross it.
#[inline]
fn position_error(position: DVec3, half_extent: DVec3) -> f64 {
    f64::EPSILON * (16.0 * half_extent.max_element() + 4.0 * position.abs().max_element())
}

/// The box around the vertices that the triangles use.
fn bounds(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<(DVec3, DVec3), TrianglesError> {
    let (mut lo, mut hi) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (triangle, corners) in triangles.iter().enumerate() {
        for &vertex in corners {
            let point = vertices
                .get(vertex as usize)
                .ok_or(TrianglesError::NoSuchVertex {
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

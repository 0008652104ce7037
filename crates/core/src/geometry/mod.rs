// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Where rays meet surfaces: primitives by their equations, and triangles by an 8-wide BVH.

mod bvh;
mod primitive;
mod sampled;
mod surface_point;
mod triangles;

pub use bvh::{overlap, Kernel, PARALLEL};
pub use primitive::{
    Cone, ConvexPolyhedron, Cylinder, Disc, Plane, Primitive, PrimitiveError, Shape, Sphere,
};
pub use sampled::{SampledSurface, SurfaceDirection, SurfaceSample};
pub use surface_point::SurfacePoint;
pub use triangles::{TriangleHit, Triangles, TrianglesError};

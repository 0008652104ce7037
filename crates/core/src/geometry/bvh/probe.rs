// SPDX-License-Identifier: Apache-2.0 OR MIT
//! A ray prepared for traversal.

use glam::{DVec3, Vec3A, Vec3Swizzles};

use crate::math::Ray;

/// Half the spacing of `f32` at one: the relative error of one rounding.
const U: f32 = f32::EPSILON / 2.0;

/// The box of the scene, grown by this share of its size, clips rays. So the start of a clipped ray
/// is clearly outside of all triangles, also of those in a face of the box.
const CLIP_MARGIN: f64 = 1.0 / 1024.0;

/// A ray relative to the centre of the scene, clipped to the scene's box, with what both precisions
/// need.
///
/// # Rounding in single precision
///
/// Let R be the half extent of the clip box (largest axis): |o| ≤ R, corners and boxes within R, u
/// = 2⁻²⁴.
///
/// **Box.** The side b of a box lies at t = (b − o)/d, computed as b·inv + fl(−o·inv). Relative
/// errors, from d, 1/d, and the last rounding, are ≤ 4u, and |t| ≤ 2R|inv| within the box:
/// 8uR|inv|. Rounding o and o·inv adds 2uR|inv|. Twelve of these instead of ten are taken into the
/// added constant: `near_offset`, `far_offset`. A component of d below 10⁻¹⁸ is replaced by 10⁻¹⁸,
/// which moves no point of the ray within the box by uR.
///
/// **Triangle.** A sheared coordinate x' = p.x − s·p.z of p = v − o carries 3uR from each of p.x
/// and p.z (origin, difference), 2uR from s, 6uR from product and difference: m = 16uR bounds it.
/// With M the largest sheared coordinate of the triangle, an edge function is off by ≤ 4mM + 2m² +
/// 4uM² ≤ 5m(M + m), as M ≤ 4R. The edge functions may have the wrong sign by that much.
#[derive(Debug)]
pub(super) struct Probe {
    /// Where the probe starts on the ray given: its t is less by this much than the ray's.
    pub(super) start: f64,
    /// Only crossings nearer than this count.
    pub(super) t_max: f64,
    /// The axes of the sheared frame: the last is the largest component of the direction.
    pub(super) axes: [usize; 3],
    /// Origin and direction, with their components in the order of `axes`.
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    /// x and y per z of the ray in the sheared frame, and t per z.
    pub(super) shear: DVec3,
    pub(super) single: SinglePrecision,
}

/// What the conservative tests need.
#[derive(Debug)]
pub(super) struct SinglePrecision {
    /// In the order of the axes.
    pub(super) turned_origin: [f32; 3],
    pub(super) inverse_direction: [f32; 3],
    pub(super) near_offset: [f32; 3],
    pub(super) far_offset: [f32; 3],
    /// What to add to x and y per z.
    pub(super) shear: [f32; 2],
    /// Edge functions may be wrong by `edge_slope` times the largest coordinate plus
    /// `edge_constant`.
    pub(super) edge_slope: f32,
    pub(super) edge_constant: f32,
}

/// Where a scene is, and how much single precision errs in it.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    /// What coordinates are relative to.
    pub(super) centre: DVec3,
    /// The largest coordinate on each axis, without sign.
    pub(super) half_extent: DVec3,
    /// Half the extent of the box to which rays are clipped.
    clip_box: DVec3,
    /// 12uR
    side_error: f32,
    edge_slope: f32,
    edge_constant: f32,
}

impl Frame {
    pub fn new(centre: DVec3, half_extent: DVec3) -> Self {
        let margin = half_extent.max_element() * CLIP_MARGIN;
        let radius = (half_extent.max_element() + margin) as f32;
        let coordinate_error = 16.0 * U * radius;
        Self {
            centre,
            half_extent,
            clip_box: half_extent + DVec3::splat(margin),
            side_error: 12.0 * U * radius,
            edge_slope: 5.0 * coordinate_error,
            edge_constant: 5.0 * coordinate_error * coordinate_error,
        }
    }
}

impl Probe {
    /// Prepares a ray. `None` if it passes the scene or is not a ray (not finite, no direction).
    #[inline(always)]
    pub fn new(ray: &Ray, frame: &Frame) -> Option<Self> {
        let direction = ray.direction;
        let origin = ray.origin - frame.centre;
        let start = clip(origin, direction, frame.clip_box)?;
        (start < ray.t_max).then_some(())?;
        let origin = origin + start * direction;
        let size = direction.abs();
        // One branch for both vectors: to index them cost as much as to visit a node.
        let (axes, turned_origin, along) = if size.z >= size.x && size.z >= size.y {
            ([0, 1, 2], origin, direction)
        } else if size.y >= size.x {
            ([2, 0, 1], origin.zxy(), direction.zxy())
        } else {
            ([1, 2, 0], origin.yzx(), direction.yzx())
        };
        let per_z = 1.0 / along.z;
        let shear = DVec3::new(along.x * per_z, along.y * per_z, per_z);
        (shear.x + shear.y + shear.z).is_finite().then_some(())?;
        Some(Self {
            start,
            t_max: ray.t_max,
            axes,
            origin: turned_origin,
            direction: along,
            shear,
            single: SinglePrecision::new(origin, turned_origin, direction, shear, frame),
        })
    }

    /// The probe's t of the ray's `t`, rounded up to single precision.
    #[inline(always)]
    pub(super) fn limit(&self, t: f64) -> f32 {
        (t - self.start) as f32 * (1.0 + 2.0 * U)
    }
}

impl SinglePrecision {
    #[inline(always)]
    fn new(
        origin: DVec3,
        turned_origin: DVec3,
        direction: DVec3,
        shear: DVec3,
        frame: &Frame,
    ) -> Self {
        let direction = Vec3A::from(direction.as_vec3());
        let inverse = 1.0 / direction.abs().max(Vec3A::splat(1e-18)).copysign(direction);
        let origin = Vec3A::from(origin.as_vec3());
        let (offset, error) = (-origin * inverse, frame.side_error * inverse.abs());
        Self {
            turned_origin: turned_origin.as_vec3().to_array(),
            inverse_direction: inverse.to_array(),
            near_offset: (offset - error).to_array(),
            far_offset: (offset + error).to_array(),
            shear: [-shear.x as f32, -shear.y as f32],
            edge_slope: frame.edge_slope,
            edge_constant: frame.edge_constant,
        }
    }
}

/// The distance along the ray to the box of ± `half_extent`: 0 inside of it, `None` if the ray does
/// not meet it.
#[inline(always)]
fn clip(origin: DVec3, direction: DVec3, half_extent: DVec3) -> Option<f64> {
    if origin.abs().cmple(half_extent).all() {
        return Some(0.0);
    }
    let direction = direction.abs().max(DVec3::splat(1e-300)).copysign(direction);
    let a = (-half_extent - origin) / direction;
    let b = (half_extent - origin) / direction;
    let (near, far) = (a.min(b), a.max(b));
    let near = near.x.max(near.y).max(near.z).max(0.0);
    let far = far.x.min(far.y).min(far.z);
    (near <= far && near.is_finite()).then_some(near)
}

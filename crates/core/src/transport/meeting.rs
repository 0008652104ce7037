// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Meeting`]: the frame in which a walk sees a surface.

use crate::math::DVec3;
use crate::matter::reflect;
use crate::scene::SurfaceHit;

/// A surface as a walk meets it.
pub(super) struct Meeting {
    /// The surface.
    pub hit: SurfaceHit,
    /// The direction back along the walk.
    pub wi: DVec3,
    /// The shading normal on the walk's side.
    pub normal: DVec3,
    /// wi · normal.
    pub cos_i: f64,
}

impl Meeting {
    pub(super) fn new(hit: SurfaceHit, direction: DVec3) -> Self {
        let wi = -direction;
        let side = 1.0_f64.copysign(hit.point.normal.dot(wi));
        let shading = hit.shading_normal * side;
        // Seen so flatly that the interpolated normal turns away, only the true one makes sense.
        let normal = if shading.dot(wi) > 0.0 { shading } else { hit.point.normal * side };
        Self { hit, wi, normal, cos_i: normal.dot(wi).clamp(0.0, 1.0) }
    }

    /// 1 where the walk comes from the side that the surface's own normal points to, else −1.
    pub(super) fn side(&self) -> f64 {
        1.0_f64.copysign(self.hit.point.normal.dot(self.wi))
    }

    /// Keep a mirrored direction on the walk's side of the true surface.
    pub(super) fn on_near_side(&self, wo: DVec3) -> DVec3 {
        let true_normal = self.hit.point.normal * self.side();
        if wo.dot(true_normal) > 0.0 {
            wo
        } else {
            reflect(self.wi, true_normal)
        }
    }

    /// Keep a refracted direction on the far side of the true surface.
    pub(super) fn on_far_side(&self, wo: DVec3) -> DVec3 {
        let true_normal = self.hit.point.normal * self.side();
        let height = wo.dot(true_normal);
        if height < 0.0 {
            wo
        } else {
            (wo - true_normal * (height + 1e-6)).normalize()
        }
    }
}

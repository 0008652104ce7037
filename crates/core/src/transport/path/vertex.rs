// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Vertex`]: where a branch is turned at random, on a surface or inside a body.

use crate::geometry::SurfacePoint;
use crate::math::{orthonormal_pair, DMat3, DVec3};
use crate::matter::{henyey_greenstein, sample_henyey_greenstein, Bsdf};
use crate::scene::{BodyId, Face, Interior};
use crate::spectrum::SampledSpectrum;

use super::Meeting;

/// Where a branch is turned at random.
pub(super) struct Vertex<'a> {
    /// Where it is.
    pub position: DVec3,
    /// The bodies on the side that the branch comes from.
    pub near: Interior,
    /// Whether it lies between two transparent media.
    pub is_boundary: bool,
    place: Place<'a>,
}

/// A surface on which light lands and is met.
#[derive(Clone, Copy)]
pub(super) struct Ground {
    /// The body whose surface it is.
    pub body: BodyId,
    /// Whether it is of opaque matter, and matt or very rough.
    pub is_matt: bool,
    /// The true normal, out of that body.
    pub normal: DVec3,
    /// The shading normal on that side.
    pub shading: DVec3,
    /// 1 where the branch comes from that side, else −1.
    pub side: f64,
}

#[expect(clippy::large_enum_variant, reason = "made at every hit: a box would cost an allocation")]
enum Place<'a> {
    Surface {
        face: Face,
        point: SurfacePoint,
        /// The surface's normal on the branch's side.
        true_normal: DVec3,
        /// Columns: two tangents and the shading normal on the branch's side.
        frame: DMat3,
        /// The direction back along the branch, in the frame.
        wi: DVec3,
        bsdf: Bsdf<'a>,
        /// The bodies on the far side.
        far: Interior,
    },
    Body {
        wi: DVec3,
        anisotropy: f64,
    },
}

impl<'a> Vertex<'a> {
    /// A vertex on opaque matter or on a sheet, with `near` on both sides.
    #[expect(clippy::large_types_passed_by_value, reason = "moved into the vertex")]
    #[inline]
    pub fn on_surface(meeting: &Meeting, bsdf: Bsdf<'a>, near: Interior) -> Self {
        let face = Face { body: meeting.hit.body, is_entered: meeting.side() > 0.0 };
        Self { is_boundary: false, ..Self::on_interface(meeting, bsdf, face, [near, near]) }
    }

    /// A vertex on a rough boundary, the `face` of a body, between the media of `near` and `far`.
    #[expect(clippy::large_types_passed_by_value, reason = "moved into the vertex")]
    #[inline]
    pub fn on_interface(
        meeting: &Meeting,
        bsdf: Bsdf<'a>,
        face: Face,
        [near, far]: [Interior; 2],
    ) -> Self {
        let point = meeting.hit.point;
        let frame = frame(meeting.normal);
        let wi = frame.transpose() * meeting.wi;
        let true_normal = point.normal * meeting.side();
        let place = Place::Surface { face, point, true_normal, frame, wi, bsdf, far };
        Self { position: point.position, near, is_boundary: true, place }
    }

    /// A vertex inside a scattering body.
    pub fn in_body(position: DVec3, wi: DVec3, anisotropy: f64, near: Interior) -> Self {
        Self { position, near, is_boundary: false, place: Place::Body { wi, anisotropy } }
    }

    /// Whether it lies inside a scattering body.
    pub fn is_in_body(&self) -> bool {
        matches!(self.place, Place::Body { .. })
    }

    /// `wi` of a meeting in the frame of its shading normal.
    pub fn local(meeting: &Meeting) -> DVec3 {
        frame(meeting.normal).transpose() * meeting.wi
    }

    /// The share of the basic radiance arriving against `wo` that goes to wi, per steradian: f |cos θ|
    /// of a surface, the phase function of a body.
    pub fn answer(&self, wo: DVec3) -> SampledSpectrum {
        match &self.place {
            Place::Surface { frame, wi, bsdf, .. } => bsdf.eval(*wi, frame.transpose() * wo),
            Place::Body { wi, anisotropy } => {
                SampledSpectrum::splat(henyey_greenstein(-wi.dot(wo), *anisotropy))
            }
        }
    }

    /// The same, were the surface turned so that this is its shading normal.
    pub fn answer_turned(&self, normal: DVec3, wo: DVec3) -> SampledSpectrum {
        match &self.place {
            Place::Surface { frame: own, wi, bsdf, .. } => {
                let to_turned = frame(normal).transpose();
                bsdf.eval(to_turned * (*own * *wi), to_turned * wo)
            }
            Place::Body { .. } => self.answer(wo),
        }
    }

    /// The share of the light that goes on, about.
    pub fn albedo(&self) -> SampledSpectrum {
        match &self.place {
            Place::Surface { wi, bsdf, .. } => bsdf.albedo(*wi),
            Place::Body { .. } => SampledSpectrum::ONE,
        }
    }

    /// The density of `sample`, per steradian.
    pub fn pdf(&self, wo: DVec3, lanes: &SampledSpectrum) -> f64 {
        match &self.place {
            Place::Surface { frame, wi, bsdf, .. } => bsdf.pdf(*wi, frame.transpose() * wo, lanes),
            Place::Body { wi, anisotropy } => henyey_greenstein(-wi.dot(wo), *anisotropy),
        }
    }

    /// A direction `wo`, more often where more is answered.
    pub fn sample(&self, lanes: &SampledSpectrum, u: [f64; 3]) -> Option<DVec3> {
        match &self.place {
            Place::Surface { frame, wi, bsdf, .. } => {
                bsdf.sample(*wi, lanes, u).map(|wo| (*frame * wo).normalize())
            }
            Place::Body { wi, anisotropy } => {
                Some(sample_henyey_greenstein(*wi, *anisotropy, [u[1], u[2]]))
            }
        }
    }

    /// The density of `sample_side` on the side of `wo`, per steradian.
    pub fn pdf_of_side(&self, wo: DVec3, lanes: &SampledSpectrum) -> f64 {
        match &self.place {
            Place::Surface { frame, wi, bsdf, .. } => {
                bsdf.pdf_of_side(*wi, frame.transpose() * wo, lanes)
            }
            Place::Body { .. } => self.pdf(wo, lanes),
        }
    }

    /// A direction on the near or the far side of a boundary, more often where more is answered there.
    pub fn sample_side(
        &self,
        is_near: bool,
        lanes: &SampledSpectrum,
        u: [f64; 3],
    ) -> Option<DVec3> {
        match &self.place {
            Place::Surface { frame, wi, bsdf, .. } => {
                bsdf.sample_side(*wi, is_near, lanes, u).map(|wo| (*frame * wo).normalize())
            }
            Place::Body { .. } => None,
        }
    }

    /// Whether `wo`, in front of or behind the shaded surface, is so with the true one too.
    pub fn agrees(&self, wo: DVec3) -> bool {
        match &self.place {
            Place::Surface { true_normal, frame, .. } => {
                (wo.dot(*true_normal) > 0.0) == (wo.dot(frame.z_axis) > 0.0)
            }
            Place::Body { .. } => true,
        }
    }

    /// `wo` mirrored at the true surface, to the side that `wo` has of the shaded one.
    pub fn put_right(&self, wo: DVec3) -> DVec3 {
        match &self.place {
            Place::Surface { true_normal, .. } => wo - *true_normal * (2.0 * wo.dot(*true_normal)),
            Place::Body { .. } => wo,
        }
    }

    /// |cos| of the angle of `wo` to the true surface.
    pub fn cosine(&self, wo: DVec3) -> f64 {
        match &self.place {
            Place::Surface { true_normal, .. } => wo.dot(*true_normal).abs(),
            Place::Body { .. } => 1.0,
        }
    }

    /// How walks from the eye and from lights meet there.
    pub fn ground(&self) -> Option<Ground> {
        let Place::Surface { face, true_normal, frame, bsdf, .. } = &self.place else {
            return None;
        };
        let is_matt = bsdf.is_broad() && !self.is_boundary;
        let side = if face.is_entered { 1.0 } else { -1.0 };
        let (normal, shading) = (*true_normal * side, frame.z_axis * side);
        bsdf.spreads().then_some(Ground { body: face.body, is_matt, normal, shading, side })
    }

    /// Where a ray along `wo` starts, and in which bodies.
    pub fn leave_along(&self, wo: DVec3) -> (DVec3, Interior) {
        match &self.place {
            Place::Surface { point, true_normal, far, .. } => {
                let is_near = wo.dot(*true_normal) > 0.0;
                (point.leave_along(wo), if is_near { self.near } else { *far })
            }
            Place::Body { .. } => (self.position, self.near),
        }
    }
}

fn frame(normal: DVec3) -> DMat3 {
    let (tangent, bitangent) = orthonormal_pair(normal);
    DMat3::from_cols(tangent, bitangent, normal)
}

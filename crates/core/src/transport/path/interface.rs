// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Boundaries: between transparent media, smooth or rough, and of opaque matter.

use crate::matter::{dielectric_reflectance, reflect, refract, Bsdf};
use crate::scene::{Face, Interior};
use crate::spectrum::SampledSpectrum;

use super::branch::{Branch, Ways};
use super::vertex::Vertex;
use super::{pick, Meeting, PathWalk};

impl PathWalk<'_> {
    /// The ways on at the boundary of two transparent media: reflected and refracted.
    pub(super) fn cross(
        &mut self,
        mut branch: Branch,
        meeting: &Meeting,
        face: Face,
        beyond: Interior,
    ) -> Ways {
        let eta = self.index(&beyond) / self.index(&branch.interior);
        let material = self.scene.material_of(face.body);
        // Outward from that body, whichever of the faces in this place was met first.
        let outward = if face.is_entered { meeting.side() } else { -meeting.side() };
        let roughness = material.roughness_at(meeting.hit.point.normal * outward);
        if roughness.is_some() {
            let bsdf = Bsdf::interface(eta, roughness);
            let vertex = Vertex::on_interface(meeting, bsdf, branch.interior, beyond);
            return [self.scatter(branch, &vertex), None];
        }
        let [choice, lane, ..] = branch.sampler.next_4d();
        let reflected = if eta.is_even() {
            SampledSpectrum::splat(dielectric_reflectance(meeting.cos_i, eta.0[0]))
        } else {
            eta.map(|eta| dielectric_reflectance(meeting.cos_i, eta))
        };
        let shares = [reflected, SampledSpectrum::ONE - reflected];
        let [near, far] = self.divide(branch, shares, choice);
        let near = near.map(|branch| mirrored(branch, meeting, reflected));
        let far = far.and_then(|mut branch| {
            branch.throughput *= shares[1];
            self.refracted(branch, meeting, eta, beyond, lane)
        });
        [near, far]
    }

    /// Refract a branch. Where lanes go different ways, one of them goes on in the place of all:
    /// chosen by what the eye gets of it, and weighted so that the mean is that of all lanes.
    fn refracted(
        &self,
        mut branch: Branch,
        meeting: &Meeting,
        eta: SampledSpectrum,
        beyond: Interior,
        u: f64,
    ) -> Option<Branch> {
        let mut hero = 0;
        if !eta.is_even() {
            let seen = self.weight(branch.throughput);
            if seen <= 0.0 {
                return None;
            }
            hero = pick(&self.lanes(branch.throughput), u);
            branch.throughput = SampledSpectrum::ZERO;
            branch.throughput.0[hero] = seen / self.visibility.0[hero];
        }
        let wo = meeting.on_far_side(refract(meeting.wi, meeting.normal, eta.0[hero])?);
        let origin = meeting.hit.point.leave_along(wo);
        Some(branch.deflected(origin, wo, beyond))
    }

    /// The ways on at opaque matter: mirrored and scattered.
    pub(super) fn answer(&mut self, mut branch: Branch, meeting: &Meeting) -> Ways {
        let material = self.scene.material_of(meeting.hit.body);
        let medium_index = self.index(&branch.interior);
        let point = &meeting.hit.point;
        let bsdf = material.bsdf(point.position, point.normal, medium_index, self.wavelengths);
        let Some(mirror) = bsdf.mirror(meeting.cos_i) else {
            let vertex = Vertex::on_surface(meeting, bsdf, branch.interior);
            return [None, self.scatter(branch, &vertex)];
        };
        if !bsdf.scatters() {
            return [Some(mirrored(branch, meeting, mirror)), None];
        }
        let wi = Vertex::local(meeting);
        let [choice, ..] = branch.sampler.next_4d();
        let [near, rest] = self.divide(branch, [mirror, bsdf.albedo(wi)], choice);
        let near = near.map(|branch| mirrored(branch, meeting, mirror));
        let rest = rest.and_then(|branch| {
            let vertex = Vertex::on_surface(meeting, bsdf, branch.interior);
            self.scatter(branch, &vertex)
        });
        [near, rest]
    }

    /// The refractive index of what fills a place.
    pub(super) fn index(&self, interior: &Interior) -> SampledSpectrum {
        let medium = self.scene.medium(interior);
        medium.map_or(SampledSpectrum::ONE, |body| body.index.at(self.wavelengths))
    }
}

fn mirrored(mut branch: Branch, meeting: &Meeting, reflectance: SampledSpectrum) -> Branch {
    branch.throughput *= reflectance;
    let wo = meeting.on_near_side(reflect(meeting.wi, meeting.normal));
    let interior = branch.interior;
    branch.deflected(meeting.hit.point.leave_along(wo), wo, interior)
}

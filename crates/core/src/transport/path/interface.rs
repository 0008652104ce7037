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
        branch: &mut Branch,
        meeting: &Meeting,
        face: Face,
        beyond: &Interior,
    ) -> Ways {
        let eta = self.index(beyond) / self.index(&branch.interior);
        let material = self.scene.material_of(face.body);
        // Outward from that body, whichever of the faces in this place was met first.
        let outward = if face.is_entered { meeting.side() } else { -meeting.side() };
        let roughness = material.roughness_at(meeting.hit.point.normal * outward);
        if roughness.is_some() {
            let bsdf = Bsdf::interface(eta, roughness);
            let sides = [branch.interior, *beyond];
            let vertex = Vertex::on_interface(meeting, bsdf, face, sides);
            return self.scatter(branch, &vertex);
        }
        let [choice, lane, ..] = branch.sampler.next_4d();
        let reflected = if eta.is_even() {
            SampledSpectrum::splat(dielectric_reflectance(meeting.cos_i, eta.0[0]))
        } else {
            eta.map(|eta| dielectric_reflectance(meeting.cos_i, eta))
        };
        let refracted = SampledSpectrum::ONE - reflected;
        let [near, far] = self.divide(branch, [&reflected, &refracted], choice);
        if !near {
            branch.throughput *= refracted;
            return Ways::one(far && self.refract(branch, meeting, eta, beyond, lane));
        }
        let mut parted = 0.0;
        if far {
            let mut other = branch.part();
            other.throughput *= refracted;
            if self.refract(&mut other, meeting, eta, beyond, lane) {
                parted = self.wait(other);
            }
        }
        Ways { goes_on: self.mirror(branch, meeting, &reflected), parted }
    }

    /// Refract a branch; whether it can be. Where lanes go different ways, one of them goes on in the
    /// place of all: chosen by what the eye gets of it, and weighted so that the mean is that of all
    /// lanes.
    fn refract(
        &self,
        branch: &mut Branch,
        meeting: &Meeting,
        eta: SampledSpectrum,
        beyond: &Interior,
        u: f64,
    ) -> bool {
        let mut hero = 0;
        if !eta.is_even() {
            let seen = self.weight(branch.throughput);
            if seen <= 0.0 {
                return false;
            }
            hero = pick(&self.lanes(branch.throughput), u);
            branch.throughput = SampledSpectrum::ZERO;
            branch.throughput.0[hero] = seen / self.visibility.0[hero];
        }
        let Some(wo) = refract(meeting.wi, meeting.normal, eta.0[hero]) else {
            return false;
        };
        let wo = meeting.on_far_side(wo);
        branch.deflect(meeting.hit.point.leave_along(wo), wo);
        branch.interior = *beyond;
        true
    }

    /// The ways on at opaque matter: mirrored and scattered.
    pub(super) fn answer(&mut self, branch: &mut Branch, meeting: &Meeting) -> Ways {
        let material = self.scene.material_of(meeting.hit.body);
        let medium_index = self.index(&branch.interior);
        let point = &meeting.hit.point;
        let bsdf = material.bsdf(point.position, point.normal, medium_index, self.wavelengths);
        let Some(mirrored) = bsdf.mirror(meeting.cos_i) else {
            let vertex = Vertex::on_surface(meeting, bsdf, branch.interior);
            return self.scatter(branch, &vertex);
        };
        if !bsdf.scatters() || !self.purpose.scatters() {
            return Ways::one(self.mirror(branch, meeting, &mirrored));
        }
        let [choice, ..] = branch.sampler.next_4d();
        let scattered = bsdf.albedo(Vertex::local(meeting));
        let [near, rest] = self.divide(branch, [&mirrored, &scattered], choice);
        if !(near || rest) {
            return Ways::default();
        }
        let mut parted = 0.0;
        if rest {
            let vertex = Vertex::on_surface(meeting, bsdf, branch.interior);
            if !near {
                return self.scatter(branch, &vertex);
            }
            let mut other = branch.part();
            let ways = self.scatter(&mut other, &vertex);
            parted = ways.parted;
            if ways.goes_on {
                parted += self.wait(other);
            }
        }
        Ways { goes_on: self.mirror(branch, meeting, &mirrored), parted }
    }

    /// Reflect a branch; whether it goes on.
    fn mirror(
        &self,
        branch: &mut Branch,
        meeting: &Meeting,
        reflectance: &SampledSpectrum,
    ) -> bool {
        branch.throughput *= *reflectance;
        let wo = meeting.on_near_side(reflect(meeting.wi, meeting.normal));
        branch.deflect(meeting.hit.point.leave_along(wo), wo);
        branch.has_turned = true;
        self.widens(branch)
    }

    /// The refractive index of what fills a place.
    pub(super) fn index(&self, interior: &Interior) -> SampledSpectrum {
        let medium = self.scene.medium(interior);
        medium.map_or(SampledSpectrum::ONE, |body| body.index.at(self.wavelengths))
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Light at the end of a way, and light that is looked for: multiple importance sampling.
//!
//! What a branch meets on its way counts in full, through whatever glass it went. Emitters inside the
//! scene are looked for besides, from every vertex along a straight way (next-event estimation);
//! where both find the same light, they share it by the balance heuristic.

use crate::math::{DVec3, Ray};
use crate::scene::BodyId;
use crate::spectrum::SampledSpectrum;

use super::branch::{Branch, CameBy};
use super::purpose::{Carried, Part, Purpose};
use super::turning::Aims;
use super::vertex::Vertex;
use super::{Meeting, PathWalk};

/// The most surfaces without effect that a straight way to an emitter may cross.
const MOST_SURFACES: usize = 256;

/// How far, relative to its distance, a point of an emitter may seem to lie behind its own surface.
const SAME_POINT: f64 = 1e-5;

impl PathWalk<'_> {
    /// Add what the background sends against a branch that leaves the scene, or hand on what it
    /// carries.
    pub(super) fn leave(&mut self, branch: &Branch) {
        let (scene, wavelengths) = (self.scene, self.wavelengths);
        match &mut self.purpose {
            Purpose::Eye(eye) if eye.part == Part::Scattered && branch.scatterings == 0 => {}
            Purpose::Eye(eye) => {
                scene.background.arriving(&branch.ray, wavelengths, |group, radiance| {
                    eye.gathered.add(scene, wavelengths, group, branch.throughput * radiance);
                });
            }
            Purpose::Light(receive) => receive(Carried::Left(&branch.ray), branch.throughput),
        }
    }

    /// Add what the surface at the end of a branch emits: `L_e`.
    pub(super) fn see_emission(&mut self, branch: &Branch, meeting: &Meeting) {
        let Some(number) = self.scene.emitters.of_body(meeting.hit.body) else {
            return;
        };
        if !self.purpose.counts(branch) {
            return;
        }
        let emitters = &self.scene.emitters;
        let emitter = emitters.get(number);
        let normal = meeting.hit.point.normal;
        let mut emitted = emitter.radiance(normal, meeting.wi, self.wavelengths);
        if emitter.per_n2 {
            let index = self.index(&branch.interior);
            emitted = emitted / (index * index);
        }
        let weight = match branch.came_by {
            CameBy::OneWay => 1.0,
            CameBy::Scattering { from, pdf } => {
                let position = meeting.hit.point.position;
                let other = emitters.pdf(number, from, position, normal, -meeting.wi);
                pdf / (pdf + other)
            }
        };
        self.add_light(emitter.group, branch.throughput * emitted * (weight * branch.share));
    }

    fn add_light(&mut self, group: usize, arriving: SampledSpectrum) {
        if let Purpose::Eye(eye) = &mut self.purpose {
            eye.gathered.add(self.scene, self.wavelengths, group, arriving);
        }
    }

    /// Add what one point of the emitters sends straight to a vertex.
    pub(super) fn see_emitters(
        &mut self,
        branch: &mut Branch,
        vertex: &Vertex<'_>,
        lanes: &SampledSpectrum,
        aims: &Aims<'_>,
    ) {
        let emitters = &self.scene.emitters;
        let is_looked_for = self.purpose.looks_for_light() && !emitters.is_empty();
        if !is_looked_for || branch.is_left() || branch.depth >= self.settings.max_depth {
            return;
        }
        let [u, v, w, _] = branch.sampler.next_4d();
        let Some(seen) = emitters.sample(vertex.position, [u, v, w]) else {
            return;
        };
        let emitter = emitters.get(seen.emitter);
        let emitted = emitter.radiance(seen.normal, -seen.direction, self.wavelengths);
        let answer = vertex.answer(seen.direction);
        if emitted.max() <= 0.0 || answer.max() <= 0.0 || !vertex.agrees(seen.direction) {
            return;
        }
        let way = self.straight_way(vertex, seen.direction, seen.distance, emitter.body);
        let Some((transmitted, index)) = way else {
            return;
        };
        let emitted = if emitter.per_n2 { emitted / (index * index) } else { emitted };
        let other = self.densities(vertex, seen.direction, lanes, aims).all;
        let arriving = branch.throughput * answer * transmitted * emitted;
        let share = self.share_of_straight(branch, vertex, seen.direction, answer);
        self.add_light(emitter.group, arriving * (share / (seen.pdf + other)));
    }

    /// The transmittance of the straight way to a point on the surface of the body `end`, and the index of
    /// the medium there; nothing where anything is in the way but boundaries that are none to light.
    fn straight_way(
        &mut self,
        vertex: &Vertex<'_>,
        direction: DVec3,
        distance: f64,
        end: BodyId,
    ) -> Option<(SampledSpectrum, SampledSpectrum)> {
        let (origin, mut interior) = vertex.leave_along(direction);
        let mut left = distance;
        let mut ray = Ray::endless(origin, direction);
        let mut share = SampledSpectrum::ONE;
        for _ in 0..MOST_SURFACES {
            self.tally.shadow_rays += 1;
            ray.t_max = left * (1.0 + 2.0 * SAME_POINT);
            let place = self.scene.first_place(&ray)?;
            let (hit, length) = (place.hit, place.hit.point.t);
            if let Some(medium) = self.scene.medium(&interior) {
                let absorption = medium.absorption.at(self.wavelengths);
                let extinction = medium.scattering.as_ref().map_or(absorption, |scattering| {
                    absorption + scattering.coefficient.at(self.wavelengths)
                });
                share *= extinction.transmittance(length);
            }
            if self.scene.material_of(hit.body).dielectric().is_none() {
                let reached = end == hit.body && length >= left * (1.0 - SAME_POINT);
                return reached.then(|| (share, self.index(&interior)));
            }
            let beyond = interior.through(place.faces(), |_, _| {});
            if self.boundary(&interior, &beyond).is_some() {
                return None;
            }
            interior = beyond;
            ray.origin = hit.point.leave_along(direction);
            left -= length;
        }
        None
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Light at the end of a way, and light that is looked for: multiple importance sampling.
//!
//! A direction is drawn from one mixture: mostly as the surface answers, sometimes towards what is
//! bright in the background. What a branch meets on its way then counts in full, through whatever
//! glass it went. Emitters inside the scene are looked for besides, from every vertex along a
//! straight way (next-event estimation); where both find the same light, they share it by the
//! balance heuristic.

use std::f64::consts::PI;

use crate::math::{DVec3, Ray};
use crate::scene::BodyId;
use crate::spectrum::SampledSpectrum;
use crate::transport::guide::Answered;

use super::branch::{Branch, CameBy, Seeks};
use super::purpose::{Carried, Part, Purpose};
use super::vertex::Vertex;
use super::{Meeting, PathWalk};

/// The most surfaces without effect that a straight way to an emitter may cross.
const MOST_SURFACES: usize = 256;

/// How far, relative to its distance, a point of an emitter may seem to lie behind its own surface.
const SAME_POINT: f64 = 1e-5;

/// How often a direction is drawn towards learned light, where there is some.
const GUIDED: f64 = 0.5;

/// How many times both ways on are followed by what was drawn so.
const AIMED_SPLITS: u32 = 1;

/// How often directions are drawn towards learned light, and towards a bright background.
struct Aims<'a> {
    background: f64,
    guided: f64,
    light: Option<Answered<'a>>,
}

impl<'a> Aims<'a> {
    /// What to draw from if a uniform `technique`, beyond the background's share, is for learned light.
    fn guide(&self, technique: f64) -> Option<&Answered<'a>> {
        self.light.as_ref().filter(|_| technique < self.background + self.guided)
    }
}

impl<'a> PathWalk<'a> {
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

    /// Turn a branch at a vertex, if it goes on: ∫ f L |cos θ| dω by one direction and one look at
    /// the emitters.
    pub(super) fn scatter(&mut self, branch: &mut Branch, vertex: &Vertex<'_>) -> bool {
        if !self.purpose.scatters() {
            return false;
        }
        let lanes = self.lanes(branch.throughput);
        let ground = vertex.ground();
        let meets_again = branch.rivals > 0.0 && ground.is_some();
        if !meets_again && !self.widens(branch) {
            return false;
        }
        let was_left = Self::all_is_left(branch);
        self.land(branch, vertex, ground.as_ref());
        let is_met = ground.as_ref().is_some_and(|ground| match self.purpose {
            Purpose::Eye(_) => self.meet(branch, vertex, ground),
            Purpose::Light(_) => true,
        });
        branch.has_turned = true;
        let aims = self.aims(branch, vertex, &lanes);
        self.see_emitters(branch, vertex, &lanes, &aims);
        let [technique, u, v, w] = branch.sampler.next_4d();
        let drawn = if technique < aims.background {
            self.scene.background.aim(vertex.position, [u, v, w])
        } else if let Some(light) = aims.guide(technique) {
            Some(light.sample([u, v, w]))
        } else {
            vertex.sample(&lanes, [u, v, w])
        };
        let Some(mut wo) = drawn else {
            return false;
        };
        let own = vertex.pdf(wo, &lanes);
        let pdf = self.mixed(vertex, wo, own, &aims);
        branch.way = 0.0;
        if technique >= aims.background && aims.guide(technique).is_some() {
            // What it was aimed at may be a mirror image: both ways on count there.
            branch.splits =
                branch.splits.min(self.settings.split_depth.saturating_sub(AIMED_SPLITS));
        }
        branch.scatterings += 1;
        branch.came_by = CameBy::Scattering { from: vertex.position, pdf };
        branch.promise = (pdf / own).min(pdf * 4.0 * PI).max(1.0);
        let answer = vertex.answer(wo);
        branch.throughput *= answer * (1.0 / pdf);
        if is_met {
            self.leave_ground(branch, vertex, wo, answer);
        }
        if !was_left && Self::all_is_left(branch) && !self.survives_unseen(branch) {
            return false;
        }
        if !vertex.agrees(wo) {
            wo = vertex.put_right(wo);
            branch.came_by = CameBy::OneWay;
        }
        let (origin, interior) = vertex.leave_along(wo);
        branch.ray = Ray::endless(origin, wo);
        branch.interior = interior;
        pdf > 0.0
    }

    /// Whether all that a branch meets of emitters is left to walks from lights.
    fn all_is_left(branch: &Branch) -> bool {
        branch.is_left() && branch.rivals <= 0.0
    }

    /// Whether a branch goes on that is reflected or turned at random: a narrow one leaves emitters to
    /// others from there on.
    pub(super) fn widens(&self, branch: &mut Branch) -> bool {
        let was_left = Self::all_is_left(branch);
        branch.rivals = 0.0;
        if branch.seeks == Seeks::Refracted {
            branch.seeks = Seeks::Nothing;
        }
        was_left || !Self::all_is_left(branch) || self.survives_unseen(branch)
    }

    /// Whether a branch goes on whose emitters are left to others. Under a dark background it brings no
    /// light, and a few of them stand for all: for the ledger.
    fn survives_unseen(&self, branch: &mut Branch) -> bool {
        const FEW: f64 = 1.0 / 16.0;
        if !self.scene.background.is_dark() {
            return true;
        }
        let [u, ..] = branch.sampler.next_4d();
        branch.throughput *= 1.0 / FEW;
        u < FEW
    }

    /// How `scatter` aims. What is not aimed weighs more by 1/(1 − share) at each turn: so that after many
    /// turns a few walks do not carry all the light, the share halves with each.
    fn aims(&self, branch: &Branch, vertex: &Vertex<'_>, lanes: &SampledSpectrum) -> Aims<'a> {
        if !self.purpose.looks_for_light() {
            return Aims { background: 0.0, guided: 0.0, light: None };
        }
        let share = 0.5_f64.powi(branch.scatterings as i32);
        let background = share * self.scene.background.aim_share(vertex.position);
        let guide = self.purpose.guide().filter(|_| !branch.is_left());
        let region = guide.and_then(|guide| guide.at(vertex.position));
        let Some(region) = region else {
            return Aims { background, guided: 0.0, light: None };
        };
        let light = region.answered(vertex.position, |wo| vertex.pdf(wo, lanes));
        // Where both are sure of a half, each of the three ways of drawing has a third.
        let guided = share * GUIDED;
        let [background, guided] =
            [(background, guided), (guided, background)].map(|(a, b)| a * (1.0 - b * 2.0 / 3.0));
        Aims { background, guided, light: Some(light) }
    }

    /// The density of the directions that `scatter` draws, per steradian; `own` is the vertex's own.
    fn mixed(&self, vertex: &Vertex<'_>, wo: DVec3, own: f64, aims: &Aims<'_>) -> f64 {
        let mut pdf = own;
        if let Some(light) = &aims.light {
            pdf += aims.guided * (light.pdf(wo) - own);
        }
        if aims.background > 0.0 {
            let ray = Ray::endless(vertex.position, wo);
            pdf += aims.background * (self.scene.background.aim_pdf(&ray) - own);
        }
        pdf
    }

    /// Add what one point of the emitters sends straight to a vertex.
    fn see_emitters(
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
        let own = vertex.pdf(seen.direction, lanes);
        let other = self.mixed(vertex, seen.direction, own, aims);
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

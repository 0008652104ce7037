// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Surfaces where walks from the eye meet what walks from lights have left there.

use std::f64::consts::FRAC_1_PI;

use crate::math::DVec3;
use crate::spectrum::SampledSpectrum;
use crate::transport::guide::Arrival;
use crate::transport::photons::Landing;

use super::branch::{Branch, Seeks};
use super::purpose::{Carried, Purpose};
use super::vertex::{Ground, Vertex};
use super::PathWalk;

impl PathWalk<'_> {
    /// Let a walk from a light land on the `ground` of a vertex, or else show that it arrives where walks
    /// from the eye have to find it.
    pub(super) fn land(&mut self, branch: &Branch, vertex: &Vertex<'_>, ground: Option<&Ground>) {
        let weight = self.weight(branch.throughput);
        let Purpose::Light(receive) = &mut self.purpose else {
            return;
        };
        let (position, direction, way) = (vertex.position, -branch.ray.direction, branch.way);
        let arrived = Carried::Arrived(Arrival { position, direction, way, weight });
        let Some(Ground { body, is_matt, normal, shading, .. }) = ground.copied() else {
            receive(arrived, branch.throughput);
            return;
        };
        let is_straight = !vertex.is_boundary && !branch.has_turned;
        let rivals = branch.rivals;
        let landing = Landing { position, direction, normal, shading, body, is_straight, rivals };
        if vertex.is_boundary || branch.has_turned || is_matt {
            receive(Carried::Landed(landing), branch.throughput);
        }
        // Next-event estimation finds by itself what comes straight to a matt surface.
        if is_straight && (branch.depth > 0 || !is_matt) {
            receive(arrived, branch.throughput);
        }
    }

    /// Take what landed round a vertex; whether the branch meets light there. What comes to opaque matter by
    /// refraction alone is left for the branch to find, but for matt surfaces behind rough boundaries:
    /// what the eye sees there is blurred by far more than a disc.
    ///
    /// The radiance that a surface sends out is Σ f·E over the irradiances E that arrive from each
    /// direction; what is carried is L/n².
    pub(super) fn meet(
        &mut self,
        branch: &mut Branch,
        vertex: &Vertex<'_>,
        ground: &Ground,
    ) -> bool {
        let meets = branch.rivals > 0.0 || branch.seeks == Seeks::All;
        let Some(photons) = self.purpose.photons().filter(|_| meets) else {
            return false;
        };
        let takes_all = vertex.is_boundary || branch.is_left() && ground.is_matt;
        branch.seeks = if takes_all { Seeks::Nothing } else { Seeks::Refracted };
        let sent_on = self.weight(branch.throughput * vertex.albedo());
        let Ground { body, normal, side, .. } = *ground;
        let per_n2 = [normal * side, normal * -side].map(|side| {
            let index = self.index(&vertex.leave_along(side).1);
            SampledSpectrum::ONE / (index * index)
        });
        let (scene, wavelengths) = (self.scene, self.wavelengths);
        let Purpose::Eye(eye) = &mut self.purpose else {
            return false;
        };
        eye.gathered.met += sent_on;
        photons.on(&photons.disc(vertex.position, normal, body), |landing, irradiance, group| {
            // The surface may be curved: seen is how it answers where the light landed. There it did so
            // on the true surface, whatever its shading.
            let cos = side * landing.direction.dot(landing.normal);
            if cos == 0.0 || landing.is_straight && !takes_all {
                return;
            }
            let shading = side * landing.shading;
            let answer = vertex.answer_turned(shading, landing.direction);
            let answer = answer * per_n2[usize::from(cos < 0.0)] * (1.0 / cos.abs());
            let f = answer.max();
            let agrees = cos * landing.direction.dot(shading) > 0.0;
            let behind = if agrees { met_beyond(f, landing.rivals) } else { 0.0 };
            let share = share(f, branch.rivals + behind);
            let arriving = branch.throughput * answer * irradiance * share;
            eye.gathered.landed += arriving;
            eye.gathered.add(scene, wavelengths, group, arriving);
        });
        true
    }

    /// Let a branch that was on ground go on along `wo`, which it answers so: where else is the light on its
    /// way met?
    ///
    /// Walks draw their directions about as surfaces answer. So where there is a choice, light is met as
    /// often at one place as all other places answer it: Π f over f of its own, and each of them takes
    /// its share by the balance heuristic, 1/f over Σ 1/f. It is met where it is answered least: what lands
    /// on a glossy surface in just the direction that is mirrored to the eye is rare, and heavy.
    ///
    /// Source: E. Veach, L. Guibas, SIGGRAPH 1995; the places of one way as techniques: I. Georgiev et
    /// al., "Light Transport Simulation with Vertex Connection and Merging", ACM TOG 31(6), 2012.
    pub(super) fn leave_ground(
        &self,
        branch: &mut Branch,
        vertex: &Vertex<'_>,
        wo: DVec3,
        answer: SampledSpectrum,
    ) {
        let behind = std::mem::take(&mut branch.rivals);
        let Some(f) = self.reciprocal(vertex, wo, answer) else {
            branch.share = if behind > 0.0 { 0.0 } else { 1.0 };
            return;
        };
        branch.share = share(f, behind);
        branch.rivals = if self.purpose.looks_for_light() {
            met_beyond(f, behind + 1.0 / f)
        } else {
            met_beyond(f, behind) + 1.0 / f
        };
    }

    /// The share of light straight from an emitter along `wo` that a branch has which met others before.
    pub(super) fn share_of_straight(
        &self,
        branch: &Branch,
        vertex: &Vertex<'_>,
        wo: DVec3,
        answer: SampledSpectrum,
    ) -> f64 {
        if branch.rivals <= 0.0 {
            return 1.0;
        }
        self.reciprocal(vertex, wo, answer).map_or(0.0, |f| share(f, branch.rivals))
    }

    /// The f of an answer along `wo` that is the same both ways, in 1/sr: the largest of all lanes; none where
    /// shading disagrees with the true surface.
    fn reciprocal(&self, vertex: &Vertex<'_>, wo: DVec3, answer: SampledSpectrum) -> Option<f64> {
        let index = self.index(&vertex.leave_along(wo).1);
        let f = (answer / (index * index)).max() / vertex.cosine(wo);
        (f > 0.0 && f.is_finite() && vertex.agrees(wo)).then_some(f)
    }
}

/// The share of light that is answered by `f` here and met elsewhere, too.
fn share(f: f64, rivals: f64) -> f64 {
    1.0 / (1.0 + f * rivals)
}

/// Those of `rivals` on the other side of ground that answers by `f`: walks from the eye go on to meet light
/// there from more than matt ground.
fn met_beyond(f: f64, rivals: f64) -> f64 {
    if f > FRAC_1_PI {
        rivals
    } else {
        0.0
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Surfaces where walks from the eye meet what walks from lights have left there.

use crate::transport::guide::Arrival;
use crate::transport::photons::Landing;

use super::branch::{Branch, Seeks};
use super::purpose::{Carried, Purpose};
use super::vertex::{Ground, Vertex};
use super::PathWalk;

impl PathWalk<'_> {
    /// Let a walk from a light land on the `ground` of a vertex, or else show that it arrives where walks
    /// from the eye have to find it; whether it goes on.
    pub(super) fn land(
        &mut self,
        branch: &mut Branch,
        vertex: &Vertex<'_>,
        ground: Option<&Ground>,
    ) -> bool {
        let weight = self.weight(branch.throughput);
        let Purpose::Light(receive, screen) = &mut self.purpose else {
            return true;
        };
        let (position, direction, way) = (vertex.position, -branch.ray.direction, branch.way);
        let arrived = Carried::Arrived(Arrival { position, direction, way, weight });
        let Some(Ground { body, is_matt, normal, shading }) = ground.copied() else {
            receive(arrived, branch.throughput);
            return true;
        };
        let is_straight = !vertex.is_boundary && !branch.has_turned;
        let landing = Landing { position, direction, normal, shading, body, is_straight };
        let landed = Carried::Landed(landing);
        if vertex.is_boundary {
            if !branch.has_met {
                receive(landed, branch.throughput);
            }
        } else if branch.has_turned || is_matt {
            receive(landed, branch.throughput);
        }
        // Next-event estimation finds by itself what comes straight to a matt surface.
        if is_straight && (branch.depth > 0 || !is_matt) {
            receive(arrived, branch.throughput);
        }
        branch.has_met |= is_matt;
        !(branch.has_met && screen.is_some())
    }

    /// Take what landed round a vertex. What did not land there is left for the branch to find: what
    /// comes by refraction alone to opaque matter, and what has been on a matt surface before it comes to
    /// a very rough boundary. Behind such a boundary the eye takes all that landed on a matt surface:
    /// what it sees there is blurred by far more than a disc.
    ///
    /// The radiance that a surface sends out is Σ f·E over the irradiances E that arrive from each
    /// direction; what is carried is L/n².
    pub(super) fn meet(&mut self, branch: &mut Branch, vertex: &Vertex<'_>, ground: &Ground) {
        let is_done = branch.has_met || branch.is_left() && !ground.is_matt;
        let Some(photons) = self.purpose.photons().filter(|_| !is_done) else {
            return;
        };
        let takes_all = branch.is_left() || vertex.is_boundary;
        branch.seeks = if takes_all { Seeks::Nothing } else { Seeks::Refracted };
        branch.has_met |= !vertex.is_boundary;
        let sent_on = self.weight(branch.throughput * vertex.albedo());
        let normal = ground.normal;
        let per_n2 = [normal, -normal].map(|side| {
            let index = self.index(&vertex.leave_along(side).1);
            branch.throughput / (index * index)
        });
        let (scene, wavelengths) = (self.scene, self.wavelengths);
        let Purpose::Eye(eye) = &mut self.purpose else {
            return;
        };
        eye.gathered.met += sent_on;
        photons.round((vertex.position, normal), ground.body, |landing, irradiance, group| {
            // The surface may be curved: seen is how it answers where the light landed. There it did so
            // on the true surface, whatever its shading.
            let side = landing.normal.dot(normal).signum();
            let cos = side * landing.direction.dot(landing.normal);
            let is_met = takes_all || !landing.is_straight;
            if cos != 0.0 && is_met {
                let carried = per_n2[usize::from(cos < 0.0)];
                let answer = vertex.answer_turned(side * landing.shading, landing.direction);
                let answer = answer * (1.0 / cos.abs());
                let arriving = carried * answer * irradiance;
                eye.gathered.landed += arriving;
                eye.gathered.add(scene, wavelengths, group, arriving);
            }
        });
    }
}

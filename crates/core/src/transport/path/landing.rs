// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Surfaces where walks from the eye meet what walks from lights have left there.

use crate::transport::photons::Landing;

use super::branch::{Branch, Seeks};
use super::purpose::{Carried, Purpose};
use super::vertex::{Ground, Vertex};
use super::PathWalk;

impl PathWalk<'_> {
    /// Let a walk from a light land; whether it goes on.
    pub(super) fn land(
        &mut self,
        branch: &mut Branch,
        vertex: &Vertex<'_>,
        ground: &Ground,
    ) -> bool {
        let Purpose::Light(receive, screen) = &mut self.purpose else {
            return true;
        };
        let lands = if vertex.is_boundary { !branch.has_met } else { branch.has_turned };
        if lands {
            let (position, direction) = (vertex.position, -branch.ray.direction);
            let landing =
                Landing { position, direction, normal: ground.true_normal, body: ground.body };
            receive(Carried::Landed(landing), branch.throughput);
        }
        branch.has_met |= ground.is_matt;
        !(branch.has_met && screen.is_some())
    }

    /// Take what landed round a vertex. What did not land there is left for the branch to find: what
    /// comes by refraction alone to opaque matter, and what has been on a matt surface before it comes to
    /// a very rough boundary.
    ///
    /// The radiance that a surface sends out is Σ f·E over the irradiances E that arrive from each
    /// direction; what is carried is L/n².
    pub(super) fn meet(&mut self, branch: &mut Branch, vertex: &Vertex<'_>, ground: &Ground) {
        let is_done = branch.has_met || branch.is_left() && !ground.is_matt;
        let Some(photons) = self.purpose.photons().filter(|_| !is_done) else {
            return;
        };
        if vertex.is_boundary {
            branch.seeks = Seeks::Nothing;
        } else {
            (branch.seeks, branch.has_met) = (Seeks::Refracted, true);
        }
        let sent_on = self.weight(branch.throughput * vertex.albedo());
        let per_n2 = [ground.true_normal, -ground.true_normal].map(|side| {
            let index = self.index(&vertex.leave_along(side).1);
            branch.throughput / (index * index)
        });
        let (scene, wavelengths) = (self.scene, self.wavelengths);
        let Purpose::Eye(eye) = &mut self.purpose else {
            return;
        };
        eye.gathered.met += sent_on;
        let place = (vertex.position, ground.true_normal);
        photons.round(place, ground.body, |landing, irradiance, group| {
            let cos = landing.direction.dot(ground.normal).abs();
            if cos > 0.0 {
                let is_near = landing.direction.dot(ground.true_normal) > 0.0;
                let carried = per_n2[usize::from(!is_near)];
                let answer = vertex.answer(landing.direction) * (1.0 / cos);
                let arriving = carried * answer * irradiance;
                eye.gathered.landed += arriving;
                eye.gathered.add(scene, wavelengths, group, arriving);
            }
        });
    }
}

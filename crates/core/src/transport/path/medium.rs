// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The way through a body: absorption exact, scattering sampled.

use crate::scene::BodyId;

use super::branch::Branch;
use super::vertex::Vertex;
use super::{pick, PathWalk};

impl<'a> PathWalk<'a> {
    /// Take a branch `length` mm through `body`, or to where the body scatters it before.
    ///
    /// Absorption (Bouguer–Beer) multiplies. The distance to a scattering is drawn from
    /// `σ_s`·exp(−`σ_s`·t) of one lane and weighted by the density over all lanes (the balance
    /// heuristic), so that all lanes go on.
    pub(super) fn pass_through(
        &mut self,
        branch: &mut Branch,
        body: BodyId,
        length: f64,
    ) -> Option<Vertex<'a>> {
        let medium = self.scene.material_of(body).dielectric()?;
        let mut distance = length;
        let mut vertex = None;
        if let Some(scattering) = &medium.scattering {
            let coefficient = scattering.coefficient.at(self.wavelengths);
            let lanes = self.lanes(branch.throughput);
            let [u, v, ..] = branch.sampler.next_4d();
            let free = -(1.0 - v).ln() / coefficient.0[pick(&lanes, u)];
            let before = self.weight(branch.throughput);
            if free < length {
                distance = free;
                let density = coefficient * coefficient.transmittance(distance);
                branch.throughput *= density * (1.0 / lanes.dot(density));
                let position = branch.ray.at(distance);
                let (wi, interior) = (-branch.ray.direction, branch.interior);
                vertex = Some(Vertex::in_body(position, wi, scattering.anisotropy, interior));
            } else {
                let through = coefficient.transmittance(distance);
                branch.throughput *= through * (1.0 / lanes.dot(through));
            }
            self.tally.ledger.chance(before, self.weight(branch.throughput));
        }
        let before = self.weight(branch.throughput);
        branch.throughput *= medium.absorption.at(self.wavelengths).transmittance(distance);
        self.tally.ledger.absorb(body, before, self.weight(branch.throughput));
        vertex
    }
}

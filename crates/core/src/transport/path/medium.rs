// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The way through a body: absorption exact, scattering sampled.

use crate::math::DVec3;
use crate::scene::BodyId;

use super::branch::Branch;
use super::{pick, PathWalk};

/// Where and how a body scatters a branch.
pub(super) struct Scattered {
    /// The place.
    pub position: DVec3,
    /// How far it is, in mm.
    pub distance: f64,
    /// g of the phase function.
    pub anisotropy: f64,
}

impl PathWalk<'_> {
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
    ) -> Option<Scattered> {
        let medium = self.scene.material_of(body).dielectric()?;
        let mut distance = length;
        let mut scattered = None;
        if let Some(scattering) = &medium.scattering {
            let coefficient = scattering.coefficient.at(self.wavelengths);
            let lanes = self.lanes(branch.throughput);
            let [u, v, ..] = branch.sampler.next_4d();
            let free = -(1.0 - v).ln() / coefficient.0[pick(&lanes, u)];
            let before = self.worth(branch.throughput);
            if free < length {
                distance = free;
                let density = coefficient * coefficient.transmittance(distance);
                branch.throughput *= density * (1.0 / lanes.dot(density));
                let position = branch.ray.at(distance);
                scattered =
                    Some(Scattered { position, distance, anisotropy: scattering.anisotropy });
            } else {
                let through = coefficient.transmittance(distance);
                branch.throughput *= through * (1.0 / lanes.dot(through));
            }
            self.tally.ledger.chance(before, self.worth(branch.throughput));
        }
        let before = self.worth(branch.throughput);
        branch.throughput *= medium.absorption.at(self.wavelengths).transmittance(distance);
        self.tally.ledger.absorb(body, before, self.worth(branch.throughput));
        scattered
    }
}

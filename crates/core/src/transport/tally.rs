// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Tally`]: what happened to the rays, counted.

use super::ledger::Ledger;
use crate::scene::{BodyId, LostRay};

/// Counts of rays and of what was left out. Sums of integers, so that their order is free.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Segments of walks from the eye, or from a light.
    pub eye_rays: u64,
    /// Segments towards lights.
    pub shadow_rays: u64,
    /// Branches not followed because the depth limit was reached.
    pub cut_by_depth: u64,
    /// Branches not followed because they weigh less than the contribution limit.
    pub cut_by_contribution: u64,
    /// Samples dropped because they were not finite and non-negative.
    pub dropped_samples: u64,
    /// The first dropped sample: (pixel, sample).
    pub first_dropped: Option<(u64, u32)>,
    /// Lost rays per body: left without entering, entered twice, ended inside, too many bodies.
    pub lost: Vec<[u64; 4]>,
    /// Where the weight of the walks went; kept by path transport.
    pub ledger: Ledger,
}

impl Tally {
    /// Nothing counted yet, for a scene of `bodies` bodies.
    pub fn new(bodies: usize) -> Self {
        Self { lost: vec![[0; 4]; bodies], ledger: Ledger::new(bodies), ..Self::default() }
    }

    /// All segments.
    pub fn segments(&self) -> u64 {
        self.eye_rays + self.shadow_rays
    }

    /// Count a lost ray.
    pub fn lose(&mut self, body: BodyId, cause: LostRay) {
        if let Some(counts) = self.lost.get_mut(body as usize) {
            counts[cause as usize] += 1;
        }
    }

    /// Count a dropped sample and remember the first in order of pixel and sample.
    pub fn drop_sample(&mut self, pixel: u64, sample: u32) {
        self.dropped_samples += 1;
        let this = (pixel, sample);
        self.first_dropped = Some(self.first_dropped.map_or(this, |first| first.min(this)));
    }

    /// Add another tally to this one.
    pub fn add(&mut self, other: &Self) {
        self.eye_rays += other.eye_rays;
        self.shadow_rays += other.shadow_rays;
        self.cut_by_depth += other.cut_by_depth;
        self.cut_by_contribution += other.cut_by_contribution;
        self.dropped_samples += other.dropped_samples;
        self.first_dropped = match (self.first_dropped, other.first_dropped) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        self.ledger.add(&other.ledger);
        for (mine, theirs) in self.lost.iter_mut().zip(&other.lost) {
            for (sum, count) in mine.iter_mut().zip(theirs) {
                *sum += count;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adding_tallies_does_not_depend_on_their_order() {
        let mut a = Tally::new(2);
        a.lose(1, LostRay::EndedInside);
        a.drop_sample(7, 3);
        let mut b = Tally::new(2);
        b.lose(1, LostRay::LeftWithoutEntering);
        b.drop_sample(2, 9);
        let (mut ab, mut ba) = (a.clone(), b.clone());
        ab.add(&b);
        ba.add(&a);
        assert_eq!(ab, ba);
        assert_eq!(ab.first_dropped, Some((2, 9)));
        assert_eq!(ab.lost[1], [1, 0, 1, 0]);
    }
}

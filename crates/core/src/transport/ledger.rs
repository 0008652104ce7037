// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Ledger`]: where the weight of the walks went.

use crate::scene::BodyId;

/// What became of the weight that walks from the eye start with, 1 each, as the eye weighs it (the
/// lanes by X + Y + Z). All entries together are the number of walks, to rounding.
///
/// Kept in whole numbers of 2⁻⁶⁰, so that sums do not depend on their order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ledger {
    started: i128,
    escaped: i128,
    cut_by_depth: i128,
    lost: i128,
    chance: i128,
    absorbed: Vec<i128>,
}

/// The smallest part of a weight that is kept.
const UNIT: f64 = 1.0 / (1_u64 << 60) as f64;

/// Shares of the weight of all walks.
#[derive(Clone, Debug, PartialEq)]
pub struct Balance {
    /// Reached the background.
    pub escaped: f64,
    /// Stayed in bodies or on their surfaces, by body.
    pub absorbed: Vec<f64>,
    /// Was not followed further because of the depth limit.
    pub cut_by_depth: f64,
    /// Was lost at surfaces that do not enclose what they should.
    pub lost: f64,
    /// What choices at random took away more than they gave: zero but for noise.
    pub chance: f64,
}

impl Balance {
    /// What is missing of 1: nothing but rounding.
    pub fn gap(&self) -> f64 {
        let absorbed: f64 = self.absorbed.iter().sum();
        1.0 - (self.escaped + absorbed + self.cut_by_depth + self.lost + self.chance)
    }
}

impl Ledger {
    /// Nothing walked yet, in a scene of `bodies` bodies.
    pub fn new(bodies: usize) -> Self {
        Self { absorbed: vec![0; bodies], ..Self::default() }
    }

    pub(super) fn start(&mut self, weight: f64) {
        self.started += units(weight);
    }

    pub(super) fn escape(&mut self, weight: f64) {
        self.escaped += units(weight);
    }

    pub(super) fn cut(&mut self, weight: f64) {
        self.cut_by_depth += units(weight);
    }

    pub(super) fn lose(&mut self, weight: f64) {
        self.lost += units(weight);
    }

    /// Book a choice at random that turned the weight `before` into `after`.
    pub(super) fn chance(&mut self, before: f64, after: f64) {
        self.chance += units(before) - units(after);
    }

    /// Book what `body` kept when the weight `before` became `after`.
    pub(super) fn absorb(&mut self, body: BodyId, before: f64, after: f64) {
        if let Some(entry) = self.absorbed.get_mut(body as usize) {
            *entry += units(before) - units(after);
        }
    }

    /// Add another ledger to this one.
    pub fn add(&mut self, other: &Self) {
        self.started += other.started;
        self.escaped += other.escaped;
        self.cut_by_depth += other.cut_by_depth;
        self.lost += other.lost;
        self.chance += other.chance;
        for (mine, theirs) in self.absorbed.iter_mut().zip(&other.absorbed) {
            *mine += theirs;
        }
    }

    /// The weight that all walks started with.
    pub fn started(&self) -> f64 {
        self.started as f64 * UNIT
    }

    /// The shares of all walks; `None` where nothing was walked.
    pub fn balance(&self) -> Option<Balance> {
        let share = |entry: &i128| *entry as f64 / self.started as f64;
        (self.started > 0).then(|| Balance {
            escaped: share(&self.escaped),
            absorbed: self.absorbed.iter().map(share).collect(),
            cut_by_depth: share(&self.cut_by_depth),
            lost: share(&self.lost),
            chance: share(&self.chance),
        })
    }
}

fn units(weight: f64) -> i128 {
    const PER_ONE: f64 = 1.0 / UNIT;
    // Machine integers hold weights below 8, and nearly all are.
    if weight.abs() < 7.9 {
        i128::from((weight * PER_ONE) as i64)
    } else {
        (weight * PER_ONE) as i128
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_starts_is_found_again_under_its_entries() {
        let mut ledger = Ledger::new(2);
        for _ in 0..3 {
            ledger.start(1.0);
        }
        ledger.absorb(1, 1.0, 0.3);
        ledger.escape(0.3);
        ledger.chance(1.0, 1.25);
        ledger.cut(1.25);
        ledger.lose(1.0);
        let balance = ledger.balance().unwrap();
        assert!((balance.absorbed[1] - 0.7 / 3.0).abs() < 1e-15);
        assert!((balance.chance + 0.25 / 3.0).abs() < 1e-15);
        assert!(balance.gap().abs() < 1e-15);
    }

    #[test]
    fn sums_do_not_depend_on_their_order() {
        let weights = [1e-9, 0.7, 1.0 / 3.0, 1e9];
        let sum = |order: [usize; 4]| {
            let mut ledger = Ledger::new(0);
            for at in order {
                ledger.escape(weights[at]);
            }
            ledger
        };
        assert_eq!(sum([0, 1, 2, 3]), sum([3, 2, 1, 0]));
    }
}

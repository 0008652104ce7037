// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Choice`]: one of several, each with its own probability.

/// One of several things, chosen with probabilities in proportion to their weights.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The sum of the weights up to and with each thing.
    sums: Vec<f64>,
}

impl Choice {
    /// A choice by `weights`; `None` where they leave nothing to choose: their sum is not positive
    /// and finite, or one is negative.
    pub fn new(weights: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sum = 0.0;
        let mut sound = true;
        let sums: Vec<f64> = weights
            .into_iter()
            .map(|weight| {
                sound &= weight >= 0.0;
                sum += weight;
                sum
            })
            .collect();
        (sound && sum.is_finite() && sum > 0.0).then_some(Self { sums })
    }

    /// The sum of the weights.
    pub fn total(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// Which one a uniform `u` in [0, 1) chooses, and where in its share `u` lies: again uniform.
    pub fn pick(&self, u: f64) -> (usize, f64) {
        pick(&self.sums, u)
    }

    /// How often it is chosen.
    pub fn probability(&self, at: usize) -> f64 {
        let before = if at == 0 { 0.0 } else { self.sums[at - 1] };
        (self.sums[at] - before) / self.total()
    }
}

/// [`Choice::pick`] for running sums that others hold; the last must be positive.
pub fn pick(sums: &[f64], u: f64) -> (usize, f64) {
    let total = sums.last().copied().unwrap_or(0.0);
    let target = (u * total).min(total.next_down());
    let at = sums.partition_point(|sum| *sum <= target);
    let before = if at == 0 { 0.0 } else { sums[at - 1] };
    (at, ((target - before) / (sums[at] - before)).clamp(0.0, 1.0_f64.next_down()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_chosen_by_its_weight_and_its_share_is_even_again() {
        let weights = [1.0, 0.0, 5.0, 2.0, 0.0];
        let choice = Choice::new(weights).unwrap();
        let mut counts = [[0usize; 4]; 5];
        let n = 80_000;
        for i in 0..n {
            let (at, rest) = choice.pick((f64::from(i) + 0.5) / f64::from(n));
            counts[at][(rest * 4.0) as usize] += 1;
        }
        for (at, weight) in weights.into_iter().enumerate() {
            assert_eq!(choice.probability(at), weight / 8.0);
            for count in counts[at] {
                assert!((count as f64 - weight / 32.0 * f64::from(n)).abs() <= 1.0);
            }
        }
        assert_eq!(choice.pick(1.0).0, 3, "even u = 1 chooses something of weight");
    }

    #[test]
    fn weights_that_leave_nothing_to_choose_are_no_choice() {
        for weights in [vec![], vec![0.0], vec![1.0, -1e-9], vec![f64::NAN], vec![f64::INFINITY]] {
            assert!(Choice::new(weights).is_none());
        }
    }
}

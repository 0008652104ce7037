// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The nodes of a table over cosines µ and index ratios η, and where a value lies between them.

/// Nodes over µ.
pub const COSINES: usize = 80;
/// Which share of the nodes is even in µ; the others are even in ln(1 + µ/k).
const EVEN_SHARE: f64 = 0.3;
/// k, as a share of α.
const KNEE: f64 = 0.01;
/// Nodes over the index ratio: odd, so that one of them is η = 1.
pub const RATIOS: usize = 513;
/// The largest |η − 1|/(η + 1) in the table: η from 1/3 to 3.
const LARGEST_CONTRAST: f64 = 0.5;

/// Where nodes lie: what hides changes with µ/α, and steeply as µ goes to 0.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    /// 1/k.
    per_cosine: f64,
    /// Nodes per ln(1 + µ/k), beside those that are even in µ.
    per_log: f64,
}

impl Spread {
    const EVEN: f64 = EVEN_SHARE * (COSINES - 1) as f64;

    pub fn new(alpha: f64) -> Self {
        let per_cosine = 1.0 / (KNEE * alpha);
        let per_log = (1.0 - EVEN_SHARE) * (COSINES - 1) as f64 / per_cosine.ln_1p();
        Self { per_cosine, per_log }
    }

    /// The number of nodes below µ, x(µ).
    pub fn below(self, mu: f64) -> f64 {
        (mu * self.per_cosine).ln_1p() * self.per_log + mu * Self::EVEN
    }

    /// ∫ 2µ·x dµ from 0.
    pub fn moment(self, mu: f64) -> f64 {
        let k = 1.0 / self.per_cosine;
        let log = (mu * mu - k * k) * (mu / k).ln_1p() - 0.5 * mu * mu + k * mu;
        self.per_log * log + Self::EVEN * mu * mu * mu / 1.5
    }

    /// µ of a node, by halving.
    pub fn cosine(self, node: usize) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.below(middle) < node as f64 {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// The weights of the nodes in 2∫ f(µ) µ dµ for functions that are linear in x between them.
    pub fn weights(self) -> [f64; COSINES] {
        let mut weights = [0.0; COSINES];
        for node in 0..COSINES - 1 {
            let [below, above] = [self.cosine(node), self.cosine(node + 1)];
            let whole = above * above - below * below;
            let upper = self.moment(above) - self.moment(below) - node as f64 * whole;
            weights[node] += whole - upper;
            weights[node + 1] += upper;
        }
        weights
    }
}

/// η of a node: contrast grows with the square of the node's distance from η = 1, near which
/// reflection at grazing incidence changes most.
pub fn node_ratio(node: usize) -> f64 {
    let s = 2.0 * node as f64 / (RATIOS - 1) as f64 - 1.0;
    let contrast = LARGEST_CONTRAST * s * s.abs();
    (1.0 + contrast) / (1.0 - contrast)
}

pub fn between_ratios(eta: f64) -> Between {
    let contrast = (eta - 1.0) / (eta + 1.0) / LARGEST_CONTRAST;
    let s = contrast.abs().sqrt().min(1.0).copysign(contrast);
    Between::new(0.5 * (s + 1.0) * (RATIOS - 1) as f64, RATIOS)
}

/// A place between two nodes.
#[derive(Clone, Copy, Debug)]
pub struct Between {
    /// The node before it.
    pub at: usize,
    /// The way to the next node, from 0 to 1.
    pub t: f64,
}

impl Between {
    pub fn new(position: f64, nodes: usize) -> Self {
        let at = (position as usize).min(nodes - 2);
        Self { at, t: (position - at as f64).clamp(0.0, 1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_integrate_what_is_linear_between_the_nodes() {
        for alpha in [0.001, 0.1, 1.0] {
            let spread = Spread::new(alpha);
            let weights = spread.weights();
            let all: f64 = weights.iter().sum();
            assert!((all - 1.0).abs() < 1e-12, "{alpha}: {all}");
            assert!(weights.iter().all(|w| *w > 0.0), "{alpha}: {weights:?}");
            let mean: f64 = weights.iter().enumerate().map(|(i, w)| w * i as f64).sum();
            let steps = 100_000;
            let place = |i: i32| (f64::from(i) + 0.5) / f64::from(steps);
            let sum: f64 = (0..steps).map(|i| 2.0 * place(i) * spread.below(place(i))).sum();
            assert!((mean - sum / f64::from(steps)).abs() < 1e-6, "{alpha}: {mean} {sum}");
        }
    }

    #[test]
    fn every_index_ratio_lies_between_the_nodes_next_to_it() {
        for i in 0..1000 {
            let eta = 1.0 / 3.0 + f64::from(i) * 0.0026;
            let ratio = between_ratios(eta);
            let [low, high] = [ratio.at, ratio.at + 1].map(node_ratio);
            assert!(low <= eta * (1.0 + 1e-12) && eta <= high * (1.0 + 1e-12), "{eta}");
        }
        assert_eq!(node_ratio(RATIOS / 2), 1.0);
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Lobe`]: directions chosen in proportion to a loss.

use super::nodes::{Between, COSINES};

/// A density over µ that follows ℓ(µ)·µ: even in µ² within each cell between two nodes.
#[derive(Clone, Debug)]
pub struct Lobe {
    /// The chance of a cosine below each node.
    below: [f64; COSINES],
}

impl Lobe {
    /// The lobe of a loss given at the nodes, whose squared cosines are `squares`.
    pub fn new(losses: &[f64; COSINES], squares: &[f64; COSINES]) -> Self {
        let mut below = [0.0; COSINES];
        for node in 1..COSINES {
            let area = squares[node] - squares[node - 1];
            below[node] = below[node - 1] + (losses[node] + losses[node - 1]) * area;
        }
        let all = below[COSINES - 1];
        // Without any loss the lobe is never asked for: any will do.
        below = if all > 0.0 { below.map(|b| b / all) } else { *squares };
        Self { below }
    }

    /// The density at a cosine, as a multiple of µ/π per sr.
    pub fn density(&self, squares: &[f64; COSINES], mu: Between) -> f64 {
        let share = self.below[mu.at + 1] - self.below[mu.at];
        share / (squares[mu.at + 1] - squares[mu.at])
    }

    /// The squared cosine of a uniform number.
    pub fn sample(&self, squares: &[f64; COSINES], u: f64) -> f64 {
        let next = self.below.partition_point(|b| *b <= u).clamp(1, COSINES - 1);
        let share = self.below[next] - self.below[next - 1];
        let t = if share > 0.0 { (u - self.below[next - 1]) / share } else { 0.5 };
        squares[next - 1] + t.clamp(0.0, 1.0) * (squares[next] - squares[next - 1])
    }
}

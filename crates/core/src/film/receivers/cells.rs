// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`DirectionCells`]: an H–V grid of directions.

/// Cells between given borders of H and V.
#[derive(Clone, Debug)]
pub struct DirectionCells {
    h: Borders,
    v: Borders,
}

impl DirectionCells {
    /// Cells between rising borders in rad, within ±π for H and ±π/2 for V; `None` for others.
    pub fn new(h_edges: Vec<f64>, v_edges: Vec<f64>) -> Option<Self> {
        use std::f64::consts::{FRAC_PI_2, PI};
        Some(Self { h: Borders::new(h_edges, PI)?, v: Borders::new(v_edges, FRAC_PI_2)? })
    }

    /// How many there are: rows of V, each along H.
    pub fn len(&self) -> usize {
        self.h.count() * self.v.count()
    }

    /// Whether there are none: never.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of the cell with a direction: along H first, then V.
    pub fn find(&self, h: f64, v: f64) -> Option<usize> {
        Some(self.v.find(v)? * self.h.count() + self.h.find(h)?)
    }
}

/// Rising borders between intervals.
#[derive(Clone, Debug)]
struct Borders {
    edges: Vec<f64>,
    /// Intervals per rad, to guess.
    per_rad: f64,
}

impl Borders {
    /// More than the rounding of the last border.
    const SLACK: f64 = 1e-9;

    fn new(edges: Vec<f64>, most: f64) -> Option<Self> {
        let rises = edges.len() > 1 && edges.windows(2).all(|pair| pair[0] < pair[1]);
        let (first, last) = (*edges.first()?, *edges.last()?);
        let within = first >= -most - Self::SLACK && last <= most + Self::SLACK;
        let per_rad = (edges.len() - 1) as f64 / (last - first);
        (rises && within).then_some(Self { edges, per_rad })
    }

    fn count(&self) -> usize {
        self.edges.len() - 1
    }

    /// The interval with `angle`; its upper border belongs to the next one.
    fn find(&self, angle: f64) -> Option<usize> {
        let (first, last) = (self.edges[0], self.edges[self.count()]);
        if !(first..=last).contains(&angle) {
            return None;
        }
        let guess = ((angle - first) * self.per_rad) as usize;
        let guess = guess.min(self.count() - 1);
        let fits = self.edges[guess] <= angle && angle < self.edges[guess + 1];
        let found =
            if fits { guess + 1 } else { self.edges.partition_point(|edge| *edge <= angle) };
        Some(found.clamp(1, self.count()) - 1)
    }
}

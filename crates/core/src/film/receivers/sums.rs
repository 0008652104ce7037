// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`GroupSums`]: what the receivers caught of one light group, in the order of its paths.

use super::Receivers;
use crate::spectrum::LANES;

/// Σ X, Σ Y, Σ Z of a flux; Y in lm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Xyz(pub [f64; 3]);

impl Xyz {
    /// Add tristimulus values.
    pub fn add(&mut self, xyz: [f64; 3]) {
        for (sum, value) in self.0.iter_mut().zip(xyz) {
            *sum += value;
        }
    }
}

/// What the receivers caught of one light group.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupSums {
    /// All that left.
    pub out: Xyz,
    /// By cell of the grid.
    pub cells: Vec<Xyz>,
    /// By spot.
    pub spots: Vec<Xyz>,
    /// By pixel of the map.
    pub map: Vec<Xyz>,
    /// Spectral flux of all that left, by band.
    pub out_bands: Vec<f64>,
    /// By cell, then by band.
    pub cell_bands: Vec<f64>,
    /// By spot, then by band.
    pub spot_bands: Vec<f64>,
}

impl GroupSums {
    /// Nothing caught yet.
    pub fn new(receivers: &Receivers) -> Self {
        let cells = receivers.cells.as_ref().map_or(0, super::DirectionCells::len);
        let (spots, bands) = (receivers.spots.len(), receivers.spot_bands * LANES);
        Self {
            out: Xyz::default(),
            cells: vec![Xyz::default(); cells],
            spots: vec![Xyz::default(); spots],
            map: vec![Xyz::default(); receivers.map.as_ref().map_or(0, super::PlaneMap::len)],
            out_bands: vec![0.0; bands],
            cell_bands: vec![0.0; cells * receivers.cell_bands * LANES],
            spot_bands: vec![0.0; spots * bands],
        }
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Directions of an emitter's flux, drawn by its angular law.

use std::f64::consts::{PI, TAU};

use super::{AngularLaw, DirectionGrid, IntensityTable};
use crate::math::{orthonormal_pair, DVec3};
use crate::sampling::{pick, Choice};

impl AngularLaw {
    /// A direction in which a place with the unit `normal` sends flux, for `u` uniform in the unit
    /// square, and its density per sr; `None` where the place sends nothing there.
    ///
    /// The density follows the flux exactly for the laws of cosines: with ξ uniform, cos θ =
    /// ξ^(1/(n + 1)). That of a table follows the table's own intensity, whichever way the place
    /// faces.
    pub fn sample(&self, normal: DVec3, [u, v]: [f64; 2]) -> Option<(DVec3, f64)> {
        let exponent = match self {
            Self::Table(table) => return table.sample(normal, [u, v]),
            Self::Lambert => 1.0,
            Self::Cosine { exponent } => *exponent,
        };
        let cos = (1.0 - u).powf(1.0 / (exponent + 1.0));
        // 1 − cos² without cancellation near the normal.
        let sin = (-(2.0 / (exponent + 1.0) * (-u).ln_1p()).exp_m1()).max(0.0).sqrt();
        let (y, x) = (TAU * v).sin_cos();
        let (tangent, bitangent) = orthonormal_pair(normal);
        let direction = (tangent * x + bitangent * y) * sin + normal * cos;
        let pdf = (exponent + 1.0) / TAU * cos.powf(exponent);
        (pdf > 0.0).then_some((direction, pdf))
    }
}

impl IntensityTable {
    fn sample(&self, normal: DVec3, u: [f64; 2]) -> Option<(DVec3, f64)> {
        let (local, pdf) = self.cells.sample(u);
        let direction = self.to_table.transpose() * local;
        (direction.dot(normal) > 0.0).then_some((direction, pdf))
    }
}

/// Cells of directions, chosen by the flux of a [`DirectionGrid`] in each and even within.
#[derive(Clone, Debug)]
pub(super) struct DirectionCells {
    /// Borders of the rows, as cosines of polar angles, falling.
    cosines: Vec<f64>,
    /// Borders of the columns, as azimuths in rad, rising; the last a turn after the first.
    azimuths: Vec<f64>,
    /// Running sums of the flux, row by row.
    sums: Vec<f64>,
}

/// The widest cell, in rad.
const WIDEST: [f64; 2] = [PI / 180.0, PI / 36.0];

impl DirectionCells {
    /// `None` where the grid is dark.
    pub fn new(grid: &DirectionGrid) -> Option<Self> {
        let polar = subdivided(&grid.polar, WIDEST[0]);
        let mut round = grid.azimuths.clone();
        round.push(round[0] + TAU);
        let azimuths = if grid.azimuths.len() == 1 { round } else { subdivided(&round, WIDEST[1]) };
        let cosines: Vec<f64> = polar.iter().map(|angle| angle.cos()).collect();
        let value = |theta: f64, phi: f64| {
            let (sin, cos) = theta.sin_cos();
            grid.at(DVec3::new(sin * phi.cos(), sin * phi.sin(), cos))
        };
        let mut weights = Vec::with_capacity(polar.len() * azimuths.len());
        for (rows, heights) in polar.windows(2).zip(cosines.windows(2)) {
            for columns in azimuths.windows(2) {
                // In a cell the grid is bilinear in its angles: the middle has the mean, and is
                // nothing only where the whole cell is.
                let middle = value(0.5 * (rows[0] + rows[1]), 0.5 * (columns[0] + columns[1]));
                weights.push(middle * (heights[0] - heights[1]) * (columns[1] - columns[0]));
            }
        }
        let mut sum = 0.0;
        Choice::new(weights.iter().copied())?;
        let sums = weights.iter().map(|weight| {
            sum += weight;
            sum
        });
        Some(Self { sums: sums.collect(), cosines, azimuths })
    }

    /// A unit direction in the grid's frame, and its density per sr.
    pub fn sample(&self, [u, v]: [f64; 2]) -> (DVec3, f64) {
        let (cell, rest) = pick(&self.sums, u);
        let columns = self.azimuths.len() - 1;
        let (row, column) = (cell / columns, cell % columns);
        let (top, bottom) = (self.cosines[row], self.cosines[row + 1]);
        let (left, right) = (self.azimuths[column], self.azimuths[column + 1]);
        let cos = top + (bottom - top) * rest;
        let (y, x) = (left + (right - left) * v).sin_cos();
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let before = if cell == 0 { 0.0 } else { self.sums[cell - 1] };
        let share = (self.sums[cell] - before) / self.sums[self.sums.len() - 1];
        (DVec3::new(sin * x, sin * y, cos), share / ((top - bottom) * (right - left)))
    }
}

/// Rising `angles` with more between them, so that none is more than `widest` from the next.
fn subdivided(angles: &[f64], widest: f64) -> Vec<f64> {
    let mut all: Vec<f64> = Vec::new();
    for pair in angles.windows(2) {
        let parts = ((pair[1] - pair[0]) / widest - 1e-9).ceil().max(1.0) as usize;
        let step = (pair[1] - pair[0]) / parts as f64;
        all.extend((0..parts).map(|part| pair[0] + step * part as f64));
    }
    all.extend(angles.last());
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DMat3;

    const N: usize = 1 << 14;

    /// ∫ f dω over all that is drawn, by points spread over the unit square.
    fn mean(law: &AngularLaw, normal: DVec3, f: impl Fn(DVec3) -> f64) -> f64 {
        let point = |i: usize| {
            let u = (i as f64 + 0.5) / N as f64;
            [u, (i as f64 * 0.618_033_988_749_895).fract()]
        };
        let value = |i: usize| law.sample(normal, point(i)).map_or(0.0, |(way, pdf)| f(way) / pdf);
        (0..N).map(value).sum::<f64>() / N as f64
    }

    #[test]
    fn the_density_of_cosine_laws_is_that_of_their_flux() {
        let normal = DVec3::new(0.3, -0.5, 0.8).normalize();
        for exponent in [0.0, 0.4, 1.0, 3.0, 60.0] {
            let law = AngularLaw::Cosine { exponent };
            for i in 0..200 {
                let u = (f64::from(i) + 0.5) / 200.0;
                let (way, pdf) = law.sample(normal, [u, 0.37]).unwrap();
                let cos = way.dot(normal);
                assert!((way.length() - 1.0).abs() < 1e-12);
                let flux = law.factor(cos, way) * cos;
                let expected = flux / law.etendue(1.0);
                assert!((pdf / expected - 1.0).abs() < 1e-9, "{exponent}: {pdf} {expected}");
            }
            // Half of the flux lies within cos θ = 2^(−1/(n + 1)).
            let half = 0.5_f64.powf(1.0 / (exponent + 1.0));
            let inner = (0..N).filter(|i| {
                let u = (*i as f64 + 0.5) / N as f64;
                law.sample(normal, [u, 0.2]).unwrap().0.dot(normal) > half
            });
            assert_eq!(inner.count(), N / 2);
        }
    }

    #[test]
    fn directions_of_a_table_stand_for_its_intensity() {
        // I = 1 + cos φ on a belt, dark elsewhere.
        let polar: Vec<f64> = (30..=90).map(|deg| f64::from(deg).to_radians()).collect();
        let azimuths: Vec<f64> = (0..360).map(|deg| f64::from(deg).to_radians()).collect();
        let values: Vec<f64> =
            azimuths.iter().flat_map(|phi| polar.iter().map(move |_| 1.0 + phi.cos())).collect();
        let grid = DirectionGrid::new(polar, azimuths, values).unwrap();
        let table = IntensityTable::new(grid, DMat3::IDENTITY, vec![DVec3::X, -DVec3::X, DVec3::Z]);
        let law = AngularLaw::Table(Box::new(table.unwrap()));
        let AngularLaw::Table(own) = &law else { unreachable!() };
        let normal = DVec3::Z;
        let flux = mean(&law, normal, |way| own.intensity.at(way));
        let expected = TAU * 30.0_f64.to_radians().cos();
        assert!((flux / expected - 1.0).abs() < 2e-3, "{flux} {expected}");
        // ∫ (1 + cos φ) cos φ dφ = π, and ∫ sin² θ dθ from 30° to 90°.
        let sideways = mean(&law, normal, |way| own.intensity.at(way) * way.x);
        let (low, high) = (PI / 6.0, PI / 2.0);
        let integral = 0.5 * (high - low) - 0.25 * ((2.0 * high).sin() - (2.0 * low).sin());
        assert!((sideways / (PI * integral) - 1.0).abs() < 2e-3, "{sideways}");
    }
}

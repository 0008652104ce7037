// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`SphereMap`]: a grid of patches over all directions, each chosen by its brightness.

use std::f64::consts::{PI, TAU};

use crate::math::DVec3;
use crate::sampling::pick;

/// A grid of `width` × `height` patches over the sphere, equal steps of azimuth and of the angle
/// from +y, with a density that is even within each patch.
///
/// Rows run from +y down to −y. The middle column looks along −z, as one who stands before a lamp
/// looks at it, and the right-hand half is on that one's right, +x: column share s stands for
/// azimuth a = 2π(s − ½), and (sin θ sin a, cos θ, −sin θ cos a) is the direction.
#[derive(Clone, Debug)]
pub(super) struct SphereMap {
    width: usize,
    height: usize,
    /// Along each row, the running sums of brightness × solid angle.
    rows: Vec<f64>,
    /// The running sums of whole rows.
    column: Vec<f64>,
}

impl SphereMap {
    /// A map of `brightness(row, column)`, each ≥ 0 and finite; `None` if all are zero.
    pub fn new(
        [width, height]: [usize; 2],
        brightness: impl Fn(usize, usize) -> f64,
    ) -> Option<Self> {
        let mut map = Self {
            width,
            height,
            rows: Vec::with_capacity(width * height),
            column: Vec::with_capacity(height),
        };
        let mut above = 0.0;
        for row in 0..height {
            let solid_angle = map.solid_angle(row);
            let mut sum = 0.0;
            for column in 0..width {
                sum += brightness(row, column) * solid_angle;
                map.rows.push(sum);
            }
            above += sum;
            map.column.push(above);
        }
        (above > 0.0 && above.is_finite()).then_some(map)
    }

    /// The middle direction of a patch of a grid of so many columns and rows.
    pub fn middle([width, height]: [usize; 2], [row, column]: [usize; 2]) -> DVec3 {
        let (sin, cos) = (PI * (row as f64 + 0.5) / height as f64).sin_cos();
        let azimuth = TAU * ((column as f64 + 0.5) / width as f64 - 0.5);
        DVec3::new(sin * azimuth.sin(), cos, -sin * azimuth.cos())
    }

    /// The sum of brightness × solid angle.
    pub fn total(&self) -> f64 {
        self.column.last().copied().unwrap_or(0.0)
    }

    /// The solid angle of one patch of a row, in sr.
    fn solid_angle(&self, row: usize) -> f64 {
        let edge = |row: usize| (PI * row as f64 / self.height as f64).cos();
        TAU / self.width as f64 * (edge(row) - edge(row + 1))
    }

    /// The row and column of the patch that `direction` points at.
    pub fn patch(&self, direction: DVec3) -> (usize, usize) {
        patch([self.width, self.height], direction)
    }

    /// The direction for `u` uniform in the unit square.
    pub fn direction(&self, [u, v]: [f64; 2]) -> DVec3 {
        let (row, down) = pick(&self.column, u);
        let (column, across) = pick(&self.rows[row * self.width..(row + 1) * self.width], v);
        let edge = |row: usize| (PI * row as f64 / self.height as f64).cos();
        let cos = edge(row) + (edge(row + 1) - edge(row)) * down;
        let azimuth = TAU * ((column as f64 + across) / self.width as f64 - 0.5);
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        DVec3::new(sin * azimuth.sin(), cos, -sin * azimuth.cos())
    }

    /// The density of [`Self::direction`], per sr.
    pub fn density(&self, direction: DVec3) -> f64 {
        let (row, column) = self.patch(direction);
        let at = row * self.width + column;
        let before = if column == 0 { 0.0 } else { self.rows[at - 1] };
        (self.rows[at] - before) / (self.solid_angle(row) * self.total())
    }
}

/// The row and column, of so many columns and rows, of the patch that `direction` points at.
pub(super) fn patch([width, height]: [usize; 2], direction: DVec3) -> (usize, usize) {
    let share = 0.5 + direction.x.atan2(-direction.z) / TAU;
    let theta = direction.x.hypot(direction.z).atan2(direction.y);
    let row = (theta / PI * height as f64) as usize;
    let column = (share * width as f64) as usize;
    (row.min(height - 1), column.min(width - 1))
}

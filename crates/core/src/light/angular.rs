// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`AngularLaw`]: how an emitter's radiance depends on direction.

mod sampling;

use std::f64::consts::{PI, TAU};

use thiserror::Error;

use crate::math::{DMat3, DVec3};
use sampling::DirectionCells;

/// How an emitter's radiance depends on direction, as a factor of its own radiance.
#[derive(Clone, Debug)]
pub enum AngularLaw {
    /// The same in all directions.
    Lambert,
    /// cosⁿ⁻¹ θ from the normal: a flat face has the intensity cosⁿ θ, and full radiance along its
    /// normal.
    Cosine {
        /// n ≥ 0; 1 is Lambert's law.
        exponent: f64,
    },
    /// A measured intensity of the whole body.
    Table(Box<IntensityTable>),
}

impl AngularLaw {
    /// The factor of the radiance that leaves along `direction` at `cos` > 0 from the normal.
    pub(super) fn factor(&self, cos: f64, direction: DVec3) -> f64 {
        match self {
            Self::Lambert => 1.0,
            Self::Cosine { exponent } => cos.powf(exponent - 1.0),
            Self::Table(table) => table.factor(direction),
        }
    }

    /// The flux that leaves a body of `area`, per radiance: ∫ factor·cos θ dA dω.
    pub fn etendue(&self, area: f64) -> f64 {
        match self {
            Self::Lambert | Self::Table(_) => PI * area,
            Self::Cosine { exponent } => TAU / (exponent + 1.0) * area,
        }
    }
}

/// Why numbers cannot be an intensity table.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IntensityError {
    /// The angles do not rise strictly, or leave their range.
    #[error("the {0} angles of an intensity table must rise, and keep within {1}")]
    Angles(&'static str, &'static str),
    /// The values are not one for each pair of angles.
    #[error("an intensity table of {polar} × {azimuths} angles needs {} values, not {values}", polar * azimuths)]
    Size {
        /// Polar angles.
        polar: usize,
        /// Azimuths.
        azimuths: usize,
        /// Values that came.
        values: usize,
    },
    /// An intensity is negative or not finite.
    #[error("an intensity must be finite and not negative, not {0}")]
    Value(f64),
    /// The body does not face any direction of which the table has light.
    #[error("the intensity table is dark in all directions that the body's surface faces")]
    Dark,
}

/// Values over all directions round an axis, linear between the angles of a grid.
#[derive(Clone, Debug)]
pub struct DirectionGrid {
    /// Polar angles in rad, rising; beyond the first and the last the value is zero.
    polar: Vec<f64>,
    /// Azimuths in rad, rising, the last less than a turn after the first: it goes round.
    azimuths: Vec<f64>,
    /// By azimuth, then by polar angle.
    values: Vec<f64>,
}

impl DirectionGrid {
    /// The grid of `polar` angles, in rad from 0 to π, and `azimuths`, in rad from 0 to less than
    /// 2π, where `values` hold all polar angles of the first azimuth, then of the next. One azimuth
    /// alone makes a body of revolution.
    ///
    /// # Errors
    /// Angles out of order, a wrong number of values, and values that are negative or not finite.
    pub fn new(
        polar: Vec<f64>,
        azimuths: Vec<f64>,
        values: Vec<f64>,
    ) -> Result<Self, IntensityError> {
        let rises = |angles: &[f64], last: f64| {
            !angles.is_empty()
                && angles.windows(2).all(|pair| pair[0] < pair[1])
                && angles[0] >= 0.0
                && angles[angles.len() - 1] <= last
        };
        if polar.len() < 2 || !rises(&polar, PI) {
            return Err(IntensityError::Angles("polar", "0 and π"));
        }
        if !rises(&azimuths, TAU.next_down()) {
            return Err(IntensityError::Angles("azimuth", "0 and 2π, 2π itself left out"));
        }
        if values.len() != polar.len() * azimuths.len() {
            let (polar, azimuths, values) = (polar.len(), azimuths.len(), values.len());
            return Err(IntensityError::Size { polar, azimuths, values });
        }
        match values.iter().find(|value| !(value.is_finite() && **value >= 0.0)) {
            Some(value) => Err(IntensityError::Value(*value)),
            None => Ok(Self { polar, azimuths, values }),
        }
    }

    /// The value in the unit direction, in the grid's frame: polar angles from +z, azimuths from +x
    /// to +y.
    pub fn at(&self, direction: DVec3) -> f64 {
        let theta = direction.x.hypot(direction.y).atan2(direction.z);
        let above = self.polar.partition_point(|angle| *angle <= theta);
        let Some((row, down)) = between(&self.polar, above, theta) else {
            return 0.0;
        };
        let along = |azimuth: usize| {
            let first = azimuth * self.polar.len() + row;
            self.values[first] * (1.0 - down) + self.values[first + 1] * down
        };
        let n = self.azimuths.len();
        if n == 1 {
            return along(0);
        }
        let phi = direction.y.atan2(direction.x).rem_euclid(TAU);
        let after = self.azimuths.partition_point(|angle| *angle <= phi);
        let (left, right) = ((after + n - 1) % n, after % n);
        let width = (self.azimuths[right] - self.azimuths[left]).rem_euclid(TAU);
        let across = (phi - self.azimuths[left]).rem_euclid(TAU) / width;
        along(left) * (1.0 - across) + along(right) * across
    }
}

/// The interval of `angles` that ends at index `above`, and the share of the way through it.
fn between(angles: &[f64], above: usize, angle: f64) -> Option<(usize, f64)> {
    let last = angles.len() - 1;
    // The poles' own angles are reached only up to rounding.
    let above = if above == angles.len() && angle <= angles[last] + 1e-12 { last } else { above };
    let row = above.checked_sub(1).filter(|row| *row < last)?;
    Some((row, ((angle - angles[row]) / (angles[row + 1] - angles[row])).min(1.0)))
}

/// The shadow that a body's outward surface casts, by direction: ∫ max(0, n·ω) dA in mm².
#[derive(Clone, Debug)]
enum ProjectedArea {
    /// Few flat faces: the sum over their area vectors n·A.
    Faces(Vec<DVec3>),
    /// Tabulated in the frame of the intensities.
    Grid(DirectionGrid),
}

/// A measured luminous intensity, as a law for the radiance of the surface that it is put on.
///
/// All places of the surface that face a direction ω get the same radiance I(ω)/A(ω), with A the
/// projected area of those places: so the whole has the intensity I, whatever its shape. Where the
/// body hides parts of itself, that light is lost. The factor is scaled so that the flux is that of
/// a Lambert emitter of the same radiance.
#[derive(Clone, Debug)]
pub struct IntensityTable {
    /// From the world to the table's frame.
    to_table: DMat3,
    intensity: DirectionGrid,
    projected: ProjectedArea,
    /// To draw directions.
    cells: DirectionCells,
    scale: f64,
    reached: f64,
}

impl IntensityTable {
    /// More faces than these are tabulated.
    const MOST_FACES: usize = 32;

    /// The law for relative `intensity` in a frame whose columns are its x, y and z axes (orthonormal,
    /// in the world), on a surface with the given area vectors (n·dA in mm², outward).
    ///
    /// # Errors
    /// The surface faces none of the directions in which the table has light.
    pub fn new(
        intensity: DirectionGrid,
        frame: DMat3,
        area_vectors: Vec<DVec3>,
    ) -> Result<Self, IntensityError> {
        let area: f64 = area_vectors.iter().map(|a| a.length()).sum();
        let to_table = frame.transpose();
        let projected = if area_vectors.len() <= Self::MOST_FACES {
            ProjectedArea::Faces(area_vectors)
        } else {
            ProjectedArea::Grid(tabulate(&area_vectors, frame))
        };
        let cells = DirectionCells::new(&intensity).ok_or(IntensityError::Dark)?;
        let mut table = Self { to_table, intensity, projected, cells, scale: 1.0, reached: 1.0 };
        let (emitted, wanted) = table.totals();
        if emitted.is_nan() || emitted <= 0.0 {
            return Err(IntensityError::Dark);
        }
        table.scale = PI * area / emitted;
        table.reached = emitted / wanted;
        Ok(table)
    }

    /// The share of the table's flux in directions that the surface faces; the rest cannot leave it.
    pub fn reached_share(&self) -> f64 {
        self.reached
    }

    fn projected(&self, direction: DVec3) -> f64 {
        match &self.projected {
            ProjectedArea::Faces(faces) => faces.iter().map(|a| a.dot(direction).max(0.0)).sum(),
            ProjectedArea::Grid(grid) => grid.at(self.to_table * direction),
        }
    }

    fn factor(&self, direction: DVec3) -> f64 {
        let projected = self.projected(direction);
        if projected <= 0.0 {
            return 0.0;
        }
        self.scale * self.intensity.at(self.to_table * direction) / projected
    }

    /// ∫ I dω over the directions that the surface faces, and over all: midpoint sums over steps of
    /// ¼° and 1°, right to 1e-5 for tables of whole degrees.
    fn totals(&self) -> (f64, f64) {
        const STEPS: [usize; 2] = [720, 360];
        let (mut emitted, mut wanted) = (0.0, 0.0);
        for i in 0..STEPS[0] {
            let (sin, cos) = (PI * (i as f64 + 0.5) / STEPS[0] as f64).sin_cos();
            for j in 0..STEPS[1] {
                let (y, x) = (TAU * (j as f64 + 0.5) / STEPS[1] as f64).sin_cos();
                let local = DVec3::new(sin * x, sin * y, cos);
                let share = self.intensity.at(local) * sin;
                wanted += share;
                if share > 0.0 && self.projected(self.to_table.transpose() * local) > 0.0 {
                    emitted += share;
                }
            }
        }
        let patch = PI / STEPS[0] as f64 * TAU / STEPS[1] as f64;
        (emitted * patch, wanted * patch)
    }
}

/// The projected area on a grid of 2°, round the axes of `frame`.
fn tabulate(area_vectors: &[DVec3], frame: DMat3) -> DirectionGrid {
    const STEPS: [usize; 2] = [90, 180];
    let polar: Vec<f64> = (0..=STEPS[0]).map(|i| PI * i as f64 / STEPS[0] as f64).collect();
    let azimuths: Vec<f64> = (0..STEPS[1]).map(|j| TAU * j as f64 / STEPS[1] as f64).collect();
    let mut values = Vec::with_capacity(polar.len() * azimuths.len());
    for phi in &azimuths {
        for theta in &polar {
            let (sin, cos) = theta.sin_cos();
            let direction = frame * DVec3::new(sin * phi.cos(), sin * phi.sin(), cos);
            values.push(area_vectors.iter().map(|a| a.dot(direction).max(0.0)).sum());
        }
    }
    DirectionGrid { polar, azimuths, values }
}

#[cfg(test)]
mod tests;

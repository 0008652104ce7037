// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`SpectralTable`]: a function of wavelength, laid out so that a path reads it with one load.

use thiserror::Error;

use super::{SampledSpectrum, LANES};

/// Which wavelengths a path carries: the phase of its sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampledWavelengths {
    /// The phase p, 0 ≤ p < P.
    pub phase: usize,
}

/// A spectrum resampled on all P·LANES wavelengths, one row of lanes per phase.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralTable {
    rows: Box<[SampledSpectrum]>,
}

/// Why values cannot make a [`SpectralTable`].
#[derive(Debug, Error, PartialEq)]
pub enum TableError {
    /// The number of values is not a multiple of the lanes.
    #[error("a spectral table needs a multiple of {LANES} values, not {0}")]
    Length(usize),
    /// A value is NaN or infinite.
    #[error("value {index} of a spectral table is not finite")]
    NotFinite {
        /// Where it stands, in order of wavelength.
        index: usize,
    },
}

impl SpectralTable {
    /// Make a table of values given in order of wavelength: value j·P + p goes to lane j, phase p.
    ///
    /// # Errors
    /// The values are not a multiple of [`LANES`], or one is not finite.
    pub fn from_ascending(values: &[f64]) -> Result<Self, TableError> {
        if values.is_empty() || !values.len().is_multiple_of(LANES) {
            return Err(TableError::Length(values.len()));
        }
        if let Some(index) = values.iter().position(|v| !v.is_finite()) {
            return Err(TableError::NotFinite { index });
        }
        let phases = values.len() / LANES;
        let rows = (0..phases)
            .map(|phase| SampledSpectrum::from_fn(|lane| values[lane * phases + phase]))
            .collect();
        Ok(Self { rows })
    }

    /// The values on one path's wavelengths.
    #[inline]
    pub fn at(&self, wavelengths: SampledWavelengths) -> SampledSpectrum {
        self.rows[wavelengths.phase]
    }

    /// The table of `f` of three tables' lanes, phase by phase.
    #[must_use]
    pub fn combine(
        tables: &[Self; 3],
        f: impl Fn([SampledSpectrum; 3]) -> SampledSpectrum,
    ) -> Self {
        let [a, b, c] = tables;
        let rows = a.rows.iter().zip(&b.rows).zip(&c.rows);
        Self { rows: rows.map(|((a, b), c)| f([*a, *b, *c])).collect() }
    }

    /// How many phases the table has.
    pub fn phases(&self) -> usize {
        self.rows.len()
    }

    /// The inner product of two tables over all their wavelengths, per phase: with ȳ in cd/m² per
    /// spectral radiance it is the luminance that P samples would find on average.
    pub fn mean_dot(&self, other: &Self) -> f64 {
        let sum: f64 = self.rows.iter().zip(&other.rows).map(|(a, b)| a.dot(*b)).sum();
        sum / self.rows.len() as f64
    }

    /// The table with every value multiplied by `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self { rows: self.rows.iter().map(|row| *row * factor).collect() }
    }

    /// Whether every value is zero.
    pub fn is_zero(&self) -> bool {
        self.rows.iter().all(|row| *row == SampledSpectrum::ZERO)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_phases_together_visit_every_value_once() {
        let values: Vec<f64> = (0..LANES * 5).map(|i| i as f64).collect();
        let table = SpectralTable::from_ascending(&values).unwrap();
        let mut seen: Vec<f64> =
            (0..5).flat_map(|phase| table.at(SampledWavelengths { phase }).0).collect();
        seen.sort_by(f64::total_cmp);
        assert_eq!(seen, values);
        assert_eq!(table.at(SampledWavelengths { phase: 2 }).0[1], 7.0);
    }

    #[test]
    fn a_table_of_odd_length_or_with_nan_is_refused() {
        assert_eq!(SpectralTable::from_ascending(&[1.0; 17]), Err(TableError::Length(17)));
        let mut values = [1.0; 32];
        values[3] = f64::NAN;
        assert_eq!(SpectralTable::from_ascending(&values), Err(TableError::NotFinite { index: 3 }));
    }
}

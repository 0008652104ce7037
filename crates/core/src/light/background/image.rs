// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`ImageMap`]: a surround from an equirectangular picture.

use thiserror::Error;

use super::map::{patch, SphereMap};
use crate::math::{DMat3, DVec3};
use crate::spectrum::{SampledSpectrum, SampledWavelengths, SpectralTable};

/// Why a picture cannot be a surround.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ImageError {
    /// The pixels are not width × height.
    #[error("a picture of {width} × {height} needs {} pixels, not {pixels}", width * height)]
    Size {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// How many pixels came.
        pixels: usize,
    },
    /// A pixel is negative, infinite or not a number.
    #[error(
        "pixel (row {row}, column {column}) is {value}: values must be finite and not negative"
    )]
    Value {
        /// Its row, from the top.
        row: usize,
        /// Its column, from the left.
        column: usize,
        /// The value found.
        value: f32,
    },
}

/// A picture round the scene, of one even radiance per pixel.
///
/// Its rows run from +y down to −y. Unturned, its middle column is seen along −z and its right-hand
/// half towards +x: as who stands before a lamp, and looks at it, sees the picture behind it.
/// `turn` rad turn it about y, from +z to +x for positive values.
///
/// A pixel's radiance is Σ value × basis over its red, green and blue: the bases are smooth spectra,
/// so colours come out as given and the spectra behind them are a guess.
#[derive(Clone, Debug)]
pub struct ImageMap {
    size: [usize; 2],
    pixels: Vec<[f32; 3]>,
    bases: [SpectralTable; 3],
    to_picture: DMat3,
}

impl ImageMap {
    /// The picture of `size` columns and rows, whose `pixels` are linear red, green and blue by rows
    /// from the top.
    ///
    /// # Errors
    /// The pixels are not as many as the size says, or a value is negative or not finite.
    pub fn new(
        size: [usize; 2],
        pixels: Vec<[f32; 3]>,
        bases: [SpectralTable; 3],
        turn: f64,
    ) -> Result<Self, ImageError> {
        let [width, height] = size;
        if width.checked_mul(height) != Some(pixels.len()) || pixels.is_empty() {
            return Err(ImageError::Size { width, height, pixels: pixels.len() });
        }
        let wrong = |value: &f32| !(value.is_finite() && *value >= 0.0);
        for (at, pixel) in pixels.iter().enumerate() {
            if let Some(&value) = pixel.iter().find(|value| wrong(value)) {
                return Err(ImageError::Value { row: at / width, column: at % width, value });
            }
        }
        Ok(Self { size, pixels, bases, to_picture: DMat3::from_rotation_y(-turn) })
    }

    /// The spectral radiance from `direction`.
    pub(super) fn radiance(&self, direction: DVec3, at: SampledWavelengths) -> SampledSpectrum {
        let (row, column) = patch(self.size, self.to_picture * direction);
        let [r, g, b] = self.pixels[row * self.size[0] + column].map(f64::from);
        let [red, green, blue] = &self.bases;
        red.at(at) * r + green.at(at) * g + blue.at(at) * b
    }

    /// Where it is bright, in the picture's own frame; `None` if it is black.
    pub(super) fn brightness(&self, luminosity: &SpectralTable) -> Option<SphereMap> {
        let weights = [0, 1, 2].map(|i| self.bases[i].mean_dot(luminosity).max(0.0));
        SphereMap::new(self.size, |row, column| {
            let pixel = self.pixels[row * self.size[0] + column];
            (0..3).map(|i| weights[i] * f64::from(pixel[i])).sum()
        })
    }

    /// The turn from the world to the picture's own frame.
    pub(super) fn to_picture(&self) -> DMat3 {
        self.to_picture
    }
}

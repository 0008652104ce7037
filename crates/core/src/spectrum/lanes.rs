// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`SampledSpectrum`]: the values of a quantity on one path's wavelengths.

use std::array;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Sub};

/// How many wavelengths a path carries.
pub const LANES: usize = 16;

/// The values of a spectral quantity on the wavelengths of one path.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct SampledSpectrum(pub [f64; LANES]);

impl SampledSpectrum {
    /// Nothing on every lane.
    pub const ZERO: Self = Self([0.0; LANES]);
    /// One on every lane.
    pub const ONE: Self = Self([1.0; LANES]);

    /// The same value on every lane.
    pub fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    /// The value of `f` for each lane.
    pub fn from_fn(f: impl FnMut(usize) -> f64) -> Self {
        Self(array::from_fn(f))
    }

    /// Apply `f` to every lane.
    #[must_use]
    pub fn map(self, mut f: impl FnMut(f64) -> f64) -> Self {
        Self(array::from_fn(|j| f(self.0[j])))
    }

    /// Apply `f` to the lanes of two spectra.
    #[must_use]
    pub fn zip(self, other: Self, mut f: impl FnMut(f64, f64) -> f64) -> Self {
        Self(array::from_fn(|j| f(self.0[j], other.0[j])))
    }

    /// The largest lane.
    pub fn max(self) -> f64 {
        self.0.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether all lanes have the same value.
    pub fn is_even(self) -> bool {
        self.0.iter().all(|value| *value == self.0[0])
    }

    /// The inner product Σⱼ aⱼ·bⱼ.
    pub fn dot(self, other: Self) -> f64 {
        self.0.iter().zip(other.0).map(|(a, b)| a * b).sum()
    }

    /// Whether every lane is finite and not negative: what a radiance must be.
    pub fn is_radiance(self) -> bool {
        self.0.iter().all(|v| v.is_finite() && *v >= 0.0)
    }

    /// Keep `lanes` and set the others to nothing.
    #[must_use]
    pub fn only(self, lanes: std::ops::Range<usize>) -> Self {
        Self(array::from_fn(|j| if lanes.contains(&j) { self.0[j] } else { 0.0 }))
    }

    /// Bouguer–Beer, eq. (2): exp(−a·b) for absorption coefficients a in mm⁻¹ over b mm.
    #[must_use]
    pub fn transmittance(self, distance_mm: f64) -> Self {
        self.map(|a| exp_of_negative(-a * distance_mm))
    }
}

/// exp(x) for x ≤ 0, to 2 ulp, in a form that compilers turn into vector code.
///
/// x = n·ln 2 + r with |r| ≤ ½ ln 2; exp(r) by its Taylor polynomial of degree 13, whose remainder
/// is below 2⁻⁵⁷; 2ⁿ by the exponent bits. Below −708 the result is 0, within 1e-307 of the truth.
#[inline]
fn exp_of_negative(x: f64) -> f64 {
    const SHIFTER: f64 = 6_755_399_441_055_744.0; // 1.5 · 2⁵²: adding it rounds to an integer
    const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
    const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    let clipped = x.max(-708.0);
    let shifted = clipped * std::f64::consts::LOG2_E + SHIFTER;
    let n = shifted - SHIFTER;
    let r = (clipped - n * LN2_HIGH) - n * LN2_LOW;
    let mut sum = 1.0 / 6_227_020_800.0;
    for factorial in [
        479_001_600.0,
        39_916_800.0,
        3_628_800.0,
        362_880.0,
        40_320.0,
        5_040.0,
        720.0,
        120.0,
        24.0,
        6.0,
        2.0,
        1.0,
        1.0,
    ] {
        sum = sum * r + 1.0 / factorial;
    }
    let exponent = shifted.to_bits().wrapping_add(1023) << 52;
    let value = sum * f64::from_bits(exponent);
    if x < -708.0 {
        0.0
    } else {
        value
    }
}

impl Add for SampledSpectrum {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl AddAssign for SampledSpectrum {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for SampledSpectrum {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for SampledSpectrum {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl MulAssign for SampledSpectrum {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl MulAssign<f64> for SampledSpectrum {
    fn mul_assign(&mut self, factor: f64) {
        *self = *self * factor;
    }
}

impl Mul<f64> for SampledSpectrum {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.map(|a| a * factor)
    }
}

impl Div for SampledSpectrum {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn three_millimetres_of_nine_tenths_per_millimetre_transmit_0_729() {
        let absorption = SampledSpectrum::splat(-(0.9_f64.ln()));
        for value in absorption.transmittance(3.0).0 {
            assert!((value - 0.729).abs() < 1e-15);
        }
    }

    #[test]
    fn nothing_is_absorbed_over_no_distance_and_all_over_an_endless_one() {
        let absorption = SampledSpectrum::splat(0.3);
        assert_eq!(absorption.transmittance(0.0), SampledSpectrum::ONE);
        assert_eq!(absorption.transmittance(1e30), SampledSpectrum::ZERO);
        assert_eq!(SampledSpectrum::ZERO.transmittance(5.0), SampledSpectrum::ONE);
    }

    proptest! {
        #[test]
        fn the_vector_exponential_is_within_two_ulp(x in -700.0..0.0f64) {
            let expected = x.exp();
            prop_assert!((exp_of_negative(x) / expected - 1.0).abs() < 2.5 * f64::EPSILON);
        }
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Eight single-precision numbers at once, and the portable way to compute with them.

use super::WIDTH;

/// Eight `f32` lanes of one instruction set.
///
/// Whether `mul_add` rounds once or twice is left to the set: every use is covered by an error
/// bound.
pub(super) trait Lanes: Copy {
    fn splat(value: f32) -> Self;
    fn load(values: &[f32; WIDTH]) -> Self;
    fn store(self) -> [f32; WIDTH];
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    /// `self * factor + term`
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// `self * factor - term`
    fn mul_sub(self, factor: Self, term: Self) -> Self;
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    fn abs(self) -> Self;
    /// Bit `i` is set where lane `i` of `self` is at most lane `i` of `other`.
    fn at_most(self, other: Self) -> u32;
    /// As [`Lanes::at_most`], where bit `i` is for lane `order >> 3 * i & 7`.
    fn at_most_in_order(self, other: Self, order: u32) -> u32;
}

/// Lanes that any machine has: the compiler makes of them what it can.
#[derive(Clone, Copy)]
pub(super) struct Portable([f32; WIDTH]);

impl Portable {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }
}

impl Lanes for Portable {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; WIDTH])
    }

    #[inline(always)]
    fn load(values: &[f32; WIDTH]) -> Self {
        Self(*values)
    }

    #[inline(always)]
    fn store(self) -> [f32; WIDTH] {
        self.0
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        self.mul(factor).zip(term, |a, b| a + b)
    }

    #[inline(always)]
    fn mul_sub(self, factor: Self, term: Self) -> Self {
        self.mul(factor).sub(term)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        (0..WIDTH).fold(0, |bits, i| bits | u32::from(self.0[i] <= other.0[i]) << i)
    }

    #[inline(always)]
    fn at_most_in_order(self, other: Self, order: u32) -> u32 {
        let bits = self.at_most(other);
        (0..WIDTH).fold(0, |ordered, i| ordered | (bits >> (order >> (3 * i) & 7) & 1) << i)
    }
}

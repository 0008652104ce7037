// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The lanes of AVX2 with FMA, and of AVX-512VL, which compares into mask registers.
//!
//! # Safety
//!
//! An intrinsic may run only on a processor that has its instruction set. Every method here is
//! inlined into one of the entry points at the end of this file, which enable the instruction set.
//! Those are called by [`Kernel`](super::Kernel) alone, on behalf of a [`Tree`], which accepts a
//! kernel only if the processor has it.

use std::arch::x86_64::{
    __m256, _mm256_and_ps, _mm256_castps_si256, _mm256_castsi256_ps, _mm256_cmp_ps,
    _mm256_cmp_ps_mask, _mm256_fmadd_ps, _mm256_fmsub_ps, _mm256_loadu_ps, _mm256_max_ps,
    _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps, _mm256_permutevar8x32_epi32,
    _mm256_permutevar8x32_ps, _mm256_set1_epi32, _mm256_set1_ps, _mm256_setr_epi32,
    _mm256_srlv_epi32, _mm256_storeu_ps, _mm256_sub_ps, _CMP_LE_OQ,
};

use crate::math::Ray;

use super::lanes::Lanes;
use super::{traverse, Tree, TriangleHit, WIDTH};

/// What the two instruction sets share; they differ in how they compare.
macro_rules! lanes_of_256_bits {
    (
        $name:ident,
        |$a:ident, $b:ident| $at_most:expr,
        |$c:ident, $d:ident, $order:ident| $at_most_in_order:expr
    ) => {
        #[derive(Clone, Copy)]
        struct $name(__m256);

        // SAFETY of every block: see the head of this file; loads and stores are of eight `f32`,
        // unaligned.
        impl Lanes for $name {
            #[inline(always)]
            fn splat(value: f32) -> Self {
                Self(unsafe { _mm256_set1_ps(value) })
            }

            #[inline(always)]
            fn load(values: &[f32; WIDTH]) -> Self {
                Self(unsafe { _mm256_loadu_ps(values.as_ptr()) })
            }

            #[inline(always)]
            fn store(self) -> [f32; WIDTH] {
                let mut values = [0.0; WIDTH];
                unsafe { _mm256_storeu_ps(values.as_mut_ptr(), self.0) };
                values
            }

            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                Self(unsafe { _mm256_sub_ps(self.0, other.0) })
            }

            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                Self(unsafe { _mm256_mul_ps(self.0, other.0) })
            }

            #[inline(always)]
            fn mul_add(self, factor: Self, term: Self) -> Self {
                Self(unsafe { _mm256_fmadd_ps(self.0, factor.0, term.0) })
            }

            #[inline(always)]
            fn mul_sub(self, factor: Self, term: Self) -> Self {
                Self(unsafe { _mm256_fmsub_ps(self.0, factor.0, term.0) })
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                Self(unsafe { _mm256_min_ps(self.0, other.0) })
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                Self(unsafe { _mm256_max_ps(self.0, other.0) })
            }

            #[inline(always)]
            fn abs(self) -> Self {
                Self(unsafe {
                    _mm256_and_ps(self.0, _mm256_castsi256_ps(_mm256_set1_epi32(i32::MAX)))
                })
            }

            #[inline(always)]
            fn at_most(self, other: Self) -> u32 {
                let ($a, $b) = (self.0, other.0);
                unsafe { $at_most }
            }

            #[inline(always)]
            fn at_most_in_order(self, other: Self, order: u32) -> u32 {
                let ($c, $d) = (self.0, other.0);
                unsafe {
                    // A permutation reads the low three bits of each index alone.
                    let $order = _mm256_srlv_epi32(
                        _mm256_set1_epi32(order as i32),
                        _mm256_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21),
                    );
                    $at_most_in_order
                }
            }
        }
    };
}

lanes_of_256_bits!(
    Avx2,
    |a, b| _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32,
    |a, b, order| {
        let at_most = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b));
        _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_permutevar8x32_epi32(at_most, order))) as u32
    }
);

lanes_of_256_bits!(
    Avx512,
    |a, b| u32::from(_mm256_cmp_ps_mask::<_CMP_LE_OQ>(a, b)),
    |a, b, order| u32::from(_mm256_cmp_ps_mask::<_CMP_LE_OQ>(
        _mm256_permutevar8x32_ps(a, order),
        _mm256_permutevar8x32_ps(b, order)
    ))
);

macro_rules! entry_points {
    ($closest:ident, $any:ident, $all:ident, $lanes:ident, $features:literal) => {
        /// The nearest crossing.
        ///
        /// # Safety
        /// The processor must have the features that are enabled here.
        #[target_feature(enable = $features)]
        pub(super) unsafe fn $closest(tree: &Tree, ray: &Ray) -> Option<TriangleHit> {
            traverse::closest::<$lanes>(tree, ray)
        }

        /// Is there a crossing?
        ///
        /// # Safety
        /// The processor must have the features that are enabled here.
        #[target_feature(enable = $features)]
        pub(super) unsafe fn $any(tree: &Tree, ray: &Ray) -> bool {
            traverse::any::<$lanes, false>(tree, ray, &mut Vec::new())
        }

        /// Adds every crossing to `found`.
        ///
        /// # Safety
        /// The processor must have the features that are enabled here.
        #[target_feature(enable = $features)]
        pub(super) unsafe fn $all(tree: &Tree, ray: &Ray, found: &mut Vec<TriangleHit>) -> bool {
            traverse::any::<$lanes, true>(tree, ray, found)
        }
    };
}

entry_points!(closest_avx2, any_avx2, all_avx2, Avx2, "avx2,fma,bmi1,lzcnt");
entry_points!(
    closest_avx512,
    any_avx512,
    all_avx512,
    Avx512,
    "avx512f,avx512vl,avx2,fma,bmi1,lzcnt"
);

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The choice of instruction set at run time.

use std::fmt;

use crate::math::Ray;

use super::lanes::Portable;
use super::{traverse, Tree, TriangleHit};

/// An instruction set for which the traversal is compiled. All give the same hits, bit for bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// Whatever the target of the compiler guarantees.
    Portable,
    /// x86-64 with AVX2 and FMA.
    Avx2,
    /// x86-64 with AVX-512F and AVX-512VL.
    Avx512,
}

impl Kernel {
    /// From the slowest to the fastest.
    const ALL: [Self; 3] = [Self::Portable, Self::Avx2, Self::Avx512];

    /// The kernels that this processor can run; [`Kernel::Portable`] always, the best one last.
    pub fn available() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|kernel| kernel.is_available())
    }

    /// The fastest kernel that this processor can run.
    pub fn best() -> Self {
        Self::available().last().unwrap_or(Self::Portable)
    }

    /// Can this processor run the kernel?
    #[cfg(target_arch = "x86_64")]
    pub fn is_available(self) -> bool {
        let avx2 = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("lzcnt");
        match self {
            Self::Portable => true,
            Self::Avx2 => avx2,
            Self::Avx512 => {
                avx2 && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl")
            }
        }
    }

    /// Can this processor run the kernel?
    #[cfg(not(target_arch = "x86_64"))]
    pub fn is_available(self) -> bool {
        self == Self::Portable
    }

    /// A short name: `portable`, `avx2`, `avx512`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// The nearest hit. The kernel must be one that [`Tree`] has accepted.
    #[inline(always)]
    pub(super) fn closest(self, tree: &Tree, ray: &Ray) -> Option<TriangleHit> {
        match self {
            // SAFETY: a tree accepts a kernel only if `is_available`, which tests for every feature
            // that is enabled.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { super::x86::closest_avx2(tree, ray) },
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { super::x86::closest_avx512(tree, ray) },
            _ => traverse::closest::<Portable>(tree, ray),
        }
    }

    /// Is there a crossing? The kernel must be one that [`Tree`] has accepted.
    #[inline(always)]
    pub(super) fn any(self, tree: &Tree, ray: &Ray) -> bool {
        match self {
            // SAFETY: as in `closest`.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { super::x86::any_avx2(tree, ray) },
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { super::x86::any_avx512(tree, ray) },
            _ => traverse::any::<Portable, false>(tree, ray, &mut Vec::new()),
        }
    }

    /// Adds every crossing to `found`. The kernel must be one that [`Tree`] has accepted.
    pub(super) fn all(self, tree: &Tree, ray: &Ray, found: &mut Vec<TriangleHit>) {
        match self {
            // SAFETY: as in `closest`.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { super::x86::all_avx2(tree, ray, found) },
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { super::x86::all_avx512(tree, ray, found) },
            _ => traverse::any::<Portable, true>(tree, ray, found),
        };
    }
}

impl fmt::Display for Kernel {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

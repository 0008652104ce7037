// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Vectors, frames and rounding bounds. Vectors are `glam`'s, in double precision.

mod ray;

pub use glam::{DAffine3, DMat3, DMat4, DVec2, DVec3, IVec3};
pub use ray::Ray;

/// The bound γₙ = nε/(1 − nε) on the relative error of `n` roundings in double precision.
///
/// Source: N. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., lemma 3.1, with
/// ε the unit round-off 2⁻⁵³.
pub const fn gamma(n: u32) -> f64 {
    let n_epsilon = n as f64 * (f64::EPSILON / 2.0);
    n_epsilon / (1.0 - n_epsilon)
}

/// Return two unit vectors that make a right-handed frame with the unit vector `z`.
///
/// Source: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
pub fn orthonormal_pair(z: DVec3) -> (DVec3, DVec3) {
    let sign = 1.0_f64.copysign(z.z);
    let a = -1.0 / (sign + z.z);
    let b = z.x * z.y * a;
    (
        DVec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x),
        DVec3::new(b, sign + z.y * z.y * a, -z.y),
    )
}

/// The largest absolute component of `v`.
pub fn largest_component(v: DVec3) -> f64 {
    v.abs().max_element()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_pair_and_its_axis_are_orthonormal_and_right_handed(
            x in -1.0..1.0f64, y in -1.0..1.0f64, z in -1.0..1.0f64,
        ) {
            prop_assume!(x * x + y * y + z * z > 1e-6);
            let axis = DVec3::new(x, y, z).normalize();
            let (u, v) = orthonormal_pair(axis);
            prop_assert!((u.cross(v) - axis).length() < 1e-14);
            prop_assert!((u.length() - 1.0).abs() < 1e-14);
            prop_assert!(u.dot(v).abs() < 1e-14);
        }
    }

    #[test]
    fn one_rounding_costs_half_an_ulp_of_one() {
        assert!((gamma(1) / (f64::EPSILON / 2.0) - 1.0).abs() < 1e-15);
    }
}

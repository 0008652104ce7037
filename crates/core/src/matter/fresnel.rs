// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Reflection and refraction at a smooth interface: Snell's law and Fresnel's equations.
//!
//! Directions follow one convention: both `wi` and `wo` point away from the surface.

use crate::math::DVec3;

/// Mirror `wi` about the unit normal.
pub fn reflect(wi: DVec3, normal: DVec3) -> DVec3 {
    normal * (2.0 * wi.dot(normal)) - wi
}

/// Refract `wi`, which lies on the normal's side, into the medium on the other side.
///
/// `eta` = n(other side)/n(this side). `None` is total internal reflection. Snell's law.
pub fn refract(wi: DVec3, normal: DVec3, eta: f64) -> Option<DVec3> {
    let cos_i = wi.dot(normal);
    let cos_t = refracted_cosine(cos_i, eta)?;
    Some((normal * (cos_i / eta - cos_t) - wi / eta).normalize())
}

/// The cosine of the refracted ray with the normal's other side; `None` beyond the critical angle.
fn refracted_cosine(cos_i: f64, eta: f64) -> Option<f64> {
    let sin2_t = ((1.0 - cos_i) * (1.0 + cos_i)).max(0.0) / (eta * eta);
    (sin2_t < 1.0).then(|| (1.0 - sin2_t).sqrt())
}

/// The reflectances of an interface between dielectrics for s- and p-polarised light.
///
/// `cos_i` is the cosine on the incident side, `eta` = n₂/n₁. Both are 1 beyond the critical angle.
/// Source: Born & Wolf, *Principles of Optics*, §1.5.2.
pub fn polarised_dielectric_reflectances(cos_i: f64, eta: f64) -> [f64; 2] {
    let cos_i = cos_i.clamp(0.0, 1.0);
    let Some(cos_t) = refracted_cosine(cos_i, eta) else {
        return [1.0, 1.0];
    };
    polarised_reflectances_between(cos_i, cos_t, eta)
}

/// The reflectances for s- and p-polarised light by the cosines on both sides.
pub fn polarised_reflectances_between(cos_i: f64, cos_t: f64, eta: f64) -> [f64; 2] {
    let r_s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let r_p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    [r_s * r_s, r_p * r_p]
}

/// The unpolarised reflectance F of an interface between dielectrics, `½(r_s² + r_p²)`.
///
/// `cos_i` is the cosine on the incident side, `eta` = n₂/n₁. It is 1 beyond the critical angle
/// and exactly 0 for `eta` = 1.
pub fn dielectric_reflectance(cos_i: f64, eta: f64) -> f64 {
    if eta == 1.0 {
        return 0.0;
    }
    let [s, p] = polarised_dielectric_reflectances(cos_i, eta);
    0.5 * (s + p)
}

/// The reflectance of an interface for light of equal radiance from everywhere, 2∫ F(µ) µ dµ.
///
/// `eta` = n₂/n₁, the light coming from side 1. Inside the denser medium it follows from the
/// balance n₁²(1 − F₁₂) = n₂²(1 − F₂₁). Source: J. Walsh, 1926, in the form of W. Egan and
/// T. Hilgeman, *Optical Properties of Inhomogeneous Materials*, 1979.
pub fn diffuse_dielectric_reflectance(eta: f64) -> f64 {
    if eta < 1.0 {
        return 1.0 - (1.0 - diffuse_dielectric_reflectance(1.0 / eta)) * eta * eta;
    }
    // Below this contrast the terms cancel to less than the result.
    if eta - 1.0 < 1e-9 {
        return 0.0;
    }
    let n = eta;
    let n2 = n * n;
    let (n4, above, below) = (n2 * n2, n2 + 1.0, n2 - 1.0);
    0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0).powi(2))
        + n2 * below * below / above.powi(3) * ((n - 1.0) / (n + 1.0)).ln()
        - 2.0 * n * n2 * (n2 + 2.0 * n - 1.0) / (above * (n4 - 1.0))
        + 8.0 * n4 * (n4 + 1.0) / (above * (n4 - 1.0).powi(2)) * n.ln()
}

/// The reflectances of a conductor for s- and p-polarised light; n + ik is relative to the medium
/// the light comes from.
///
/// Source: Born & Wolf, *Principles of Optics*, §14.2, in the form with
/// a² + b² = |√((n + ik)² − sin²θ)|².
pub fn polarised_conductor_reflectances(cos_i: f64, n: f64, k: f64) -> [f64; 2] {
    let cos_i = cos_i.clamp(0.0, 1.0);
    let cos2 = cos_i * cos_i;
    let sin2 = 1.0 - cos2;
    let d = n * n - k * k - sin2;
    // Not `hypot`, which is slow: no index comes near the ends of the range.
    let twice_nk = 2.0 * n * k;
    let a2_b2 = (d * d + twice_nk * twice_nk).sqrt();
    let a = (0.5 * (a2_b2 + d)).max(0.0).sqrt();
    let r_s = (a2_b2 + cos2 - 2.0 * a * cos_i) / (a2_b2 + cos2 + 2.0 * a * cos_i);
    let far = cos2 * a2_b2 + sin2 * sin2;
    let near = 2.0 * a * cos_i * sin2;
    [r_s, r_s * (far - near) / (far + near)]
}

/// The unpolarised reflectance of a conductor with the complex index n + ik relative to the medium
/// the light comes from.
pub fn conductor_reflectance(cos_i: f64, n: f64, k: f64) -> f64 {
    let [s, p] = polarised_conductor_reflectances(cos_i, n, k);
    0.5 * (s + p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn normal_incidence_reflects_the_square_of_the_index_contrast() {
        for (eta, expected) in [(1.5, 0.04), (1.0 / 1.5, 0.04), (1.4915, 0.038_915_7)] {
            assert!((dielectric_reflectance(1.0, eta) - expected).abs() < 1e-6);
        }
        for cos_i in [0.0, 1e-9, 0.3, 1.0] {
            assert_eq!(dielectric_reflectance(cos_i, 1.0), 0.0);
        }
    }

    #[test]
    fn at_brewsters_angle_only_s_polarised_light_is_reflected() {
        let n: f64 = 1.5;
        let cos_b = n.atan().cos();
        let expected = 0.5 * ((n * n - 1.0) / (n * n + 1.0)).powi(2);
        assert!((dielectric_reflectance(cos_b, n) - expected).abs() < 1e-15);
    }

    #[test]
    fn pmma_reflects_totally_from_42_1_degrees() {
        let critical = (1.0_f64 / 1.4915).asin();
        assert!((critical.to_degrees() - 42.1).abs() < 0.05);
        assert_eq!(dielectric_reflectance((critical + 1e-9).cos(), 1.0 / 1.4915), 1.0);
        assert!(dielectric_reflectance((critical - 1e-3).cos(), 1.0 / 1.4915) < 0.9);
    }

    #[test]
    fn aluminium_at_550_nm_reflects_91_5_percent() {
        // Rakić 1995: n = 1.015, k = 6.627 at 550 nm, R = 0.915 at normal incidence.
        assert!((conductor_reflectance(1.0, 1.015, 6.627) - 0.9153).abs() < 2e-4);
        let (n, k): (f64, f64) = (1.015, 6.627);
        let exact = ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
        assert!((conductor_reflectance(1.0, n, k) - exact).abs() < 1e-15);
    }

    #[test]
    fn diffuse_reflectance_is_the_mean_over_the_hemisphere() {
        // Published: 0.0918 outside and 0.596 inside for n = 1.5 (Judd, J. Res. NBS 29, 1942).
        assert!((diffuse_dielectric_reflectance(1.5) - 0.0918).abs() < 5e-5);
        assert!((diffuse_dielectric_reflectance(1.0 / 1.5) - 0.596).abs() < 5e-4);
        assert_eq!(diffuse_dielectric_reflectance(1.0), 0.0);
        for eta in [1.0 / 2.4, 1.0 / 1.5, 0.9, 1.001, 1.1, 1.5, 2.4] {
            let steps = 100_000;
            let sum: f64 = (0..steps)
                .map(|i| (f64::from(i) + 0.5) / f64::from(steps))
                .map(|mu| 2.0 * mu * dielectric_reflectance(mu, eta) / f64::from(steps))
                .sum();
            assert!((diffuse_dielectric_reflectance(eta) - sum).abs() < 1e-6, "{eta}");
        }
    }

    proptest! {
        #[test]
        fn a_conductor_without_extinction_is_a_dielectric(cos in 0.01..1.0f64, n in 1.05..2.5f64) {
            let difference = conductor_reflectance(cos, n, 0.0) - dielectric_reflectance(cos, n);
            prop_assert!(difference.abs() < 1e-12);
        }

        #[test]
        fn refraction_obeys_snell_and_runs_backwards(
            angle in 0.0..1.57f64, azimuth in 0.0..std::f64::consts::TAU, eta in 0.5..2.0f64,
        ) {
            let wi = DVec3::new(
                angle.sin() * azimuth.cos(), angle.sin() * azimuth.sin(), angle.cos());
            let Some(wo) = refract(wi, DVec3::Z, eta) else {
                prop_assert!(angle.sin() >= eta * (1.0 - 1e-12));
                return Ok(());
            };
            let (sin_i, sin_o) = (wi.cross(DVec3::Z).length(), wo.cross(DVec3::Z).length());
            prop_assert!((sin_i - eta * sin_o).abs() < 1e-14);
            prop_assert!(wo.z < 0.0);
            let back = refract(wo, -DVec3::Z, 1.0 / eta).unwrap();
            prop_assert!((back - wi).length() < 1e-6);
            let there = dielectric_reflectance(wi.z, eta);
            let again = dielectric_reflectance(-wo.z, 1.0 / eta);
            prop_assert!((there - again).abs() < 1e-6);
        }
    }
}

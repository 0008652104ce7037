// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The surface of a sphere, stretched or not.

use std::f64::consts::{PI, TAU};

use super::{SurfaceDirection, SurfaceSample};
use crate::math::{orthonormal_pair, DAffine3, DMat3, DVec2, DVec3};
use crate::sampling::{uniform_cone, uniform_sphere};

/// The image of the unit sphere under an affine map M·x + m.
#[derive(Clone, Debug)]
pub(super) struct Ellipsoid {
    from_unit: DAffine3,
    to_unit: DAffine3,
    /// M⁻ᵀ·|det M|: takes a normal n of the unit sphere to n·(dA of the ellipsoid per dA of it).
    cofactors: DMat3,
    /// 1/|det M|.
    shrink: f64,
    area: f64,
}

impl Ellipsoid {
    pub fn new(centre: DVec3, radius: f64, to_world: DAffine3) -> Self {
        let unit = DAffine3::from_scale_rotation_translation(
            DVec3::splat(radius),
            glam::DQuat::IDENTITY,
            centre,
        );
        let from_unit = to_world * unit;
        let to_unit = from_unit.inverse();
        let stretch = from_unit.matrix3.determinant().abs();
        let cofactors = to_unit.matrix3.transpose() * stretch;
        let area = orientations(256, 512).map(|(n, dω)| (cofactors * n).length() * dω).sum();
        Self { from_unit, to_unit, cofactors, shrink: 1.0 / stretch, area }
    }

    pub fn area(&self) -> f64 {
        self.area
    }

    pub fn area_vectors(&self) -> Vec<DVec3> {
        orientations(48, 96).map(|(n, dω)| self.cofactors * n * dω).collect()
    }

    /// Uniform on the unit sphere.
    pub fn sample(&self, [_, v, w]: [f64; 3]) -> SurfaceSample {
        let unit = uniform_sphere(DVec2::new(v, w));
        let stretched = self.cofactors * unit;
        SurfaceSample {
            position: self.from_unit.transform_point3(unit),
            normal: stretched.normalize(),
            pdf: 1.0 / (4.0 * PI * stretched.length()),
        }
    }

    /// Uniform by the solid angle of the cone in which the unit sphere is seen from where the place
    /// is before stretching; stretching multiplies a solid angle by |det M|/|M·ω|³.
    pub fn sample_from(
        &self,
        from: DVec3,
        [_, v, w]: [f64; 3],
        error: f64,
    ) -> Option<SurfaceDirection> {
        let seen = self.to_unit.transform_point3(from);
        let cone = Cone::of(seen)?;
        let (x, y) = orthonormal_pair(cone.axis);
        let local = uniform_cone([v, w], cone.one_minus_cos);
        // The first point on the way, by the angle α that it makes at the sphere's middle with the
        // way to the place: cos α = sin²θ/s + cos θ·√(1 − sin²θ/s²), s the sine of the cone. (Pharr,
        // Jakob and Humphreys, Physically Based Rendering, 4th ed., §6.2.4.)
        let sin_squared = local.x * local.x + local.y * local.y;
        let ratio_squared = (sin_squared / (cone.sin * cone.sin)).min(1.0);
        let cos_alpha = sin_squared / cone.sin + local.z * (1.0 - ratio_squared).sqrt();
        let sin_alpha = (1.0 - cos_alpha * cos_alpha).max(0.0).sqrt();
        let around = (x * local.x + y * local.y).normalize_or_zero();
        let unit = (around * sin_alpha - cone.axis * cos_alpha).normalize();
        let position = self.from_unit.transform_point3(unit);
        let way = position - from;
        let distance = way.length();
        let direction = way / distance;
        Some(SurfaceDirection {
            position,
            normal: (self.cofactors * unit).normalize(),
            direction,
            distance,
            pdf: self.density(&cone, direction),
            error,
        })
    }

    /// The density per sr of the directions of [`Self::sample_from`].
    pub fn density_from(&self, from: DVec3, direction: DVec3) -> f64 {
        let seen = self.to_unit.transform_point3(from);
        Cone::of(seen).map_or(0.0, |cone| self.density(&cone, direction))
    }

    fn density(&self, cone: &Cone, direction: DVec3) -> f64 {
        let back = self.to_unit.matrix3 * direction;
        self.shrink / back.length().powi(3) / (TAU * cone.one_minus_cos)
    }
}

/// The cone in which the unit sphere is seen.
struct Cone {
    axis: DVec3,
    sin: f64,
    one_minus_cos: f64,
}

impl Cone {
    /// The cone from a place outside; `None` inside and on the sphere.
    fn of(place: DVec3) -> Option<Self> {
        let distance = place.length();
        if distance.is_nan() || distance <= 1.0 {
            return None;
        }
        let sin = 1.0 / distance;
        let cos = ((distance - 1.0) * (distance + 1.0)).sqrt() * sin;
        Some(Self { axis: -place / distance, sin, one_minus_cos: sin * sin / (1.0 + cos) })
    }
}

/// Unit vectors over the sphere with their solid angles: two Gauss points on each of half as many
/// bands of equal height, and even steps around.
fn orientations(rings: usize, steps: usize) -> impl Iterator<Item = (DVec3, f64)> {
    let half_gap = 1.0 / 3.0_f64.sqrt();
    (0..rings).flat_map(move |ring| {
        let band = (ring / 2) as f64 + 0.5;
        let offset = if ring % 2 == 0 { -half_gap } else { half_gap } / 2.0;
        let z = 1.0 - 4.0 * (band + offset) / rings as f64;
        let radius = (1.0 - z * z).sqrt();
        let solid_angle = 4.0 * PI / (rings * steps) as f64;
        (0..steps).map(move |step| {
            let (sin, cos) = (TAU * (step as f64 + 0.5) / steps as f64).sin_cos();
            (DVec3::new(radius * cos, radius * sin, z), solid_angle)
        })
    })
}

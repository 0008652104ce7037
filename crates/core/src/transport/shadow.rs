// SPDX-License-Identifier: Apache-2.0 OR MIT
//! The straight way to a light: what opaque bodies block and transparent ones let through.

use crate::geometry::SurfacePoint;
use crate::light::LightSample;
use crate::math::Ray;
use crate::matter::{dielectric_reflectance, Dielectric};
use crate::scene::{Interior, LostRay, Scene};
use crate::spectrum::{SampledSpectrum, SampledWavelengths};

use super::tally::Tally;

/// The most surfaces that one way to a light may cross.
const MOST_SURFACES: usize = 256;

/// The share of a light that reaches `point`: zero behind anything opaque, else absorption (2) along
/// the straight way times `F_st` of every interface crossed.
///
/// The way is not bent, as in the study. `F_st` is taken for the angle outside of the denser body, at
/// which light crosses a parallel plate on both of its faces.
pub(super) fn transmittance_towards(
    scene: &Scene,
    wavelengths: SampledWavelengths,
    (point, mut interior): (&SurfacePoint, Interior),
    way: LightSample,
    tally: &mut Tally,
) -> SampledSpectrum {
    let mut share = SampledSpectrum::ONE;
    let mut ray = Ray {
        origin: point.leave_along(way.direction),
        direction: way.direction,
        t_max: way.distance,
    };
    for _ in 0..MOST_SURFACES {
        tally.shadow_rays += 1;
        let place = scene.first_place(&ray);
        let length = place.as_ref().map_or(ray.t_max, |place| place.hit.point.t);
        let medium = scene.medium(&interior);
        if let Some(body) = medium {
            share *= body.absorption.at(wavelengths).transmittance(length);
        }
        let Some(place) = place else {
            return share;
        };
        let hit = place.hit;
        if scene.material_of(hit.body).dielectric().is_none() {
            return SampledSpectrum::ZERO;
        }
        let beyond = interior.through(place.faces(), |body, cause| tally.lose(body, cause));
        if let Some(face) = scene.interface(&interior, &beyond) {
            let cosine = hit.point.normal.dot(ray.direction).abs();
            let media = [medium, scene.medium(&beyond)];
            let own = scene.material_of(face.body).hall.specular_transmittance.as_ref();
            share *= own.map_or_else(
                || outer_transmittance(wavelengths, cosine, media),
                |table| table.at(wavelengths),
            );
        }
        interior = beyond;
        ray.origin = hit.point.leave_along(ray.direction);
        ray.t_max -= length;
        if share.max() <= 0.0 || ray.t_max <= 0.0 {
            return share;
        }
    }
    if let Some(body) = interior.filling(&scene.bodies) {
        tally.lose(body, LostRay::EndedInside);
    }
    SampledSpectrum::ZERO
}

/// 1 − F of an interface for light at the cosine `outer` in its thinner medium.
fn outer_transmittance(
    wavelengths: SampledWavelengths,
    outer: f64,
    media: [Option<&Dielectric>; 2],
) -> SampledSpectrum {
    let [a, b] =
        media.map(|medium| medium.map_or(SampledSpectrum::ONE, |body| body.index.at(wavelengths)));
    a.zip(b, |a, b| 1.0 - dielectric_reflectance(outer, (a / b).max(b / a)))
}

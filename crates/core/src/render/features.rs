// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Features`]: what each pixel looks at, besides its light.

use rayon::prelude::*;

use super::RenderError;
use crate::math::{DVec2, DVec3, Ray};
use crate::matter::refract;
use crate::scene::{Interior, Place, Scene};
use crate::spectrum::{SampledSpectrum, SampledWavelengths};

/// What one pixel looks at: means over some samples, those that see something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Features {
    /// The distance to the first surface in mm; infinite where there is none.
    pub depth: f64,
    /// Its shading normal, towards the eye; shorter than 1 where it changes within the pixel.
    pub normal: DVec3,
    /// The body in the middle of the pixel.
    pub body: Option<u32>,
    /// X, Y and Z of the first surface's directional albedo under equal-energy light; Y = 1 is white.
    pub albedo: [f64; 3],
    /// How many boundaries of transparent media a ray crosses, refracted, until it meets opaque
    /// matter or leaves.
    pub interfaces: f64,
}

/// Samples along a side of the pixel.
const SIDE: u32 = 3;

/// The most boundaries that are counted.
const MOST_INTERFACES: u32 = 64;

/// What every pixel of a picture looks at, row by row.
///
/// # Errors
/// The camera is inside an opaque body.
pub fn features(
    scene: &Scene,
    width: u32,
    height: u32,
    threads: usize,
) -> Result<Vec<Features>, RenderError> {
    let interior = super::eye_interior(scene)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let pixels = width as usize * height as usize;
    let look = Look { scene, width, height, interior };
    let of_pixel = |number: usize| look.at_pixel(number);
    Ok(pool.install(|| (0..pixels).into_par_iter().map(of_pixel).collect()))
}

struct Look<'a> {
    scene: &'a Scene,
    width: u32,
    height: u32,
    interior: Interior,
}

/// What one ray sees first.
struct Sight {
    depth: f64,
    normal: DVec3,
    body: u32,
    albedo: [f64; 3],
    interfaces: u32,
}

impl Look<'_> {
    fn at_pixel(&self, number: usize) -> Features {
        let width = self.width as usize;
        let corner = DVec2::new((number % width) as f64, (number / width) as f64);
        let cells = SIDE * SIDE;
        let sights = (0..cells).map(|cell| {
            let at = DVec2::new(f64::from(cell % SIDE) + 0.5, f64::from(cell / SIDE) + 0.5);
            self.along(corner + at / f64::from(SIDE), cell)
        });
        let sights: Vec<Option<Sight>> = sights.collect();
        let body = sights[cells as usize / 2].as_ref().map(|sight| sight.body);
        let seen: Vec<Sight> = sights.into_iter().flatten().collect();
        let share = 1.0 / seen.len().max(1) as f64;
        let mean = |value: &dyn Fn(&Sight) -> f64| seen.iter().map(value).sum::<f64>() * share;
        Features {
            depth: if seen.is_empty() { f64::INFINITY } else { mean(&|sight| sight.depth) },
            normal: seen.iter().map(|sight| sight.normal).sum::<DVec3>() * share,
            body,
            albedo: [0, 1, 2].map(|i| mean(&|sight| sight.albedo[i])),
            interfaces: mean(&|sight| f64::from(sight.interfaces)),
        }
    }

    fn along(&self, place: DVec2, cell: u32) -> Option<Sight> {
        let scene = self.scene;
        let ray = scene.camera.ray(place, DVec2::splat(0.5), self.width, self.height);
        let met = scene.first_place(&ray)?;
        let phases = scene.phases();
        let phase = (cell as usize * phases / (SIDE * SIDE) as usize) % phases;
        let wavelengths = SampledWavelengths { phase };
        let normal = met.hit.shading_normal;
        Some(Sight {
            depth: met.hit.point.t,
            normal: normal * -1.0_f64.copysign(normal.dot(ray.direction)),
            body: met.hit.body,
            albedo: self.albedo(&met, -ray.direction, wavelengths),
            interfaces: self.count_interfaces(ray),
        })
    }

    fn albedo(&self, met: &Place, wi: DVec3, wavelengths: SampledWavelengths) -> [f64; 3] {
        let scene = self.scene;
        let white = scene.tristimulus(SampledSpectrum::ONE, wavelengths)[1];
        let reflected = scene.albedo(&met.hit, wi, &self.interior, wavelengths);
        scene.tristimulus(reflected, wavelengths).map(|value| value / white)
    }

    fn count_interfaces(&self, mut ray: Ray) -> u32 {
        let scene = self.scene;
        let (mut interior, mut count) = (self.interior, 0);
        for _ in 0..MOST_INTERFACES {
            let Some(place) = scene.first_place(&ray) else {
                break;
            };
            let hit = place.hit;
            if scene.material_of(hit.body).dielectric().is_none() {
                break;
            }
            let beyond = interior.through(place.faces(), |_, _| {});
            let mut way = ray.direction;
            if scene.interface(&interior, &beyond).is_some() {
                count += 1;
                let index = |list| scene.medium(list).map_or(1.0, |medium| medium.index_d);
                let eta = index(&beyond) / index(&interior);
                let normal = hit.point.normal * -1.0_f64.copysign(hit.point.normal.dot(way));
                let Some(refracted) = refract(-way, normal, eta) else {
                    break;
                };
                way = refracted;
            }
            interior = beyond;
            ray = Ray::endless(hit.point.leave_along(way), way);
        }
        count
    }
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Shining`]: the light of all bodies that shine, from their surfaces.

use super::Departure;
use crate::math::{DVec3, Ray};
use crate::sampling::PixelSampler;
use crate::scene::{BodyId, Interior, Scene};
use crate::spectrum::{SampledSpectrum, SampledWavelengths};

const M2_PER_MM2: f64 = 1e-6;

/// How many points of an emitter are asked for the bodies that they are in.
const PROBES: u32 = 256;

/// The bodies that a place is in, or the opaque one that holds it.
type Around = Result<Interior, BodyId>;

/// The light of all bodies that shine.
pub struct Shining {
    /// For each emitter the bodies that all of its surface is in; `None` where that differs from
    /// place to place, and is asked anew at each.
    around: Vec<Option<Around>>,
}

impl Shining {
    /// The emitters of a scene. Of each, 256 points tell whether all of it is in the same bodies.
    pub fn of(scene: &Scene) -> Self {
        let around = |emitter| {
            let mut seen = (0..PROBES).map(|probe| {
                let u = [0.618_033_988_749_895, 0.754_877_666_246_693, 0.569_840_290_998_053];
                let u = u.map(|step| (f64::from(probe) * step + 0.5).fract());
                place(scene, emitter, u).0.around(scene)
            });
            let first = seen.next()?;
            seen.all(|other| other == first).then_some(first)
        };
        Self { around: (0..scene.emitters.len()).map(around).collect() }
    }

    /// X, Y, Z of each group's flux.
    pub(super) fn flux(&self, scene: &Scene) -> Vec<[f64; 3]> {
        let mut sums = vec![[0.0; 3]; scene.groups];
        for (at, around) in self.around.iter().enumerate() {
            let emitter = scene.emitters.get(at);
            let etendue = emitter.law.etendue(scene.emitters.surface(at).area());
            let inside = match around {
                Some(Ok(interior)) if !emitter.per_n2 => scene.medium(interior),
                _ => None,
            };
            for phase in 0..scene.phases() {
                let wavelengths = SampledWavelengths { phase };
                let mut radiance = emitter.radiance.at(wavelengths);
                if let Some(index) = inside.map(|medium| medium.index.at(wavelengths)) {
                    radiance = radiance * index * index;
                }
                let seen = scene.tristimulus(radiance, wavelengths);
                for (sum, value) in sums[emitter.group].iter_mut().zip(seen) {
                    *sum += value * etendue * M2_PER_MM2 / scene.phases() as f64;
                }
            }
        }
        sums
    }

    /// Draw an emitter by its flux, a place on it by area and a direction by its law.
    pub(super) fn depart(
        &self,
        scene: &Scene,
        [choice, v, w, _]: [f64; 4],
        sampler: &mut PixelSampler,
    ) -> Option<Departure> {
        let wavelengths = sampler.wavelengths(scene.phases());
        let [a, b, ..] = sampler.next_4d();
        let (number, rest) = scene.emitters.choose(choice)?;
        let emitter = scene.emitters.get(number);
        let (at, per_mm2) = place(scene, number, [rest, v, w]);
        let (direction, per_sr) = emitter.law.sample(at.normal, [a, b])?;
        let density = scene.emitters.probability(number) * per_mm2 * per_sr;
        let cos = at.normal.dot(direction);
        let radiance = emitter.radiance(at.normal, direction, wavelengths);
        let mut flux = radiance * (cos * M2_PER_MM2 / density);
        let interior = self.around[number].unwrap_or_else(|| at.around(scene));
        if let (Ok(interior), false) = (&interior, emitter.per_n2) {
            // A radiance in air is the basic radiance L/n² inside.
            let medium = scene.medium(interior).map(|medium| medium.index.at(wavelengths));
            let index = medium.unwrap_or(SampledSpectrum::ONE);
            flux = flux * index * index;
        }
        let ray = Ray::endless(at.origin, direction);
        (flux.max() > 0.0).then_some(Departure {
            ray,
            interior,
            wavelengths,
            flux,
            group: emitter.group,
        })
    }
}

/// A place just before an emitter's surface.
struct Start {
    origin: DVec3,
    normal: DVec3,
}

impl Start {
    fn around(&self, scene: &Scene) -> Around {
        scene.bodies_round(self.origin)
    }
}

/// A place on an emitter for `u` uniform in the unit cube, and its density per mm².
fn place(scene: &Scene, emitter: usize, u: [f64; 3]) -> (Start, f64) {
    let surface = scene.emitters.surface(emitter);
    let chosen = surface.sample(u);
    let origin = chosen.position + chosen.normal * surface.error();
    (Start { origin, normal: chosen.normal }, chosen.pdf)
}

// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Emitters`]: all bodies that shine, and how to choose a point on one of them.

use super::body::BodyId;
use crate::geometry::SampledSurface;
use crate::light::Emitter;
use crate::math::DVec3;
use crate::sampling::Choice;
use crate::spectrum::SpectralTable;

/// A point chosen on an emitter, as seen from a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmitterSample {
    /// The number of the emitter.
    pub emitter: usize,
    /// The point, in mm.
    pub position: DVec3,
    /// The surface's own outward unit normal there; it faces the place.
    pub normal: DVec3,
    /// The unit vector from the place to the point.
    pub direction: DVec3,
    /// How far it is, in mm.
    pub distance: f64,
    /// The density of the direction per sr at the place, the choice of the emitter included.
    pub pdf: f64,
    /// How far, in mm, the point may be from where rays see the surface: moved by as much along
    /// `normal`, it is before the emitter's own surface.
    pub error: f64,
}

/// All bodies that shine; each is chosen by its luminous flux.
#[derive(Clone, Debug, Default)]
pub struct Emitters {
    all: Vec<(Emitter, SampledSurface)>,
    /// For every body up to the last that shines, the number of its emitter.
    of_body: Vec<Option<usize>>,
    by_flux: Option<Choice>,
}

impl Emitters {
    /// The emitters, at most one a body, each with the surface of its body. The inner product with
    /// `luminosity` is the luminance by which they are chosen.
    pub fn new(all: Vec<(Emitter, SampledSurface)>, luminosity: &SpectralTable) -> Self {
        let mut of_body = Vec::new();
        for (at, (emitter, _)) in all.iter().enumerate() {
            let body = emitter.body as usize;
            of_body.resize(of_body.len().max(body + 1), None);
            of_body[body] = Some(at);
        }
        let flux = |(emitter, surface): &(Emitter, SampledSurface)| {
            let luminance = emitter.radiance.mean_dot(luminosity).max(0.0);
            luminance * emitter.law.etendue(surface.area())
        };
        let by_flux = Choice::new(all.iter().map(flux));
        Self { all, of_body, by_flux }
    }

    /// Whether nothing shines.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// An emitter by its number.
    pub fn get(&self, emitter: usize) -> &Emitter {
        &self.all[emitter].0
    }

    /// The surface of an emitter by its number.
    pub fn surface(&self, emitter: usize) -> &SampledSurface {
        &self.all[emitter].1
    }

    /// The number of the emitter that a body is.
    pub fn of_body(&self, body: BodyId) -> Option<usize> {
        self.of_body.get(body as usize).copied().flatten()
    }

    /// An emitter chosen by its luminous flux for `u` uniform in [0, 1), and where in its share `u`
    /// lies: again uniform. `None` where nothing shines.
    pub fn choose(&self, u: f64) -> Option<(usize, f64)> {
        self.by_flux.as_ref().map(|by_flux| by_flux.pick(u))
    }

    /// How often [`choose`](Self::choose) chooses it.
    pub fn probability(&self, emitter: usize) -> f64 {
        self.by_flux.as_ref().map_or(0.0, |by_flux| by_flux.probability(emitter))
    }

    /// A point on one of the emitters for `u` uniform in the unit cube; `None` where the point that
    /// was chosen faces away from `from`, and its light cannot arrive.
    pub fn sample(&self, from: DVec3, [u, v, w]: [f64; 3]) -> Option<EmitterSample> {
        let by_flux = self.by_flux.as_ref()?;
        let (emitter, rest) = by_flux.pick(u);
        let point = self.all[emitter].1.sample_from(from, [rest, v, w])?;
        Some(EmitterSample {
            emitter,
            position: point.position,
            normal: point.normal,
            direction: point.direction,
            distance: point.distance,
            pdf: by_flux.probability(emitter) * point.pdf,
            error: point.error,
        })
    }

    /// The density per sr with which [`sample`](Self::sample) chooses the unit `direction` from
    /// `from` to the point `position` of an emitter with the outward unit `normal`.
    pub fn pdf(
        &self,
        emitter: usize,
        from: DVec3,
        position: DVec3,
        normal: DVec3,
        direction: DVec3,
    ) -> f64 {
        self.by_flux.as_ref().map_or(0.0, |by_flux| {
            let surface = &self.all[emitter].1;
            by_flux.probability(emitter) * surface.pdf_from(from, position, normal, direction)
        })
    }
}

#[cfg(test)]
mod tests;

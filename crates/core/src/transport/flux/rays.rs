// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`RaySet`]: light given as rays, such as a maker measured of a lamp.

use super::{Departure, FluxError};
use crate::math::{DVec3, Ray};
use crate::sampling::{Choice, PixelSampler};
use crate::scene::Scene;
use crate::spectrum::{SampledSpectrum, SampledWavelengths, SpectralTable, LANES};

/// The spectrum of rays.
#[derive(Clone, Debug)]
enum Colour {
    /// All have this one, in W/nm per lm.
    Shared(Box<SpectralTable>),
    /// Each has one wavelength: its number among all, rising, which are `step_nm` apart.
    Single { wavelengths: Vec<u32>, step_nm: f64 },
}

/// Light given as rays.
pub struct RaySet {
    rays: Vec<(DVec3, DVec3)>,
    /// In lm where the spectrum is shared, in W where each ray has a wavelength of its own.
    powers: Vec<f64>,
    colour: Colour,
    by_flux: Choice,
    group: usize,
}

impl RaySet {
    /// Rays from `positions` in mm along `directions` with luminous fluxes in lm, and one spectrum,
    /// whose scale has no meaning, for all.
    ///
    /// # Errors
    /// The arrays differ in length, an entry is no ray, or there is no flux.
    pub fn of_one_spectrum(
        positions: &[[f64; 3]],
        directions: &[[f64; 3]],
        fluxes: Vec<f64>,
        spectrum: &SpectralTable,
        luminosity: &SpectralTable,
    ) -> Result<Self, FluxError> {
        let rays = checked(positions, directions, &fluxes)?;
        let own = spectrum.mean_dot(luminosity);
        if !(own.is_finite() && own > 0.0) {
            return Err(FluxError::NoFlux);
        }
        let by_flux = Choice::new(fluxes.iter().copied()).ok_or(FluxError::NoFlux)?;
        let colour = Colour::Shared(Box::new(spectrum.scaled(1.0 / own)));
        Ok(Self { rays, powers: fluxes, colour, by_flux, group: 0 })
    }

    /// Rays with radiant fluxes in W of one wavelength each: its number among the scene's, rising,
    /// which are `step_nm` apart.
    ///
    /// # Errors
    /// As above, and wavelengths that the scene does not have.
    pub fn of_wavelengths(
        positions: &[[f64; 3]],
        directions: &[[f64; 3]],
        fluxes: Vec<f64>,
        (wavelengths, step_nm): (Vec<u32>, f64),
        luminosity: &SpectralTable,
    ) -> Result<Self, FluxError> {
        let rays = checked(positions, directions, &fluxes)?;
        if wavelengths.len() != rays.len() {
            let (count, rays) = (wavelengths.len(), rays.len());
            return Err(FluxError::Count { what: "wavelengths", count, rays });
        }
        let count = luminosity.phases() * LANES;
        if let Some(ray) = wavelengths.iter().position(|at| *at as usize >= count) {
            return Err(FluxError::Ray {
                ray,
                fault: "its wavelength is not one of the picture's",
            });
        }
        let seen = wavelengths.iter().zip(&fluxes).map(|(at, flux)| {
            let (lane, wavelengths) = lane_of(*at, luminosity.phases());
            flux * luminosity.at(wavelengths).0[lane]
        });
        let by_flux = Choice::new(seen).ok_or(FluxError::NoFlux)?;
        Ok(Self {
            rays,
            powers: fluxes,
            colour: Colour::Single { wavelengths, step_nm },
            by_flux,
            group: 0,
        })
    }

    /// The same rays, counted to a light group.
    #[must_use]
    pub fn in_group(self, group: usize) -> Self {
        Self { group, ..self }
    }

    /// The light group that they are counted to: 0 unless told otherwise.
    pub fn group(&self) -> usize {
        self.group
    }

    /// X, Y, Z of the flux of all rays.
    pub(super) fn flux(&self, scene: &Scene) -> [f64; 3] {
        let tables = &scene.colour_matching;
        match &self.colour {
            Colour::Shared(spectrum) => {
                let total: f64 = self.powers.iter().sum();
                [0, 1, 2].map(|i| total * spectrum.mean_dot(&tables[i]))
            }
            Colour::Single { wavelengths, step_nm } => {
                let phases = scene.phases();
                // What a lane counts stands for all phases; a single wavelength is one of them.
                let share = 1.0 / (phases as f64 * step_nm);
                let mut sums = [0.0; 3];
                for (at, watts) in wavelengths.iter().zip(&self.powers) {
                    let (lane, wavelengths) = lane_of(*at, phases);
                    for (sum, table) in sums.iter_mut().zip(tables) {
                        *sum += watts * share * table.at(wavelengths).0[lane];
                    }
                }
                sums
            }
        }
    }

    /// Draw a ray by its luminous flux.
    pub(super) fn depart(
        &self,
        scene: &Scene,
        [choice, ..]: [f64; 4],
        sampler: &PixelSampler,
    ) -> Option<Departure> {
        let (number, _) = self.by_flux.pick(choice);
        let weight = self.powers[number] / self.by_flux.probability(number);
        let (wavelengths, flux) = match &self.colour {
            Colour::Shared(spectrum) => {
                let wavelengths = sampler.wavelengths(scene.phases());
                (wavelengths, spectrum.at(wavelengths) * weight)
            }
            Colour::Single { wavelengths, step_nm } => {
                let (lane, wavelengths) = lane_of(wavelengths[number], scene.phases());
                let mut flux = SampledSpectrum::ZERO;
                flux.0[lane] = weight / (step_nm * scene.phases() as f64);
                (wavelengths, flux)
            }
        };
        let (origin, direction) = self.rays[number];
        let interior = scene.bodies_round(origin);
        let ray = Ray::endless(origin, direction);
        (flux.max() > 0.0).then_some(Departure {
            ray,
            interior,
            wavelengths,
            flux,
            group: self.group,
        })
    }
}

/// The lane, and the wavelengths that it is among, of wavelength number `at` of all.
fn lane_of(at: u32, phases: usize) -> (usize, SampledWavelengths) {
    let at = at as usize;
    (at / phases, SampledWavelengths { phase: at % phases })
}

fn checked(
    positions: &[[f64; 3]],
    directions: &[[f64; 3]],
    fluxes: &[f64],
) -> Result<Vec<(DVec3, DVec3)>, FluxError> {
    let rays = positions.len();
    for (what, count) in [("directions", directions.len()), ("fluxes", fluxes.len())] {
        if count != rays {
            return Err(FluxError::Count { what, count, rays });
        }
    }
    let ray = |at: usize| {
        let position = DVec3::from_array(positions[at]);
        let direction = DVec3::from_array(directions[at]);
        let fault = |fault| FluxError::Ray { ray: at, fault };
        if !position.is_finite() {
            return Err(fault("its position is not finite"));
        }
        if !(fluxes[at].is_finite() && fluxes[at] >= 0.0) {
            return Err(fault("its flux must be finite and not negative"));
        }
        let direction = direction.try_normalize();
        direction.map(|way| (position, way)).ok_or(fault("its direction has no length"))
    };
    (0..rays).map(ray).collect()
}

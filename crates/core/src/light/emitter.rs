// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Emitter`]: what shines from a body's surface.

use super::angular::AngularLaw;
use crate::math::DVec3;
use crate::spectrum::{SampledSpectrum, SampledWavelengths, SpectralTable};

/// The light that leaves a body's surface on its outward side: that of its geometric normal.
#[derive(Clone, Debug)]
pub struct Emitter {
    /// The number of the body that shines.
    pub body: u32,
    /// The light group that its light is counted to.
    pub group: usize,
    /// Its spectral radiance: along the normal for a cosine law, on average for a table.
    pub radiance: SpectralTable,
    /// How that depends on direction.
    pub law: AngularLaw,
    /// Whether its flux was given, and not its radiance in air: then the basic radiance L/n² inside
    /// a medium of index n is `radiance`/n².
    pub per_n2: bool,
}

impl Emitter {
    /// The emitter whose surface, of `area` in mm², sends out the given spectral `flux` in W/nm.
    pub fn with_flux(
        body: u32,
        group: usize,
        flux: &SpectralTable,
        law: AngularLaw,
        area: f64,
    ) -> Self {
        const MM2_PER_M2: f64 = 1e6;
        let radiance = flux.scaled(MM2_PER_M2 / law.etendue(area));
        Self { body, group, radiance, law, per_n2: true }
    }

    /// The spectral radiance that leaves along the unit vector `direction_out`, at a place with the
    /// outward unit `normal`; nothing on the back. In a medium see `per_n2`.
    pub fn radiance(
        &self,
        normal: DVec3,
        direction_out: DVec3,
        wavelengths: SampledWavelengths,
    ) -> SampledSpectrum {
        let cos = normal.dot(direction_out);
        if cos <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        self.radiance.at(wavelengths) * self.law.factor(cos, direction_out)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::spectrum::LANES;

    fn emitter(law: AngularLaw) -> Emitter {
        let radiance = SpectralTable::from_ascending(&[2.0; LANES]).unwrap();
        Emitter { body: 0, group: 0, radiance, law, per_n2: false }
    }

    fn value(emitter: &Emitter, theta: f64) -> f64 {
        let out = DVec3::new(theta.sin(), 0.0, theta.cos());
        emitter.radiance(DVec3::Z, out, SampledWavelengths { phase: 0 }).0[4]
    }

    #[test]
    fn the_back_is_dark_and_the_front_shines_by_its_law() {
        let cube = emitter(AngularLaw::Cosine { exponent: 3.0 });
        assert!((value(&cube, PI / 3.0) - 0.5).abs() < 1e-15);
        assert_eq!(value(&cube, 0.0), 2.0);
        for law in [AngularLaw::Lambert, AngularLaw::Cosine { exponent: 0.0 }] {
            assert_eq!(value(&emitter(law), 2.0), 0.0);
        }
        assert_eq!(value(&emitter(AngularLaw::Lambert), 1.5), 2.0);
    }

    /// ∫ L cos θ dω by the midpoint rule in θ, against the flux that was given: 1 W/nm on 5 mm².
    #[test]
    fn the_flux_that_was_given_is_the_integral_of_radiance_and_cosine() {
        let flux = SpectralTable::from_ascending(&[1.0; LANES]).unwrap();
        for law in [0.0, 0.5, 1.0, 2.5, 40.0].map(|exponent| AngularLaw::Cosine { exponent }) {
            let emitter = Emitter::with_flux(0, 0, &flux, law.clone(), 5.0);
            let n = 20_000;
            let ring = |i: usize| {
                let theta = (i as f64 + 0.5) / n as f64 * PI / 2.0;
                value(&emitter, theta) * theta.cos() * theta.sin() * TAU * (PI / 2.0 / n as f64)
            };
            let exitance: f64 = (0..n).map(ring).sum();
            assert!((exitance * 5e-6 - 1.0).abs() < 1e-5, "{law:?}: {exitance}");
        }
    }
}
